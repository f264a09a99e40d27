//! Where missed balls come down: the places of rebounds.
//!
//! A shot ends below the ring, behind the board, or at its highest point below the ring. From there
//! the ball flies on without touching anything: the lower edge of the board, the net, players and
//! what holds the board are not modelled. Of a ball that is lodged nothing is said.

use super::miss_breakdown::{BATCH, CLASSIFIED, first_states};
use crate::dynamics::{BatchWorkspace, Ending, OutcomeKind, Simulator};
use crate::model::BallState;
use crate::shooter::{Nominal, Profile};
use crate::units::FOOT_M;
use rayon::prelude::*;

/// Simulated shots.
pub const REBOUND_SHOTS: u32 = CLASSIFIED;
/// The height at which a rebound is fought for, above the floor, m.
pub const CONTEST_HEIGHT_M: f64 = 9.0 * FOOT_M;
/// The reach of a rebounder who does not jump, m.
pub const REACH_M: f64 = 8.0 * FOOT_M;
/// A shot is traced at its events alone, s.
const NO_SAMPLES_S: f64 = 100.0;
/// Nothing falls for longer, s.
const LONGEST_FALL_S: f64 = 20.0;

/// Where a ball falls through a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Time from the release, s.
    pub time_s: f64,
    /// From the hoop's centre towards midcourt, m.
    pub x_m: f64,
    /// To the right as a shooter in front of the hoop sees it, m.
    pub y_m: f64,
}

impl Spot {
    /// Distance from the hoop's centre on the floor, m.
    #[must_use]
    pub fn distance_m(&self) -> f64 {
        libm::hypot(self.x_m, self.y_m)
    }
}

/// A missed ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound {
    /// How it missed.
    pub kind: OutcomeKind,
    /// Where its path leads to the right of the hoop's centre, m: the side of a wide miss.
    pub right_of_centre_m: f64,
    /// Where its centre first falls below each height, in the order that they were given.
    pub spots: [Spot; 3],
}

/// The heights above the floor at which rebounds are looked at, m: contested, within reach, and
/// when the ball touches the floor.
#[must_use]
pub fn rebound_heights_m(profile: &Profile, reach_m: f64) -> [f64; 3] {
    [CONTEST_HEIGHT_M, reach_m, profile.physics().ball_radius_m]
}

/// The missed balls among [`REBOUND_SHOTS`] shots about a nominal one. The samples are those of
/// [`classify_misses`](super::miss_breakdown::classify_misses).
#[must_use]
pub fn find_rebounds(
    profile: &Profile,
    nominal: &Nominal,
    seed: u64,
    reach_m: f64,
) -> Vec<Rebound> {
    let starts = first_states(profile, nominal, seed, CLASSIFIED);
    let heights = rebound_heights_m(profile, reach_m);
    let simulator = profile.simulator();
    // In lanes first: only misses need their path.
    starts
        .par_chunks(BATCH)
        .flat_map_iter(|starts| {
            let mut workspace = BatchWorkspace::default();
            let verdicts = simulator.finite_verdicts(starts, &mut workspace).iter();
            let misses = verdicts.zip(starts).filter(|(verdict, _)| !verdict.made);
            misses
                .filter_map(|(_, start)| rebound(simulator, *start, &heights))
                .collect::<Vec<_>>()
        })
        .collect()
}

/// The rebound of a shot; `None` if it goes in, or never comes down.
#[must_use]
pub fn rebound(simulator: &Simulator, start: BallState, heights_m: &[f64; 3]) -> Option<Rebound> {
    let trace = simulator.trace_state(start, NO_SAMPLES_S).ok()?;
    let outcome = trace.outcome;
    let can_fall = matches!(
        outcome.verdict.ending,
        Ending::Fell | Ending::NeverRose | Ending::BehindBoard
    );
    if outcome.verdict.made || !can_fall {
        return None;
    }
    let end = trace.events.last()?;
    let plane_m = simulator.physics().hoop_plane_height_m();
    let mut spots = [None; 3];
    for (spot, height_m) in spots.iter_mut().zip(heights_m) {
        *spot = fall_through(simulator, &end.state, end.time_s, height_m - plane_m);
    }
    let [Some(contested), Some(in_reach), Some(floor)] = spots else {
        return None;
    };
    Some(Rebound {
        kind: outcome.kind,
        right_of_centre_m: outcome.right_of_centre_m,
        spots: [contested, in_reach, floor],
    })
}

/// Where a ball that touches nothing falls through z; where it is already lower and falls, where
/// it is.
fn fall_through(simulator: &Simulator, from: &BallState, time_s: f64, z_m: f64) -> Option<Spot> {
    let at = |seconds: f64| simulator.undisturbed_state(from, seconds);
    let is_below = |seconds: f64| {
        let state = at(seconds);
        state.position_m.z < z_m && state.velocity_m_s.z < 0.0
    };
    // It first falls within a doubling of the time, and stays below.
    let mut above = 0.0;
    let mut below = 0.0;
    if !is_below(0.0) {
        below = 0.01;
        while !is_below(below) {
            above = below;
            below *= 2.0;
            if below > LONGEST_FALL_S {
                return None;
            }
        }
        while below - above > 1e-6 {
            let middle = 0.5 * (above + below);
            match is_below(middle) {
                true => below = middle,
                false => above = middle,
            }
        }
    }
    let state = at(below);
    Some(Spot {
        time_s: time_s + below,
        x_m: state.position_m.x,
        y_m: state.position_m.y,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::parse_profile;
    use crate::shooter::NominalVariable;

    fn profile(angle_deg: f64) -> Profile {
        let text = include_str!("../../configs/free_throw.toml")
            .replace("angle = \"0 deg\"", &format!("angle = \"{angle_deg} deg\""));
        parse_profile(&text, "test").unwrap()
    }

    fn nominal(profile: &Profile) -> Nominal {
        let mut nominal = profile.fixed_nominal();
        *nominal.get_mut(NominalVariable::Speed) = 24.4 * FOOT_M;
        *nominal.get_mut(NominalVariable::Pitch) = 52.0_f64.to_radians();
        *nominal.get_mut(NominalVariable::Polar) = profile.location().angle_rad;
        nominal
    }

    /// Authority: the points of the traced path, one each millisecond.
    #[test]
    fn val_rebounds_are_where_traced_shots_come_down() {
        let profile = profile(0.0);
        let simulator = profile.simulator();
        let heights = rebound_heights_m(&profile, REACH_M);
        let plane_m = profile.physics().hoop_plane_height_m();
        let samples =
            crate::probability::monte_carlo::first_samples(&profile, &nominal(&profile), 3, 400);
        let mut compared = 0;
        for release in samples {
            let trace = simulator.trace(&release, 0.001).unwrap();
            let Some(found) = rebound(simulator, release.state(), &heights) else {
                assert!(
                    trace.outcome.verdict.made || trace.outcome.verdict.ending == Ending::Lodged
                );
                continue;
            };
            // The last point below the ring, carried on as a parabola without air: 10 cm lower the
            // two differ by less than a millimetre.
            let last = trace.samples.last().unwrap();
            let z = heights[0] - plane_m;
            let (p, v) = (last.state.position_m, last.state.velocity_m_s);
            if p.z < z || trace.outcome.verdict.ending != Ending::Fell {
                continue;
            }
            let g = 9.806_65;
            let t = (v.z + (v.z * v.z + 2.0 * g * (p.z - z)).sqrt()) / g;
            let spot = found.spots[0];
            assert!((spot.x_m - (p.x + t * v.x)).abs() < 0.003, "{spot:?}");
            assert!((spot.y_m - (p.y + t * v.y)).abs() < 0.003);
            assert!((spot.time_s - (last.time_s + t)).abs() < 0.003);
            let times = found.spots.map(|spot| spot.time_s);
            assert!(times[0] < times[1] && times[1] < times[2]);
            compared += 1;
        }
        assert!(compared > 40, "{compared}");
    }

    /// A shot from the left and its mirror image from the right rebound to mirrored places.
    #[test]
    fn prop_rebounds_are_mirror_symmetric() {
        let (right, left) = (profile(30.0), profile(-30.0));
        let heights = rebound_heights_m(&right, REACH_M);
        let samples =
            crate::probability::monte_carlo::first_samples(&right, &nominal(&right), 5, 200);
        let mut compared = 0;
        for release in samples {
            let state = release.state();
            let mut mirrored = state;
            mirrored.position_m.y = -state.position_m.y;
            mirrored.velocity_m_s.y = -state.velocity_m_s.y;
            mirrored.spin_rad_s.x = -state.spin_rad_s.x;
            mirrored.spin_rad_s.z = -state.spin_rad_s.z;
            let a = rebound(right.simulator(), state, &heights);
            let b = rebound(left.simulator(), mirrored, &heights);
            assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                for (a, b) in a.spots.iter().zip(&b.spots) {
                    assert!((a.x_m - b.x_m).abs() < 1e-6 && (a.y_m + b.y_m).abs() < 1e-6);
                }
                compared += 1;
            }
        }
        assert!(compared > 20, "{compared}");
    }
}
