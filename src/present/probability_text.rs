//! P of one nominal shot in text.

use super::layout::TextAnswer;
use super::rebounds_text::rebounds_text;
use super::words::{
    capitalised, nominal_name, of_100, per_100, per_100_with_error, scatter_note, simulation_error,
    subject, taken_as_exact, variable_name,
};
use crate::answers::probability::{MADE_SHARES, ProbabilityAnswer};
use crate::shooter::{NominalVariable, Profile, ReleaseVariable};
use crate::units::{Dimension, UnitSystem};

/// The answer in text. `scatter` are the changes of the scatter, as they were typed.
#[must_use]
pub fn probability_text(
    profile: &Profile,
    answer: &ProbabilityAnswer,
    scatter: &[String],
) -> TextAnswer {
    let units = profile.output().units;
    let over_draws = answer.over_draws.as_ref();
    let p = over_draws.map_or(answer.probability, |over| over.interval.mean);
    let standard_error = over_draws.map_or(answer.standard_error.unwrap_or(0.0), |over| {
        over.numerical_standard_error
    });
    let error = match (over_draws, answer.standard_error) {
        (Some(over), _) => format!(
            ", simulation error {}",
            simulation_error(over.numerical_standard_error)
        ),
        (None, Some(error)) => format!(", simulation error {}", simulation_error(error)),
        (None, None) => "; the method states no error".to_owned(),
    };
    let mut sentences = vec![capitalised(&format!(
        "{} of 100 go in ({}{error}).",
        of_100(p),
        per_100_with_error(p, standard_error)
    ))];
    sentences.extend(over_draws.map(|over| {
        let [low, high] = [over.interval.low, over.interval.high].map(|p| 100.0 * p);
        format!("95 % interval {low:.0} to {high:.0}, from the measured shots.")
    }));
    let mut labelled = vec![
        ("shot", shot(answer, units)),
        ("scatter", scatter_of(answer, units)),
    ];
    labelled.extend(shares(answer));
    let mut notes: Vec<String> = scatter_note(scatter).into_iter().collect();
    notes.push(taken_as_exact(over_draws.is_some()).to_owned());
    TextAnswer {
        answer: sentences,
        subject: subject(profile, units),
        labelled,
        notes,
        details: details(answer, units),
        ..TextAnswer::default()
    }
}

/// Decimals that people need of a quantity.
fn decimals(dimension: Dimension) -> usize {
    match dimension {
        Dimension::Spin => 1,
        Dimension::Angle => 1,
        _ => 2,
    }
}

fn shot(answer: &ProbabilityAnswer, units: UnitSystem) -> String {
    let values = NominalVariable::ALL.map(|of| {
        let unit = units.unit(of.dimension());
        let value = answer.nominal.get(of) / unit.size;
        let decimals = decimals(of.dimension());
        (value != 0.0).then(|| format!("{} {value:.decimals$} {}", nominal_name(of), unit.name))
    });
    let values: Vec<String> = values.into_iter().flatten().collect();
    values.join(", ")
}

/// The first four standard deviations, and how many more there are.
fn scatter_of(answer: &ProbabilityAnswer, units: UnitSystem) -> String {
    let sigmas = ReleaseVariable::ALL
        .into_iter()
        .zip(&answer.standard_deviations.0);
    let given = sigmas.filter(|(_, (_, sigma))| *sigma > 0.0);
    let values: Vec<String> = given
        .map(|(of, (_, sigma))| {
            let unit = units.unit(of.dimension());
            format!(
                "{} {:.2} {}",
                variable_name(of),
                sigma / unit.size,
                unit.name
            )
        })
        .collect();
    const MOST: usize = 4;
    match values.len() {
        0 => "none".to_owned(),
        n if n <= MOST => values.join(", "),
        n => format!(
            "{}, and {} more (--details)",
            values[..MOST].join(", "),
            n - MOST
        ),
    }
}

/// The words for an outcome.
fn outcome(name: &str) -> &str {
    match name {
        "ring" => "off the ring",
        "board" => "off the board",
        "board_and_ring" => "off board and ring",
        "in_and_out" => "in and out",
        "over" => "over the board",
        "airball" => "air ball",
        other => other,
    }
}

/// The outcomes of shots that went in, and of those that missed: the greatest, and the rest.
fn shares(answer: &ProbabilityAnswer) -> Vec<(&'static str, String)> {
    let Some(all) = &answer.shares else {
        return Vec::new();
    };
    let (made, missed) = all.0.split_at(MADE_SHARES.len().min(all.0.len()));
    let line = |(label, part): (&'static str, &[(String, f64)])| {
        const MOST: usize = 4;
        let total: f64 = part.iter().map(|(_, share)| share).sum();
        let mut part: Vec<&(String, f64)> =
            part.iter().filter(|(_, share)| *share >= 5e-4).collect();
        part.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut words: Vec<String> = part
            .iter()
            .take(MOST)
            .map(|(name, share)| format!("{} {}", outcome(name), per_100(*share)))
            .collect();
        let rest: f64 = part.iter().skip(MOST).map(|(_, share)| share).sum();
        if rest >= 5e-4 {
            words.push(format!("other {}", per_100(rest)));
        }
        (label, format!("{}   {}", per_100(total), words.join(", ")))
    };
    [("went in", made), ("missed", missed)].map(line).into()
}

fn details(answer: &ProbabilityAnswer, units: UnitSystem) -> String {
    let mut text = format!(
        "  method       {}, {} shots\n",
        answer.method.name(),
        answer.shots
    );
    if let Some((low, high)) = answer.interval_95 {
        text += &format!(
            "  simulation   {} per 100, 95 % of the simulation error {} to {}\n",
            per_100(answer.probability),
            per_100(low),
            per_100(high)
        );
    }
    for (of, (_, sigma)) in ReleaseVariable::ALL
        .into_iter()
        .zip(&answer.standard_deviations.0)
    {
        let unit = units.unit(of.dimension());
        text += &format!(
            "  scatter      {} {:.3} {}\n",
            variable_name(of),
            sigma / unit.size,
            unit.name
        );
    }
    for (name, share) in answer.shares.iter().flat_map(|shares| &shares.0) {
        text += &format!("  outcome      {} {:.2}\n", outcome(name), 100.0 * share);
    }
    let rebounds = answer.rebounds.as_ref();
    text + &rebounds.map_or_else(String::new, |rebounds| {
        rebounds_text(rebounds, "misses", units)
    })
}
