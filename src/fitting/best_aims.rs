//! The best release near a shooter's own, for each release angle: what aims are measured from.
//!
//! All releases are compared by one weighted sample ([`WeightedShots`]), so that their differences
//! hardly have a numerical error.

use super::draw_probabilities::WeightedShots;
use super::measured_release::Values;
use super::posterior::Draw;
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, FOOT_M};

/// Shots of the sample.
const SHOTS: usize = 32_768;
/// How far from its centre the sample reaches: speed (m/s), pitch and polar angle (rad). The
/// backspin is the shooter's own.
const REACH: [f64; 3] = [0.35 * FOOT_M, 4.0 * DEGREE_RAD, DEGREE_RAD];
/// The greatest distance from the centre, in reaches, that one sample bears.
const FARTHEST: f64 = 1.5;
const MOST_SAMPLES: usize = 5;
/// Rounds of a climb along one value after the other.
const ROUNDS: usize = 6;
/// Angles to each side of the best one, and their spacing, rad.
const ANGLES: i32 = 3;
const ANGLE_STEP_RAD: f64 = 2.0 * DEGREE_RAD;
/// Where hardly any shot goes in there is no best one to climb to.
const LEAST_PROBABILITY: f64 = 0.005;

/// The best releases near a shooter's own.
#[derive(Clone, Debug)]
pub struct BestAims {
    /// The best release.
    best: Values,
    /// The best speed less that of the best release at angles about the best one, in ascending
    /// order.
    speeds: Vec<f64>,
}

/// P of releases about a centre for one draw.
struct Surroundings<'a> {
    sample: WeightedShots,
    draw: &'a Draw,
    place: usize,
    centre: Values,
}

impl<'a> Surroundings<'a> {
    fn new(profile: &Profile, draw: &'a Draw, place: usize, centre: Values) -> Self {
        let mut means = vec![centre];
        for (i, reach) in REACH.iter().enumerate() {
            means.extend([*reach, -*reach].map(|reach| {
                let mut moved = centre;
                moved[i] += reach;
                moved
            }));
        }
        let draws = (std::slice::from_ref(draw), place);
        let seed = profile.search().seed;
        Self {
            sample: WeightedShots::simulate(profile, draws, &means, SHOTS, seed),
            draw,
            place,
            centre,
        }
    }

    fn probability(&self, values: &Values) -> f64 {
        let draws = std::slice::from_ref(self.draw);
        let p = self
            .sample
            .probabilities(draws, |_| *values, |draw| draw.factor_at(self.place));
        p.of_draws[0]
    }

    /// One step of Newton's method along a value, or one uphill.
    fn climb(&self, values: &mut Values, i: usize) {
        let step = 0.3 * REACH[i];
        let at = |offset: f64| {
            let mut moved = *values;
            moved[i] += offset;
            self.probability(&moved)
        };
        let [below, here, above] = [-step, 0.0, step].map(at);
        let (slope, curvature) = (0.5 * (above - below), below - 2.0 * here + above);
        let part = if curvature < 0.0 {
            (-slope / curvature).clamp(-1.0, 1.0)
        } else {
            slope.signum()
        };
        let limit = FARTHEST * REACH[i];
        let from_centre = values[i] + part * step - self.centre[i];
        values[i] = self.centre[i] + from_centre.clamp(-limit, limit);
    }

    fn is_at_its_end(&self, values: &Values) -> bool {
        (0..3).any(|i| (values[i] - self.centre[i]).abs() > 0.99 * FARTHEST * REACH[i])
    }
}

impl BestAims {
    /// Those near the aim of a draw at a place. `None` where hardly any shot goes in.
    #[must_use]
    pub fn near(profile: &Profile, draw: &Draw, place: usize) -> Option<Self> {
        let mut best = draw.means[place];
        for _ in 0..MOST_SAMPLES {
            let near = Surroundings::new(profile, draw, place, best);
            for _ in 0..ROUNDS {
                for i in [0, 2, 1] {
                    near.climb(&mut best, i);
                }
            }
            if near.probability(&best) < LEAST_PROBABILITY {
                return None;
            }
            if near.is_at_its_end(&best) {
                continue;
            }
            let speeds = (-ANGLES..=ANGLES).map(|k| {
                let mut at_angle = best;
                at_angle[1] += f64::from(k) * ANGLE_STEP_RAD;
                for _ in 0..ROUNDS / 2 {
                    near.climb(&mut at_angle, 0);
                }
                at_angle[0] - best[0]
            });
            return Some(Self {
                speeds: speeds.collect(),
                best,
            });
        }
        None
    }

    /// The best release at an angle so much above the best one, rad.
    #[must_use]
    pub fn at_angle(&self, angle_rad: f64) -> Values {
        let mut values = self.best;
        values[0] += self.speed_for(angle_rad);
        values[1] += angle_rad;
        values
    }

    /// The best speed at an angle so much above the best one, less that at the best one.
    fn speed_for(&self, angle_rad: f64) -> f64 {
        let most = 2.0 * f64::from(ANGLES);
        let at = (angle_rad / ANGLE_STEP_RAD + f64::from(ANGLES)).clamp(0.0, most);
        let below = (at as usize).min(self.speeds.len() - 2);
        let part = at - below as f64;
        self.speeds[below] + part * (self.speeds[below + 1] - self.speeds[below])
    }

    /// How far a release is from the best one: in speed from the best at its angle, in angle and in
    /// direction.
    pub(super) fn deviation(&self, values: &Values) -> [f64; 3] {
        let angle = values[1] - self.best[1];
        [
            values[0] - self.best[0] - self.speed_for(angle),
            angle,
            values[2] - self.best[2],
        ]
    }
}
