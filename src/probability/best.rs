//! The best direct and the best bank shot from one place (Eq. 26), refined off the grid.
//!
//! A nominal shot is *bank* when its error-free flight touches the board first, else *direct*. Of
//! each kind a coarse table of everything the shooter may intend gives a few starts far apart; from
//! each a pattern search climbs on P itself, integrated with the same Sobol points everywhere (common
//! random numbers). About the highest top a finer table, a window, gives P of all nominal shots to
//! about 0.001; while its best lies at the window's edge the window moves on. A parabola along each axis
//! leaves its grid. P of the winner is computed afresh with independent scrambles, so it is not the
//! largest of many noisy values.

use super::Progress;
use super::curves::{self, Curve};
use super::estimate::{Estimate, Sampler};
use super::lessons::{self, Lessons, Topics};
use super::sobol::Key;
use super::table::{Probabilities, Table};
use crate::dynamics::{Outcome, Simulator, Touched};
use crate::physics::PhysicsError;
use crate::plan::{Plan, PlanError};
use crate::profile::{CHOICES, Nominal, Profile};
use rayon::prelude::*;
use serde::Serialize;

/// Starts of the climb for each kind.
const STARTS: usize = 3;
/// Distance in pitch between starts, in nominal pitch angles of the table.
const START_GAP: usize = 3;
/// Moves tried at most from one start.
const MOST_MOVES: u32 = 200;

/// Times as many Sobol points as in the climb by which the tops of the climbs are compared.
const COMPARE: u32 = 8;
/// First steps of the climb: speed past the parabola through the hoop's centre (m/s), pitch (rad),
/// polar angle (rad), backspin (rad/s), side spin (rad/s).
const FIRST_STEPS: [f64; CHOICES.len()] = [0.06, 0.03, 0.01, 3.0, 3.0];
/// Times the steps are halved.
const HALVINGS: u32 = 2;
/// Windows that follow each other at most.
const MOST_WINDOWS: u32 = 4;
/// Part of a window's half width over which the parabola about its best is taken.
const PARABOLA: f64 = 0.3;

/// Which of the two kinds a nominal shot is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ShotKind {
    /// Touches the ring first, or nothing.
    Direct,
    /// Touches the board first.
    Bank,
}

impl ShotKind {
    /// `direct` or `bank`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Bank => "bank",
        }
    }

    /// The kind of a nominal shot.
    #[must_use]
    pub fn of(profile: &Profile, simulator: &Simulator, nominal: &Nominal) -> Self {
        match simulator.first_touch(&profile.release(nominal)) {
            Some(Touched::Board) => Self::Bank,
            _ => Self::Direct,
        }
    }
}

/// The best shot of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct BestShot {
    /// What to aim for.
    pub nominal: Nominal,
    /// Its probability.
    pub estimate: Estimate,
    /// The largest P of this kind in the table of the window about the best.
    pub table_probability: f64,
    /// The plan of that table.
    pub window: Plan,
    /// The error-free shot.
    pub outcome: Outcome,
    /// P along each part of it.
    pub curves: Vec<Curve>,
    /// What the shooter learns from it.
    pub lessons: Lessons,
    /// Where the error-free path, undisturbed, would pass the plane of the hoop: past the hoop's
    /// centre along the shot's own direction, m (positive is long).
    pub aim_past_centre_m: Option<f64>,
    /// Upper bound of the probability that errors lead outside the table's pitch and backspin.
    pub mass_outside: f64,
    /// Limits of the search that the best lies at.
    pub at_limits: Vec<&'static str>,
}

/// What was found for a place.
#[derive(Clone, Debug)]
pub struct Best {
    /// The plan that was carried out.
    pub plan: Plan,
    /// The best direct shot, or why there is none.
    pub direct: Result<BestShot, NoShot>,
    /// The best bank shot, or why there is none.
    pub bank: Result<BestShot, NoShot>,
}

/// Why there is no best shot of a kind.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no {} shot within the limits can go in from this place", .kind.name())]
pub struct NoShot {
    /// The kind.
    pub kind: ShotKind,
}

/// Why the search could not start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BestError {
    /// The physics cannot be simulated.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// There is nothing to plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// Finds the best direct and the best bank shot of a profile on the current rayon pool.
///
/// # Errors
/// When the physics cannot be simulated or the plan is refused.
pub fn find(profile: &Profile, progress: &dyn Progress) -> Result<Best, BestError> {
    let (plan, mut shots) = find_kinds(profile, &KINDS, Topics::ALL, progress)?;
    let nothing = |kind| Err(NoShot { kind });
    let bank = shots.pop().unwrap_or_else(|| nothing(ShotKind::Bank));
    let direct = shots.pop().unwrap_or_else(|| nothing(ShotKind::Direct));
    Ok(Best { plan, direct, bank })
}

/// Both kinds, in the order of their numbers.
pub const KINDS: [ShotKind; 2] = [ShotKind::Direct, ShotKind::Bank];

/// Finds the best shots of some kinds, in their order, and draws the lessons of some topics; what is
/// found of a kind does not depend on the others.
///
/// # Errors
/// As [`find`].
pub fn find_kinds(
    profile: &Profile,
    kinds: &[ShotKind],
    topics: Topics,
    progress: &dyn Progress,
) -> Result<(Plan, Vec<Result<BestShot, NoShot>>), BestError> {
    let plan = Plan::new(profile)?;
    let simulator = Simulator::with_integrator(&profile.physics, profile.integrator)?;
    let search = Search {
        profile,
        plan: &plan,
        simulator: &simulator,
        topics,
        progress,
    };
    let mut starts: [Vec<Nominal>; 2] = [Vec::new(), Vec::new()];
    for side_spin_rad_s in side_spins(profile, &plan) {
        let plan = Plan::with_side_spin(profile, side_spin_rad_s)?;
        let tops = search.tops(&search.table(&plan));
        for (starts, tops) in starts.iter_mut().zip(tops) {
            starts.extend(apart(&tops).into_iter().map(|(_, nominal)| nominal));
        }
    }
    let shots = kinds
        .iter()
        .map(|&kind| search.best(kind, &starts[kind as usize]))
        .collect::<Result<_, _>>()?;
    Ok((plan, shots))
}

/// The side spins from which the search starts: the held one; or none and the limits, of which one is
/// enough where the other is its mirror image.
fn side_spins(profile: &Profile, plan: &Plan) -> Vec<f64> {
    let most = profile.shooter.max_side_spin_rad_s;
    match (profile.search.choose.side_spin, plan.mirrored) {
        (false, _) => vec![plan.nominal.side_spin_rad_s],
        (true, true) => vec![0.0, most],
        (true, false) => vec![0.0, most, -most],
    }
}

/// A nominal shot of the table with its P.
type Top = (f64, Nominal);

struct Search<'a> {
    profile: &'a Profile,
    plan: &'a Plan,
    simulator: &'a Simulator,
    topics: Topics,
    progress: &'a dyn Progress,
}

impl Search<'_> {
    /// For direct and for bank: the best nominal shot at each nominal pitch angle.
    fn tops(&self, table: &Probabilities) -> [Vec<Option<Top>>; 2] {
        let rows: Vec<[Option<Top>; 2]> = (0..table.pitch_rad.len())
            .into_par_iter()
            .map(|pitch| {
                let mut tops: [Option<Top>; 2] = [None, None];
                for polar in 0..table.polar_rad.len() {
                    for speed in 0..table.speed_m_s.len() {
                        // The kind does not depend on spin: flight comes before any contact.
                        let best = (0..table.backspin_rad_s.len())
                            .map(|spin| table.at([pitch, polar, spin, speed]))
                            .fold((0.0, None), |best: (f64, Option<Nominal>), (p, nominal)| {
                                if p > best.0 { (p, Some(nominal)) } else { best }
                            });
                        let (p, Some(nominal)) = best else { continue };
                        if tops
                            .iter()
                            .all(|top| top.is_some_and(|(most, _)| most >= p))
                        {
                            continue;
                        }
                        let kind = ShotKind::of(self.profile, self.simulator, &nominal);
                        let top = &mut tops[kind as usize];
                        if top.is_none_or(|(most, _)| p > most) {
                            *top = Some((p, nominal));
                        }
                    }
                }
                tops
            })
            .collect();
        [0, 1].map(|kind| rows.iter().map(|row| row[kind]).collect())
    }

    fn table(&self, plan: &Plan) -> Probabilities {
        Table::build(self.profile, plan, self.simulator, self.progress).probabilities(self.profile)
    }

    fn best(
        &self,
        kind: ShotKind,
        starts: &[Nominal],
    ) -> Result<Result<BestShot, NoShot>, PlanError> {
        let sampler = Sampler::new(self.profile, self.simulator);
        let scramble = sampler.scramble(Key {
            seed: self.profile.search.seed,
            // Of its own, so that the final estimate is independent of the climb.
            replicate: u64::MAX,
        });
        let made = |points: u32, nominal: &Nominal| {
            let counts = sampler.count(nominal, &scramble, (0, points));
            counts.made()
        };
        let climb_points = self.profile.search.climb_samples;
        let compare_points = COMPARE * climb_points;
        let hill = starts
            .iter()
            .map(|&start| {
                let top = self.climb(kind, start, |nominal| made(climb_points, nominal));
                (made(compare_points, &top), top)
            })
            .reduce(|best, next| if next.0 > best.0 { next } else { best })
            .filter(|(made, _)| *made > 0);
        let Some((_, mut nominal)) = hill else {
            return Ok(Err(NoShot { kind }));
        };
        let mut window = self.plan.around(self.profile, &nominal)?;
        let mut table_probability = 0.0;
        let mut curves = Vec::new();
        for _ in 0..MOST_WINDOWS {
            let table = self.table(&window);
            let tops = self.tops(&table);
            let Some(&(p, top)) = apart(&tops[kind as usize]).first() else {
                break;
            };
            table_probability = p;
            nominal = self.off_the_grid(kind, &table, &top);
            curves = curves::from_table(&table, &nominal);
            let next = self.plan.around(self.profile, &nominal)?;
            if !window.nominal.is_at_edge(&top, &next.nominal) {
                break;
            }
            window = next;
        }
        if !self.profile.shooter.errors.are_of_eq_25() || self.profile.search.choose.side_spin {
            // The table knows four independent errors and one side spin; the samples know them all.
            nominal = self.climb(kind, nominal, |nominal| made(compare_points, nominal));
            window = self.plan.around(self.profile, &nominal)?;
            curves = curves::from_samples(self.profile, &sampler, &scramble, &window, &nominal);
        }
        let search = &self.profile.search;
        let estimate =
            sampler.estimate(&nominal, search.standard_error, search.seed, self.progress);
        Ok(Ok(BestShot {
            nominal,
            estimate,
            table_probability,
            window,
            outcome: self.simulator.shoot(&self.profile.release(&nominal)),
            curves,
            lessons: lessons::draw(
                self.profile,
                self.simulator,
                &nominal,
                self.topics,
                self.progress,
            ),
            aim_past_centre_m: aim_past_centre_m(self.profile, &nominal),
            mass_outside: self.plan.mass_outside(self.profile, &nominal),
            at_limits: self.limits(&nominal),
        }))
    }

    /// The top of the parabola through a table's best and two others, along each axis; the table's best
    /// itself where the parabola has no top between them, or leads to the other kind.
    fn off_the_grid(&self, kind: ShotKind, table: &Probabilities, top: &Nominal) -> Nominal {
        let mut nominal = *top;
        let index = table.index_of(top);
        let axes = table.counts();
        for axis in 0..axes.len() {
            let reach = ((PARABOLA * 0.5 * axes[axis] as f64) as usize).max(1);
            if index[axis] < reach || index[axis] + reach >= axes[axis] {
                continue;
            }
            let at = |i: usize| {
                let mut index = index;
                index[axis] = i;
                table.at(index)
            };
            let [low, middle, high] =
                [index[axis] - reach, index[axis], index[axis] + reach].map(at);
            let bend = low.0 - 2.0 * middle.0 + high.0;
            if bend < 0.0 {
                let part = (0.5 * (low.0 - high.0) / bend).clamp(-1.0, 1.0);
                let reach = 0.5 * (axis_value(&high.1, axis) - axis_value(&low.1, axis));
                *axis_value_mut(&mut nominal, axis) += part * reach;
            }
        }
        if ShotKind::of(self.profile, self.simulator, &nominal) == kind {
            nominal
        } else {
            *top
        }
    }

    /// Climbs from a start by a pattern search on the number of shots made; gives the top.
    fn climb(&self, kind: ShotKind, start: Nominal, value: impl Fn(&Nominal) -> u64) -> Nominal {
        let mut steps = FIRST_STEPS;
        let chosen = self.profile.search.choose.flags();
        let mut best = (value(&start), start);
        let mut moves = 0;
        self.progress.begin("climbing", u64::from(HALVINGS + 1));
        for _ in 0..=HALVINGS {
            let mut moved = true;
            while moved && moves < MOST_MOVES {
                moved = false;
                for (axis, &step) in steps.iter().enumerate() {
                    if !chosen[axis] {
                        continue;
                    }
                    for sign in [1.0, -1.0] {
                        let next = self.moved(&best.1, axis, sign * step);
                        if next == best.1
                            || ShotKind::of(self.profile, self.simulator, &next) != kind
                        {
                            continue;
                        }
                        moves += 1;
                        let made = value(&next);
                        if made > best.0 {
                            best = (made, next);
                            moved = true;
                            break;
                        }
                    }
                }
            }
            steps = steps.map(|step| 0.5 * step);
            self.progress.advance(1);
        }
        self.progress.end();
        best.1
    }

    /// The nominal shot moved along one axis and kept within the limits. A move in pitch takes the
    /// speed along, so that the path still passes the hoop where it did.
    fn moved(&self, from: &Nominal, axis: usize, by: f64) -> Nominal {
        let search = &self.profile.search;
        let mut to = *from;
        match axis {
            0 => to.speed_m_s += by,
            1 => {
                to.pitch_rad =
                    (from.pitch_rad + by).clamp(search.pitch_min_rad, search.pitch_max_rad);
                let before = centre_speed_m_s(self.profile, from.pitch_rad);
                let after = centre_speed_m_s(self.profile, to.pitch_rad);
                if let Some((before, after)) = before.zip(after).filter(|_| search.choose.speed) {
                    to.speed_m_s += after - before;
                }
            }
            2 => {
                let (low, high) = self.plan.bracket.polar_rad;
                to.polar_rad = (from.polar_rad + by).clamp(low, high);
            }
            3 => {
                let most = self.profile.shooter.max_backspin_rad_s;
                to.backspin_rad_s = (from.backspin_rad_s + by).clamp(0.0, most);
            }
            _ => {
                let most = self.profile.shooter.max_side_spin_rad_s;
                to.side_spin_rad_s = (from.side_spin_rad_s + by).clamp(-most, most);
            }
        }
        if search.choose.speed {
            to.speed_m_s = to.speed_m_s.clamp(0.1, self.plan.bracket.speed_max_m_s);
        }
        to
    }

    fn limits(&self, nominal: &Nominal) -> Vec<&'static str> {
        let search = &self.profile.search;
        let choose = search.choose;
        let (least_spin, most_spin) = self.profile.backspins_rad_s();
        let most_side_spin = self.profile.shooter.max_side_spin_rad_s;
        [
            (
                "pitch_min",
                choose.pitch && nominal.pitch_rad <= search.pitch_min_rad,
            ),
            (
                "pitch_max",
                choose.pitch && nominal.pitch_rad >= search.pitch_max_rad,
            ),
            (
                "no backspin",
                most_spin > least_spin && nominal.backspin_rad_s <= least_spin,
            ),
            (
                "max_backspin",
                most_spin > least_spin && nominal.backspin_rad_s >= most_spin,
            ),
            (
                "max_side_spin",
                choose.side_spin && nominal.side_spin_rad_s.abs() >= most_side_spin,
            ),
            (
                "speed_max",
                choose.speed && nominal.speed_m_s >= self.plan.bracket.speed_max_m_s,
            ),
        ]
        .into_iter()
        .filter_map(|(name, at)| at.then_some(name))
        .collect()
    }
}

/// A nominal value by the order of a table's axes: pitch, polar angle, backspin, speed.
fn axis_value(nominal: &Nominal, axis: usize) -> f64 {
    let mut nominal = *nominal;
    *axis_value_mut(&mut nominal, axis)
}

fn axis_value_mut(nominal: &mut Nominal, axis: usize) -> &mut f64 {
    match axis {
        0 => &mut nominal.pitch_rad,
        1 => &mut nominal.polar_rad,
        2 => &mut nominal.backspin_rad_s,
        _ => &mut nominal.speed_m_s,
    }
}

/// The best of the tops, and others at least [`START_GAP`] pitch angles away from those before.
fn apart(tops: &[Option<Top>]) -> Vec<Top> {
    let mut order: Vec<(usize, Top)> = tops
        .iter()
        .enumerate()
        .filter_map(|(i, top)| top.map(|top| (i, top)))
        .collect();
    order.sort_by(|a, b| b.1.0.total_cmp(&a.1.0).then(a.0.cmp(&b.0)));
    let mut chosen: Vec<(usize, Top)> = Vec::new();
    for (i, top) in order {
        if chosen.len() < STARTS && chosen.iter().all(|(j, _)| i.abs_diff(*j) >= START_GAP) {
            chosen.push((i, top));
        }
    }
    chosen.into_iter().map(|(_, top)| top).collect()
}

/// Speed of the parabola through the hoop's centre; none where the pitch is too low.
fn centre_speed_m_s(profile: &Profile, pitch_rad: f64) -> Option<f64> {
    let s = profile.place.distance_m;
    let (sin, cos) = libm::sincos(pitch_rad);
    let over = profile.height_above_hoop_m() + s * sin / cos;
    (over > 0.0 && cos > 1e-6).then(|| s / cos * (0.5 * profile.physics.gravity_m_s2 / over).sqrt())
}

/// How far past the hoop's centre the undisturbed path falls through the plane of the hoop, along
/// the path's own level direction.
fn aim_past_centre_m(profile: &Profile, nominal: &Nominal) -> Option<f64> {
    let (sin, cos) = libm::sincos(nominal.pitch_rad);
    let g = profile.physics.gravity_m_s2;
    let up = nominal.speed_m_s * sin;
    let square = up * up + 2.0 * g * profile.height_above_hoop_m();
    let length = nominal.speed_m_s * cos * (up + square.max(0.0).sqrt()) / g;
    let turn = libm::cos(nominal.polar_rad - profile.place.angle_rad);
    (square > 0.0).then_some(length - profile.place.distance_m * turn)
}
