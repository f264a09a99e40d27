//! The search for the best shots, refined off the grid.
//!
//! For each kind, a coarse table of everything the shooter can intend gives some starts, far apart.
//! From each of them a pattern search climbs on P itself, integrated with few Sobol points that are
//! the same everywhere (common random numbers); where climbs meet, the highest goes on with smaller
//! steps. (The table alone does not tell which start is best: it does not resolve the P of a very
//! accurate shooter.) From the best optima, parabolas along each variable lead to the top, through
//! P of all nominal shots nearby from one weighted sample of shots ([`Neighbourhood`]). About the
//! highest top this is done again with more shots. While the top is far from the middle of the
//! sample, the next sample is about the top. A shot too far from it has P counted from shots of its
//! own: where a variable is searched that has no error, and where a move leads farther than the
//! errors do (one in pitch moves the speed, too, which may hardly err). P of the winner is computed
//! again with independent scrambles, so it is not the largest of many noisy values.

use super::followed::Starts;
use super::found_shots::{BestShot, BestShotError, BestShots, Limit, NoShot, NotCleanShot};
use super::pattern_search::{PatternSearch, Start, step};
use super::table_maxima::Candidate;
use crate::analysis::aim_past_hoop::aim_past_centre_m;
use crate::analysis::probability_curves::{self, ProbabilityCurve};
use crate::analysis::sensitivity::{self, SensitivityTopics};
use crate::math::sobol::{Scramble, ScrambleKey};
use crate::probability::{
    Counts, Estimate, Neighbourhood, NominalProbabilities, NominalTable, Progress, Sampler, Silent,
};
use crate::search_space::{PlanError, TablePlan};
use crate::shooter::{LEAST_WIDE_SPIN_RAD_S, Nominal, NominalVariable, Profile, Search, ShotKind};
use rayon::prelude::*;

/// A climb has this part of the Sobol points of the parabolas through its optimum, and at least so
/// many.
const CLIMB_PART: u32 = 4;
/// See [`CLIMB_PART`].
const CLIMB_LEAST: u32 = 256;
/// Parts of the usual steps that climbs take first, and those of them that go on.
const STEPS: [f64; 2] = [1.0, 0.5];
/// Climbs go on that reach P of the best one but for this.
const CLIMBING_MARGIN: f64 = 0.15;
/// Most optima of each kind that parabolas are taken about.
const MOST_OPTIMA: usize = 3;
/// Parabolas are taken about an optimum that reaches P of the best one but for this: so much may
/// the few points of a climb hide.
const PROMISING_MARGIN: f64 = 0.03;
/// What else may grow to the best optimum nearby: optima that reach P of the best one but for this,
/// at most so many of a kind.
const FOLLOWED_MARGIN: f64 = 0.08;
/// See [`FOLLOWED_MARGIN`].
const MOST_FOLLOWED: usize = 4;
/// P of the other kind, which is said beside the best shot, may have so many times the standard
/// error of the search.
const ERROR_OF_OTHER_KIND: f64 = 3.0;
/// Two optima nearer than this, in pitch, are taken for the same one.
const SAME_OPTIMUM_RAD: f64 = 0.05;
/// Optima this near are one where the pitch angle is fixed: in direction, and relative in speed.
const SAME_DIRECTION_RAD: f64 = 0.02;
const SAME_SPEED: f64 = 0.02;
/// Optima this near in side spin are one, rad/s.
const SAME_SIDE_SPIN_RAD_S: f64 = 6.0;
/// A loss of P that is none by chance.
const LEAST_LOSS: f64 = 0.01;
/// Tops are compared with this many times the Sobol points of the parabolas.
const COMPARISON_FACTOR: u32 = 8;
/// Samples of a neighbourhood have this many times the Sobol points of the parabolas: about each
/// promising optimum, and about the highest top.
const NEIGHBOURHOOD_FACTOR: u32 = 4;
const LAST_FACTOR: u32 = 16;
/// Their errors are so many times the shooter's.
const WIDENING: f64 = 1.4;
/// Greatest number of neighbourhoods in a row.
const MOST_NEIGHBOURHOODS: u32 = 4;
/// Reaches of the parabolas of one round after the other in standard deviations; and in half widths
/// of a window, where P is counted.
const PARABOLA_REACHES: [f64; 2] = [1.0, 0.5];
const COUNTED_PARABOLA_REACH: f64 = 0.7;
/// A sample tells P of shots within so many standard deviations of its middle.
const NEIGHBOURHOOD: f64 = 1.5;

/// Finds the best direct and the best bank shot of a profile, on the current rayon pool.
///
/// # Errors
/// The table would be too large, or no release reaches the hoop.
pub fn find(profile: &Profile, progress: &dyn Progress) -> Result<BestShots, BestShotError> {
    find_both(profile, progress, None)
}

/// What a search knows of the best shot of a kind before it refines it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DraftShot {
    /// Its kind.
    pub kind: ShotKind,
    /// The best shot so far.
    #[serde(flatten)]
    pub nominal: Nominal,
    /// P by the points of the search: to 0.01 or so.
    pub probability: f64,
}

/// What takes drafts.
type Draft<'a> = Option<&'a dyn Fn(&[DraftShot])>;

/// As [`find`]. `draft` gets the best shot of each kind early: of the coarse table after a fifth of
/// the time, and then what climbs alone find.
///
/// # Errors
/// As [`find`].
pub fn find_with_draft(
    profile: &Profile,
    progress: &dyn Progress,
    draft: &dyn Fn(&[DraftShot]),
) -> Result<BestShots, BestShotError> {
    find_both(profile, progress, Some(draft))
}

fn find_both(
    profile: &Profile,
    progress: &dyn Progress,
    draft: Draft<'_>,
) -> Result<BestShots, BestShotError> {
    let topics = SensitivityTopics::ALL;
    let Found {
        plan, mut shots, ..
    } = find_from(
        (profile, Starts::Table),
        &ShotKind::ALL,
        topics,
        progress,
        draft,
    )?;
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
    let found = find_from((profile, Starts::Table), kinds, topics, progress, None)?;
    Ok((found.plan, found.shots))
}

/// What a search finds.
pub(super) struct Found {
    plan: TablePlan,
    /// The best shots of the kinds.
    pub(super) shots: Vec<Result<BestShot, NoShot>>,
    /// The local optima of the kinds that [`Starts::Optima`] takes.
    pub(super) optima: Vec<Nominal>,
}

/// As [`find_kinds`], with climbs from `starts`.
///
/// # Errors
/// As [`find`].
pub(super) fn find_from(
    (profile, starts): (&Profile, Starts),
    kinds: &[ShotKind],
    topics: SensitivityTopics,
    progress: &dyn Progress,
    draft: Draft<'_>,
) -> Result<Found, BestShotError> {
    let plan = TablePlan::for_search(profile)?;
    let search = BestShotSearch::new(profile, &plan, topics, progress);
    let LocalOptima { highest, followed } = search.optima(&search.starts(kinds, starts)?, draft);
    let shots = kinds
        .par_iter()
        .map(|&kind| search.best(kind, highest[kind.index()]))
        .collect::<Result<_, _>>()?;
    Ok(Found {
        plan,
        shots,
        optima: followed,
    })
}

/// The best shot of a kind without its sensitivity, P of the optimum of the other kind that
/// climbs alone find (`None` where no shot of that kind is made), and the local optima of both.
pub(super) struct FoundBesideOtherKind {
    pub(super) shot: Result<BestShot, NoShot>,
    pub(super) other_kind: Option<Estimate>,
    pub(super) optima: Vec<Nominal>,
}

/// See [`FoundBesideOtherKind`].
///
/// # Errors
/// As [`find`].
pub(super) fn find_beside_other_kind(
    (profile, starts): (&Profile, Starts),
    kind: ShotKind,
    progress: &dyn Progress,
) -> Result<FoundBesideOtherKind, BestShotError> {
    let plan = TablePlan::for_search(profile)?;
    let search = BestShotSearch::new(profile, &plan, SensitivityTopics::NONE, progress);
    let LocalOptima { highest, followed } =
        search.optima(&search.starts(&ShotKind::ALL, starts)?, None);
    let settings = profile.search();
    let error = ERROR_OF_OTHER_KIND * settings.standard_error;
    let roughly = |nominal| (search.sampler).estimate(&nominal, error, settings.seed, &Silent);
    Ok(FoundBesideOtherKind {
        shot: search.best(kind, highest[kind.index()])?,
        other_kind: highest[kind.other().index()].map(roughly),
        optima: followed,
    })
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
    let search = BestShotSearch::new(profile, &plan, SensitivityTopics::NONE, &Silent);
    let mut starts = search.starts_among(shots);
    starts.retain(|start| start.kind == kind);
    let optimum = search.optima(&starts, None).highest[kind.index()];
    Ok(optimum.map(|nominal| (nominal, search.estimate(&nominal, &Silent))))
}

/// The refined optimum of a kind.
struct Top {
    nominal: Nominal,
    /// P by the sample that it was found with, if there was one.
    probability: Option<f64>,
}

/// The optimum of a climb, after its number of made shots.
type Optimum = (u64, Nominal);

/// What climbs and parabolas find.
struct LocalOptima {
    /// The highest optimum of each kind; `None` where no shot of it is made.
    highest: [Option<Nominal>; 2],
    /// Optima of all kinds that may be the highest ones nearby.
    followed: Vec<Nominal>,
}

pub(super) struct BestShotSearch<'a> {
    pub(super) profile: &'a Profile,
    pub(super) plan: &'a TablePlan,
    topics: SensitivityTopics,
    progress: &'a dyn Progress,
    sampler: Sampler<'a>,
    /// Of a replicate of its own, so that final estimates are independent of the search.
    scramble: Scramble,
}

impl<'a> BestShotSearch<'a> {
    fn new(
        profile: &'a Profile,
        plan: &'a TablePlan,
        topics: SensitivityTopics,
        progress: &'a dyn Progress,
    ) -> Self {
        let sampler = Sampler::new(profile);
        let scramble = sampler.scramble(ScrambleKey {
            seed: profile.search().seed,
            replicate: u64::MAX,
        });
        Self {
            profile,
            plan,
            topics,
            progress,
            sampler,
            scramble,
        }
    }

    pub(super) fn table(&self, plan: &TablePlan) -> NominalProbabilities {
        NominalTable::simulate(self.profile, plan, self.progress).probabilities(self.profile)
    }

    fn is_made(&self, nominal: &Nominal) -> bool {
        let start = self.profile.release(nominal).state();
        self.profile.simulator().verdict(start).made
    }

    /// The most probable nominal shot near a top that is made without errors, and its P.
    fn best_clean(&self, kind: ShotKind, top: &Nominal) -> Result<Option<Candidate>, PlanError> {
        let table = self.table(&self.plan.window(self.profile, top)?);
        let mut shots: Vec<Candidate> = table.shots().filter(|(p, _)| *p > 0.0).collect();
        shots.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(shots.into_iter().find(|(_, nominal)| {
            ShotKind::of(self.profile, nominal) == kind && self.is_made(nominal)
        }))
    }

    /// P of a nominal shot with independent scrambles.
    fn estimate(&self, nominal: &Nominal, progress: &dyn Progress) -> Estimate {
        let search = self.profile.search();
        let target = search.standard_error;
        self.sampler
            .estimate(nominal, target, search.seed, progress)
    }

    /// The best shot of a kind about the optimum that the search found, if it found one.
    fn best(
        &self,
        kind: ShotKind,
        optimum: Option<Nominal>,
    ) -> Result<Result<BestShot, NoShot>, PlanError> {
        let Some(optimum) = optimum else {
            return Ok(Err(NoShot::Impossible(kind)));
        };
        let mut top = self.last_top(kind, optimum)?;
        let mut probable = None;
        if !self.is_made(&top.nominal) {
            // The most probable shot goes in only with errors: take the best one that needs none.
            if let Some((p, clean)) = self.best_clean(kind, &top.nominal)? {
                probable = Some(top.nominal);
                top = Top {
                    nominal: clean,
                    probability: Some(p),
                };
            }
        }
        let (nominal, estimate) = self.straight_if_as_good(kind, &top.nominal);
        let outcome = self
            .profile
            .simulator()
            .outcome(self.profile.release(&nominal).state());
        if !outcome.verdict.made {
            return Ok(Err(NoShot::NotClean(NotCleanShot {
                kind,
                nominal,
                probability: estimate.probability,
            })));
        }
        let more_probable = probable
            .map(|nominal| NotCleanShot {
                kind,
                nominal,
                probability: self.estimate(&nominal, self.progress).probability,
            })
            .filter(|other| other.probability > estimate.probability + LEAST_LOSS);
        Ok(Ok(BestShot {
            nominal,
            estimate,
            search_probability: top.probability,
            outcome,
            curves: self.curves(&nominal)?,
            sensitivity: sensitivity::analyse(self.profile, &nominal, self.topics, self.progress),
            aim_past_centre_m: aim_past_centre_m(self.profile, &nominal),
            mass_outside: self.plan.mass_outside(self.profile, &nominal),
            at_limits: self.limits_at(&nominal),
            more_probable,
        }))
    }

    /// The shot with its P; aimed straight at the hoop's centre if left and right are mirror images
    /// and P is the same but for its error, by points that the search has not seen.
    fn straight_if_as_good(&self, kind: ShotKind, nominal: &Nominal) -> (Nominal, Estimate) {
        let straight = Nominal {
            polar_rad: self.profile.location().angle_rad,
            ..*nominal
        };
        let is_other = self.plan.mirrored && straight.polar_rad != nominal.polar_rad;
        let is_as_good = || {
            let Search {
                seed,
                standard_error,
                ..
            } = *self.profile.search();
            let replicate = u64::MAX - 1;
            let fresh = self.sampler.scramble(ScrambleKey { seed, replicate });
            let points = NEIGHBOURHOOD_FACTOR * self.points();
            let [straight, found] = [straight, *nominal]
                .map(|shot| made_with((&self.sampler, &fresh), &[shot], points)[0] as f64);
            found - straight <= standard_error * f64::from(points)
        };
        let goes_straight = is_other
            && ShotKind::of(self.profile, &straight) == kind
            && self.is_made(&straight)
            && is_as_good();
        let nominal = if goes_straight { straight } else { *nominal };
        (nominal, self.estimate(&nominal, self.progress))
    }

    /// The optima that are reached from some starts.
    fn optima(&self, starts: &[Start], draft: Draft<'_>) -> LocalOptima {
        let points = self.points();
        let few = (points / CLIMB_PART).max(CLIMB_LEAST);
        if let Some(draft) = draft {
            let nominals: Vec<Nominal> = starts.iter().map(|start| start.nominal).collect();
            // The count of shots in an answer does not depend on a draft.
            let apart = self.profile.counting_apart();
            let made = made_with((&Sampler::new(&apart), &self.scramble), &nominals, points);
            draft(&self.drafts(&by_kind(starts, &nominals, &made)));
        }
        self.progress.begin("climbing", starts.len() as u64);
        let optima = self.climb(starts, few);
        self.progress.end();
        let nominals: Vec<Nominal> = optima.iter().map(|optimum| optimum.nominal).collect();
        let optima = by_kind(&optima, &nominals, &self.made(&nominals, points));
        if let Some(draft) = draft {
            draft(&self.drafts(&optima));
        }
        let mut promising: Vec<Start> = Vec::new();
        let mut climbed: Vec<Nominal> = Vec::new();
        for (kind, optima) in ShotKind::ALL.into_iter().zip(&optima) {
            let margin = |margin| margin * f64::from(points);
            let near = self.apart(optima, margin(PROMISING_MARGIN), MOST_OPTIMA);
            promising.extend(near.into_iter().map(|nominal| Start { kind, nominal }));
            climbed.extend(self.apart(optima, margin(FOLLOWED_MARGIN), MOST_FOLLOWED));
        }
        let highest = self.highest_tops(&promising);
        let tops = highest.iter().flatten().copied();
        LocalOptima {
            followed: tops.chain(climbed).collect(),
            highest,
        }
    }

    fn drafts(&self, optima: &[Vec<Optimum>; 2]) -> Vec<DraftShot> {
        let best = |(kind, optima): (ShotKind, &Vec<Optimum>)| {
            optima.first().map(|&(made, nominal)| DraftShot {
                kind,
                nominal,
                probability: made as f64 / f64::from(self.points()),
            })
        };
        ShotKind::ALL
            .into_iter()
            .zip(optima)
            .filter_map(best)
            .collect()
    }

    /// At most so many of some optima, the best first, that are made as often as the first but for
    /// a margin and are far from each other.
    fn apart(&self, optima: &[Optimum], margin: f64, most: usize) -> Vec<Nominal> {
        let least = |best: &Optimum| best.0 as f64 - margin;
        let least = optima.first().map_or(0.0, least);
        let mut chosen: Vec<Nominal> = Vec::new();
        for (_, optimum) in optima.iter().filter(|(made, _)| *made as f64 >= least) {
            if chosen.len() < most && chosen.iter().all(|c| self.are_apart(optimum, c)) {
                chosen.push(*optimum);
            }
        }
        chosen
    }

    /// Whether two optima are not the same one: apart in side spin, or in pitch; where the pitch
    /// angle is fixed, in direction or speed.
    pub(super) fn are_apart(&self, a: &Nominal, b: &Nominal) -> bool {
        let choice = self.profile.search().choice;
        let relative_speed = a.speed_m_s / b.speed_m_s - 1.0;
        let apart = if choice.includes(NominalVariable::Pitch) {
            (a.pitch_rad - b.pitch_rad).abs() > SAME_OPTIMUM_RAD
        } else {
            (a.polar_rad - b.polar_rad).abs() > SAME_DIRECTION_RAD
                || relative_speed.abs() > SAME_SPEED
        };
        apart || (a.side_spin_rad_s - b.side_spin_rad_s).abs() > SAME_SIDE_SPIN_RAD_S
    }

    /// The highest top of each kind of the parabolas about some optima; `None` where no shot of it
    /// is made. A single optimum of a kind is taken as it is: parabolas are taken about the highest
    /// one later, too.
    fn highest_tops(&self, optima: &[Start]) -> [Option<Nominal>; 2] {
        let of_kind = |kind: ShotKind| optima.iter().filter(move |start| start.kind == kind);
        let (alone, starts): (Vec<Start>, Vec<Start>) =
            (optima.iter()).partition(|start| of_kind(start.kind).count() == 1);
        let points = self.points();
        self.progress.begin("refining", starts.len() as u64);
        let nominals: Vec<Nominal> = starts
            .par_iter()
            .map(|start| {
                let top = self.top_near(start, NEIGHBOURHOOD_FACTOR * points);
                self.progress.advance(1);
                self.unless_worse(top, start.nominal, points).nominal
            })
            .collect();
        self.progress.end();
        let made = self.made(&nominals, self.compared_points());
        ShotKind::ALL.map(|kind| {
            if let Some(only) = alone.iter().find(|start| start.kind == kind) {
                let some = [points, self.compared_points()];
                let is_made = |points| self.made(&[only.nominal], points)[0] > 0;
                return some.into_iter().any(is_made).then_some(only.nominal);
            }
            let highest = (starts.iter().zip(made.iter().zip(&nominals)))
                .filter(|(start, (made, _))| start.kind == kind && **made > 0)
                .map(|(_, optimum)| optimum)
                .reduce(|best, next| if next.0 > best.0 { next } else { best });
            highest.map(|(_, &nominal)| nominal)
        })
    }

    /// The top of parabolas; but the shot that they were taken about, where that is better by more
    /// than the points err: P of a very accurate shooter is no parabola.
    fn unless_worse(&self, top: Top, optimum: Nominal, points: u32) -> Top {
        let made = self.made(&[top.nominal, optimum], points);
        let lost = made[1] as f64 - made[0] as f64;
        if lost > LEAST_LOSS * f64::from(points) {
            Top {
                nominal: optimum,
                probability: None,
            }
        } else {
            top
        }
    }

    /// The number of points of the parabolas.
    fn points(&self) -> u32 {
        self.profile.search().climb_samples.max(CLIMB_LEAST)
    }

    /// The number of points with which tops are compared.
    fn compared_points(&self) -> u32 {
        COMPARISON_FACTOR * self.points()
    }

    /// The optima that climbs with so many points reach.
    fn climb(&self, starts: &[Start], points: u32) -> Vec<Start> {
        let values = |nominals: &[Nominal]| self.made(nominals, points);
        let search = self.pattern_search();
        let [first, then] = STEPS;
        let (nominals, made) = search.climb(starts, first, values, self.progress);
        let margin = CLIMBING_MARGIN * f64::from(points);
        let mut going_on: Vec<Start> = Vec::new();
        for (kind, optima) in ShotKind::ALL
            .into_iter()
            .zip(by_kind(starts, &nominals, &made))
        {
            let apart = self.apart(&optima, margin, usize::MAX).into_iter();
            going_on.extend(apart.map(|nominal| Start { kind, nominal }));
        }
        let (nominals, _) = search.climb(&going_on, then, values, &Silent);
        let each = going_on.iter().zip(nominals);
        each.map(|(start, nominal)| Start { nominal, ..*start })
            .collect()
    }

    /// Whether every variable that is searched has an error: then the shots of a sample also tell P
    /// of nominal shots beside its own.
    fn has_all_errors(&self, nominal: &Nominal) -> bool {
        let mut variables = self.profile.search().choice.iter();
        variables.all(|variable| self.sigma(variable, nominal) > 0.0)
    }

    fn sigma(&self, variable: NominalVariable, nominal: &Nominal) -> f64 {
        let dispersion = &self.profile.shooter().dispersion;
        dispersion.sigma(variable.as_release_variable(), nominal)
    }

    /// How far apart shots are that a sample compares, as its standard deviation.
    fn spread(&self, variable: NominalVariable, nominal: &Nominal) -> f64 {
        let sigma = self.sigma(variable, nominal);
        match variable {
            NominalVariable::Backspin | NominalVariable::SideSpin => {
                sigma.max(LEAST_WIDE_SPIN_RAD_S)
            }
            _ => sigma,
        }
    }

    /// The top near a shot, by samples of so many points.
    fn top_near(&self, start: &Start, points: u32) -> Top {
        let search = self.pattern_search();
        let counted = |nominals: &[Nominal]| {
            let made = self.made(nominals, points / NEIGHBOURHOOD_FACTOR);
            made.into_iter().map(|made| made as f64).collect()
        };
        if !self.has_all_errors(&start.nominal) {
            let once = search.top_of_parabolas(start, step, counted);
            return Top {
                nominal: search.top_of_parabolas(&once, step, counted).nominal,
                probability: None,
            };
        }
        let mut top = *start;
        let mut probability = None;
        for _ in 0..MOST_NEIGHBOURHOODS {
            let centre = top.nominal;
            let spread = |variable| self.spread(variable, &centre);
            let sample = (&self.scramble, points);
            let near = Neighbourhood::simulate(self.profile, &centre, sample, WIDENING);
            let values = |nominals: &[Nominal]| {
                let each = nominals.iter();
                let weighed: Option<Vec<f64>> = each
                    .map(|nominal| Some(near.probability(nominal)?.probability))
                    .collect();
                weighed.unwrap_or_else(|| counted(nominals))
            };
            for part in PARABOLA_REACHES {
                let reach = |variable| part * spread(variable);
                top = search.top_of_parabolas(&top, reach, values);
                top = search.best_beside_other_kind(&top, reach, values);
            }
            probability = near.probability(&top.nominal).map(|p| p.probability);
            let is_near = |variable: NominalVariable| {
                let moved = top.nominal.get(variable) - centre.get(variable);
                moved.abs() < NEIGHBOURHOOD * spread(variable)
            };
            if self.profile.search().choice.iter().all(is_near) {
                break;
            }
        }
        Top {
            nominal: top.nominal,
            probability,
        }
    }

    /// The numbers of made shots under the first points of the search's scramble.
    fn made(&self, nominals: &[Nominal], points: u32) -> Vec<u64> {
        made_with((&self.sampler, &self.scramble), nominals, points)
    }

    pub(super) fn pattern_search(&self) -> PatternSearch<'_> {
        PatternSearch::new(self.profile, &self.plan.bracket)
    }

    /// The top near the optimum that was found with fewer points.
    fn last_top(&self, kind: ShotKind, optimum: Nominal) -> Result<Top, PlanError> {
        let start = Start {
            kind,
            nominal: optimum,
        };
        if self.has_all_errors(&optimum) {
            let top = self.top_near(&start, LAST_FACTOR * self.points());
            return Ok(self.unless_worse(top, optimum, self.points()));
        }
        let points = self.compared_points();
        let plan = self.plan.window(self.profile, &optimum)?;
        let reach = |variable| {
            let axis = plan.nominal.axis(variable);
            COUNTED_PARABOLA_REACH * 0.5 * (axis.high - axis.low)
        };
        let counted = |nominals: &[Nominal]| {
            let made = self.made(nominals, points);
            made.into_iter().map(|made| made as f64).collect()
        };
        let search = self.pattern_search();
        let near = search.top_of_parabolas(&start, step, counted);
        let top = Top {
            nominal: search.top_of_parabolas(&near, reach, counted).nominal,
            probability: None,
        };
        Ok(self.unless_worse(top, optimum, points))
    }

    /// P along each variable of a shot, if that is asked for.
    fn curves(&self, nominal: &Nominal) -> Result<Vec<ProbabilityCurve>, PlanError> {
        if !self.topics.curves {
            return Ok(Vec::new());
        }
        let plan = self.plan.window(self.profile, nominal)?;
        Ok(probability_curves::about(
            self.profile,
            (&self.sampler, &self.scramble),
            &plan,
            nominal,
        ))
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

/// The numbers of made shots under the first points of a scramble.
fn made_with(
    (sampler, scramble): (&Sampler<'_>, &Scramble),
    nominals: &[Nominal],
    points: u32,
) -> Vec<u64> {
    let shots: Vec<_> = nominals.iter().map(|n| (n, scramble)).collect();
    let counts = sampler.counts(&shots, (0, points), &Silent);
    counts.iter().map(Counts::made).collect()
}

/// The shots that some starts led to, with their numbers of made ones, by kind, the best first.
fn by_kind(starts: &[Start], nominals: &[Nominal], made: &[u64]) -> [Vec<Optimum>; 2] {
    ShotKind::ALL.map(|kind| {
        let mut optima: Vec<Optimum> = (starts.iter().zip(made.iter().zip(nominals)))
            .filter_map(|(start, (&m, &n))| (start.kind == kind).then_some((m, n)))
            .collect();
        // (Sorting is stable: of two that are level the first start's.)
        optima.sort_by_key(|(made, _)| std::cmp::Reverse(*made));
        optima
    })
}
