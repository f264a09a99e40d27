//! How much of an answer rests on the physics: best shots under other physics.

use super::followed::{Starts, carried};
use super::found_shots::{BestShot, BestShotError, NoShot};
use super::search::{Found, find_from};
use crate::analysis::aim_past_hoop::aim_past_centre_m;
use crate::analysis::sensitivity::SensitivityTopics;
use crate::model::{Air, PRESETS, Physics, Preset, SolidId};
use crate::probability::{Progress, Sampler, Silent};
use crate::shooter::{Nominal, Profile, ShotKind};
use crate::units::FOOT_M;
use std::mem::{Discriminant, discriminant};

/// A single change of a physics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PhysicsChange {
    /// A vacuum.
    NoAir,
    /// The air of a mile above the sea, 1609 m.
    Altitude,
    /// Another drag coefficient.
    Drag(f64),
    /// Another lift slope.
    Lift(f64),
    /// A ring without thickness.
    ThinRing,
    /// No bracket.
    NoBracket,
    /// Another restitution of the hoop.
    RingRestitution(f64),
    /// The stiffness of the hoop times this, at the same restitution: the ball stays on the ring
    /// for a shorter or a longer time.
    RingStiffness(f64),
    /// Another restitution of the board.
    BoardRestitution(f64),
    /// A release higher by this, m. A release is measured from the floor, and only its height below
    /// the ring matters.
    ReleaseHeight(f64),
    /// Another friction of board and hoop.
    Friction(f64),
}

impl PhysicsChange {
    /// Whether nobody measured it in this gym. The altitude, the thickness of a ring and its
    /// bracket are known of every gym.
    fn is_unmeasured(self) -> bool {
        !matches!(
            self,
            Self::NoAir | Self::Altitude | Self::ThinRing | Self::NoBracket
        )
    }

    /// What it changes, whatever the value.
    #[must_use]
    pub fn quantity(self) -> Discriminant<Self> {
        discriminant(&self)
    }

    /// The changed physics.
    fn of(self, base: &Physics) -> Physics {
        let mut physics = base.clone();
        let mut set = |solid, restitution| {
            let set = physics.set_restitution_on(solid, restitution);
            set.expect("a restitution between 0 and 1");
        };
        match self {
            Self::NoAir => physics.air = Air::NONE,
            Self::Altitude => physics.air.density_kg_m3 = 0.98,
            Self::Drag(drag) => physics.air.drag_coefficient = drag,
            Self::Lift(slope) => physics.air.lift_slope = slope,
            Self::ThinRing => physics.ring_tube_diameter_m = 0.0,
            Self::NoBracket => physics.bracket_width_m = 0.0,
            Self::RingRestitution(restitution) => set(SolidId::Ring, restitution),
            Self::BoardRestitution(restitution) => set(SolidId::Board, restitution),
            Self::RingStiffness(times) => {
                let own = physics.restitution_on(SolidId::Ring);
                physics.hoop_contact.stiffness_n_m *= times;
                physics
                    .set_restitution_on(SolidId::Ring, own)
                    .expect("the one that it had");
            }
            Self::ReleaseHeight(by_m) => physics.hoop_height_m -= by_m,
            Self::Friction(friction) => {
                physics = physics.with_contacts(|contact| contact.friction = friction);
            }
        }
        physics
    }
}

/// Which physics one of a comparison is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PhysicsOf {
    /// The profile's own.
    Profile,
    /// One that was asked for in its place.
    Given,
    /// That of a preset.
    Preset(&'static str),
    /// The profile's own with a single change.
    Changed(PhysicsChange),
    /// That of `ncaa` with a single change, where the profile's own has no air.
    ChangedNcaa(PhysicsChange),
}

impl PhysicsOf {
    /// The single change, if it is one.
    #[must_use]
    pub fn change(self) -> Option<PhysicsChange> {
        match self {
            Self::Changed(change) | Self::ChangedNcaa(change) => Some(change),
            Self::Profile | Self::Given | Self::Preset(_) => None,
        }
    }

    /// The single change of something that nobody measured in this gym.
    #[must_use]
    pub fn unmeasured(self) -> Option<PhysicsChange> {
        self.change().filter(|change| change.is_unmeasured())
    }
}

/// A physics to compare with.
#[derive(Clone, Debug)]
pub struct PhysicsVariant {
    /// Which it is.
    pub of: PhysicsOf,
    /// The physics itself.
    pub physics: Physics,
}

/// The best shots under one physics.
#[derive(Clone, Debug)]
pub struct PhysicsRow {
    /// Which it is.
    pub of: PhysicsOf,
    /// The physics itself.
    pub physics: Physics,
    /// The best direct shot.
    pub direct: Result<BestShot, NoShot>,
    /// The best bank shot.
    pub bank: Result<BestShot, NoShot>,
    /// Where the undisturbed path of the best direct shot falls past the hoop's centre, m.
    pub aim_past_centre_m: Option<f64>,
    /// P of [`PhysicsComparison::same_shot`].
    pub same_shot: Option<SameShotProbability>,
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

    /// P of the best direct shot.
    #[must_use]
    pub fn direct_p(&self) -> Option<f64> {
        Some(self.direct.as_ref().ok()?.estimate.probability)
    }

    /// P of the best bank shot.
    #[must_use]
    pub fn bank_p(&self) -> Option<f64> {
        Some(self.bank.as_ref().ok()?.estimate.probability)
    }

    /// P of [`PhysicsComparison::same_shot`].
    #[must_use]
    pub fn same_shot_p(&self) -> Option<f64> {
        Some(self.same_shot.as_ref()?.probability)
    }

    /// P of the best bank shot less that of the best direct one.
    #[must_use]
    pub fn bank_gain(&self) -> Option<f64> {
        Some(self.bank_p()? - self.direct_p()?)
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

/// What a single change does to a P, as far as the gym may have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangeOfP {
    /// The index of its row.
    pub row: usize,
    /// The change.
    pub change: PhysicsChange,
    /// P there less P of the base.
    pub by: f64,
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
    /// The comparison with another shot that is the same in every row.
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

    /// The comparison with how far towards each row the gym may be.
    #[must_use]
    pub fn with_possible_shares(mut self, shares: &[f64]) -> Self {
        for (row, share) in self.rows.iter_mut().zip(shares) {
            row.possible_share = *share;
        }
        self
    }

    /// What the single changes that nobody measured in this gym do to a P of a row, as far as the
    /// gym may have them, the largest first.
    pub fn unmeasured_changes(
        &self,
        p: impl Fn(usize, &PhysicsRow) -> Option<f64>,
    ) -> Vec<ChangeOfP> {
        let base = self.rows.get(self.base).and_then(|row| p(self.base, row));
        let rows = self.rows.iter().enumerate();
        let mut changes: Vec<ChangeOfP> = rows
            .filter_map(|(index, row)| {
                let change = row.of.unmeasured()?;
                let by = row.possible_share * (p(index, row)? - base?);
                let row = index;
                Some(ChangeOfP { row, change, by })
            })
            .collect();
        changes.sort_by(|a, b| b.by.abs().total_cmp(&a.by.abs()));
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

    /// The changes that nobody measured under which the other kind of shot is the better one, as
    /// far as the gym may have them.
    #[must_use]
    pub fn kind_turners(&self) -> Vec<&PhysicsRow> {
        let Some(gain) = self.rows.get(self.base).and_then(PhysicsRow::bank_gain) else {
            return Vec::new();
        };
        let turns = |row: &&PhysicsRow| {
            let there = row.bank_gain();
            let there = there.map(|there| gain + row.possible_share * (there - gain));
            row.of.unmeasured().is_some() && there.is_some_and(|there| there * gain < 0.0)
        };
        self.rows.iter().filter(turns).collect()
    }
}

/// How far single changes may lower and raise P together: the root of the sum of squares, of each
/// quantity the change that does most on that side. The changes are ends of what the quantities may
/// be.
#[must_use]
pub fn together(changes: &[ChangeOfP]) -> [f64; 2] {
    [-1.0, 1.0].map(|side| {
        let mut most: Vec<(Discriminant<PhysicsChange>, f64)> = Vec::new();
        for ChangeOfP { change, by, .. } in changes {
            let of = change.quantity();
            match most.iter_mut().find(|(other, _)| *other == of) {
                Some((_, most)) => *most = most.max(side * by),
                None => most.push((of, (side * by).max(0.0))),
            }
        }
        most.sort_by(|a, b| a.1.total_cmp(&b.1));
        side * most.iter().map(|(_, by)| by * by).sum::<f64>().sqrt()
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

/// The restitutions that a board may have where nobody measured it: a drop test is on a hard floor,
/// a board on a mount may give way, and boards differ.
#[must_use]
pub fn likely_board_restitutions(physics: &Physics) -> [f64; 2] {
    let own = physics.restitution_on(SolidId::Board);
    [-0.05, 0.05].map(|by| (own + by).clamp(0.01, 0.99))
}

/// The physics of a profile, every preset, and single changes: of the profile's own physics if it
/// has air, of `ncaa` otherwise. `own_is` says whose the own one is.
#[must_use]
pub fn physics_variants(own: &Physics, own_is: PhysicsOf) -> Vec<PhysicsVariant> {
    let variant = |of, physics: Physics| PhysicsVariant { of, physics };
    let mut variants = vec![variant(own_is, own.clone())];
    let presets = PRESETS.iter();
    variants
        .extend(presets.map(|preset| variant(PhysicsOf::Preset(preset.name), preset.physics())));
    let has_air = own.air.density_kg_m3 > 0.0;
    let base = match Preset::named(NCAA) {
        Some(preset) if !has_air => preset.physics(),
        _ => own.clone(),
    };
    // The range of a basketball; of another ball a tenth to each side of its own value.
    let drags = match base.air.drag_coefficient {
        drag if (0.41..=0.54).contains(&drag) => [0.41, 0.54],
        drag => [0.9 * drag, 1.1 * drag],
    };
    let boards = likely_board_restitutions(&base);
    let changes = [
        PhysicsChange::NoAir,
        PhysicsChange::Altitude,
        PhysicsChange::Drag(drags[0]),
        PhysicsChange::Drag(drags[1]),
        PhysicsChange::Lift(0.1),
        PhysicsChange::ThinRing,
        PhysicsChange::NoBracket,
        PhysicsChange::RingRestitution(0.41),
        PhysicsChange::RingRestitution(0.70),
        PhysicsChange::RingStiffness(0.5),
        PhysicsChange::RingStiffness(2.0),
        PhysicsChange::BoardRestitution(boards[0]),
        PhysicsChange::BoardRestitution(boards[1]),
        PhysicsChange::ReleaseHeight(-0.1 * FOOT_M),
        PhysicsChange::ReleaseHeight(0.1 * FOOT_M),
        PhysicsChange::Friction(0.8),
    ];
    let changed = changes.into_iter().map(|change| {
        let of = match has_air {
            true => PhysicsOf::Changed(change),
            false => PhysicsOf::ChangedNcaa(change),
        };
        variant(of, change.of(&base))
    });
    // What the base has already is no change.
    variants.extend(changed.filter(|variant| variant.physics != base));
    variants
}

/// The preset that single changes start from where the profile's own physics has no air.
const NCAA: &str = "ncaa";

/// The best shots of a profile under each physics. One under which the profile is not valid is left
/// out. The first physics with air and the first without are searched; the others follow the optima
/// of these.
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
    let mut searched: Vec<(Profile, Vec<Nominal>)> = Vec::new();
    let has_air = |profile: &Profile| profile.physics().air.density_kg_m3 > 0.0;
    progress.begin("comparing physics", variants.len() as u64);
    for variant in variants {
        progress.advance(u64::from(!rows.is_empty()));
        let other = profile.with(|settings| settings.physics = variant.physics.clone());
        let Ok(other) = other else { continue };
        let near = searched
            .iter()
            .find(|(near, _)| has_air(near) == has_air(&other));
        let starts: Vec<Nominal> = near.map_or(Vec::new(), |(near, optima)| {
            let optima = optima.iter();
            optima.map(|shot| carried(near, &other, shot)).collect()
        });
        let found = find_from(
            (&other, Starts::of(&starts)),
            &ShotKind::ALL,
            SensitivityTopics::NONE,
            &Silent,
            None,
        );
        let mut shots = match found {
            Ok(Found { shots, optima, .. }) => {
                if near.is_none() {
                    searched.push((other.clone(), optima));
                }
                shots
            }
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
            of: variant.of,
            physics: variant.physics.clone(),
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
    let ncaa = rows
        .iter()
        .position(|row| row.of == PhysicsOf::Preset(NCAA));
    Ok(PhysicsComparison {
        base: if has_air(profile) {
            0
        } else {
            ncaa.unwrap_or(0)
        },
        rows,
        same_shot: if own.is_some() {
            SameShot::OfProfile
        } else {
            SameShot::BestOfFirstRow
        },
    })
}
