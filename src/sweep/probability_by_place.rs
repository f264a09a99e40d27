//! What a finished sweep says of one player at each place: P of both kinds of shot, and which of
//! them to shoot.

use super::bank_direct_difference::{difference, is_advised};
use super::columns;
use super::court_region::CourtPlace;
use super::job_list::Jobs;
use super::result_row::ResultRow;
use super::sweep_toml::SweepConfig;
use crate::analysis::sensitivity::Difference;
use crate::math::normal_distribution::quantile;
use crate::model::SolidId;
use crate::shooter::{Nominal, ShotKind};
use crate::units::UnitSystem;
use std::collections::BTreeMap;

/// Which kind of shot is better, by the rule of [`is_advised`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preference {
    /// The direct shot, or there is no bank shot.
    Direct,
    /// The bank shot, or there is no direct shot.
    Bank,
    /// The difference is less than a shot in 100, or within the error of both.
    Either,
}

impl Preference {
    /// Of P of both kinds; `None` without any shot.
    #[must_use]
    pub fn of(direct: Option<Difference>, bank: Option<Difference>) -> Option<Self> {
        Some(match (direct, bank) {
            (None, None) => return None,
            (Some(_), None) => Self::Direct,
            (None, Some(_)) => Self::Bank,
            (Some(direct), Some(bank)) => Self::of_gain(difference(bank, direct)),
        })
    }

    /// Of P of the bank shot less that of the direct one.
    fn of_gain(gain: Difference) -> Self {
        match (is_advised(gain), gain.value > 0.0) {
            (false, _) => Self::Either,
            (true, true) => Self::Bank,
            (true, false) => Self::Direct,
        }
    }

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Bank => "bank",
            Self::Either => "either",
        }
    }
}

/// The kind of shot that is better in this share of the draws of a fit is surely so.
pub const SURE: f64 = 0.9;

/// Places nearer than this are the same, m.
const SAME_PLACE_M: f64 = 0.01;

/// The least gain of a bank shot, and the solid under which it is that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastGain {
    /// P of the bank shot less that of the direct one.
    pub gain: f64,
    /// The ring or the board.
    pub solid: SolidId,
    /// Its restitution.
    pub restitution: f64,
}

/// A player's chances at one place.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceProbabilities {
    /// The place.
    pub place: CourtPlace,
    /// Its name, if the sweep gives one.
    pub name: Option<String>,
    /// P of the best direct shot.
    pub direct: Option<Difference>,
    /// P of the best bank shot.
    pub bank: Option<Difference>,
    /// The best direct and the best bank shot.
    pub nominals: [Option<Nominal>; 2],
    /// The share of the draws of the player's fit in which the bank shot is the better one; `None`
    /// without a fit, or where it was not computed.
    pub bank_is_better: Option<f64>,
    /// The share of the draws that agree on which side, this or its mirror image, bank gains more;
    /// where that tells the sides apart.
    pub sides_differ: Option<f64>,
    /// The mean of what bank gains here and at the mirror image, where the draws do not tell the
    /// two apart.
    pub gain_of_both_sides: Option<Difference>,
    /// Shots of that fit.
    pub fitted_shots: Option<usize>,
    /// Where the bank shot is preferred: where the same bank shot gains least over the same direct
    /// one, of the rings and the boards that a gym may have.
    pub least_gain: Option<LeastGain>,
    /// Where on the board the best bank shot hits it: to the right of its middle line and above the
    /// hoop, m.
    pub board_aim_m: Option<(f64, f64)>,
}

impl PlaceProbabilities {
    /// Of every place of a sweep, in order.
    #[must_use]
    pub fn of_sweep(config: &SweepConfig, rows: &BTreeMap<u64, ResultRow>) -> Vec<Self> {
        let jobs = Jobs::new(config);
        let row_of = |source: usize, wanted: ShotKind| {
            let kind = jobs.kinds.iter().position(|&kind| kind == wanted)?;
            let source = &jobs.sources[source];
            let row = rows.get(&jobs.number(source.computed, kind))?;
            Some(if source.mirrored {
                row.mirrored()
            } else {
                row.clone()
            })
        };
        (0..jobs.sources.len())
            .map(|place| {
                let bank = row_of(place, ShotKind::Bank);
                let direct = row_of(place, ShotKind::Direct);
                let nominal = |row: &Option<ResultRow>| row.as_ref().and_then(ResultRow::nominal);
                Self {
                    nominals: [nominal(&direct), nominal(&bank)],
                    bank_is_better: None,
                    sides_differ: None,
                    gain_of_both_sides: None,
                    fitted_shots: None,
                    least_gain: None,
                    place: jobs.sources[place].place,
                    name: config
                        .place_names
                        .get(place)
                        .filter(|name| !name.is_empty())
                        .cloned(),
                    direct: direct.as_ref().and_then(ResultRow::probability),
                    bank: bank.as_ref().and_then(ResultRow::probability),
                    board_aim_m: bank.and_then(|row| {
                        Some((
                            row.real(columns::BOARD_AIM_ACROSS)?,
                            row.real(columns::BOARD_AIM_ABOVE_HOOP)?,
                        ))
                    }),
                }
            })
            .collect()
    }

    /// The greater P of both kinds.
    #[must_use]
    pub fn best(&self) -> Option<Difference> {
        let both = [self.direct, self.bank].into_iter().flatten();
        both.reduce(|a, b| if b.value > a.value { b } else { a })
    }

    /// P of the kind to tell the player: the preferred one, but that of the direct shot where the
    /// draws of the fit leave doubt that the bank shot is better; the greater one where neither is
    /// preferred.
    #[must_use]
    pub fn told(&self) -> Option<Difference> {
        let told = match self.preference()? {
            Preference::Bank if self.is_sure() => self.bank,
            Preference::Bank | Preference::Direct => self.direct,
            Preference::Either => None,
        };
        told.or_else(|| self.best())
    }

    /// Which kind to shoot; `None` without any shot. Where the place and its mirror image have one
    /// answer, that of both together.
    #[must_use]
    pub fn preference(&self) -> Option<Preference> {
        match self.gain_of_both_sides {
            Some(gain) => Some(Preference::of_gain(gain)),
            None => Preference::of(self.direct, self.bank),
        }
    }

    /// The share of the draws in which the preferred kind is the better one; `None` where neither
    /// is preferred, or without draws.
    #[must_use]
    pub fn share_of_preferred(&self) -> Option<f64> {
        match (self.preference()?, self.bank_is_better?) {
            (Preference::Bank, share) => Some(share),
            (Preference::Direct, share) => Some(1.0 - share),
            (Preference::Either, _) => None,
        }
    }

    /// Whether the draws of the player's fit, if there are any, leave no doubt about the preferred
    /// kind.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        self.share_of_preferred().is_none_or(|share| share >= SURE)
    }

    /// About how many more measured shots would make the preferred kind sure with a power of 80 %,
    /// if the difference is as it seems; `None` where it is sure, or the draws do not point its
    /// way.
    #[must_use]
    pub fn shots_to_be_sure(&self) -> Option<f64> {
        let share = self.share_of_preferred().filter(|share| *share > 0.5)?;
        if self.is_sure() {
            return None;
        }
        // The error of the difference falls with the root of the shots.
        let root = (quantile(SURE) + quantile(0.8)) / quantile(share);
        Some(self.fitted_shots? as f64 * (root * root - 1.0))
    }

    /// Whether the direct shot is the better one on some ring or board that the gym may have.
    #[must_use]
    pub fn turns_with_the_hoop(&self) -> bool {
        self.least_gain.is_some_and(|least| least.gain < 0.0)
    }

    /// P of the bank shot minus that of the direct one; `None` where one of them is missing.
    #[must_use]
    pub fn bank_gain(&self) -> Option<Difference> {
        Some(difference(self.bank?, self.direct?))
    }

    /// The place in a player's words: its name, or the part of the court; with its mirror image
    /// where that is in the list too.
    #[must_use]
    pub fn in_players_words(&self, listed: &[&Self], units: UnitSystem) -> String {
        match &self.name {
            Some(name) => name.clone(),
            None if self.has_mirror_in(listed) => {
                self.place.location().in_players_words_on_either_side(units)
            }
            None => self.place.location().in_players_words(units),
        }
    }

    /// Whether the mirror image of the place is in a list too.
    #[must_use]
    pub fn has_mirror_in(&self, listed: &[&Self]) -> bool {
        let (x_m, y_m) = (self.place.x_m, self.place.y_m);
        let is_mirror = |other: &&Self| {
            libm::hypot(other.place.x_m - x_m, other.place.y_m + y_m) < SAME_PLACE_M
        };
        self.name.is_none() && libm::fabs(y_m) >= SAME_PLACE_M && listed.iter().any(is_mirror)
    }

    /// Where on the board the bank shot is aimed, such as `14 in above the ring, 8 in left of the
    /// board's middle`.
    #[must_use]
    pub fn board_aim_in_words(&self, units: UnitSystem) -> Option<String> {
        let (across_m, above_m) = self.board_aim_m?;
        let (short, metre) = units.short_length();
        let height = format!(
            "{:.0} {short} {} the ring",
            (above_m / metre).abs(),
            if above_m < 0.0 { "below" } else { "above" }
        );
        let across = (across_m / metre).abs();
        Some(if across < 0.5 {
            format!("{height}, on the board's middle line")
        } else {
            let side = if across_m > 0.0 { "right" } else { "left" };
            format!("{height}, {across:.0} {short} {side} of the board's middle")
        })
    }
}

/// The places of a list, each together with its mirror image, in the order of the first of each.
#[must_use]
pub fn with_mirror_images<'a>(
    places: &[&'a PlaceProbabilities],
) -> Vec<Vec<&'a PlaceProbabilities>> {
    let mut groups: Vec<Vec<&PlaceProbabilities>> = Vec::new();
    for &place in places {
        let image = groups
            .iter_mut()
            .find(|group| group.len() == 1 && place.has_mirror_in(group));
        match image {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    groups
}

/// Whether P differs between a place and its mirror image, by a shot in 100 and by twice the error.
#[must_use]
pub fn left_and_right_differ(places: &[PlaceProbabilities]) -> bool {
    let listed: Vec<&PlaceProbabilities> = places.iter().collect();
    with_mirror_images(&listed)
        .iter()
        .any(|same| match same[..] {
            [one, other] => match (one.best(), other.best()) {
                (Some(a), Some(b)) => is_advised(difference(a, b)),
                (a, b) => a.is_some() != b.is_some(),
            },
            _ => false,
        })
}

/// Where on the board to aim from a place, or from it and its mirror image: `22 to 24 in above the
/// ring, 13 in from its middle on your side`. `None` where the two sides differ in more than the
/// numbers.
#[must_use]
pub fn board_aim_of_sides(same: &[&PlaceProbabilities], units: UnitSystem) -> Option<String> {
    let [first, second] = same else {
        return same.first()?.board_aim_in_words(units);
    };
    let is_own_side = |place: &PlaceProbabilities| {
        let (across_m, _) = place.board_aim_m?;
        Some(across_m * place.place.y_m > 0.0)
    };
    if is_own_side(first)? != is_own_side(second)? {
        return None;
    }
    let (short, metre) = units.short_length();
    let range = |values: [f64; 2]| {
        let mut values = values.map(|value| libm::round(value / metre));
        values.sort_by(f64::total_cmp);
        match values {
            [least, most] if least < most => format!("{least} to {most} {short}"),
            [least, _] => format!("{least} {short}"),
        }
    };
    let (a, b) = (first.board_aim_m?, second.board_aim_m?);
    Some(format!(
        "{} above the ring, {} from its middle on {} side",
        range([a.1, b.1]),
        range([a.0.abs(), b.0.abs()]),
        if is_own_side(first)? {
            "your"
        } else {
            "the other"
        }
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bank shot that the draws leave in doubt is not told, nor is its chance.
    #[test]
    fn contract_a_doubtful_bank_shot_is_not_told() {
        let p = |value: f64| {
            Some(Difference {
                value,
                standard_error: 0.001,
            })
        };
        let place = |bank_is_better| PlaceProbabilities {
            place: CourtPlace { x_m: 3.0, y_m: 0.0 },
            name: None,
            direct: p(0.70),
            bank: p(0.74),
            nominals: [None; 2],
            bank_is_better,
            sides_differ: None,
            gain_of_both_sides: None,
            fitted_shots: Some(100),
            least_gain: None,
            board_aim_m: None,
        };
        for (share, told) in [(None, 0.74), (Some(0.95), 0.74), (Some(0.6), 0.70)] {
            assert_eq!(place(share).told().unwrap().value, told, "{share:?}");
        }
        // Authority: at 1.2816 standard errors 90 % of the draws agree; with a power of 80 % that
        // takes 2.1232 of them.
        let one_error = place(Some(0.841_344_746)).shots_to_be_sure().unwrap();
        assert!(
            (one_error - 100.0 * (2.1232 * 2.1232 - 1.0)).abs() < 0.1,
            "{one_error}"
        );
        assert_eq!(place(Some(0.95)).shots_to_be_sure(), None);
        assert_eq!(place(Some(0.4)).shots_to_be_sure(), None);
    }
}
