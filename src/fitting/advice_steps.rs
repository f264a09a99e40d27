//! From the usual release to a better one, step by step.
//!
//! Speed and release angle belong together: a steeper shot with the speed of a flatter one is
//! short. So the first step is the best speed at the shooter's own angle, the second a better angle
//! with the speed that suits it. Then come the aim and, where it was measured, the backspin.
//!
//! P hardly depends on the angle near the best one. So the second step goes no farther than it has
//! to: to the angle nearest to the shooter's own at which P is within [`TOLERANCE`] of the
//! greatest.

use super::draw_probabilities::{DrawProbabilities, WeightedShots};
use super::interval::Interval;
use super::measured_release::{VALUE_NAMES, Values};
use super::posterior::Draw;
use crate::math::normal_distribution::quantile;
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, FOOT_M};
use serde::Serialize;

/// Shots of a sample that two steps are compared with, and of one that a speed is chosen with.
const STEP_SHOTS: usize = 32_768;
const SPEED_SHOTS: usize = 32_768;
/// Speeds that are tried are this many standard deviations to each side, in steps of a quarter.
const SPEED_REACH: i32 = 3;
const SPEEDS_PER_SIGMA: i32 = 4;
/// Angles that are tried between the usual and the best one.
const ANGLES: usize = 8;
/// How much P may be below the greatest for an angle nearer to the usual one.
const TOLERANCE: f64 = 0.005;
/// Nobody can throw harder or softer, or aim to a side, by less than this on purpose: m/s, rad.
pub const SAME_SPEED_M_S: f64 = 0.05 * FOOT_M;
const SAME_AIM_RAD: f64 = 0.05 * DEGREE_RAD;
/// Nobody can change the release angle by less than this on purpose, rad.
const SAME_PITCH_RAD: f64 = 0.1 * DEGREE_RAD;
/// A change is supported from this share of the draws on: in so many it gains, and goes to one
/// side.
const SUPPORTED: f64 = 0.975;
/// So many standard errors of the computation to both sides of a limit are at the limit: another
/// seed could decide otherwise.
const GUARD: f64 = 2.5;
/// A search with another seed finds a release whose P differs by about this.
const SEARCH_ERROR: f64 = 0.0003;
/// By how much such a release differs from the one of another seed: speed (m/s), pitch, direction
/// (rad), backspin (rad/s).
const SEARCH_ERRORS: Values = [0.003, 0.0015, 0.0002, 0.1];
/// The least gain in P that is worth a change.
const WORTH_A_CHANGE: f64 = 0.005;

/// A part of the release that a shooter can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cause(pub usize);

impl Cause {
    /// The speed, at the shooter's own angle.
    pub const SPEED: Self = Self(0);
    /// The release angle, with the speed that suits it.
    pub const PITCH: Self = Self(1);
    /// The direction.
    pub const AIM: Self = Self(2);
    /// The backspin.
    pub const BACKSPIN: Self = Self(3);

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["speed", "pitch", "aim", "backspin"][self.0]
    }
}

/// One step from the current release to the best one.
#[derive(Clone, Debug)]
pub struct AdviceStep {
    /// What is changed.
    pub cause: Cause,
    /// The release after this step and those before it.
    pub release: Values,
    /// What it adds to P, on top of the supported steps before it.
    pub gain: Interval,
    /// The share of the draws in which the change goes to the same side: a shooter whose usual aim
    /// is hardly known cannot be told to which side to change it.
    pub same_side: f64,
    /// Whether the shots support it.
    pub support: Support,
}

/// Whether shots support a change: it gains at least half a make in 100, its interval lies above 0,
/// and the side of the change is as clear.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Support {
    /// They do not.
    NotSupported,
    /// Within the errors of the computation: another seed could decide otherwise.
    AtTheLimit,
    /// They do.
    Supported,
}

impl Support {
    /// Of a value that must lie above a limit; `error` is its standard error.
    fn of(value: f64, limit: f64, error: f64) -> Self {
        if value >= limit + GUARD * error {
            Self::Supported
        } else if value <= limit - GUARD * error {
            Self::NotSupported
        } else {
            Self::AtTheLimit
        }
    }
}

impl AdviceStep {
    /// Whether the shots support the step.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        self.support == Support::Supported
    }

    /// How many shots in place of `shots` would make the step sure, if it gains what it seems to;
    /// `None` if it is sure or gains too little.
    #[must_use]
    pub fn sure_after(&self, shots: usize) -> Option<f64> {
        let Interval { mean, low, .. } = self.gain;
        let is_open = !self.is_sure() && mean > WORTH_A_CHANGE;
        // The interval narrows with the root of the number of shots.
        let narrower = (mean - low) / mean;
        let of_side = quantile(SUPPORTED) / quantile(self.same_side.clamp(0.51, 0.999)).max(0.025);
        is_open.then(|| {
            let factor = narrower.max(of_side).max(1.0);
            shots as f64 * factor * factor
        })
    }
}

/// What a shooter should change.
#[derive(Clone, Debug)]
pub struct AdviceSteps {
    /// The steps in order.
    pub steps: Vec<AdviceStep>,
    /// The release after the sure steps alone: the usual one if no step is sure.
    pub advised: Values,
    /// Which values of it differ from the usual ones.
    pub is_changed: [bool; VALUE_NAMES.len()],
    /// P of the advised release less that of the usual one.
    pub gain: Interval,
    /// What the advised speed alone and the advised angle alone gain, if both change.
    pub alone: Option<AloneGains>,
}

/// What the advised speed and the advised angle gain, each without the other.
#[derive(Clone, Copy, Debug)]
pub struct AloneGains {
    /// The gain in P of the speed.
    pub speed: Interval,
    /// The gain in P of the angle.
    pub pitch: Interval,
    /// The share of the draws in which the speed alone gains more.
    pub speed_is_better: f64,
}

/// What a release changes of the usual one of each draw: a value where there is one.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct Change([Option<f64>; VALUE_NAMES.len()]);

impl Change {
    /// Every value but those that are kept.
    pub(super) fn to(target: &Values, is_kept: impl Fn(usize) -> bool) -> Self {
        Self(std::array::from_fn(|i| (!is_kept(i)).then_some(target[i])))
    }

    fn with(mut self, i: usize, value: f64) -> Self {
        self.0[i] = Some(value);
        self
    }

    /// This change with a step of another one: the angle comes with its speed.
    fn and(mut self, cause: Cause, other: &Self) -> Self {
        if cause == Cause::PITCH {
            self.0[0] = other.0[0];
        }
        self.0[cause.0] = other.0[cause.0];
        self
    }

    /// The release of a draw with this change. A shooter changes what the tracker reads: where its
    /// constant error is greater than that of the typical draw, the release is less by that.
    pub(super) fn of_draw(&self, draw: &Draw, typical: &Draw, place: usize) -> Values {
        std::array::from_fn(|i| match self.0[i] {
            Some(value) => {
                value + typical.constant_errors[place][i] - draw.constant_errors[place][i]
            }
            None => draw.means[place][i],
        })
    }
}

/// A shooter at a place, with the shots that were simulated there.
pub(super) struct Shooting<'a> {
    profile: &'a Profile,
    draws: &'a [Draw],
    typical: &'a Draw,
    place: usize,
    /// A sample for each change that was asked for: most are asked for more than once.
    samples: Vec<ChangedShots>,
}

/// Shots about a changed release, and P for each draw.
pub(super) struct ChangedShots {
    change: Change,
    pub(super) shots: WeightedShots,
    pub(super) probabilities: DrawProbabilities,
}

impl<'a> Shooting<'a> {
    pub(super) fn new(
        profile: &'a Profile,
        draws: &'a [Draw],
        typical: &'a Draw,
        place: usize,
    ) -> Self {
        Self {
            profile,
            draws,
            typical,
            place,
            samples: Vec::new(),
        }
    }

    /// Shots with a change.
    pub(super) fn with(&mut self, change: Change) -> &ChangedShots {
        let known = self.samples.iter().position(|known| known.change == change);
        let index = known.unwrap_or_else(|| {
            self.samples.push(self.simulate(change));
            self.samples.len() - 1
        });
        &self.samples[index]
    }

    fn simulate(&self, change: Change) -> ChangedShots {
        let place = self.place;
        let mean = |draw: &Draw| change.of_draw(draw, self.typical, place);
        let means: Vec<Values> = self.draws.iter().map(mean).collect();
        let shots = WeightedShots::simulate(
            self.profile,
            (self.draws, place),
            &means,
            STEP_SHOTS,
            self.profile.search().seed,
        );
        let factor = |draw: &Draw| draw.factors[place];
        ChangedShots {
            change,
            probabilities: shots.probabilities(self.draws, mean, factor),
            shots,
        }
    }

    /// P for each draw with a change less that of another.
    fn gain(&mut self, change: Change, before: Change) -> Interval {
        self.difference(change, before).interval()
    }

    fn difference(&mut self, change: Change, before: Change) -> DrawProbabilities {
        let p = self.with(change).probabilities.clone();
        p.minus(&self.with(before).probabilities)
    }

    /// The best speed of a release for the typical scatter, near the speed of the release, and its
    /// P.
    fn best_speed(&self, release: Values) -> (f64, f64) {
        let sigma = self.typical.sds_at(self.place)[0];
        let count = SPEED_REACH * SPEEDS_PER_SIGMA;
        let step = sigma / f64::from(SPEEDS_PER_SIGMA);
        let at = |i: i32| {
            let mut values = release;
            values[0] += f64::from(i) * step;
            values
        };
        let means: Vec<Values> = (-count..=count).map(at).collect();
        let typical = std::slice::from_ref(self.typical);
        let seed = self.profile.search().seed;
        let sample = WeightedShots::simulate(
            self.profile,
            (typical, self.place),
            &means,
            SPEED_SHOTS,
            seed,
        );
        let p: Vec<f64> = means
            .iter()
            .map(|mean| {
                let of_draw =
                    sample.probabilities(typical, |_| *mean, |draw| draw.factors[self.place]);
                of_draw.of_draws[0]
            })
            .collect();
        let top = (0..p.len()).fold(0, |best, i| if p[i] > p[best] { i } else { best });
        if top == 0 || top + 1 == p.len() {
            return (means[top][0], p[top]);
        }
        // The top of the parabola through the highest value and its neighbours.
        let curvature = p[top - 1] - 2.0 * p[top] + p[top + 1];
        let slope = 0.5 * (p[top + 1] - p[top - 1]);
        let part = if curvature < 0.0 {
            (-slope / curvature).clamp(-1.0, 1.0)
        } else {
            0.0
        };
        let gain = part * (slope + 0.5 * part * curvature);
        (means[top][0] + part * step, p[top] + gain)
    }

    /// The best speed at the usual angle; and the speed and the angle of the second step.
    fn speed_and_angle(&self, usual: &Values, best: &Values) -> (f64, (f64, f64)) {
        let on_the_way: Vec<(f64, f64, f64)> = (0..=ANGLES)
            .map(|k| {
                let part = k as f64 / ANGLES as f64;
                let mut release = *usual;
                for i in 0..2 {
                    release[i] = usual[i] + part * (best[i] - usual[i]);
                }
                let (speed, p) = self.best_speed(release);
                (speed, release[1], p)
            })
            .collect();
        let own_speed = on_the_way[0].0;
        let most = on_the_way.iter().map(|(.., p)| *p).fold(0.0, f64::max);
        let enough = most - TOLERANCE;
        let first = on_the_way.iter().position(|(.., p)| *p >= enough);
        let second = match first {
            None => (best[0], best[1]),
            Some(0) => (own_speed, usual[1]),
            Some(k) => {
                // Between two angles that were tried, so that shooters who hardly differ are told
                // to do the same.
                let (before, after) = (on_the_way[k - 1], on_the_way[k]);
                let part = (enough - before.2) / (after.2 - before.2);
                let between = |from: f64, to: f64| from + part * (to - from);
                (between(before.0, after.0), between(before.1, after.1))
            }
        };
        (own_speed, second)
    }

    /// The steps from the current release to the best one of the same kind, and what they change.
    pub(super) fn steps(
        &mut self,
        usual: &Values,
        best: &Values,
        measured_values: usize,
    ) -> (AdviceSteps, Change) {
        let none = Change::default();
        let (own_speed, (speed, angle)) = self.speed_and_angle(usual, best);
        let (mut change, mut order) = (none, Vec::new());
        if (own_speed - usual[0]).abs() >= SAME_SPEED_M_S {
            change = none.with(0, own_speed);
            order.push((Cause::SPEED, change));
        }
        if (angle - usual[1]).abs() >= SAME_PITCH_RAD {
            change = change.with(0, speed).with(1, angle);
            order.push((Cause::PITCH, change));
        }
        if measured_values > 2 && (best[2] - usual[2]).abs() >= SAME_AIM_RAD {
            change = change.with(2, best[2]);
            order.push((Cause::AIM, change));
        }
        if measured_values > 3 {
            order.push((Cause::BACKSPIN, change.with(3, best[3])));
        }
        let mut advised = none;
        let mut steps: Vec<AdviceStep> = Vec::new();
        for (cause, change) in order {
            // On top of what is supported so far: what is dropped must not carry a later step.
            let with = advised.and(cause, &change);
            let difference = self.difference(with, advised);
            let release = with.of_draw(self.typical, self.typical, self.place);
            let (from, to) = (usual[cause.0], release[cause.0]);
            steps.push(AdviceStep {
                cause,
                release,
                gain: difference.interval(),
                same_side: self.same_side(from, to, cause),
                support: self
                    .support(&difference)
                    .min(self.support_of_side(from, to, cause)),
            });
            if steps.last().is_some_and(AdviceStep::is_sure) {
                advised = with;
            }
        }
        // Together they must gain too.
        while advised != none && self.gain(advised, none).low <= 0.0 {
            if let Some(last) = steps.iter_mut().rfind(|step| step.is_sure()) {
                last.support = Support::AtTheLimit;
            }
            let kept = steps.iter().filter(|step| step.is_sure());
            advised = kept.fold(none, |change, step| {
                change.and(step.cause, &Change(step.release.map(Some)))
            });
        }
        let speed_and_pitch = advised.0[0].zip(advised.0[1]);
        let steps = AdviceSteps {
            advised: advised.of_draw(self.typical, self.typical, self.place),
            is_changed: advised.0.map(|value| value.is_some()),
            gain: self.gain(advised, none),
            alone: speed_and_pitch.map(|(speed, pitch)| {
                let [speed, pitch] = [none.with(0, speed), none.with(1, pitch)];
                let less = self.difference(speed, pitch);
                AloneGains {
                    speed: self.gain(speed, none),
                    pitch: self.gain(pitch, none),
                    speed_is_better: less.share_positive(),
                }
            }),
            steps,
        };
        (steps, advised)
    }
}

/// The standard error of a share of so many draws.
fn error_of_share(share: f64, draws: usize) -> f64 {
    let count = draws as f64;
    // None or all of the draws may be one of them.
    let share = share.clamp(1.0 / count, 1.0 - 1.0 / count);
    (share * (1.0 - share) / count).sqrt()
}

impl Shooting<'_> {
    /// Whether the draws support a difference: worth a change, and above 0.
    fn support(&self, difference: &DrawProbabilities) -> Support {
        let interval = difference.interval();
        let simulation = libm::hypot(difference.simulation_standard_error(), SEARCH_ERROR);
        let count = self.draws.len() as f64;
        let of_mean = libm::hypot(simulation, interval.sd / count.sqrt());
        let worth = Support::of(interval.mean, WORTH_A_CHANGE, of_mean);
        // All draws share the error of the simulation.
        let [least, most] = [GUARD, -GUARD].map(|guard| {
            let share = difference.share_above(guard * simulation);
            Support::of(share, SUPPORTED, error_of_share(share, self.draws.len()))
        });
        let positive = if least == most {
            least
        } else {
            Support::AtTheLimit
        };
        worth.min(positive)
    }

    /// Whether the draws support the side of a change.
    fn support_of_side(&self, usual: f64, advised: f64, cause: Cause) -> Support {
        let shift = SEARCH_ERRORS[cause.0].copysign(advised - usual);
        let at = |advised: f64| {
            let share = self.same_side(usual, advised, cause);
            Support::of(share, SUPPORTED, error_of_share(share, self.draws.len()))
        };
        match (at(advised - shift), at(advised + shift)) {
            (least, most) if least == most => least,
            _ => Support::AtTheLimit,
        }
    }

    /// The share of the draws whose usual value lies on the same side of the advised one as the
    /// typical `usual` value.
    fn same_side(&self, usual: f64, advised: f64, cause: Cause) -> f64 {
        let known = self.typical.constant_errors[self.place][cause.0];
        // As the tracker reads them: the advice is a change of that.
        let of_draws = self
            .draws
            .iter()
            .map(|draw| draw.measured_mean(self.place)[cause.0] - known);
        let same = of_draws.filter(|mean| (advised - mean) * (advised - usual) > 0.0);
        same.count() as f64 / self.draws.len() as f64
    }
}
