//! What should be said of a fit, in words.

use crate::fitting::{FitNote, SurprisingShot};
use crate::shooter::ReleaseVariable;
use crate::units::{DEGREE_RAD, FOOT_M, Measure, REV_RAD};

/// What makes chances wrong.
const LOOK_AT: &str = "look at the place (a free throw is 13.75 ft or 4.19 m from the hoop's centre) and the height of the release, the columns (units, left and right, what depth is counted from, made), the physics (air, and this ring may be softer or harder) and the tracker's noise (--tracker)";

/// A note in words.
#[must_use]
pub fn fit_note_text(note: &FitNote) -> String {
    match note {
        FitNote::NoisyTracker { of, share } => format!(
            "{}: {:.0} % of the variance of the measurements is the tracker's error; the shooter's own scatter is what is left of it, and uncertain",
            of.name(),
            100.0 * share
        ),
        FitNote::MostlyPopulation { of, weight } => format!(
            "{}: {:.0} % of what is known of its scatter comes from the population of shooters, not from these shots",
            of.name(),
            100.0 * weight
        ),
        FitNote::OtherNoise { scatter_ratio } => format!(
            "the trajectories scatter {scatter_ratio:.1} times as much about the fitted flights as the tracker should; give its noise with --tracker FILE: the error of a position is about so many times what the tracker says"
        ),
        FitNote::OtherDrag {
            best,
            low,
            high,
            of_physics,
        } => format!(
            "the flights fit a drag coefficient of {best:.3} (95 % interval {low:.3} to {high:.3}), the physics has {of_physics:.3}: speeds and angles rest on it; `bankshot fit --free drag_coefficient` shows how to use another"
        ),
        FitNote::NotNormal {
            skewness_p,
            kurtosis_p,
            sessions_differ,
        } => format!(
            "the releases are not normal (Mardia: skewness p = {skewness_p:.4}, kurtosis p = {kurtosis_p:.4}); {}",
            if *sessions_differ {
                "the sessions differ (see there), which alone can be the reason: fit each with --session"
            } else {
                "look for outliers, or for shots of two kinds"
            }
        ),
        FitNote::HeavyTails {
            degrees_of_freedom,
            is_seen,
        } => format!(
            "{} a t distribution with {degrees_of_freedom:.1} degrees of freedom was fitted. profile.toml holds its standard deviations, draws.parquet all of it (`--draws`)",
            if *is_seen {
                "far releases are more frequent than normal ones;"
            } else {
                "the shots do not show more far releases than normal ones have; as asked for,"
            }
        ),
        FitNote::OtherMakes {
            made,
            expected,
            expected_sd,
        } => format!(
            "{made} shots went in where {expected:.1} \u{b1} {expected_sd:.1} were expected of the measured releases; {LOOK_AT}"
        ),
        FitNote::TooSure {
            calibration_z,
            shots,
        } => {
            let shown: Vec<String> = shots.iter().map(surprising_shot).collect();
            format!(
                "the chances of single shots are too sure (Spiegelhalter's z {calibration_z:+.1}; above 3 in about 1 of 700 tests if they are right). The most surprising: {}. First suspect the tracker's noise (--tracker FILE with a greater one) and these rows; then look at the place, the height of the release, the columns and the physics",
                shown.join(", ")
            )
        }
        FitNote::Drift { of, p, by } => format!(
            "{} drifts by {} from the first shot to the last ({}): the last shots differ from the mean, on which P and the advice are based",
            of.name(),
            drift_in_words(*of, *by),
            p_value(*p)
        ),
        FitNote::SessionsDiffer { of, p } => format!(
            "{} differs between the sessions ({}): the scatter here holds that too, and is wider than that of one session (fit one alone with --session NAME)",
            of.name(),
            p_value(*p)
        ),
        FitNote::ScatterDiffers { of, p } => format!(
            "the scatter of {} differs between the sessions ({}): this fit describes their mixture, not the latest one (fit one alone with --session NAME; `bankshot compare-sessions` compares two)",
            of.name(),
            p_value(*p)
        ),
        FitNote::SerialCorrelation { of, p } => format!(
            "{}: a shot is like the one before it ({}); intervals are then too narrow",
            of.name(),
            p_value(*p)
        ),
    }
}

fn surprising_shot(shot: &SurprisingShot) -> String {
    let result = if shot.made { "went in" } else { "missed" };
    format!("line {} (chance {:.2}) {result}", shot.row, shot.chance)
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
