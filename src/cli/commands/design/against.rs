//! How many shots show the difference of two known shooters, or of one shooter on two days.

use super::TestedShot;
use super::changes::{FirstSession, in_words, known_after};
use crate::fitting::{DesignRow, POWER, SessionError};
use crate::output::json_object::number;
use crate::shooter::ReleaseVariable;
use serde_json::{Value, json};

/// A second session as it is expected: its shots differ from those of the first one.
pub(super) struct Against {
    /// Whose session it is.
    pub(super) name: String,
    /// What differs.
    pub(super) differences: Vec<SessionDifference>,
}

/// What differs between the sessions, and how many shots show it.
pub(super) struct SessionDifference {
    /// The name of a key.
    key: &'static str,
    /// What it is, for people.
    what: &'static str,
    /// The values of both sessions.
    values: [f64; 2],
    /// Shots in each of two equal sessions.
    in_each: f64,
    /// Shots of a second session after the first one; `None` if no number shows it, or without a
    /// first one.
    in_second: Option<f64>,
}

/// The scatter that is compared.
const SCATTER: [(&str, &str, ReleaseVariable); 3] = [
    ("speed_sd", "speed scatter", ReleaseVariable::Speed),
    ("pitch_sd", "pitch scatter", ReleaseVariable::Pitch),
    ("polar_sd", "polar scatter", ReleaseVariable::Polar),
];

impl Against {
    /// From simulated tests of both sessions.
    pub(super) fn new(
        name: String,
        [first, second]: [&TestedShot; 2],
        [rows, second_rows]: [&[DesignRow]; 2],
        session: Option<&FirstSession>,
    ) -> Self {
        let sigmas = [first, second].map(|of| of.profile.shooter().dispersion.sigmas(&of.nominal));
        // Relative errors of a scatter are errors of its logarithm.
        let mut differences = vec![difference(
            ("probability", "P"),
            [first.probability, second.probability],
            second.probability - first.probability,
            [rows, second_rows],
            &|row| row.probability_error,
            session.map(|session| session.p),
        )];
        for (i, (key, what, variable)) in SCATTER.into_iter().enumerate() {
            let index = ReleaseVariable::ALL.iter().position(|of| *of == variable);
            let values = sigmas.map(|sigmas| index.map_or(0.0, |index| sigmas[index]));
            differences.push(difference(
                (key, what),
                values,
                libm::log(values[1] / values[0]),
                [rows, second_rows],
                &|row| row.sd_errors[i],
                session.map(|session| session.scatter),
            ));
        }
        Self { name, differences }
    }

    /// For people.
    pub(super) fn text(&self, session: Option<&FirstSession>) -> String {
        let mut text = format!(
            "Shots in each of two equal sessions that show how {} differs (95 % level, power 80 %){}:\n",
            self.name,
            session.map_or_else(String::new, |session| format!(
                "; in brackets, in a second session after the {} shots of the first one",
                session.shots
            ))
        );
        for difference in &self.differences {
            let [before, after] = difference.values;
            let change = match difference.key {
                "probability" => format!(
                    "{:.1} to {:.1} of 100 ({:+.1} points)",
                    100.0 * before,
                    100.0 * after,
                    100.0 * (after - before)
                ),
                _ => format!("{:+.0} %", 100.0 * (after / before - 1.0) + 0.0),
            };
            text += &format!(
                "  {}, {change}: {}{}\n",
                difference.what,
                in_words(Some(difference.in_each)),
                session.map_or_else(String::new, |_| format!(
                    " ({})",
                    in_words(difference.in_second)
                ))
            );
        }
        text + "Each is a test of its own: of several at once, one shows by chance more often. never: the first shots alone leave it too unsure.\n"
    }

    pub(super) fn json(&self) -> Value {
        let listed = self.differences.iter().map(|difference| {
            let [before, after] = difference.values;
            json!({
                "name": difference.key,
                "change": number(match difference.key {
                    "probability" => after - before,
                    _ => after / before - 1.0,
                }),
                "shots_in_each_of_two": number(difference.in_each),
                "shots_in_second_session": difference.in_second.map(|shots| number(shots.ceil())),
            })
        });
        json!({ "shooter": self.name, "differences": listed.collect::<Value>() })
    }
}

/// How many shots show a change, with the errors of both sessions.
fn difference(
    (key, what): (&'static str, &'static str),
    values: [f64; 2],
    change: f64,
    [rows, second_rows]: [&[DesignRow]; 2],
    error: &dyn Fn(&DesignRow) -> f64,
    session: Option<SessionError>,
) -> SessionDifference {
    let change = change.abs();
    // The row that is nearest in size is known once the size is.
    let of_one_shot =
        |rows: &[DesignRow], shots: f64| known_after(rows, shots as usize, error).of_one_shot;
    let in_each_near = |shots: f64| {
        let both = libm::hypot(of_one_shot(rows, shots), of_one_shot(second_rows, shots));
        let root = POWER * both / change;
        root * root
    };
    let in_second_near =
        |shots: f64| session?.second_session(change, of_one_shot(second_rows, shots));
    const ROUGHLY: f64 = 100.0;
    SessionDifference {
        key,
        what,
        values,
        in_each: in_each_near(in_each_near(ROUGHLY)),
        in_second: in_second_near(ROUGHLY).and_then(in_second_near),
    }
}
