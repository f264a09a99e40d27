//! P along one variable of a nominal shot, the others as they are, in text.

use super::layout::{Side, TextAnswer, TextTable};
use super::words::{
    nominal_name, per_100, scatter_note, simulation_error, subject, taken_as_exact,
};

use crate::analysis::miss_breakdown::MissBreakdown;
use crate::answers::along_variable::{PointAlong, Varied};
use crate::shooter::{Nominal, NominalVariable, Profile};
use crate::units::{Unit, UnitSystem, with_decimals};

/// A loss of P that the sentence counts as none.
const LEVEL: f64 = 0.01;

/// P of one nominal shot whose variable has several values.
#[derive(Clone, Debug)]
pub struct ProbabilityAlong<'a> {
    /// The shooter and the location.
    pub profile: &'a Profile,
    /// The variable.
    pub varied: Varied,
    /// Whether the draws have the uncertainty of the shot's other values too, not of the scatter
    /// alone.
    pub is_rest_uncertain: bool,
    /// In ascending order of the variable.
    pub points: Vec<PointAlong>,
    /// The first and the last of the points between which the best one lies in 95 of 100 draws.
    pub best_of_draws: Option<(usize, usize)>,
}

impl ProbabilityAlong<'_> {
    fn units(&self) -> UnitSystem {
        self.profile.output().units
    }

    /// The name of the variable.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.varied.name()
    }

    /// The unit of the variable, that unit in a column's name, and its size in SI units.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.units().unit(self.varied.variable.dimension())
    }

    /// The value of the variable of a shot, in its unit.
    #[must_use]
    pub fn value(&self, nominal: &Nominal) -> f64 {
        self.varied.value(self.profile, nominal) / self.unit().size
    }

    /// The shooter's own value of the variable, in its unit, if the profile has it.
    #[must_use]
    pub fn own_value(&self) -> Option<f64> {
        let own = self.profile.nominal_overrides().get(self.varied.variable)?;
        let nominal = Nominal::default().with(self.varied.variable, own);
        Some(self.value(&nominal))
    }

    /// Whether the points have intervals over the draws of a fit.
    fn has_draws(&self) -> bool {
        self.points.iter().any(|point| point.over_draws.is_some())
    }

    /// What the intervals over the draws are of; empty without draws.
    #[must_use]
    pub fn draws_in_words(&self) -> &'static str {
        match self.has_draws() {
            true if self.is_rest_uncertain => {
                "95 % intervals: from the measured shots; scatter and the rest of the shot are uncertain."
            }
            true => {
                "95 % intervals: from the measured shots; the scatter is uncertain, the shot is exact."
            }
            false => "",
        }
    }

    /// The point with the highest P.
    fn best(&self) -> Option<usize> {
        let indices = 0..self.points.len();
        indices.max_by(|a, b| self.p(*a).total_cmp(&self.p(*b)))
    }

    /// The name of the variable in text.
    fn name_in_text(&self) -> &'static str {
        match self.varied.is_aim {
            true => "direction",
            false => nominal_name(self.varied.variable),
        }
    }

    /// P at a point: over the draws of a fit, if it is known.
    fn p(&self, index: usize) -> f64 {
        let point = &self.points[index];
        let over = point.over_draws.map(|over| over.probability.mean);
        over.unwrap_or(point.estimate.probability)
    }

    /// What the variable is worth.
    fn sentences(&self, best: usize) -> Vec<String> {
        let unit = self.unit().name;
        let name = self.name_in_text();
        let value = |index: usize| short(self.value(&self.points[index].nominal));
        let highest = self.p(best);
        let is_level = |&index: &usize| highest - self.p(index) <= LEVEL;
        let low = (0..best).rev().take_while(is_level).last();
        let high = (best + 1..self.points.len()).take_while(is_level).last();
        let mut sentences = vec![format!(
            "Best {name} tried: {} {unit}, {} of 100.",
            value(best),
            per_100(highest)
        )];
        let (low, high) = (low.unwrap_or(best), high.unwrap_or(best));
        if low < high {
            sentences.push(format!(
                "From {} to {} {unit} you lose at most 1 per 100.",
                value(low),
                value(high)
            ));
        }
        if let Some((low, high)) = self.best_of_draws {
            sentences.push(match low < high {
                true => format!(
                    "95 % interval of the best {name}: {} to {} {unit}.",
                    value(low),
                    value(high)
                ),
                false => format!(
                    "{} {unit} is the best {name} with a probability above 95 %.",
                    value(low)
                ),
            });
        }
        sentences
    }

    /// The values of the rest of the shot.
    #[must_use]
    pub fn fixed_values(&self) -> String {
        let Some(first) = self.points.first() else {
            return String::new();
        };
        let others = NominalVariable::ALL
            .into_iter()
            .filter(|&other| other != self.varied.variable);
        let parts = others.filter_map(|other| {
            let value = first.nominal.get(other);
            let is_always_told = matches!(
                other,
                NominalVariable::Speed | NominalVariable::Pitch | NominalVariable::Polar
            );
            let Unit {
                name: unit, size, ..
            } = self.units().unit(other.dimension());
            let name = nominal_name(other);
            (is_always_told || value != 0.0)
                .then(|| format!("{name} {} {unit}", short(value / size)))
        });
        parts.collect::<Vec<_>>().join(", ")
    }

    /// For people. `scatter` are the changes of the scatter, as they were typed.
    #[must_use]
    pub fn in_text(&self, scatter: &[String]) -> TextAnswer {
        let Some(best) = self.best() else {
            return TextAnswer::default();
        };
        let mut notes = vec![format!("Held fixed: {}.", self.fixed_values())];
        if self.varied.is_aim {
            notes.push("direction: from the line to the hoop, positive to the left.".to_owned());
        }
        notes.extend(scatter_note(scatter));
        let errors = self
            .points
            .iter()
            .map(|point| point.estimate.standard_error);
        notes.push(format!(
            "{} Simulation error: {} per 100.",
            match self.draws_in_words() {
                "" => taken_as_exact(false),
                words => words,
            },
            simulation_error(errors.fold(0.0, f64::max))
        ));
        TextAnswer {
            answer: self.sentences(best),
            subject: subject(self.profile, self.units()),
            table: Some(self.table(best)),
            notes,
            ..TextAnswer::default()
        }
    }

    fn table(&self, best: usize) -> TextTable {
        let mut columns = vec![
            (self.name_in_text(), self.unit().name, Side::Right),
            ("makes", "per 100", Side::Right),
            ("below", "best", Side::Right),
        ];
        let has_draws = self.has_draws();
        match has_draws {
            true => columns.extend([
                ("makes,", "95 %", Side::Left),
                ("below,", "95 %", Side::Left),
            ]),
            false => columns.extend(MISSES.iter().map(|(name, _)| (*name, "", Side::Right))),
        }
        let mut table = TextTable::new(&columns);
        let highest = self.p(best);
        for (index, point) in self.points.iter().enumerate() {
            let p = self.p(index);
            let mut cells = vec![
                short(self.value(&point.nominal)),
                per_100(p),
                per_100(highest - p),
            ];
            match &point.over_draws {
                Some(over) => cells.extend([over.probability, over.below_best].map(|interval| {
                    format!("{} to {}", per_100(interval.low), per_100(interval.high))
                })),
                None => cells.extend(
                    MISSES
                        .iter()
                        .map(|(_, share)| per_100(share(&point.misses))),
                ),
            }
            table.add(cells);
        }
        table
    }
}

/// The misses that the text has, with their shares.
type MissColumn = (&'static str, fn(&MissBreakdown) -> f64);
const MISSES: [MissColumn; 5] = [
    ("short", |misses| misses.short),
    ("long", |misses| misses.long),
    ("left", |misses| misses.left),
    ("right", |misses| misses.right),
    ("other", |misses| {
        let MissBreakdown {
            in_and_out,
            over,
            lodged,
            airball,
            unresolved,
            ..
        } = misses;
        in_and_out + over + lodged + airball + unresolved
    }),
];

/// A number with three decimals at most.
fn short(value: f64) -> String {
    format!("{}", with_decimals(value, 3))
}
