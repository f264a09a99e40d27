//! How much of an answer rests on the physics: best shots under other physics.

use super::found_shots::{BestShot, BestShotError, NoShot};
use super::search::find_kinds;
use crate::analysis::aim_past_hoop::aim_past_centre_m;
use crate::analysis::sensitivity::SensitivityTopics;
use crate::model::{Air, PRESETS, Physics, SolidId};
use crate::probability::{Progress, Sampler, Silent};
use crate::shooter::{Profile, ShotKind};
use crate::units::{FOOT_M, UnitSystem};
use std::collections::BTreeMap;

/// A bank shot that makes so much less than the direct one is told too.
const NEAR: f64 = 0.05;

/// A physics to compare with.
#[derive(Clone, Debug)]
pub struct PhysicsVariant {
    /// What it is, or what it changes.
    pub name: String,
    /// It.
    pub physics: Physics,
    /// Whether it changes something of the base that nobody measured in this gym.
    pub is_unmeasured: bool,
}

/// The best shots under one physics.
#[derive(Clone, Debug)]
pub struct PhysicsRow {
    /// What the physics is, or what it changes.
    pub name: String,
    /// The best direct shot.
    pub direct: Result<BestShot, NoShot>,
    /// The best bank shot.
    pub bank: Result<BestShot, NoShot>,
    /// Where the undisturbed path of the best direct shot falls past the hoop's centre, m.
    pub aim_past_centre_m: Option<f64>,
    /// P of [`PhysicsComparison::same_shot`].
    pub same_shot: Option<SameShotProbability>,
    /// As [`PhysicsVariant::is_unmeasured`].
    pub is_unmeasured: bool,
    /// How far towards this change the gym may be, 0 to 1: less than 1 where something rules the
    /// change out. Changes of P are taken to grow evenly on the way.
    pub possible_share: f64,
}

impl PhysicsRow {
    /// Whether something rules the change out.
    #[must_use]
    pub fn is_ruled_out(&self) -> bool {
        self.possible_share < 1.0
    }
}

/// P of one shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SameShotProbability {
    /// P.
    pub probability: f64,
    /// Its numerical standard error.
    pub standard_error: f64,
}

/// The best shots of a profile under each physics, and one shot under all of them.
#[derive(Clone, Debug)]
pub struct PhysicsComparison {
    /// One for each physics.
    pub rows: Vec<PhysicsRow>,
    /// The shot that is the same in every row.
    pub same_shot: SameShot,
    /// The row that single changes start from: the profile's own physics, or `ncaa`.
    pub base: usize,
}

impl PhysicsComparison {
    /// The same with another shot that is the same in every row.
    #[must_use]
    pub fn with_same_shot(
        mut self,
        same_shot: SameShot,
        of_rows: impl IntoIterator<Item = Option<SameShotProbability>>,
    ) -> Self {
        self.same_shot = same_shot;
        for (row, probability) in self.rows.iter_mut().zip(of_rows) {
            row.same_shot = probability;
        }
        self
    }

    /// The same with how far towards each row the gym may be.
    #[must_use]
    pub fn with_possible_shares(mut self, shares: &[f64]) -> Self {
        for (row, share) in self.rows.iter_mut().zip(shares) {
            row.possible_share = *share;
        }
        self
    }

    /// What the single changes that nobody measured in this gym do to a P of a row, as far as the
    /// gym may have them: their names and P less that of the base, the largest first.
    pub fn unmeasured_changes(&self, p: impl Fn(&PhysicsRow) -> Option<f64>) -> Vec<(&str, f64)> {
        let base = self.rows.get(self.base).and_then(&p);
        let rows = self.rows.iter().filter(|row| row.is_unmeasured);
        let mut changes: Vec<(&str, f64)> = rows
            .filter_map(|row| {
                let by = p(row)? - base?;
                Some((row.name.as_str(), row.possible_share * by))
            })
            .collect();
        changes.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        changes
    }

    /// The greatest numerical standard error of a P of the rows.
    #[must_use]
    pub fn greatest_standard_error(&self) -> f64 {
        let errors = self.rows.iter().flat_map(|row| {
            let of_best =
                |shot: &Result<BestShot, NoShot>| Some(shot.as_ref().ok()?.estimate.standard_error);
            let same = row.same_shot.map(|shot| shot.standard_error);
            [of_best(&row.direct), of_best(&row.bank), same]
        });
        errors.flatten().fold(0.0, f64::max)
    }

    /// Whether the better kind of shot is the same under each change that nobody measured; empty
    /// where there is one kind alone.
    fn kinds_in_words(&self) -> String {
        let bank_gain = |row: &PhysicsRow| {
            let bank = row.bank.as_ref().ok()?.estimate.probability;
            Some(bank - Self::direct_p(row)?)
        };
        let Some(gain) = self.rows.get(self.base).and_then(bank_gain) else {
            return String::new();
        };
        // The rule of `team` and of sweeps: less than a shot in 100 decides nothing.
        if gain.abs() < 0.01 {
            return "The best bank shot and the best direct one are level, within one of 100. "
                .to_owned();
        }
        let (better, worse) = if gain > 0.0 {
            ("bank", "direct")
        } else {
            ("direct", "bank")
        };
        let rows = self.rows.iter().filter(|row| row.is_unmeasured);
        let turned: Vec<&str> = rows
            .filter(|row| {
                let there = bank_gain(row).map(|there| gain + row.possible_share * (there - gain));
                there.is_some_and(|there| there * gain < 0.0)
            })
            .map(|row| {
                row.name
                    .split_once(' ')
                    .map_or(row.name.as_str(), |(_, change)| change)
            })
            .collect();
        if turned.is_empty() {
            format!(
                "The best {better} shot makes more than the best {worse} one ({:.1} of 100 more), and does so under each change of what nobody measured in this gym. ",
                100.0 * gain.abs()
            )
        } else {
            format!(
                "The best {better} shot makes more than the best {worse} one ({:.1} of 100 more), but not with {}: that depends on what nobody measured in this gym. ",
                100.0 * gain.abs(),
                turned.join(", ")
            )
        }
    }

    /// P of the best direct shot.
    #[must_use]
    pub fn direct_p(row: &PhysicsRow) -> Option<f64> {
        let shot = row.direct.as_ref().ok()?;
        Some(shot.estimate.probability)
    }

    /// P of [`Self::same_shot`].
    #[must_use]
    pub fn same_shot_p(row: &PhysicsRow) -> Option<f64> {
        Some(row.same_shot.as_ref()?.probability)
    }

    /// P of the best bank shot.
    #[must_use]
    pub fn bank_p(row: &PhysicsRow) -> Option<f64> {
        let shot = row.bank.as_ref().ok()?;
        Some(shot.estimate.probability)
    }

    /// In words: how far P of the best shots rests on what nobody measured in this gym, and how far
    /// that of [`Self::same_shot`] does.
    #[must_use]
    pub fn in_words(&self) -> Option<String> {
        let base = self.rows.get(self.base)?;
        let range = |p: &dyn Fn(&PhysicsRow) -> Option<f64>| {
            let changes = self.unmeasured_changes(p);
            let here = p(base).filter(|_| !changes.is_empty())?;
            let [down, up] = together(&changes);
            let ends = [here + down, here + up].map(|p| p.clamp(0.0, 1.0));
            Some(format!("{here:.2} ({:.2} to {:.2})", ends[0], ends[1]))
        };
        let direct = range(&Self::direct_p);
        let is_bank_near = Self::bank_p(base) > Self::direct_p(base).map(|p| p - NEAR);
        let bank = range(&Self::bank_p).filter(|_| is_bank_near);
        let best: Vec<String> = [("direct", direct), ("bank", bank)]
            .into_iter()
            .filter_map(|(kind, range)| Some(format!("of the best {kind} shot {}", range?)))
            .collect();
        if best.is_empty() {
            return None;
        }
        let under = match self.base {
            0 => String::new(),
            _ => format!(" under {}", base.name),
        };
        let mut text = self.kinds_in_words();
        text += &format!(
            "P{under}, with the range that what nobody measured in this gym leaves: {}, searched anew in the gym as it is (the speed set there, by where shots land).",
            best.join(", ")
        );
        if let Some(same) = range(&Self::same_shot_p) {
            text += &format!(
                " P of {}{}, {}: {same}.",
                self.same_shot.in_words(),
                self.kind_of_same_shot(),
                self.same_shot.what_stays()
            );
        }
        Some(text)
    }

    /// Which kind the best shot of the first row is; empty for another shot.
    fn kind_of_same_shot(&self) -> &'static str {
        let Some(first) = self.rows.first() else {
            return "";
        };
        match self.same_shot {
            SameShot::BestOfFirstRow if Self::bank_p(first) > Self::direct_p(first) => {
                " (a bank shot)"
            }
            SameShot::BestOfFirstRow => " (a direct shot)",
            SameShot::OfProfile | SameShot::AsMeasured => "",
        }
    }
}

/// How far single changes may lower and raise P together: the root of the sum of squares, of each
/// quantity the change that does most on that side. The changes are ends of what the quantities may
/// be.
#[must_use]
pub fn together(changes: &[(&str, f64)]) -> [f64; 2] {
    // `with hoop_restitution 0.41`: the second word is the quantity.
    let quantity = |name: &str| name.split(' ').nth(1).unwrap_or(name).to_owned();
    [-1.0, 1.0].map(|side| {
        let mut most: BTreeMap<String, f64> = BTreeMap::new();
        for (name, by) in changes {
            let most = most.entry(quantity(name)).or_default();
            *most = most.max(side * by);
        }
        side * most.values().map(|by| by * by).sum::<f64>().sqrt()
    })
}

/// A shot that is released the same way under each physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SameShot {
    /// The one that the profile gives: that of a shooter who does not know the answer.
    OfProfile,
    /// The best shot of the first row, of either kind.
    BestOfFirstRow,
    /// The usual shot of a fit, as the tracker saw it fall to the hoop.
    AsMeasured,
}

impl SameShot {
    /// What it is, in words.
    #[must_use]
    pub fn in_words(self) -> &'static str {
        match self {
            Self::OfProfile => "the usual shot (the profile's [nominal] table)",
            Self::BestOfFirstRow => "the best shot of the first row",
            Self::AsMeasured => "the usual shot",
        }
    }

    /// What of it is the same under each physics, in words.
    #[must_use]
    pub fn what_stays(self) -> &'static str {
        match self {
            Self::OfProfile | Self::BestOfFirstRow => "released the same way everywhere",
            Self::AsMeasured => "which falls to the hoop as it was measured",
        }
    }
}

/// The restitutions that a board may have where nobody measured it: a drop test is on a hard floor,
/// a board on a mount may give way, and boards differ.
#[must_use]
pub fn likely_board_restitutions(physics: &Physics) -> [f64; 2] {
    let own = physics.restitution_on(SolidId::Board);
    [-0.05, 0.05].map(|by| (own + by).clamp(0.01, 0.99))
}

/// The physics of a profile, every preset, and single changes: of the profile's own physics if it
/// has air, of `ncaa` otherwise. Heights in their names are in `units`.
#[must_use]
pub fn physics_variants(own: &Physics, units: UnitSystem) -> Vec<PhysicsVariant> {
    let variant = |name: &str, physics: &Physics| PhysicsVariant {
        name: name.to_owned(),
        physics: physics.clone(),
        is_unmeasured: false,
    };
    let mut variants = vec![variant("the profile's", own)];
    variants.extend(
        PRESETS
            .iter()
            .map(|preset| variant(preset.name, &preset.physics())),
    );
    let has_air = own.air.density_kg_m3 > 0.0;
    let ncaa = PRESETS.iter().find(|preset| preset.name == "ncaa");
    let base = match ncaa {
        Some(preset) if !has_air => preset.physics(),
        _ => own.clone(),
    };
    let with = if has_air { "with" } else { "ncaa," };
    let [altitude, lower, higher] = match units {
        UnitSystem::Imperial => [
            "air of 5280 ft",
            "release 0.1 ft lower",
            "release 0.1 ft higher",
        ],
        UnitSystem::Metric => [
            "air of 1609 m",
            "release 3.05 cm lower",
            "release 3.05 cm higher",
        ],
    };
    // The range of a basketball; of another ball a tenth to each side of its own value.
    let drag = base.air.drag_coefficient;
    let drags = match drag {
        drag if (0.41..=0.54).contains(&drag) => [0.41, 0.54],
        drag => [0.9 * drag, 1.1 * drag],
    };
    let boards = likely_board_restitutions(&base);
    let drag_names = drags.map(|drag| format!("drag_coefficient {drag:.2}"));
    let board_names = boards.map(|board| format!("board_restitution {board:.2}"));
    // The altitude, the thickness of a ring and its bracket are known of every gym.
    // A release is measured from the floor, and only its height below the ring matters.
    type Change<'a> = (&'a str, bool, Box<dyn Fn(&mut Physics)>);
    let restitution = |solid: SolidId, restitution: f64| -> Box<dyn Fn(&mut Physics)> {
        Box::new(move |physics| {
            physics
                .set_restitution_on(solid, restitution)
                .expect("between 0 and 1");
        })
    };
    // At the same restitution: the ball stays on the ring for a shorter or a longer time.
    let stiffness = |times: f64| -> Box<dyn Fn(&mut Physics)> {
        Box::new(move |physics| {
            let restitution = physics.restitution_on(SolidId::Ring);
            physics.hoop_contact.stiffness_n_m *= times;
            physics
                .set_restitution_on(SolidId::Ring, restitution)
                .expect("the one that it had");
        })
    };
    let drag_of = |drag: f64| -> Box<dyn Fn(&mut Physics)> {
        Box::new(move |physics| physics.air.drag_coefficient = drag)
    };
    let raised = |by_m: f64| -> Box<dyn Fn(&mut Physics)> {
        Box::new(move |physics| physics.hoop_height_m += by_m)
    };
    let changes: Vec<Change<'_>> = vec![
        ("no air", false, Box::new(|physics| physics.air = Air::NONE)),
        (
            altitude,
            false,
            Box::new(|physics| physics.air.density_kg_m3 = 0.98),
        ),
        (&drag_names[0], true, drag_of(drags[0])),
        (&drag_names[1], true, drag_of(drags[1])),
        (
            "lift_slope 0.1",
            true,
            Box::new(|physics| physics.air.lift_slope = 0.1),
        ),
        (
            "a ring of no thickness",
            false,
            Box::new(|physics| physics.ring_tube_diameter_m = 0.0),
        ),
        (
            "no bracket",
            false,
            Box::new(|physics| physics.bracket_width_m = 0.0),
        ),
        (
            "hoop_restitution 0.41",
            true,
            restitution(SolidId::Ring, 0.41),
        ),
        (
            "hoop_restitution 0.70",
            true,
            restitution(SolidId::Ring, 0.70),
        ),
        ("hoop_stiffness half", true, stiffness(0.5)),
        ("hoop_stiffness double", true, stiffness(2.0)),
        (
            &board_names[0],
            true,
            restitution(SolidId::Board, boards[0]),
        ),
        (
            &board_names[1],
            true,
            restitution(SolidId::Board, boards[1]),
        ),
        (lower, true, raised(0.1 * FOOT_M)),
        (higher, true, raised(-0.1 * FOOT_M)),
        (
            "friction 0.8",
            true,
            Box::new(|physics| {
                *physics = physics
                    .clone()
                    .with_contacts(|contact| contact.friction = 0.8);
            }),
        ),
    ];
    variants.extend(
        changes
            .into_iter()
            .filter_map(|(name, is_unmeasured, change)| {
                let mut physics = base.clone();
                change(&mut physics);
                // What the base has already is no change.
                (physics != base).then(|| PhysicsVariant {
                    is_unmeasured,
                    ..variant(&format!("{with} {name}"), &physics)
                })
            }),
    );
    variants
}

/// The best shots of a profile under each physics. One under which the profile is not valid is left
/// out.
///
/// # Errors
/// There is no plan under the first of them.
pub fn compare_physics(
    profile: &Profile,
    variants: &[PhysicsVariant],
    progress: &dyn Progress,
) -> Result<PhysicsComparison, BestShotError> {
    let mut rows: Vec<PhysicsRow> = Vec::new();
    let own = profile
        .nominal_overrides()
        .whole_shot(profile.location().angle_rad);
    let mut first = None;
    progress.begin("comparing physics", variants.len() as u64);
    for variant in variants {
        progress.advance(u64::from(!rows.is_empty()));
        let other = profile.with(|settings| settings.physics = variant.physics.clone());
        let Ok(other) = other else { continue };
        let found = find_kinds(&other, &ShotKind::ALL, SensitivityTopics::NONE, &Silent);
        let mut shots = match found {
            Ok((_, shots)) => shots,
            Err(error) if rows.is_empty() => {
                progress.end();
                return Err(error);
            }
            Err(_) => continue,
        };
        let none = |kind| Err(NoShot::Impossible(kind));
        let bank = shots.pop().unwrap_or_else(|| none(ShotKind::Bank));
        let direct = shots.pop().unwrap_or_else(|| none(ShotKind::Direct));
        if rows.is_empty() {
            let found = [&direct, &bank]
                .into_iter()
                .filter_map(|shot| shot.as_ref().ok());
            let best = found.max_by(|a, b| {
                let [a, b] = [a, b].map(|shot| shot.estimate.probability);
                a.total_cmp(&b)
            });
            first = best.map(|shot| shot.nominal);
        }
        let search = other.search();
        let same_shot = own.or(first).map(|shot| {
            let sampler = Sampler::new(&other);
            let estimate = sampler.estimate(&shot, search.standard_error, search.seed, &Silent);
            SameShotProbability {
                probability: estimate.probability,
                standard_error: estimate.standard_error,
            }
        });
        rows.push(PhysicsRow {
            name: variant.name.clone(),
            is_unmeasured: variant.is_unmeasured,
            possible_share: 1.0,
            aim_past_centre_m: direct
                .as_ref()
                .ok()
                .and_then(|shot| aim_past_centre_m(&other, &shot.nominal)),
            direct,
            bank,
            same_shot,
        });
    }
    progress.end();
    let has_air = profile.physics().air.density_kg_m3 > 0.0;
    let ncaa = rows.iter().position(|row| row.name == "ncaa");
    Ok(PhysicsComparison {
        base: if has_air { 0 } else { ncaa.unwrap_or(0) },
        rows,
        same_shot: if own.is_some() {
            SameShot::OfProfile
        } else {
            SameShot::BestOfFirstRow
        },
    })
}
