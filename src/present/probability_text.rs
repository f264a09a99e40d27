//! P of one nominal shot, for people.

use crate::answers::probability::{MADE_SHARES, ProbabilityAnswer};
use crate::shooter::{NominalVariable, ReleaseVariable};
use crate::units::{Dimension, UnitSystem};

/// The answer as text.
#[must_use]
pub fn answer_text(answer: &ProbabilityAnswer, units: UnitSystem) -> String {
    let (p, shots, method) = (answer.probability, answer.shots, answer.method.name());
    let mut text = match answer.standard_error.zip(answer.interval_95) {
        Some((error, (low, high))) => {
            let digits = decimals(error);
            format!(
                "P = {p:.digits$} ± {error:.digits$} (95 %: {low:.digits$} to {high:.digits$}), {shots} shots by {method}\n"
            )
        }
        None => format!(
            "P = {p:.4}, {shots} shots by {method} (its error is unknown; with n about 40 it was 0.004 to 0.02)\n"
        ),
    };
    let values = [
        NominalVariable::Speed,
        NominalVariable::Pitch,
        NominalVariable::Polar,
        NominalVariable::Backspin,
        NominalVariable::RifleSpin,
        NominalVariable::SideSpin,
    ]
    .map(|of| (of.name(), of.dimension(), answer.nominal.get(of)));
    text.push_str(&format!("shot    {}\n", list(values, units)));
    let sigmas = ReleaseVariable::ALL
        .iter()
        .zip(&answer.standard_deviations.0);
    let sigmas = sigmas.map(|(of, (_, sigma))| (of.name(), of.dimension(), *sigma));
    let sigmas = list(sigmas, units);
    let sigmas = if sigmas.is_empty() { "none" } else { &sigmas };
    text.push_str(&format!("errors  {sigmas} (standard deviations)\n"));
    let shares = answer.shares.as_ref().map_or(&[][..], |shares| &shares.0);
    let (made, missed) = shares.split_at(MADE_SHARES.len().min(shares.len()));
    for (label, part) in [("made", made), ("missed", missed)] {
        let parts: Vec<String> = part
            .iter()
            .filter(|(_, share)| *share >= 5e-5)
            .map(|(name, share)| format!("{} {:.2} %", name.replace('_', " "), 100.0 * share))
            .collect();
        if !parts.is_empty() {
            text.push_str(&format!("{label:7} {}\n", parts.join(", ")));
        }
    }
    text
}

/// Values with their units; those that are 0 are left out.
fn list(
    values: impl IntoIterator<Item = (&'static str, Dimension, f64)>,
    units: UnitSystem,
) -> String {
    let present = values.into_iter().filter(|(_, _, value)| *value != 0.0);
    let parts = present.map(|(name, dimension, value)| {
        let unit = units.unit(dimension);
        let name = name.replace('_', " ");
        format!("{name} {:.3} {}", value / unit.size, unit.name)
    });
    parts.collect::<Vec<_>>().join(", ")
}

/// Decimals that show a digit of the standard error, 4 to 9.
fn decimals(standard_error: f64) -> usize {
    (4..9)
        .find(|&digits| standard_error * libm::pow(10.0, digits as f64) >= 0.95)
        .unwrap_or(if standard_error > 0.0 { 9 } else { 4 })
}
