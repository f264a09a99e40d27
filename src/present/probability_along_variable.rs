//! P along one variable of a nominal shot, the others as they are: for people, as CSV and JSON.

use crate::analysis::miss_breakdown::MissBreakdown;
use crate::answers::along_variable::{PointAlong, Varied};
use crate::shooter::{Nominal, NominalVariable, Profile};
use crate::units::{Unit, UnitSystem, with_decimals};
use comfy_table::{CellAlignment, Table, presets};

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

    /// What the intervals over the draws are of; empty without draws.
    #[must_use]
    pub fn draws_in_words(&self) -> &'static str {
        match self.points.iter().any(|point| point.over_draws.is_some()) {
            true if self.is_rest_uncertain => {
                "95 %: what the measured shots leave open, of the scatter and of the shot's other values."
            }
            true => {
                "95 %: what the measured shots leave open of the scatter; the shot itself is taken as exact."
            }
            false => "",
        }
    }

    /// The point with the highest P.
    fn best(&self) -> Option<usize> {
        let points = self.points.iter().enumerate();
        let best = points.max_by(|a, b| {
            let [a, b] = [a.1, b.1].map(|point| point.estimate.probability);
            a.total_cmp(&b)
        });
        best.map(|(index, _)| index)
    }

    /// What the variable is worth, in three sentences at most.
    fn in_words(&self, best: usize) -> String {
        let unit = self.unit().name;
        let name = self.name().replace('_', " ");
        let value = |index: usize| short(self.value(&self.points[index].nominal));
        let highest = self.points[best].estimate.probability;
        let is_level = |&index: &usize| highest - self.points[index].estimate.probability <= LEVEL;
        let low = (0..best).rev().take_while(is_level).last();
        let high = (best + 1..self.points.len()).take_while(is_level).last();
        let mut text = format!(
            "Of these values of the {name}, {} {unit} makes most: {:.1} of 100.",
            value(best),
            100.0 * highest
        );
        let (low, high) = (low.unwrap_or(best), high.unwrap_or(best));
        if low < high {
            text += &format!(
                " From {} to {} {unit} it makes at most one of 100 less.",
                value(low),
                value(high)
            );
        }
        if let Some((low, high)) = self.best_of_draws {
            text += &match low < high {
                true => format!(
                    " In 95 of 100 draws of the fit the best of them is from {} to {} {unit}.",
                    value(low),
                    value(high)
                ),
                false => format!(
                    " In 95 of 100 draws of the fit {} {unit} is the best of them.",
                    value(low)
                ),
            };
        }
        text
    }

    /// What stays as it is.
    fn fixed_in_words(&self) -> String {
        format!("The rest stays: {}.", self.fixed_values())
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
            let name = other.name().replace('_', " ");
            (is_always_told || value != 0.0)
                .then(|| format!("{name} {} {unit}", short(value / size)))
        });
        parts.collect::<Vec<_>>().join(", ")
    }

    /// For people, at most 80 columns wide.
    #[must_use]
    pub fn in_text(&self) -> String {
        let Some(best) = self.best() else {
            return String::new();
        };
        let unit = self.unit().name;
        let name = &self.profile.shooter().name;
        let of = match name.is_empty() {
            true => String::new(),
            false => format!("{name}, "),
        };
        let place = self.profile.location().in_words(self.units());
        let mut text = String::new();
        for sentence in [
            format!("{of}{place}."),
            self.in_words(best),
            self.fixed_in_words(),
        ] {
            text += &(textwrap::fill(&sentence, 80) + "\n");
        }
        let has_draws = self.points.iter().any(|point| point.over_draws.is_some());
        let mut header = vec![
            format!("{}\n{unit}", self.name().replace('_', " ")),
            "P".to_owned(),
            "less".to_owned(),
        ];
        if has_draws {
            header.extend(["95 %".to_owned(), "less, 95 %".to_owned()]);
        }
        let misses = if has_draws { &MISSES[..0] } else { &MISSES[..] };
        header.extend(misses.iter().map(|(name, _)| format!("{name}\n%")));
        let mut table = Table::new();
        table.load_style(presets::NOTHING);
        table.set_header(header);
        let highest = self.points[best].estimate.probability;
        for point in &self.points {
            let p = point.estimate.probability;
            let mut row = vec![
                short(self.value(&point.nominal)),
                format!("{p:.4}"),
                format!("{:.4}", highest - p),
            ];
            if let Some(over) = &point.over_draws {
                for interval in [over.probability, over.less] {
                    row.push(format!(
                        "{:.3} to {:.3}",
                        interval.low + 0.0,
                        interval.high + 0.0
                    ));
                }
            }
            let shares = misses.iter().map(|(_, share)| share(&point.misses));
            row.extend(shares.map(|share| format!("{:.1}", 100.0 * share)));
            table.add_row(row);
        }
        for column in table.column_iter_mut() {
            column.set_cell_alignment(CellAlignment::Right);
        }
        text += &(table.trim_fmt() + "\n");
        let errors = self
            .points
            .iter()
            .map(|point| point.estimate.standard_error);
        let error = errors.fold(0.0, f64::max);
        let meaning = if has_draws {
            format!(
                "{} less, 95 %: than where the mean over the draws is highest, draw by draw.",
                self.draws_in_words()
            )
        } else {
            "short, long, left, right: how shots are missed; other: all else, such as airballs (CSV and JSON have each).".to_owned()
        };
        let of_aim = match self.varied.is_aim {
            true => " aim: from the line to the hoop's centre, positive to the left.",
            false => "",
        };
        text += &(textwrap::fill(
            &format!("P has a numerical standard error of at most {error:.4}. {meaning}{of_aim}"),
            80,
        ) + "\n");
        text
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
