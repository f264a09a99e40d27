//! The search for the best shots, refined off the grid.
//!
//! For each kind, a coarse table of everything the shooter can intend gives a few starts, far
//! apart. From each start a pattern search climbs on P itself, integrated with the same Sobol
//! points everywhere (common random numbers). The table does not resolve the P of a very accurate
//! shooter, so the other starts are tried with few points. About the highest optimum a finer table,
//! a window, gives P of all nominal shots to about 0.001. While its best shot lies at the window's
//! edge, the window moves on. A parabola along each axis finds the optimum between the points of
//! the table. A table has four independent errors and one side spin: where errors are correlated,
//! or the side spin is searched too, a climb with more points and parabolas through its optimum
//! take the place of the windows. P of the winner is computed again with independent scrambles, so
//! it is not the largest of many noisy values.

use super::found_shots::{BestShot, BestShotError, BestShots, Limit, NoShot};
use super::pattern_search::{Climb, Steps};
use super::table_maxima::{Candidate, maxima_by_pitch, maxima_by_speed, separated};
use crate::analysis::aim_past_hoop::aim_past_centre_m;
use crate::analysis::probability_curves::{self, ProbabilityCurve};
use crate::analysis::sensitivity::{self, SensitivityTopics};
use crate::math::sobol::{Scramble, ScrambleKey};
use crate::probability::{Estimate, NominalProbabilities, NominalTable, Progress, Sampler, Silent};
use crate::search_space::{PlanError, TablePlan};
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};
use rayon::prelude::*;

/// Starts of the climb for each kind, and for each side spin that is tried.
const STARTS: usize = 3;
/// Sobol points of a trial of another start.
const TRIAL_SAMPLES: u32 = 256;
/// A trial that reaches P of the optimum but for this is worth a climb: about twice the error of
/// its few points.
const TRIAL_MARGIN: f64 = 0.02;
/// The optimum of another start must be better by so many standard errors of independent points: by
/// less, two are level, and the first one stays.
const LEAST_GAIN: f64 = 2.0;
/// A trial that ends nearer than this to the optimum, in pitch, has found the same one.
const SAME_OPTIMUM_RAD: f64 = 0.05;
/// The same for a fixed pitch angle: in direction, and relative in speed.
const SAME_DIRECTION_RAD: f64 = 0.02;
const SAME_SPEED: f64 = 0.02;
/// The optima of the climbs are compared with this many times the Sobol points of the climbs.
const COMPARISON_FACTOR: u32 = 8;
/// Greatest number of windows in a row.
const MAX_WINDOWS: u32 = 4;
/// Fraction of a window's half width over which the parabola about its best shot is taken.
const PARABOLA_REACH: f64 = 0.3;
/// The same where P comes from samples, whose differences are less exact than those of a table.
const SAMPLED_PARABOLA_REACH: f64 = 0.7;

/// Finds the best direct and the best bank shot of a profile, on the current rayon pool.
///
/// # Errors
/// The table would be too large, or no release reaches the hoop.
pub fn find(profile: &Profile, progress: &dyn Progress) -> Result<BestShots, BestShotError> {
    let topics = SensitivityTopics::ALL;
    let (plan, mut shots) = find_kinds(profile, &ShotKind::ALL, topics, progress)?;
    let none = |kind| Err(NoShot::Impossible(kind));
    let bank = shots.pop().unwrap_or_else(|| none(ShotKind::Bank));
    let direct = shots.pop().unwrap_or_else(|| none(ShotKind::Direct));
    Ok(BestShots { plan, direct, bank })
}

/// Finds the best shots of some kinds, in their order, with some topics of their sensitivity. The
/// result of a kind does not depend on the others.
///
/// # Errors
/// As [`find`].
pub fn find_kinds(
    profile: &Profile,
    kinds: &[ShotKind],
    topics: SensitivityTopics,
    progress: &dyn Progress,
) -> Result<(TablePlan, Vec<Result<BestShot, NoShot>>), BestShotError> {
    let plan = TablePlan::for_search(profile)?;
    let search = BestShotSearch {
        profile,
        plan: &plan,
        topics,
        progress,
    };
    let starts = search.starts()?;
    // Side by side: the climbs of one kind are too few for all threads.
    let shots = kinds
        .par_iter()
        .map(|&kind| search.best(kind, &starts[kind.index()]))
        .collect::<Result<_, _>>()?;
    Ok((plan, shots))
}

/// The best shot of a kind without its sensitivity, and P of the optimum of the other kind
/// that climbs alone find; `None` where no shot of that kind is made.
///
/// # Errors
/// As [`find`].
pub(super) fn find_beside_other_kind(
    profile: &Profile,
    kind: ShotKind,
    progress: &dyn Progress,
) -> Result<(Result<BestShot, NoShot>, Option<Estimate>), BestShotError> {
    let plan = TablePlan::for_search(profile)?;
    let search = BestShotSearch {
        profile,
        plan: &plan,
        topics: SensitivityTopics::NONE,
        progress,
    };
    let starts = search.starts()?;
    let best = search.best(kind, &starts[kind.index()])?;
    let other = kind.other();
    let optimum = search.optimum(other, &starts[other.index()]);
    Ok((best, optimum.map(|(_, estimate)| estimate)))
}

/// The optimum of a kind that climbs from some shots reach, and its P; `None` where none of the
/// shots is of the kind, or no shot at the optimum is made. There may be a higher one elsewhere.
///
/// # Errors
/// As [`find`].
pub(super) fn climb_from_shots(
    profile: &Profile,
    kind: ShotKind,
    shots: &[Nominal],
) -> Result<Option<(Nominal, Estimate)>, BestShotError> {
    let plan = TablePlan::for_search(profile)?;
    let search = BestShotSearch {
        profile,
        plan: &plan,
        topics: SensitivityTopics::NONE,
        progress: &Silent,
    };
    let of_kind = |shot: &&Nominal| ShotKind::of(profile, shot) == kind;
    let starts = Starts {
        first: shots.iter().filter(of_kind).copied().collect(),
        others: Vec::new(),
    };
    Ok(search.optimum(kind, &starts))
}

/// The side spins from which the search starts: the fixed one; or none and the limits. One limit is
/// enough if the other is its mirror image.
fn start_side_spins(profile: &Profile, plan: &TablePlan) -> Vec<f64> {
    let most = profile.shooter().max_side_spin_rad_s;
    let is_searched = profile.search().choice.includes(NominalVariable::SideSpin);
    match (is_searched, plan.mirrored) {
        (false, _) => vec![plan.nominal.side_spin_rad_s],
        (true, true) => vec![0.0, most],
        (true, false) => vec![0.0, most, -most],
    }
}

/// The refined optimum of a kind, and the window about it.
struct Window {
    plan: TablePlan,
    nominal: Nominal,
    /// The largest P of the window's table, where there is one.
    table_probability: Option<f64>,
    curves: Vec<ProbabilityCurve>,
}

/// Where the climbs of a kind start.
#[derive(Default)]
struct Starts {
    /// The best of the coarse table, far apart.
    first: Vec<Nominal>,
    /// The next ones, which are tried with few points.
    others: Vec<Nominal>,
}

struct BestShotSearch<'a> {
    profile: &'a Profile,
    plan: &'a TablePlan,
    topics: SensitivityTopics,
    progress: &'a dyn Progress,
}

impl BestShotSearch<'_> {
    /// The starts of the climbs of each kind, from the coarse table.
    fn starts(&self) -> Result<[Starts; 2], PlanError> {
        let mut starts = [Starts::default(), Starts::default()];
        for side_spin_rad_s in start_side_spins(self.profile, self.plan) {
            let plan = TablePlan::for_search_with_side_spin(self.profile, side_spin_rad_s)?;
            let table = self.table(&plan);
            let maxima = if table.pitch_rad.len() == 1 {
                maxima_by_speed(self.profile, &table)
            } else {
                maxima_by_pitch(self.profile, &table)
            };
            for (starts, maxima) in starts.iter_mut().zip(maxima) {
                let mut separated = separated(&maxima);
                let others = separated.split_off(STARTS.min(separated.len()));
                let nominal = |(_, nominal): Candidate| nominal;
                starts.first.extend(separated.into_iter().map(nominal));
                starts.others.extend(others.into_iter().map(nominal));
            }
        }
        Ok(starts)
    }

    /// The scramble of the climbs: of a replicate of its own, so that final estimates are
    /// independent of the climb.
    fn climb_scramble(&self, sampler: &Sampler<'_>) -> Scramble {
        sampler.scramble(ScrambleKey {
            seed: self.profile.search().seed,
            replicate: u64::MAX,
        })
    }

    /// The optimum that climbs from `starts` reach, and its P; `None` if no shot of it is made.
    fn optimum(&self, kind: ShotKind, starts: &Starts) -> Option<(Nominal, Estimate)> {
        let sampler = Sampler::new(self.profile);
        let scramble = self.climb_scramble(&sampler);
        let nominal = self.climb_from(kind, starts, &sampler, &scramble)?;
        let search = self.profile.search();
        let target = search.standard_error;
        let estimate = sampler.estimate(&nominal, target, search.seed, &Silent);
        Some((nominal, estimate))
    }

    fn table(&self, plan: &TablePlan) -> NominalProbabilities {
        NominalTable::simulate(self.profile, plan, self.progress).probabilities(self.profile)
    }

    fn best(&self, kind: ShotKind, starts: &Starts) -> Result<Result<BestShot, NoShot>, PlanError> {
        let sampler = Sampler::new(self.profile);
        let search = self.profile.search();
        let scramble = self.climb_scramble(&sampler);
        let Some(start) = self.climb_from(kind, starts, &sampler, &scramble) else {
            return Ok(Err(NoShot::Impossible(kind)));
        };
        let searches_side_spin = search.choice.includes(NominalVariable::SideSpin);
        let tables_hold = self.profile.shooter().dispersion.is_of_eq_25() && !searches_side_spin;
        let mut window = if tables_hold {
            self.move_window(kind, start)?
        } else {
            self.climb_with_more_points(kind, start, &sampler, &scramble)?
        };
        if !self.is_made(&window.nominal) {
            // The most probable shot goes in only with errors: take the best one that needs none.
            let table = self.table(&window.plan);
            if let Some((p, clean)) = self.best_clean(kind, &table) {
                window.table_probability = tables_hold.then_some(p);
                window.nominal = clean;
                window.curves = probability_curves::from_table(&table, &clean);
            }
        }
        let (nominal, estimate) = self.straight_if_as_good(kind, &window.nominal, &sampler);
        let outcome = self
            .profile
            .simulator()
            .outcome(self.profile.release(&nominal).state());
        if !outcome.verdict.made {
            return Ok(Err(NoShot::NotClean {
                kind,
                probability_per_million: (estimate.probability * 1e6).round() as u32,
            }));
        }
        Ok(Ok(BestShot {
            nominal,
            estimate,
            table_probability: window.table_probability,
            window: window.plan,
            outcome,
            curves: window.curves,
            sensitivity: sensitivity::analyse(self.profile, &nominal, self.topics, self.progress),
            aim_past_centre_m: aim_past_centre_m(self.profile, &nominal),
            mass_outside: self.plan.mass_outside(self.profile, &nominal),
            at_limits: self.limits_at(&nominal),
        }))
    }

    /// The shot with its P; aimed straight at the hoop's centre if left and right are mirror images
    /// and P is the same but for its error.
    fn straight_if_as_good(
        &self,
        kind: ShotKind,
        nominal: &Nominal,
        sampler: &Sampler<'_>,
    ) -> (Nominal, Estimate) {
        let search = self.profile.search();
        let with_estimate = |nominal: Nominal| {
            let target = search.standard_error;
            let estimate = sampler.estimate(&nominal, target, search.seed, self.progress);
            (nominal, estimate)
        };
        let found = with_estimate(*nominal);
        let straight = Nominal {
            polar_rad: self.profile.location().angle_rad,
            ..*nominal
        };
        let is_other = self.plan.mirrored && straight.polar_rad != nominal.polar_rad;
        if !is_other || ShotKind::of(self.profile, &straight) != kind || !self.is_made(&straight) {
            return found;
        }
        let straight = with_estimate(straight);
        if straight.1.probability >= found.1.probability - found.1.standard_error {
            straight
        } else {
            found
        }
    }

    fn is_made(&self, nominal: &Nominal) -> bool {
        let start = self.profile.release(nominal).state();
        self.profile.simulator().verdict(start).made
    }

    /// The most probable nominal shot of a table that is made without errors.
    fn best_clean(&self, kind: ShotKind, table: &NominalProbabilities) -> Option<Candidate> {
        let mut shots: Vec<Candidate> = Vec::new();
        for pitch in 0..table.pitch_rad.len() {
            for polar in 0..table.polar_rad.len() {
                for spin in 0..table.backspin_rad_s.len() {
                    let speeds = 0..table.speed_m_s.len();
                    shots.extend(speeds.map(|speed| table.at([pitch, polar, spin, speed])));
                }
            }
        }
        shots.sort_by(|a, b| b.0.total_cmp(&a.0));
        shots
            .into_iter()
            .take_while(|(p, _)| *p > 0.0)
            .find(|(_, nominal)| {
                ShotKind::of(self.profile, nominal) == kind && self.is_made(nominal)
            })
    }

    /// Climbs from the first starts, and from those of the others that a trial finds promising;
    /// returns the highest optimum, if any shot of it is made.
    fn climb_from(
        &self,
        kind: ShotKind,
        starts: &Starts,
        sampler: &Sampler<'_>,
        scramble: &Scramble,
    ) -> Option<Nominal> {
        let best = self.highest_optimum(kind, &starts.first, sampler, scramble)?;
        let compared = f64::from(COMPARISON_FACTOR * self.profile.search().climb_samples);
        let worth_a_climb = best.0 as f64 / compared - TRIAL_MARGIN;
        let is_promising = |optimum: &Nominal| {
            let made = sampler.count(optimum, scramble, (0, TRIAL_SAMPLES)).made();
            self.is_other_optimum(optimum, &best.1)
                && made as f64 / f64::from(TRIAL_SAMPLES) > worth_a_climb
        };
        let promising: Vec<Nominal> = starts
            .others
            .par_iter()
            .map(|&start| self.climb(kind, start, sampler, scramble, TRIAL_SAMPLES))
            .filter(is_promising)
            .collect();
        let other = self.highest_optimum(kind, &promising, sampler, scramble);
        let share = best.0 as f64 / compared;
        let error = (2.0 * compared * share * (1.0 - share)).sqrt();
        Some(match other {
            Some(other) if other.0 as f64 > best.0 as f64 + LEAST_GAIN * error => other.1,
            _ => best.1,
        })
    }

    /// Whether an optimum is another one: apart in pitch; where the pitch angle is fixed, in
    /// direction or speed.
    fn is_other_optimum(&self, optimum: &Nominal, known: &Nominal) -> bool {
        if self
            .profile
            .search()
            .choice
            .includes(NominalVariable::Pitch)
        {
            return (optimum.pitch_rad - known.pitch_rad).abs() > SAME_OPTIMUM_RAD;
        }
        (optimum.polar_rad - known.polar_rad).abs() > SAME_DIRECTION_RAD
            || (optimum.speed_m_s / known.speed_m_s - 1.0).abs() > SAME_SPEED
    }

    /// Climbs from every start; returns the highest optimum, if any shot of it is made, with the
    /// number that are.
    fn highest_optimum(
        &self,
        kind: ShotKind,
        starts: &[Nominal],
        sampler: &Sampler<'_>,
        scramble: &Scramble,
    ) -> Option<(u64, Nominal)> {
        let points = self.profile.search().climb_samples;
        let compared = (0, COMPARISON_FACTOR * points);
        self.progress.begin("climbing", starts.len() as u64);
        // The climbs run side by side: each of them takes one small step after the other.
        let optima: Vec<(u64, Nominal)> = starts
            .par_iter()
            .map(|&start| {
                let optimum = self.climb(kind, start, sampler, scramble, points);
                let made = sampler.count(&optimum, scramble, compared).made();
                self.progress.advance(1);
                (made, optimum)
            })
            .collect();
        self.progress.end();
        optima
            .into_iter()
            .reduce(|best, next| if next.0 > best.0 { next } else { best })
            .filter(|(made, _)| *made > 0)
    }

    fn climb(
        &self,
        kind: ShotKind,
        start: Nominal,
        sampler: &Sampler<'_>,
        scramble: &Scramble,
        points: u32,
    ) -> Nominal {
        let made = |nominal: &Nominal| sampler.count(nominal, scramble, (0, points)).made();
        self.pattern_search().run(kind, start, Steps::ALL, made)
    }

    fn pattern_search(&self) -> Climb<'_> {
        Climb {
            profile: self.profile,
            bracket: &self.plan.bracket,
        }
    }

    /// The optimum near one that was found with few points, for errors that a table does not have.
    fn climb_with_more_points(
        &self,
        kind: ShotKind,
        start: Nominal,
        sampler: &Sampler<'_>,
        scramble: &Scramble,
    ) -> Result<Window, PlanError> {
        let points = COMPARISON_FACTOR * self.profile.search().climb_samples;
        let made = |nominal: &Nominal| sampler.count(nominal, scramble, (0, points)).made();
        let search = self.pattern_search();
        let optimum = search.run(kind, start, Steps::SMALL, made);
        let plan = self.plan.window(self.profile, &optimum)?;
        let reach = |variable| {
            let axis = plan.nominal.axis(variable);
            SAMPLED_PARABOLA_REACH * 0.5 * (axis.high - axis.low)
        };
        let nominal = search.top_of_parabolas(kind, optimum, reach, made);
        let plan = self.plan.window(self.profile, &nominal)?;
        let curves = if self.topics.curves {
            probability_curves::from_samples(self.profile, sampler, &plan, &nominal)
        } else {
            Vec::new()
        };
        Ok(Window {
            plan,
            nominal,
            table_probability: None,
            curves,
        })
    }

    /// Computes windows about a nominal shot until the best shot does not lie at the edge.
    fn move_window(&self, kind: ShotKind, start: Nominal) -> Result<Window, PlanError> {
        let mut window = Window {
            plan: self.plan.window(self.profile, &start)?,
            nominal: start,
            table_probability: None,
            curves: Vec::new(),
        };
        for _ in 0..MAX_WINDOWS {
            let table = self.table(&window.plan);
            let maxima = maxima_by_pitch(self.profile, &table);
            let Some(&(p, maximum)) = separated(&maxima[kind.index()]).first() else {
                break;
            };
            window.table_probability = Some(p);
            window.nominal = self.between_points(kind, &table, &maximum);
            window.curves = probability_curves::from_table(&table, &window.nominal);
            let next = self.plan.window(self.profile, &window.nominal)?;
            if !window.plan.nominal.is_at_edge(&maximum, &next.nominal) {
                break;
            }
            window.plan = next;
        }
        Ok(window)
    }

    /// The top of the parabola through a table's best shot and two others, along each axis. If the
    /// parabola has no top between them, or leads to the other kind, the table's best shot itself.
    fn between_points(
        &self,
        kind: ShotKind,
        table: &NominalProbabilities,
        best: &Nominal,
    ) -> Nominal {
        let mut nominal = *best;
        let index = table.index_of(best);
        let counts = table.counts();
        for (axis, variable) in NominalVariable::TABLE_AXES.into_iter().enumerate() {
            let reach = ((PARABOLA_REACH * 0.5 * counts[axis] as f64) as usize).max(1);
            if index[axis] < reach || index[axis] + reach >= counts[axis] {
                continue;
            }
            let at = |i: usize| {
                let mut index = index;
                index[axis] = i;
                table.at(index)
            };
            let [low, middle, high] =
                [index[axis] - reach, index[axis], index[axis] + reach].map(at);
            let curvature = low.0 - 2.0 * middle.0 + high.0;
            if curvature < 0.0 {
                let part = (0.5 * (low.0 - high.0) / curvature).clamp(-1.0, 1.0);
                let half_width = 0.5 * (high.1.get(variable) - low.1.get(variable));
                *nominal.get_mut(variable) += part * half_width;
            }
        }
        if ShotKind::of(self.profile, &nominal) == kind {
            nominal
        } else {
            *best
        }
    }

    /// The limits that a nominal shot lies at.
    fn limits_at(&self, nominal: &Nominal) -> Vec<Limit> {
        let search = self.profile.search();
        let searches = |variable| search.choice.includes(variable);
        let (min_spin, max_spin) = self.profile.backspin_range_rad_s();
        let max_side_spin = self.profile.shooter().max_side_spin_rad_s;
        let pitch = searches(NominalVariable::Pitch);
        let backspin = max_spin > min_spin;
        [
            (
                Limit::PitchMin,
                pitch && nominal.pitch_rad <= search.pitch_min_rad,
            ),
            (
                Limit::PitchMax,
                pitch && nominal.pitch_rad >= search.pitch_max_rad,
            ),
            (
                Limit::NoBackspin,
                backspin && nominal.backspin_rad_s <= min_spin,
            ),
            (
                Limit::MaxBackspin,
                backspin && nominal.backspin_rad_s >= max_spin,
            ),
            (
                Limit::MaxSideSpin,
                searches(NominalVariable::SideSpin)
                    && nominal.side_spin_rad_s.abs() >= max_side_spin,
            ),
            (
                Limit::SpeedMax,
                searches(NominalVariable::Speed)
                    && nominal.speed_m_s >= self.plan.bracket.speed_max_m_s,
            ),
        ]
        .into_iter()
        .filter_map(|(limit, is_reached)| is_reached.then_some(limit))
        .collect()
    }
}
