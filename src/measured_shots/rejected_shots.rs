//! Rows and shots that are kept out.

use super::row_reader::{FARTHEST_LANDING_M, IS_MISSING};
use super::shooter_shots::ShooterShots;
use crate::dynamics::Simulator;
use crate::fitting::{CENTRE_DEPTH_M, MeasuredRelease, Place, Values, far_shots, landing_of};
use crate::units::FOOT_M;

/// A shot farther than this from the others, in robust standard deviations, is doubtful.
const DOUBTFUL: f64 = 6.0;

/// Rows that were kept out for one kind of reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReasonGroup {
    /// How many.
    pub rows: usize,
    /// The first of them.
    pub first: u64,
    /// The reason of the first.
    pub reason: String,
}

/// The reasons with how often each occurs, the most frequent first. Reasons that differ in numbers
/// or in quoted cells alone are one.
#[must_use]
pub fn grouped_reasons(rejected: &[(u64, String)]) -> Vec<ReasonGroup> {
    let kind = |reason: &str| -> String {
        let outside: Vec<&str> = reason.split('"').step_by(2).collect();
        outside
            .concat()
            .replace(|c: char| c.is_ascii_digit() || "-.+".contains(c), "")
    };
    let mut groups: Vec<(String, ReasonGroup)> = Vec::new();
    for (row, reason) in rejected {
        let kind = kind(reason);
        match groups.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, group)) => group.rows += 1,
            None => groups.push((
                kind,
                ReasonGroup {
                    rows: 1,
                    first: *row,
                    reason: reason.clone(),
                },
            )),
        }
    }
    let mut groups: Vec<ReasonGroup> = groups.into_iter().map(|(_, group)| group).collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.rows));
    groups
}

/// Refuses a file in which so many rows hold absurd values that the columns are probably others. An
/// empty cell is not absurd.
pub(super) fn too_many_absurd(rows: usize, rejected: &[(u64, String)]) -> Result<(), String> {
    /// Fewer than this can be mistakes of single rows, whatever their fraction.
    const MANY: usize = 10;
    /// One in so many.
    const FRACTION: usize = 4;
    let absurd: Vec<(u64, String)> = rejected
        .iter()
        .filter(|(_, reason)| !reason.ends_with(IS_MISSING))
        .cloned()
        .collect();
    if absurd.len() < MANY || FRACTION * absurd.len() <= rows {
        return Ok(());
    }
    let reasons: Vec<String> = grouped_reasons(&absurd)
        .iter()
        .map(|group| {
            format!(
                "\n  {} rows, the first in row {}: {}",
                group.rows, group.first, group.reason
            )
        })
        .collect();
    Err(format!(
        "{} of {rows} rows hold absurd values; do the columns hold what their names say, in these units?{}",
        absurd.len(),
        reasons.concat()
    ))
}

/// Keeps out shots that are none, and those far from all others.
pub(super) fn reject_shots(simulator: &Simulator, shooter: &mut ShooterShots) {
    let mut keep: Vec<Result<(), String>> = shooter
        .shots
        .iter()
        .map(|shot| is_shot(simulator, &shooter.places[shot.place], &shot.values))
        .collect();
    let good: Vec<usize> = (0..keep.len()).filter(|&i| keep[i].is_ok()).collect();
    let kept: Vec<MeasuredRelease> = good.iter().map(|&i| shooter.shots[i].clone()).collect();
    let values = shooter.spin.measured_values();
    let far = far_shots(&kept, shooter.places.len(), values, DOUBTFUL);
    for (&i, far) in good.iter().zip(far) {
        if far {
            keep[i] = Err(format!(
                "left out as doubtful: it is more than {DOUBTFUL:.0} robust standard deviations from the other shots"
            ));
        }
    }
    let mut index = 0;
    let mut filter = |rejected: &mut Vec<(u64, String)>, row: Option<u64>| {
        let verdict = &keep[index];
        index += 1;
        if let (Err(reason), Some(row)) = (verdict, row) {
            rejected.push((row, reason.clone()));
        }
        verdict.is_ok()
    };
    let mut rejected = std::mem::take(&mut shooter.rejected);
    shooter
        .shots
        .retain(|shot| filter(&mut rejected, Some(shot.row)));
    shooter.rejected = rejected;
    retain_by(&mut shooter.sessions, &keep);
    retain_by(&mut shooter.shot_names, &keep);
    retain_by(&mut shooter.tracks, &keep);
    retain_by(&mut shooter.chi_squares, &keep);
    // A place that lost all its shots is none.
    let mut numbers: Vec<Option<usize>> = vec![None; shooter.places.len()];
    for shot in &shooter.shots {
        numbers[shot.place] = Some(0);
    }
    let used: Vec<usize> = (0..numbers.len())
        .filter(|&place| numbers[place].is_some())
        .collect();
    for (number, &place) in used.iter().enumerate() {
        numbers[place] = Some(number);
    }
    for shot in &mut shooter.shots {
        shot.place = numbers[shot.place].unwrap_or(0);
    }
    shooter.place_scatter = used
        .iter()
        .map(|&place| shooter.place_scatter[place])
        .collect();
    shooter.places = used.iter().map(|&place| shooter.places[place]).collect();
}

/// Whether a release is one at this hoop.
fn is_shot(simulator: &Simulator, place: &Place, values: &Values) -> Result<(), String> {
    let Some(landing) = landing_of(simulator, place, values) else {
        return Err("does not rise to the hoop: no shot".to_owned());
    };
    let beyond = landing.depth_m - CENTRE_DEPTH_M;
    let off = libm::hypot(beyond, landing.right_m);
    if off > FARTHEST_LANDING_M {
        return Err(format!(
            "falls through the height of the hoop {:.1} ft from its centre: no shot at it",
            off / FOOT_M
        ));
    }
    Ok(())
}

/// Keeps the elements of a list, if it has one for each verdict.
fn retain_by<T>(list: &mut Vec<T>, keep: &[Result<(), String>]) {
    if list.len() == keep.len() {
        let mut index = 0;
        list.retain(|_| {
            index += 1;
            keep[index - 1].is_ok()
        });
    }
}
