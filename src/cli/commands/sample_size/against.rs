//! How many shots show the difference of two known shooters, or of one shooter on two days.

use super::changes::{FirstSession, in_short, known_after};
use super::tested_shot::TestedShot;
use crate::answers::sample_size::{AgainstAnswer, ShotsForDifference};
use crate::fitting::{Covariance, DesignRow, POWER, SessionError, values_of};
use crate::shooter::ReleaseVariable;
use crate::units::{DEGREE_RAD, UnitSystem};

/// A second session as it is expected: its shots differ from those of the first one.
pub(super) struct Against {
    /// Whose session it is.
    name: String,
    /// What differs.
    differences: Vec<SessionDifference>,
}

/// What differs between the sessions, and how many shots show it.
struct SessionDifference {
    /// The name of a key.
    key: &'static str,
    /// What it is and how it differs, for people.
    words: String,
    /// The difference: of P, of a value in SI units, or of a scatter as a share of it.
    change: f64,
    /// Shots in each of two equal sessions.
    in_each: f64,
    /// Shots of a second session after the first one; `None` if no number shows it, or without a
    /// first one.
    in_second: Option<f64>,
}

/// The values that are compared: their index in a release, and the names of their mean and scatter.
const VALUES: [(ReleaseVariable, &str, &str, &str); 3] = [
    (ReleaseVariable::Speed, "speed", "speed_mean", "speed_sd"),
    (ReleaseVariable::Pitch, "angle", "pitch_mean", "pitch_sd"),
    (
        ReleaseVariable::Polar,
        "direction",
        "polar_mean",
        "polar_sd",
    ),
];

/// How far a session of so many shots knows something, as [`SessionError::of_one_shot`].
type OfOneShot<'a> = &'a dyn Fn(f64) -> f64;

impl Against {
    /// From simulated tests of both sessions, and the errors of the tracker at both shots.
    pub(super) fn new(
        name: String,
        [first, second]: [&TestedShot; 2],
        [rows, second_rows]: [&[DesignRow]; 2],
        noises: [&Covariance; 2],
        (session, units): (Option<&FirstSession>, UnitSystem),
    ) -> Self {
        let known = |rows: &[DesignRow], error: &dyn Fn(&DesignRow) -> f64, shots: f64| {
            known_after(rows, shots as usize, error).of_one_shot
        };
        let p_error = |row: &DesignRow| row.probability_error;
        let change = second.probability - first.probability;
        let mut differences = vec![SessionDifference::new(
            "probability",
            format!(
                "makes per 100, {:.1} to {:.1} ({:+.1})",
                100.0 * first.probability,
                100.0 * second.probability,
                100.0 * change
            ),
            (change, change),
            [&|shots| known(rows, &p_error, shots), &|shots| {
                known(second_rows, &p_error, shots)
            }],
            session.map(|session| session.p),
        )];
        let both = [first, second];
        let sigmas = both.map(|of| of.profile.shooter().dispersion.sigmas(&of.nominal));
        let means = both.map(|of| values_of(&of.nominal));
        let (long, metre) = units.length();
        for (i, (variable, name, mean_key, sd_key)) in VALUES.into_iter().enumerate() {
            let (unit, size) = match variable {
                ReleaseVariable::Speed => (format!("{long}/s"), metre),
                _ => ("deg".to_owned(), DEGREE_RAD),
            };
            let sd = sigmas.map(|sigmas| sigmas[variable.index()]);
            // Of a mean: the scatter and the tracker's noise, in each shot.
            let of_mean = [0, 1].map(|k| libm::sqrt(sd[k] * sd[k] + noises[k][(i, i)]));
            let change = means[1][i] - means[0][i];
            differences.push(SessionDifference::new(
                mean_key,
                format!(
                    "{name}, {:.2} to {:.2} {unit}",
                    means[0][i] / size,
                    means[1][i] / size
                ),
                (change, change),
                [&|_| of_mean[0], &|_| of_mean[1]],
                session.map(|session| SessionError {
                    of_one_shot: of_mean[0],
                    shots: session.p.shots,
                }),
            ));
            // A relative error of a scatter is an error of its logarithm.
            let sd_error = |row: &DesignRow| row.sd_errors[i];
            let grown = sd[1] / sd[0];
            differences.push(SessionDifference::new(
                sd_key,
                format!("scatter of {name}, {:+.0} %", 100.0 * (grown - 1.0) + 0.0),
                (grown - 1.0, libm::log(grown)),
                [&|shots| known(rows, &sd_error, shots), &|shots| {
                    known(second_rows, &sd_error, shots)
                }],
                session.map(|session| session.scatters[i]),
            ));
        }
        Self { name, differences }
    }

    /// For people: a sentence for each difference.
    pub(super) fn notes(&self, session: Option<&FirstSession>) -> Vec<String> {
        let mut notes = vec![format!(
            "Shots in each of two sessions to show how {} differs (brackets: in a second session after the first one):",
            self.name
        )];
        notes.extend(self.differences.iter().map(|difference| {
            let after = session.map_or_else(String::new, |_| {
                format!(" ({})", in_short(difference.in_second))
            });
            format!(
                "  {}: {}{after}",
                difference.words,
                in_short(Some(difference.in_each))
            )
        }));
        notes.push(
            "Measured differences are often exaggerated by chance, so plan for more shots; several values at once need more too."
                .to_owned(),
        );
        notes
    }

    /// For programs.
    pub(super) fn answer(&self) -> AgainstAnswer {
        let of = |difference: &SessionDifference| ShotsForDifference {
            name: difference.key,
            change: difference.change,
            shots_in_each_of_two: difference.in_each,
            shots_in_second_session: difference.in_second.map(f64::ceil),
        };
        AgainstAnswer {
            shooter: self.name.clone(),
            differences: self.differences.iter().map(of).collect(),
        }
    }
}

impl SessionDifference {
    /// Of a change, and the same on the scale of the errors.
    fn new(
        key: &'static str,
        words: String,
        (change, on_scale): (f64, f64),
        [first, second]: [OfOneShot<'_>; 2],
        session: Option<SessionError>,
    ) -> Self {
        let on_scale = on_scale.abs();
        let in_each_near = |shots: f64| {
            let root = POWER * libm::hypot(first(shots), second(shots)) / on_scale;
            root * root
        };
        let in_second_near = |shots: f64| session?.second_session(on_scale, second(shots));
        // The row that is nearest in size is known once the size is.
        const ROUGHLY: f64 = 100.0;
        Self {
            key,
            words,
            change,
            in_each: in_each_near(in_each_near(ROUGHLY)),
            in_second: in_second_near(ROUGHLY).and_then(in_second_near),
        }
    }
}
