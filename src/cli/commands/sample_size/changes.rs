//! How many shots show that a shooter has changed: in two equal sessions, and against a first one.

use crate::answers::sample_size::ShotsForChange;
use crate::fitting::{DesignRow, POWER, SessionError};
use crate::present::fit_files::session_changes_text::two_digits;
use crate::store::fit::Fit;

/// The smallest and the largest test.
const LEAST_SHOTS: f64 = 10.0;
pub(super) const MOST_SHOTS: usize = 5000;

/// A session that is there already.
#[derive(Clone)]
pub(super) struct FirstSession {
    pub(super) shots: usize,
    /// How far it knows P, and the scatter (relative).
    pub(super) p: SessionError,
    pub(super) scatter: SessionError,
    /// Error of the scatter of the speed, the angle and the direction (relative).
    pub(super) scatters: [SessionError; 3],
}

impl FirstSession {
    /// The shots of a fit at a place: as the fit knows them.
    pub(super) fn of_fit(fit: &Fit, place: usize) -> Self {
        // Those of other places tell the scatter, not this P.
        let shots = match fit.profiles.len() {
            1 => fit.posterior.shots,
            _ => fit.observed[place].1.max(1),
        };
        let known_to = |error: f64| SessionError {
            of_one_shot: error * (shots as f64).sqrt(),
            shots: shots as f64,
        };
        let sds = [0, 1, 2].map(|i| {
            let sd = fit.posterior.summary(|draw| draw.sds[i]);
            sd.sd / sd.mean
        });
        Self {
            shots,
            p: known_to(fit.usual_probabilities(place).interval().sd),
            scatter: known_to(sds.iter().sum::<f64>() / 3.0),
            scatters: sds.map(known_to),
        }
    }

    /// So many shots with the tracker of the designed tests.
    pub(super) fn designed(rows: &[DesignRow], shots: usize) -> Self {
        Self {
            shots,
            p: known_after(rows, shots, |row| row.probability_error),
            scatter: known_after(rows, shots, DesignRow::sd_error),
            scatters: [0, 1, 2].map(|i| known_after(rows, shots, |row| row.sd_errors[i])),
        }
    }
}

/// The least change of P that shows between the first session (without one, another of the row's
/// size) and one of the row's size: at the level of 95 %, with a power of 80 %.
pub(super) fn least_change(row: &DesignRow, first: Option<&FirstSession>) -> f64 {
    let before = first.map_or(row.probability_error, |first| first.p.error());
    POWER * libm::hypot(before, row.probability_error)
}

/// How far a session of so many shots knows something, from the row of the nearest size.
pub(super) fn known_after(
    rows: &[DesignRow],
    shots: usize,
    error: impl Fn(&DesignRow) -> f64,
) -> SessionError {
    let nearest = rows.iter().min_by_key(|row| row.shots.abs_diff(shots));
    SessionError {
        of_one_shot: nearest.map_or(0.0, |row| error(row) * (row.shots as f64).sqrt()),
        shots: shots as f64,
    }
}

/// A number of shots for people.
pub(super) fn in_words(shots: Option<f64>) -> String {
    match shots {
        None => "no number of".to_owned(),
        Some(shots) if !shots.is_finite() => "no difference:".to_owned(),
        Some(shots) if shots < LEAST_SHOTS => format!("fewer than {LEAST_SHOTS}"),
        Some(shots) if shots > MOST_SHOTS as f64 => format!("more than {MOST_SHOTS}"),
        Some(shots) => format!("about {}", two_digits(shots)),
    }
}

/// Number of shots as words in a list.
pub(super) fn in_short(shots: Option<f64>) -> String {
    match shots {
        None => "not possible".to_owned(),
        Some(shots) if !shots.is_finite() => "no difference".to_owned(),
        shots => in_words(shots).replace("about ", ""),
    }
}

/// How many shots show that the makes or a scatter changed, in two equal sessions and after a first
/// one.
pub(super) fn shots_to_show(
    rows: &[DesignRow],
    first: Option<&FirstSession>,
    changes: &[f64],
) -> Vec<String> {
    let falls = [0.1, 0.2, 0.3];
    let most = rows.last().map_or(0, |row| row.shots);
    let scatter = known_after(rows, most, DesignRow::sd_error).of_one_shot;
    let listed = |shots: &dyn Fn(f64) -> Option<f64>| {
        let of_changes = changes
            .iter()
            .map(|points| format!("{} for {points} per 100", in_short(shots(points / 100.0))));
        of_changes.collect::<Vec<_>>().join(", ")
    };
    let of_falls =
        |shots: &dyn Fn(f64) -> Option<f64>| falls.map(|fall| in_short(shots(fall))).join(", ");
    let mut notes = vec![
        format!(
            "Shots needed in each of two sessions to show a change: {}.",
            listed(&|change| Some(shots_in_each(rows, change)))
        ),
        format!(
            "Shots needed in each to show 10, 20 or 30 % less scatter in one value: {}.",
            of_falls(&|fall| Some(SessionError::each_session(scatter, fall, 1.0 - fall)))
        ),
    ];
    if let Some(first) = first {
        notes.push(format!(
            "After the {} shots of the first session: {}; less scatter: {}.",
            first.shots,
            listed(&|change| further_shots(rows, first, change)),
            of_falls(&|fall| first.scatter.second_session(fall, (1.0 - fall) * scatter))
        ));
        let hidden = |error: &SessionError| 100.0 * POWER * error.error();
        notes.push(format!(
            "Not possible: the first session is too small. It hides a change below {:.1} per 100, or of a scatter below {:.0} %.",
            hidden(&first.p),
            hidden(&first.scatter)
        ));
    }
    notes
}

/// The largest test that answers ask for, where it is so much larger than those of the rows that
/// they do not tell it: the error of a test does not fall with the root of its shots alone, as what
/// is known before it wears off.
pub(super) fn size_to_check(rows: &[DesignRow], changes: &[f64]) -> Option<usize> {
    /// Rows tell tests up to so many times as large.
    const FAR: f64 = 1.5;
    let most = rows.iter().map(|row| row.shots).max()?;
    let asked = changes
        .iter()
        .map(|points| shots_in_each(rows, points / 100.0));
    let largest = asked.filter(|shots| *shots <= MOST_SHOTS as f64);
    let largest = largest.fold(0.0, f64::max);
    (largest > FAR * most as f64).then_some(largest as usize)
}

/// Shots in each of two equal sessions that show a change of P.
pub(super) fn shots_in_each(rows: &[DesignRow], change: f64) -> f64 {
    shots_for(rows, change / (POWER * std::f64::consts::SQRT_2)) as f64
}

/// Shots of a second session that show a change of P since the first one; `None` if no number does.
fn further_shots(rows: &[DesignRow], first: &FirstSession, change: f64) -> Option<f64> {
    let of_one_shot =
        |shots: f64| known_after(rows, shots as usize, |row| row.probability_error).of_one_shot;
    // The row that is nearest in size is known once the size is.
    let rough = first.p.second_session(change, of_one_shot(100.0))?;
    first.p.second_session(change, of_one_shot(rough))
}

/// The shots that show changes of P.
pub(super) fn shots_for_changes_answer(
    rows: &[DesignRow],
    first: Option<&FirstSession>,
    changes: &[f64],
) -> Vec<ShotsForChange> {
    let of_change = |points: &f64| {
        let change = points / 100.0;
        let second = first.and_then(|first| further_shots(rows, first, change));
        ShotsForChange {
            change_of_probability: change,
            shots_in_second_session: second.map(f64::ceil),
            shots_in_each_of_two: shots_in_each(rows, change),
        }
    };
    changes.iter().map(of_change).collect()
}

/// Shots that make P known to a standard deviation, which falls with the square root of the shots:
/// from the row that is nearest to it.
pub(super) fn shots_for(rows: &[DesignRow], probability_error: f64) -> usize {
    let distance =
        |row: &&DesignRow| libm::fabs(libm::log(row.probability_error / probability_error));
    let nearest = rows
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or(0, |row| {
        let ratio = row.probability_error / probability_error;
        (row.shots as f64 * ratio * ratio).ceil() as usize
    })
}
