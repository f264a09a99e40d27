//! The best shots at several release angles in text.

use super::notes::speed_limit_in_words;
use crate::best_shot::{ShotAtPitch, TableKind, TableShot};
use crate::fitting::AngleOverDraws;
use crate::present::layout::{Side, TextAnswer, TextTable};
use crate::present::words::{
    of_100, per_100, scatter_note, simulation_error, subject, taken_as_exact,
};
use crate::shooter::{NominalVariable, Profile};
use crate::units::{DEGREE_RAD, REV_RAD};

/// A loss of P that is worth no word.
const LEVEL: f64 = 0.005;

/// The shots at several release angles, and what a fit says of them.
#[derive(Clone, Copy, Debug)]
pub struct AngleCurve<'a> {
    /// The profile.
    pub profile: &'a Profile,
    /// The kind of the shots.
    pub kind: TableKind,
    /// The shots.
    pub rows: &'a [ShotAtPitch],
    /// P over the draws of a fit at each angle; empty without a fit.
    pub over_draws: &'a [Option<AngleOverDraws>],
    /// The first and the last of the angles between which the best one lies in 95 of 100 draws.
    pub best_of_draws: Option<(usize, usize)>,
    /// Angle and P of the current shot of a fit.
    pub current: Option<(f64, f64)>,
}

/// A release angle: `55`, `52.5`.
#[must_use]
pub(super) fn degrees(rad: f64) -> String {
    let text = format!("{:.1}", rad / DEGREE_RAD + 0.0);
    text.trim_end_matches(".0").to_owned()
}

/// The kind in a sentence, with a space after it.
pub(super) fn kind_before_shot(kind: TableKind) -> String {
    match kind {
        TableKind::One(kind) => format!("{} ", kind.name()),
        TableKind::Better => String::new(),
    }
}

/// A value with decimals, or a dash.
#[must_use]
pub(super) fn or_dash(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(
        || "-".to_owned(),
        |value| format!("{:.decimals$}", value + 0.0),
    )
}

/// The tolerances below and above, such as `-0.24 +0.31`.
#[must_use]
pub(super) fn tolerance(sides: [f64; 2], decimals: usize) -> String {
    let [below, above] = sides.map(|side| {
        let decimals = if side < 9.95 { decimals } else { 0 };
        format!("{side:.decimals$}")
    });
    format!("-{below} +{above}")
}

impl AngleCurve<'_> {
    /// P at an angle: over the draws of a fit, if it is known.
    fn p(&self, row: usize) -> Option<f64> {
        let shot = self.rows[row].shot.as_ref()?;
        let over = self.over_draws.get(row).copied().flatten();
        Some(over.map_or(shot.probability, |over| over.probability.mean))
    }

    fn found(&self) -> impl Iterator<Item = (f64, &TableShot)> {
        let rows = self.rows.iter();
        rows.filter_map(|row| Some((row.pitch_rad, row.shot.as_ref()?)))
    }

    /// The row with the highest P.
    fn best(&self) -> Option<usize> {
        let rows = (0..self.rows.len()).filter(|row| self.p(*row).is_some());
        rows.max_by(|a, b| {
            self.p(*a)
                .partial_cmp(&self.p(*b))
                .unwrap_or(std::cmp::Ordering::Equal)
        })
    }

    /// The curve in text. `scatter` are the changes of the scatter, as they were typed.
    #[must_use]
    pub fn text(&self, scatter: &[String]) -> TextAnswer {
        let units = self.profile.output().units;
        let mut notes = self.notes();
        notes.extend(scatter_note(scatter));
        notes.push(self.what_is_left_out());
        TextAnswer {
            answer: self.answer(),
            subject: subject(self.profile, units),
            table: Some(self.table()),
            notes,
            details: self.details(),
            ..TextAnswer::default()
        }
    }

    /// The best angle, what its neighbours cost, and the interval of the best angle.
    fn answer(&self) -> Vec<String> {
        let Some(best) = self.best() else {
            let most = self.rows.iter().map(ShotAtPitch::probability);
            let most = most.fold(0.0, f64::max);
            return vec![match most > 0.0 {
                true => format!(
                    "No exact shot goes in at these angles; the most probable release makes {} of 100.",
                    of_100(most)
                ),
                false => "No shot goes in at these angles.".to_owned(),
            }];
        };
        let highest = self.p(best).unwrap_or(0.0);
        let angle = |row: usize| degrees(self.rows[row].pitch_rad);
        let cost = |row: usize| {
            let loss = highest - self.p(row)?;
            (loss >= LEVEL / 10.0).then(|| format!("{} fewer at {} deg", per_100(loss), angle(row)))
        };
        let neighbours = [best.checked_sub(1), Some(best + 1), best.checked_sub(2)];
        let in_list = neighbours
            .into_iter()
            .flatten()
            .filter(|row| *row < self.rows.len());
        let costs: Vec<String> = in_list.filter_map(cost).collect();
        let costs = match costs.is_empty() {
            true => String::new(),
            false => format!(" Per 100, {}.", costs.join(", ")),
        };
        let mut answer = vec![format!(
            "Release at about {} deg: {} of 100 go in.{costs}",
            angle(best),
            of_100(highest)
        )];
        answer.extend(self.best_of_draws.map(|(low, high)| match low < high {
            true => format!(
                "95 % interval of the best angle: {} to {} deg, from the measured shots.",
                angle(low),
                angle(high)
            ),
            false => format!(
                "The probability that {} deg is best is above 95 %.",
                angle(low)
            ),
        }));
        answer
    }

    fn table(&self) -> TextTable {
        let (long, metre) = self.profile.output().units.length();
        let speed_unit = format!("{long}/s");
        let other = match self.kind {
            TableKind::One(kind) => format!("{} makes", kind.other().name()),
            TableKind::Better => "other kind".to_owned(),
        };
        let has_draws = !self.over_draws.is_empty();
        let mut columns = vec![
            ("angle", "deg", Side::Right),
            ("speed", speed_unit.as_str(), Side::Right),
            ("entry", "deg", Side::Right),
            ("makes", "per 100", Side::Right),
        ];
        if has_draws {
            columns.push(("95 %", "interval", Side::Left));
        }
        columns.extend([
            ("below", "best", Side::Right),
            (&*other, "per 100", Side::Right),
        ]);
        if !has_draws {
            columns.extend([
                ("tolerance", speed_unit.as_str(), Side::Right),
                ("tolerance", "deg", Side::Right),
            ]);
        }
        if self.kind == TableKind::Better {
            columns.push(("kind", "", Side::Left));
        }
        let mut table = TextTable::new(&columns);
        let highest = self.best().and_then(|best| self.p(best)).unwrap_or(0.0);
        for (i, row) in self.rows.iter().enumerate() {
            let (angle, p) = (format!("{:.1}", row.pitch_rad / DEGREE_RAD), self.p(i));
            let Some((shot, p)) = row.shot.as_ref().zip(p) else {
                let makes = row.not_clean.map(|shot| shot.probability);
                let speed = row.not_clean.map(|shot| shot.nominal.speed_m_s / metre);
                let mut cells = vec![
                    angle,
                    or_dash(speed, 2),
                    "-".to_owned(),
                    makes.map_or("-".to_owned(), |p| format!("{}*", per_100(p))),
                ];
                cells.resize(columns.len(), "-".to_owned());
                table.add(cells);
                continue;
            };
            let [speed_sides, pitch_sides] = shot.tolerances;
            let mut cells = vec![
                angle,
                format!("{:.2}", shot.nominal.speed_m_s / metre),
                or_dash(shot.entry_rad.map(|rad| rad / DEGREE_RAD), 1),
                per_100(p),
            ];
            if has_draws {
                let over = self.over_draws[i].map(|over| over.probability);
                cells.push(over.map_or("-".to_owned(), |p| {
                    format!("{} to {}", per_100(p.low), per_100(p.high))
                }));
            }
            cells.extend([
                per_100(highest - p),
                shot.other_kind.map_or("-".to_owned(), per_100),
            ]);
            if !has_draws {
                cells.push(tolerance(speed_sides.map(|side| side / metre), 2));
                cells.push(tolerance(pitch_sides.map(|side| side / DEGREE_RAD), 1));
            }
            if self.kind == TableKind::Better {
                cells.push(shot.kind.name().to_owned());
            }
            table.add(cells);
        }
        table
    }

    /// What can change the decision.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let units = self.profile.output().units;
        if let Some((pitch_rad, p)) = self.current {
            notes.push(format!(
                "The current shot ({} deg, as measured) makes {} of 100; its speed and direction are not optimised.",
                degrees(pitch_rad),
                per_100(p)
            ));
        }
        let is_at_end = |best: usize| best == 0 || best + 1 == self.rows.len();
        if self.rows.len() > 1 && self.best().is_some_and(is_at_end) {
            notes.push(
                "The best angle is the last of the list; angles between or beyond may be better (--pitches)."
                    .to_owned(),
            );
        }
        notes.extend(self.other_kind());
        notes.extend(self.at_speed_limit());
        if self
            .rows
            .iter()
            .any(|row| row.shot.is_none() && row.not_clean.is_some())
        {
            notes.push("*: the most probable release; an exact shot with it misses.".to_owned());
        }
        if self
            .rows
            .iter()
            .any(|row| row.shot.is_none() && row.not_clean.is_none())
        {
            notes.push(format!(
                "-: no shot within the limits{} goes in.",
                speed_limit_in_words(self.profile, units)
            ));
        }
        notes
    }

    /// That the other kind makes more than the best of these, if it does.
    fn other_kind(&self) -> Option<String> {
        let TableKind::One(kind) = self.kind else {
            return None;
        };
        let highest = self.p(self.best()?)?;
        let others = self.found().filter_map(|(_, shot)| shot.other_kind);
        let most = others.fold(0.0, f64::max);
        (most > highest + 2.0 * LEVEL).then(|| {
            format!(
                "At some angles the {} shot makes up to {} of 100 (--kind best).",
                kind.other().name(),
                of_100(most)
            )
        })
    }

    /// At which angles the speed is the greatest one of the profile.
    fn at_speed_limit(&self) -> Option<String> {
        let most_m_s = self.profile.search().speed_max_m_s?;
        let is_at_limit = |shot: &TableShot| shot.nominal.speed_m_s > (1.0 - 1e-6) * most_m_s;
        let at_limit = self.found().filter(|(_, shot)| is_at_limit(shot));
        let angles: Vec<String> = at_limit.map(|(rad, _)| degrees(rad)).collect();
        (!angles.is_empty()).then(|| {
            format!(
                "At {} deg the speed is speed_max; a faster launcher makes more there.",
                angles.join(", ")
            )
        })
    }

    fn what_is_left_out(&self) -> String {
        let errors = self.found().map(|(_, shot)| shot.standard_error);
        let choice = self.profile.search().choice;
        let best = match choice.includes(NominalVariable::Backspin) {
            true => "Each row has the best speed, direction and spin for its angle.",
            false => "Each row has the best speed and direction for its angle.",
        };
        format!(
            "{best} {} Simulation error: {} per 100.",
            taken_as_exact(!self.over_draws.is_empty()),
            simulation_error(errors.fold(0.0, f64::max))
        )
    }

    fn details(&self) -> String {
        let (long, metre) = self.profile.output().units.length();
        let speed_unit = format!("{long}/s");
        let mut table = TextTable::new(&[
            ("angle", "deg", Side::Right),
            ("speed", &speed_unit, Side::Right),
            ("direction", "deg left", Side::Right),
            ("spin", "rev/s", Side::Right),
            ("makes", "per 100", Side::Right),
            ("simulation", "error", Side::Right),
        ]);
        for (pitch_rad, shot) in self.found() {
            table.add([
                format!("{:.2}", pitch_rad / DEGREE_RAD),
                format!("{:.3}", shot.nominal.speed_m_s / metre),
                format!("{:.2}", shot.aim_rad / DEGREE_RAD + 0.0),
                format!("{:.2}", shot.nominal.backspin_rad_s / REV_RAD + 0.0),
                format!("{:.2}", 100.0 * shot.probability),
                simulation_error(shot.standard_error),
            ]);
        }
        let mut text = table.text();
        let slowest = self
            .found()
            .min_by(|a, b| a.1.nominal.speed_m_s.total_cmp(&b.1.nominal.speed_m_s));
        if let Some((pitch_rad, shot)) = slowest {
            text += &format!(
                "Of these angles, {} deg needs the least speed ({:.2} {long}/s).\n",
                degrees(pitch_rad),
                shot.nominal.speed_m_s / metre
            );
        }
        text += "Tolerance: how far below or above its value speed or angle can be before an\nexact shot misses. The scatter is taken to be the same at all angles.\n";
        for (row, over) in self.rows.iter().zip(self.over_draws) {
            if let Some(over) = over {
                text += &format!(
                    "{} deg, below the best angle: {} (95 % interval {} to {})\n",
                    degrees(row.pitch_rad),
                    per_100(over.below_best.mean),
                    per_100(over.below_best.low),
                    per_100(over.below_best.high)
                );
            }
        }
        text
    }
}
