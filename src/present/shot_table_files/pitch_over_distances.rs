//! The best shots at several pitch angles from several distances: which one pitch angle suits a
//! launcher whose angle is fixed.

use super::by_pitch::kind_before_shot;
use super::notes::{has_no_reserve, physics_note, speed_limit_in_words};
use super::table_text::{decimal, line, wrapped};
use crate::best_shot::{ShotAtPitch, TableKind};
use crate::shooter::{Profile, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem};

/// The shots from one distance, one for each pitch angle. All distances have the same angles.
#[derive(Clone, Debug)]
pub struct DistanceShots {
    /// The profile at that distance.
    pub profile: Profile,
    /// The best shots there.
    pub shots: Vec<ShotAtPitch>,
}

impl DistanceShots {
    fn distance(&self, units: UnitSystem) -> f64 {
        let distance = self.profile.location().distance_m / units.length().1;
        // Without what its conversion cost in the last digits.
        (distance * 1e9).round() / 1e9
    }

    /// P at a pitch angle; zero where no shot goes in.
    fn probability(&self, row: usize) -> f64 {
        self.shots[row].probability()
    }

    /// Whether a clean shot goes in at one of the angles.
    fn is_in_reach(&self) -> bool {
        self.shots.iter().any(|at| at.shot.is_some())
    }

    /// P at a pitch angle in a table.
    fn cell(&self, row: usize, kind: TableKind) -> String {
        let at = &self.shots[row];
        let p = decimal(at.probability(), 3);
        match (&at.shot, at.not_clean) {
            (Some(shot), _) if kind == TableKind::Better && shot.kind == ShotKind::Bank => p + "b",
            (Some(_), _) => p,
            (None, Some(_)) => p + "*",
            (None, None) => decimal(f64::NAN, 3),
        }
    }
}

/// Angles of the list on both sides of one, deg, where they are more than a degree from it: between
/// them the mean can have a peak.
fn neighbours_apart(from: &[&DistanceShots], row: usize) -> Option<(String, String)> {
    const NEAR_RAD: f64 = 1.01 * DEGREE_RAD;
    let angles = &from.first()?.shots;
    let [low, high] = [row.saturating_sub(1), (row + 1).min(angles.len() - 1)];
    let apart = |other: usize| (angles[other].pitch_rad - angles[row].pitch_rad).abs();
    (apart(low).max(apart(high)) > NEAR_RAD).then(|| (degrees(from, low), degrees(from, high)))
}

/// A loss of the mean P that the sentence about the angles counts as none.
const LEVEL: f64 = 0.01;
/// Distances side by side in 80 columns.
const ACROSS: usize = 8;

/// Mean and least P over the distances at a pitch angle.
fn mean_and_least(from: &[&DistanceShots], row: usize) -> (f64, f64) {
    let all = from.iter().map(|shots| shots.probability(row));
    let (sum, least) = all.fold((0.0, 1.0_f64), |(sum, least), p| (sum + p, least.min(p)));
    (sum / from.len() as f64, least)
}

/// The pitch angle of a row, in degrees.
fn degrees(from: &[&DistanceShots], row: usize) -> String {
    let text = format!("{:.1}", from[0].shots[row].pitch_rad / DEGREE_RAD);
    text.trim_end_matches(".0").to_owned()
}

/// What one pitch angle costs against the best of the angles at each distance.
fn cost_in_words(from: &[&DistanceShots], row: usize, units: UnitSystem) -> String {
    let costs: Vec<(f64, &DistanceShots)> = from
        .iter()
        .map(|&shots| {
            let all = (0..shots.shots.len()).map(|row| shots.probability(row));
            (all.fold(0.0, f64::max) - shots.probability(row), shots)
        })
        .collect();
    let mean = costs.iter().map(|(cost, _)| cost).sum::<f64>() / costs.len().max(1) as f64;
    let most = costs.iter().max_by(|a, b| a.0.total_cmp(&b.0));
    most.map_or_else(String::new, |(most, shots)| {
        format!(
            " Against the best of these angles at each distance {} deg makes {:.1} less on average, and {:.1} less at most, from {} {}.",
            degrees(from, row),
            100.0 * mean,
            100.0 * most,
            shots.distance(units),
            units.length().0
        )
    })
}

/// From where the shots at a pitch angle have no reserve of speed, with a space before it; empty
/// where all have one.
fn reserve_in_words(from: &[&DistanceShots], row: usize, units: UnitSystem) -> String {
    let is_short = |shots: &&&DistanceShots| {
        let shot = shots.shots[row].shot.as_ref();
        shot.is_some_and(|shot| has_no_reserve(&shots.profile, &shot.nominal))
    };
    let places: Vec<String> = from
        .iter()
        .filter(is_short)
        .map(|shots| shots.distance(units).to_string())
        .collect();
    if places.is_empty() {
        return String::new();
    }
    format!(
        " But from {} {} its speed is within one standard deviation of speed_max: there nothing is left to set it higher in the gym.",
        places.join(", "),
        units.length().0
    )
}

/// P at each pitch angle and distance for people, at most 80 columns wide: the angle with the
/// greatest mean and that with the greatest least P, then a table.
#[must_use]
pub fn pitch_over_distances_text(
    from: &[DistanceShots],
    kind: TableKind,
    units: UnitSystem,
) -> String {
    let [first, ..] = from else {
        return String::new();
    };
    let (long, _) = units.length();
    let everywhere = from;
    let (mut from, beyond): (Vec<&DistanceShots>, Vec<&DistanceShots>) =
        everywhere.iter().partition(|shots| shots.is_in_reach());
    let out_of_reach: Vec<String> = match from.is_empty() {
        true => Vec::new(),
        false => beyond
            .iter()
            .map(|shots| format!("{}", shots.distance(units)))
            .collect(),
    };
    if from.is_empty() {
        from = beyond;
    }
    let from = &from[..];
    let rows: Vec<(f64, f64)> = (0..first.shots.len())
        .map(|row| mean_and_least(from, row))
        .collect();
    let degrees = |row: usize| degrees(from, row);
    let greatest = |value: &dyn Fn(usize) -> f64| {
        (0..rows.len()).max_by(|&a, &b| value(a).total_cmp(&value(b)))
    };
    let mut text = String::new();
    let best = greatest(&|row| rows[row].0).filter(|&row| rows[row].0 > 0.0);
    let Some(best) = best else {
        return wrapped("No shot at these pitch angles goes in.");
    };
    let is_level = |row: &usize| rows[best].0 - rows[*row].0 <= LEVEL;
    let low = (0..best).rev().take_while(is_level).last().unwrap_or(best);
    let high = (best + 1..rows.len()).take_while(is_level).last();
    let high = high.unwrap_or(best);
    let mut words = format!(
        "One pitch angle for {} {}: {} deg makes the most {}shots on average, {:.1} of 100",
        if out_of_reach.is_empty() {
            "all"
        } else {
            "the"
        },
        match from.len() {
            1 => "1 distance".to_owned(),
            more => format!("{more} distances"),
        },
        degrees(best),
        kind_before_shot(kind),
        100.0 * rows[best].0
    );
    let wide = neighbours_apart(from, best);
    let of_list = wide.map_or(String::new(), |(low, high)| {
        format!(
            " Angles between those of the list can be better: --pitches '{low} deg to {high} deg by 0.5 deg'."
        )
    });
    words += &match low < high {
        true => format!(
            "; at the angles of this list from {} to {} deg it is at most one less.",
            degrees(low),
            degrees(high)
        ),
        false => ".".to_owned(),
    };
    words += &of_list;
    words += &reserve_in_words(from, best, units);
    if rows.len() > 1 && from.len() > 1 {
        words += &cost_in_words(from, best, units);
    }
    if let Some(steady) = greatest(&|row| rows[row].1).filter(|&row| rows[row].1 > 0.0) {
        let worst = from
            .iter()
            .min_by(|a, b| a.probability(steady).total_cmp(&b.probability(steady)));
        let where_least = worst.map_or(0.0, |shots| shots.distance(units));
        words += &format!(
            " The lowest P over the distances is highest at {} deg: {:.1} of 100, from {where_least} {long}.",
            degrees(steady),
            100.0 * rows[steady].1
        );
        if steady != best {
            words += &cost_in_words(from, steady, units);
        }
    }
    if !out_of_reach.is_empty() {
        words += &format!(
            " Left out of these, and of mean and least: {} {long}, where no clean shot goes in at any of the angles.",
            out_of_reach.join(", ")
        );
    }
    if rows.len() > 1 && (best == 0 || best + 1 == rows.len()) {
        words += &format!(
            " {} deg is at the end of the angles that were asked for: look beyond it.",
            degrees(best)
        );
    }
    text += &wrapped(&words);
    text += &wrapped(&physics_note(&first.profile, units));
    text += &wrapped(&format!(
        "P of the best {}shot at each pitch angle and distance ({long}); speed, aim and spin are the best ones there (--backspin keeps one). CSV and JSON have the shots.",
        kind_before_shot(kind)
    ));
    let limit = speed_limit_in_words(&first.profile, units);
    let all = || everywhere.iter().flat_map(|shots| &shots.shots);
    let signs = [
        (
            all().any(|row| row.shot.is_none() && row.not_clean.is_none()),
            format!(
                "-: no shot within the limits{limit} goes in; where other angles have one it counts as 0."
            ),
        ),
        (
            all().any(|row| row.not_clean.is_some() && row.shot.is_none()),
            "*: no clean shot: the most probable one misses without errors.".to_owned(),
        ),
        (kind == TableKind::Better, "b: a bank shot.".to_owned()),
    ];
    for (_, words) in signs.iter().filter(|(is_there, _)| *is_there) {
        text += &wrapped(words);
    }
    let mut widths = vec![5];
    widths.extend([6; ACROSS]);
    widths.extend([6, 6]);
    for (number, across) in everywhere.chunks(ACROSS).enumerate() {
        let is_last = (number + 1) * ACROSS >= everywhere.len();
        let last = ["mean", "least"].map(str::to_owned);
        let last = || last.iter().filter(|_| is_last).cloned();
        let heads = across.iter().map(|shots| decimal(shots.distance(units), 2));
        let mut head: Vec<String> = vec!["pitch".to_owned()];
        head.extend(heads.chain(last()));
        text += &line(head.iter().map(String::as_str), &widths);
        for (row, (mean, least)) in rows.iter().enumerate() {
            let mut cells = vec![decimal(first.shots[row].pitch_rad / DEGREE_RAD, 1)];
            cells.extend(across.iter().map(|shots| shots.cell(row, kind)));
            if is_last {
                cells.extend([decimal(*mean, 3), decimal(*least, 3)]);
            }
            text += &line(cells.iter().map(String::as_str), &widths);
        }
    }
    text
}
