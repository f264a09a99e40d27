//! Observers of a running shot.
//!
//! The integrators report to an [`Observer`]. The silent one, `()`, costs nothing. So the loop that
//! feeds a probability and the one that records a trajectory are the same code.

use super::flight::FlightPath;
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::{BallState, SolidId};

/// The impulse of each solid on the ball per unit of mass, m/s; by [`SolidId::index`].
pub(crate) type Impulses = [Vec3<f64>; SolidId::COUNT];

/// No impulse.
pub(crate) const NO_IMPULSES: Impulses = [Vec3::new(0.0, 0.0, 0.0); SolidId::COUNT];

/// Receives each part of a shot in order.
pub(crate) trait Observer {
    /// Free flight for `dt` along a path that starts at the time `t`.
    fn flight(&mut self, _params: &ModelParams, _t: f64, _dt: f64, _path: &FlightPath) {}
    /// A contact begins.
    fn touch(&mut self, _t: f64, _solid: SolidId, _state: &BallState) {}
    /// A step of `dt` in contact, from the first state to the second.
    fn step(&mut self, _t: f64, _dt: f64, _states: (&BallState, &BallState), _impulses: Impulses) {}
    /// A contact ends.
    fn separation(&mut self, _t: f64, _solid: SolidId, _state: &BallState) {}
}

impl Observer for () {}

impl<A: Observer, B: Observer> Observer for (A, B) {
    fn flight(&mut self, params: &ModelParams, t: f64, dt: f64, path: &FlightPath) {
        self.0.flight(params, t, dt, path);
        self.1.flight(params, t, dt, path);
    }
    fn touch(&mut self, t: f64, solid: SolidId, state: &BallState) {
        self.0.touch(t, solid, state);
        self.1.touch(t, solid, state);
    }
    fn step(&mut self, t: f64, dt: f64, states: (&BallState, &BallState), impulses: Impulses) {
        self.0.step(t, dt, states, impulses);
        self.1.step(t, dt, states, impulses);
    }
    fn separation(&mut self, t: f64, solid: SolidId, state: &BallState) {
        self.0.separation(t, solid, state);
        self.1.separation(t, solid, state);
    }
}
