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
use crate::shooter::Profile;

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

/// One step from the usual release to the best one.
#[derive(Clone, Debug)]
pub struct AdviceStep {
    /// What is changed.
    pub cause: Cause,
    /// The release after this step and those before it.
    pub release: Values,
    /// What it adds to P.
    pub gain: Interval,
}

impl AdviceStep {
    /// Whether the step gains at least half a point, and its interval lies above 0.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        self.gain.low > 0.0 && self.gain.mean > WORTH_A_CHANGE
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
    pub alone: Option<[Interval; 2]>,
}

/// A release in which some values are those of a target and the others the usual ones of a draw.
#[derive(Clone, Copy)]
struct Change {
    target: Values,
    changed: [bool; VALUE_NAMES.len()],
}

impl Change {
    fn with(mut self, i: usize, value: f64) -> Self {
        self.target[i] = value;
        self.changed[i] = true;
        self
    }

    fn of_draw(&self, draw: &Draw, place: usize) -> Values {
        std::array::from_fn(|i| {
            if self.changed[i] {
                self.target[i]
            } else {
                draw.means[place][i]
            }
        })
    }
}

impl AdviceSteps {
    /// The advised release of a draw: its own but for what changes.
    pub(super) fn advised_of(&self, draw: &Draw, place: usize) -> Values {
        let change = Change {
            target: self.advised,
            changed: self.is_changed,
        };
        change.of_draw(draw, place)
    }
}

/// The shooter at a place.
pub(super) struct Shooting<'a> {
    pub(super) profile: &'a Profile,
    pub(super) draws: &'a [Draw],
    pub(super) typical: &'a Draw,
    pub(super) place: usize,
}

impl Shooting<'_> {
    /// P for each draw with a change.
    fn probabilities(&self, change: &Change) -> DrawProbabilities {
        let mean = |draw: &Draw| change.of_draw(draw, self.place);
        let means: Vec<Values> = self.draws.iter().map(mean).collect();
        let seed = self.profile.search().seed;
        WeightedShots::simulate(
            self.profile,
            (self.draws, self.place),
            &means,
            STEP_SHOTS,
            seed,
        )
        .probabilities(self.draws, mean, |draw| draw.factors[self.place])
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

    /// The speed and the angle of the second step.
    fn speed_and_angle(&self, usual: &Values, best: &Values) -> (f64, f64) {
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
        let most = on_the_way.iter().map(|(.., p)| *p).fold(0.0, f64::max);
        on_the_way
            .into_iter()
            .find(|(.., p)| *p >= most - TOLERANCE)
            .map_or((best[0], best[1]), |(speed, angle, _)| (speed, angle))
    }

    /// The steps from the usual release to the best one of the same kind.
    pub(super) fn steps(&self, usual: &Values, best: &Values, changes_spin: bool) -> AdviceSteps {
        let none = Change {
            target: *usual,
            changed: [false; VALUE_NAMES.len()],
        };
        let mut best = *best;
        if !changes_spin {
            best[3] = usual[3];
        }
        let (own_speed, _) = self.best_speed(*usual);
        let (speed, angle) = self.speed_and_angle(usual, &best);
        let mut order = vec![(Cause::SPEED, none.with(0, own_speed))];
        let mut change = none.with(0, own_speed);
        if angle != usual[1] {
            change = change.with(0, speed).with(1, angle);
            order.push((Cause::PITCH, change));
        }
        change = change.with(2, best[2]);
        order.push((Cause::AIM, change));
        if changes_spin {
            order.push((Cause::BACKSPIN, change.with(3, best[3])));
        }
        let usual_p = self.probabilities(&none);
        let mut before = usual_p.clone();
        let mut steps = Vec::new();
        for (cause, change) in order {
            let p = self.probabilities(&change);
            steps.push(AdviceStep {
                cause,
                release: change.of_draw(self.typical, self.place),
                gain: p.minus(&before).interval(),
            });
            before = p;
        }
        let advised = advised(&steps, none);
        let is_two = advised.changed[0] && advised.changed[1];
        AdviceSteps {
            advised: advised.of_draw(self.typical, self.place),
            is_changed: advised.changed,
            gain: self.probabilities(&advised).minus(&usual_p).interval(),
            alone: is_two.then(|| {
                [0, 1].map(|i| {
                    let alone = none.with(i, advised.target[i]);
                    self.probabilities(&alone).minus(&usual_p).interval()
                })
            }),
            steps,
        }
    }
}

/// The sure steps together.
fn advised(steps: &[AdviceStep], none: Change) -> Change {
    let mut change = none;
    for step in steps.iter().filter(|step| step.is_sure()) {
        if step.cause == Cause::PITCH {
            change = change.with(0, step.release[0]);
        }
        change = change.with(step.cause.0, step.release[step.cause.0]);
    }
    change
}
