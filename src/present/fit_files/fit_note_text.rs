//! What should be said of a fit, in words.

use crate::fitting::{Contradiction, FitNote, SurprisingShot};
use crate::present::words::variable_name;
use crate::shooter::ReleaseVariable;
use crate::units::{DEGREE_RAD, FOOT_M, Measure, REV_RAD};

/// What to do where the makes contradict the measured shots.
pub const WHAT_TO_CHECK: &str = "Check which word is a make, the units, the distance, the release height, the columns and the physics.";

/// How the makes contradict the measured shots, without a full stop.
#[must_use]
pub fn contradiction(of: &Contradiction) -> String {
    format!(
        "{} of {} went in, but the measured shots predict {:.0}",
        of.made, of.shots, of.expected
    )
}

/// A note in words, without a full stop.
#[must_use]
pub fn fit_note_text(note: &FitNote) -> String {
    match note {
        FitNote::NoisyTracker { of, share } => format!(
            "{:.0} % of the measured variance of the {} is tracker noise, so the scatter is uncertain",
            100.0 * share,
            variable_name(*of)
        ),
        FitNote::MostlyPopulation { of, weight } => format!(
            "{:.0} % of the estimate of the scatter of the {} comes from other players (the prior), not from these shots",
            100.0 * weight,
            variable_name(*of)
        ),
        FitNote::OtherNoise { scatter_ratio } => format!(
            "the points scatter {scatter_ratio:.1} times as much about the fitted flights as the tracker's noise predicts; give its noise with --tracker FILE"
        ),
        FitNote::OtherDrag {
            best,
            low,
            high,
            of_physics,
        } => format!(
            "the flights fit a drag coefficient of {best:.3} (95 % interval {low:.3} to {high:.3}), but the physics has {of_physics:.3}; `bankshot fit --free drag_coefficient` shows how to use another"
        ),
        FitNote::NotNormal {
            skewness_p,
            kurtosis_p,
            sessions_differ,
        } => format!(
            "the releases are not normally distributed (Mardia: skewness {}, kurtosis {}); {}",
            p_value(*skewness_p),
            p_value(*kurtosis_p),
            if *sessions_differ {
                "the sessions differ, which can be the reason: fit each with --session"
            } else {
                "look for outliers, or for shots of two kinds"
            }
        ),
        FitNote::HeavyTails {
            degrees_of_freedom,
            is_seen,
        } => format!(
            "a t distribution with {degrees_of_freedom:.1} degrees of freedom was fitted {}; profile.toml has its standard deviations, draws.parquet all of it",
            if *is_seen {
                "because outliers are more frequent than in a normal distribution"
            } else {
                "(as requested), although the shots show no more outliers than a normal distribution has"
            }
        ),
        FitNote::OtherMakes {
            made,
            expected,
            expected_sd,
        } => format!(
            "{made} shots went in, but the measured shots predict {expected:.1} (standard deviation {expected_sd:.1}); check the distance (a free throw is 13.75 ft or 4.19 m from the hoop's centre), the release height, the columns and units, the physics and the tracker's noise"
        ),
        FitNote::TooSure {
            calibration_z,
            shots,
        } => {
            let shown: Vec<String> = shots.iter().map(surprising_shot).collect();
            format!(
                "the chances of single shots are overconfident (Spiegelhalter's z {calibration_z:+.1}, limit 3); most surprising: {}. Try more tracker noise (--tracker FILE), then check these rows, the distance, the release height and the columns",
                shown.join(", ")
            )
        }
        FitNote::Drift { of, p, by } => format!(
            "the {} drifts by {} from the first shot to the last ({}), so the last shots differ from the average that the results describe",
            variable_name(*of),
            drift_in_words(*of, *by),
            p_value(*p)
        ),
        FitNote::SessionsDiffer { of, p } => format!(
            "the {} differs between sessions ({}), so the scatter includes that difference; fit one session with --session NAME",
            variable_name(*of),
            p_value(*p)
        ),
        FitNote::ScatterDiffers { of, p } => format!(
            "the scatter of the {} differs between sessions ({}), so the fit describes their mixture; fit one session with --session NAME",
            variable_name(*of),
            p_value(*p)
        ),
        FitNote::SerialCorrelation { of, p } => format!(
            "the {} depends on that of the shot before ({}), which makes the intervals wider",
            variable_name(*of),
            p_value(*p)
        ),
    }
}

fn surprising_shot(shot: &SurprisingShot) -> String {
    let result = if shot.made { "went in" } else { "missed" };
    format!("row {} (chance {:.2}) {result}", shot.row, shot.chance)
}

/// How much and to which side a value drifts.
fn drift_in_words(of: ReleaseVariable, by: Measure) -> String {
    let (by, size) = (by.in_si(), by.in_si().abs());
    let side = |words: [&'static str; 2]| words[usize::from(by < 0.0)];
    match of {
        ReleaseVariable::Pitch => format!("{:.1} deg {}", size / DEGREE_RAD, side(["up", "down"])),
        ReleaseVariable::Polar => format!(
            "{:.1} deg {}",
            size / DEGREE_RAD,
            side(["to the left", "to the right"])
        ),
        ReleaseVariable::Speed => format!(
            "{:.2} ft/s ({size:.2} m/s) {}",
            size / FOOT_M,
            side(["up", "down"])
        ),
        _ => format!("{:.2} rev/s {}", size / REV_RAD, side(["up", "down"])),
    }
}

/// `p = 0.22`, `p = 0.0031`, or `p < 0.0001`.
#[must_use]
pub fn p_value(p: f64) -> String {
    match p {
        p if p < 1e-4 => "p < 0.0001".to_owned(),
        p if p < 0.01 => format!("p = {p:.4}"),
        p => format!("p = {p:.2}"),
    }
}
