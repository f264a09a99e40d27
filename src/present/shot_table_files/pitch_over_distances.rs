//! The best shots at several release angles from several distances in text: which one angle suits a
//! launcher whose angle is fixed.

use super::by_pitch::{degrees, kind_before_shot};
use super::notes::{has_no_reserve, speed_limit_in_words};
use crate::best_shot::{ShotAtPitch, TableKind};
use crate::present::layout::{Side, TextAnswer, TextTable};
use crate::present::words::{list, of_100, per_100, physics_name, scatter_note, taken_as_exact};
use crate::shooter::{Profile, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem, rounded};

/// The shots from one distance, one for each release angle. All distances have the same angles.
#[derive(Clone, Debug)]
pub struct DistanceShots {
    /// The profile at that distance.
    pub profile: Profile,
    /// The best shots there.
    pub shots: Vec<ShotAtPitch>,
}

impl DistanceShots {
    fn distance(&self, units: UnitSystem) -> f64 {
        rounded(self.profile.location().distance_m / units.length().1)
    }

    /// P at an angle; zero where no shot goes in.
    fn probability(&self, row: usize) -> f64 {
        self.shots[row].probability()
    }

    /// Whether an exact shot goes in at one of the angles.
    fn is_in_reach(&self) -> bool {
        self.shots.iter().any(|at| at.shot.is_some())
    }

    /// The makes at an angle in a table.
    fn cell(&self, row: usize, kind: TableKind) -> String {
        let at = &self.shots[row];
        let makes = per_100(at.probability());
        match (&at.shot, at.not_clean) {
            (Some(shot), _) if kind == TableKind::Better && shot.kind == ShotKind::Bank => {
                makes + "b"
            }
            (Some(_), _) => makes,
            (None, Some(_)) => makes + "*",
            (None, None) => "-".to_owned(),
        }
    }
}

/// A loss of the mean that is worth no word.
const LEVEL: f64 = 0.01;
/// Distances side by side in 80 columns.
const ACROSS: usize = 7;

/// The distances that are in reach, and what one angle does over them.
struct OverDistances<'a> {
    all: &'a [DistanceShots],
    in_reach: Vec<&'a DistanceShots>,
    beyond: Vec<&'a DistanceShots>,
    kind: TableKind,
    units: UnitSystem,
}

/// The best angle over several distances in text. `scatter` are the changes of the scatter, as
/// they were typed.
#[must_use]
pub fn pitch_over_distances_text(
    from: &[DistanceShots],
    kind: TableKind,
    units: UnitSystem,
    scatter: &[String],
) -> TextAnswer {
    let (mut in_reach, mut beyond): (Vec<_>, Vec<_>) =
        from.iter().partition(|shots| shots.is_in_reach());
    if in_reach.is_empty() {
        std::mem::swap(&mut in_reach, &mut beyond);
    }
    let over = OverDistances {
        all: from,
        in_reach,
        beyond,
        kind,
        units,
    };
    over.text(scatter)
}

impl OverDistances<'_> {
    fn rows(&self) -> std::ops::Range<usize> {
        0..self.all.first().map_or(0, |first| first.shots.len())
    }

    fn angle(&self, row: usize) -> String {
        degrees(self.all[0].shots[row].pitch_rad)
    }

    /// Mean of P over the distances in reach.
    fn mean(&self, row: usize) -> f64 {
        let all = self.in_reach.iter().map(|shots| shots.probability(row));
        all.sum::<f64>() / self.in_reach.len().max(1) as f64
    }

    /// The least P over the distances in reach.
    fn least(&self, row: usize) -> f64 {
        let all = self.in_reach.iter().map(|shots| shots.probability(row));
        all.fold(1.0, f64::min)
    }

    /// The row with the greatest value, if it is positive.
    fn greatest(&self, value: impl Fn(usize) -> f64) -> Option<usize> {
        let row = self.rows().max_by(|&a, &b| value(a).total_cmp(&value(b)))?;
        (value(row) > 0.0).then_some(row)
    }

    fn text(&self, scatter: &[String]) -> TextAnswer {
        let Some(best) = self.greatest(|row| self.mean(row)) else {
            return TextAnswer {
                answer: vec!["No shot goes in at these angles.".to_owned()],
                ..TextAnswer::default()
            };
        };
        let profile = &self.all[0].profile;
        let who = match profile.shooter().name.as_str() {
            "" => String::new(),
            name => format!("{name}: "),
        };
        let mut notes = self.notes(best);
        notes.extend(scatter_note(scatter));
        notes.push(format!(
            "Speed, direction and spin are the best ones in each cell. {}",
            taken_as_exact(false)
        ));
        TextAnswer {
            answer: self.answer(best),
            subject: format!(
                "{who}the best {}shot at {} distances. Physics: {}.",
                kind_before_shot(self.kind),
                self.all.len(),
                physics_name(profile)
            ),
            table: self.tables().into_iter().next(),
            notes,
            details: self.tables().iter().skip(1).map(TextTable::text).collect(),
            ..TextAnswer::default()
        }
    }

    /// The angle with the greatest mean, and the one with the greatest least value.
    fn answer(&self, best: usize) -> Vec<String> {
        let is_level = |row: &usize| self.mean(best) - self.mean(*row) <= LEVEL;
        let low = (0..best).rev().take_while(is_level).last().unwrap_or(best);
        let high = (best + 1..self.rows().end).take_while(is_level).last();
        let high = high.unwrap_or(best);
        let level = match low < high {
            true => format!(
                " From {} to {} deg you lose at most 1 per 100.",
                self.angle(low),
                self.angle(high)
            ),
            false => String::new(),
        };
        let mut answer = vec![format!(
            "Fix the angle at {} deg: {} of 100 go in on average over the distances.{level}",
            self.angle(best),
            of_100(self.mean(best))
        )];
        answer.extend(self.cost(best));
        if let Some(steady) = self
            .greatest(|row| self.least(row))
            .filter(|row| *row != best)
        {
            answer.push(format!(
                "The hardest distance is easiest at {} deg: {} of 100 there.",
                self.angle(steady),
                of_100(self.least(steady))
            ));
        }
        answer
    }

    /// What one angle costs against the best angle at each distance.
    fn cost(&self, row: usize) -> Option<String> {
        if self.rows().len() < 2 || self.in_reach.len() < 2 {
            return None;
        }
        let cost = |shots: &&DistanceShots| {
            let all = self.rows().map(|row| shots.probability(row));
            all.fold(0.0, f64::max) - shots.probability(row)
        };
        let mean = self.in_reach.iter().map(cost).sum::<f64>() / self.in_reach.len() as f64;
        let most = self
            .in_reach
            .iter()
            .max_by(|a, b| cost(a).total_cmp(&cost(b)))?;
        Some(format!(
            "Compared with the best angle at each distance, {} deg costs {} per 100 on average and {} at most, from {} {}.",
            self.angle(row),
            per_100(mean),
            per_100(cost(most)),
            most.distance(self.units),
            self.units.length().0
        ))
    }

    fn notes(&self, best: usize) -> Vec<String> {
        let (long, _) = self.units.length();
        let mut notes = Vec::new();
        let distances = |shots: &[&DistanceShots]| {
            let words = shots
                .iter()
                .map(|shots| shots.distance(self.units).to_string());
            list(&words.collect::<Vec<_>>())
        };
        if !self.beyond.is_empty() {
            notes.push(format!(
                "Left out of mean and least: {} {long}, where no exact shot goes in.",
                distances(&self.beyond)
            ));
        }
        let has_no_reserve = |shots: &&&DistanceShots| {
            let shot = shots.shots[best].shot.as_ref();
            shot.is_some_and(|shot| has_no_reserve(&shots.profile, &shot.nominal))
        };
        let short: Vec<&DistanceShots> = self
            .in_reach
            .iter()
            .filter(has_no_reserve)
            .copied()
            .collect();
        if !short.is_empty() {
            notes.push(format!(
                "From {} {long} the speed is within one standard deviation of speed_max, so it cannot be set higher in the gym.",
                distances(&short)
            ));
        }
        if self.rows().len() > 1 && (best == 0 || best + 1 == self.rows().end) {
            notes.push(format!(
                "{} deg is the last angle of the list; angles between or beyond may be better (--pitches).",
                self.angle(best)
            ));
        } else {
            notes.extend(self.finer(best));
        }
        notes.extend(self.signs());
        notes
    }

    /// How to look between the angles of the list, where they are more than a degree apart.
    fn finer(&self, best: usize) -> Option<String> {
        const NEAR_RAD: f64 = 1.01 * DEGREE_RAD;
        let angles = &self.all.first()?.shots;
        let [low, high] = [best.saturating_sub(1), (best + 1).min(angles.len() - 1)];
        let apart = |row: usize| (angles[row].pitch_rad - angles[best].pitch_rad).abs();
        (apart(low).max(apart(high)) > NEAR_RAD).then(|| {
            format!(
                "An angle between those of the list may be better: `--pitches '{} deg to {} deg by 0.5 deg'`.",
                self.angle(low),
                self.angle(high)
            )
        })
    }

    /// The signs of the table.
    fn signs(&self) -> Vec<String> {
        let all = || self.all.iter().flat_map(|shots| &shots.shots);
        let limit = speed_limit_in_words(&self.all[0].profile, self.units);
        let signs = [
            (
                all().any(|row| row.shot.is_none() && row.not_clean.is_none()),
                format!("-: no shot within the limits{limit} goes in; it counts as 0."),
            ),
            (
                all().any(|row| row.not_clean.is_some() && row.shot.is_none()),
                "*: the most probable release; an exact shot with it misses.".to_owned(),
            ),
            (self.kind == TableKind::Better, "b: a bank shot.".to_owned()),
        ];
        let there = signs.into_iter().filter(|(is_there, _)| *is_there);
        there.map(|(_, words)| words).collect()
    }

    /// The makes per 100 at each angle and distance, so many distances in each table.
    fn tables(&self) -> Vec<TextTable> {
        let (long, _) = self.units.length();
        let table = |(number, across): (usize, &[DistanceShots])| {
            let is_last = (number + 1) * ACROSS >= self.all.len();
            let heads: Vec<String> = across
                .iter()
                .map(|shots| format!("{:.2}", shots.distance(self.units)))
                .collect();
            let mut columns = vec![("angle", "deg", Side::Right)];
            columns.extend(heads.iter().map(|head| (head.as_str(), long, Side::Right)));
            if is_last {
                columns.extend([("mean", "", Side::Right), ("least", "", Side::Right)]);
            }
            let mut table = TextTable::new(&columns);
            for row in self.rows() {
                let mut cells = vec![self.angle(row)];
                cells.extend(across.iter().map(|shots| shots.cell(row, self.kind)));
                if is_last {
                    cells.extend([per_100(self.mean(row)), per_100(self.least(row))]);
                }
                table.add(cells);
            }
            table
        };
        self.all.chunks(ACROSS).enumerate().map(table).collect()
    }
}
