//! The releases that can go in, from geometry alone.
//!
//! A shot that goes in must come within reach of the ring (a circle of radius R_H + R about the
//! hoop's axis) at or above `z = -R`, and must pass neither above the ring from its near to its far
//! side nor over the board. Both bound the speed for each pitch angle. Its direction must lead
//! within reach of the ring, or to a point on the board from which a bounce can. A bounce does not
//! reverse the velocity along the board (only much side spin could, and it is not counted). The
//! velocity away from the board can have any size: off an edge, and off the paper's board that a
//! rising ball leaves at the top while it is still compressed.
//!
//! With air the speeds are those of the paths under drag. A faster path in the same direction lies
//! above a slower one all along, with drag too; and the path in a vacuum lies above both. Lift
//! depends on the spin: the bounds are those for the greatest backspin and the greatest forward
//! spin that errors bring about.

use crate::dynamics::{Release, Simulator};
use crate::model::BoardEdge;
use crate::shooter::{Location, Nominal, Profile};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// Points of the path at which the bounds of the speed are computed.
const PATH_POINTS: u32 = 24;
/// Spacing of the tested polar angles, rad.
const POLAR_STEP_RAD: f64 = 0.000_5;
/// Default of the greatest speed, as a multiple of the least speed that reaches the hoop.
const MAX_SPEED_FACTOR: f64 = 2.0;

/// Standard deviations of the error in speed beyond a limit of the nominal speed.
const SPEED_DEVIATIONS: f64 = 5.0;

/// The speeds (for each direction) and the polar angles of the releases that can go in.
#[derive(Clone, Debug, Serialize)]
pub struct Bracket {
    /// Least and greatest polar angle, rad.
    pub polar_rad: (f64, f64),
    /// Greatest nominal speed, m/s.
    pub speed_max_m_s: f64,
    /// Greatest speed of a release, m/s. Where the profile limits the nominal speed, errors lead
    /// beyond it.
    pub release_speed_max_m_s: f64,
    location: Location,
    start_height_m: f64,
    reach_m: f64,
    /// Distance of the centre of a touching ball from the ring's circle, m.
    contact_m: f64,
    ball_radius_m: f64,
    gravity_m_s2: f64,
    /// With air, the paths; and the spins to bound.
    #[serde(skip)]
    air: Option<(Simulator, [f64; 2])>,
    face_x_m: f64,
    /// The plane that the centre of a ball in play does not pass: the face or, with round edges,
    /// one edge radius behind it.
    last_plane_x_m: f64,
    /// Greatest height of the centre of a ball that touches the board, m.
    board_top_m: f64,
    /// Greatest distance of such a centre from the board's middle to either side, m.
    board_half_width_m: f64,
}

impl Bracket {
    /// The bracket of a profile; `None` if no direction leads to the hoop.
    #[must_use]
    pub fn new(profile: &Profile) -> Option<Self> {
        let physics = profile.physics();
        let location = profile.location();
        let start_height_m = profile.height_above_hoop_m();
        let gravity_m_s2 = physics.gravity_less_buoyancy_m_s2();
        let drag = physics.drag_per_m() * location.distance_m;
        let least =
            least_speed_m_s(location.distance_m, -start_height_m, gravity_m_s2) * (1.0 + drag);
        // A ball can touch a round edge from above and from beside the board.
        let over_edge_m = match physics.board_edge {
            BoardEdge::None => 0.0,
            BoardEdge::Rounded { .. } => physics.ball_radius_m,
        };
        let contact_m = physics.ball_radius_m + physics.ring_tube_radius_m();
        let limit = profile.search().speed_max_m_s;
        let with_errors =
            |limit: f64| limit + SPEED_DEVIATIONS * profile.shooter().dispersion.speed_m_s(limit);
        let mut bracket = Self {
            polar_rad: (0.0, 0.0),
            speed_max_m_s: limit.unwrap_or(MAX_SPEED_FACTOR * least),
            release_speed_max_m_s: limit.map_or(MAX_SPEED_FACTOR * least, with_errors),
            location,
            start_height_m,
            reach_m: physics.ring_radius_m + contact_m,
            contact_m,
            ball_radius_m: physics.ball_radius_m,
            gravity_m_s2,
            air: paths_in_air(profile),
            face_x_m: -physics.board_distance_m,
            last_plane_x_m: -physics.board_distance_m - physics.board_edge.radius_m(),
            board_top_m: physics.board_centre_z_m() + 0.5 * physics.board_height_m + over_edge_m,
            board_half_width_m: 0.5 * physics.board_width_m + over_edge_m,
        };
        let tries = (2.0 * FRAC_PI_2 / POLAR_STEP_RAD) as i64;
        let mut low = f64::INFINITY;
        let mut high = f64::NEG_INFINITY;
        for i in -tries / 2..=tries / 2 {
            let polar = location.angle_rad + i as f64 * POLAR_STEP_RAD;
            if bracket.passes_ring(polar) || bracket.banks_to_ring(polar) {
                low = low.min(polar - POLAR_STEP_RAD);
                high = high.max(polar + POLAR_STEP_RAD);
            }
        }
        bracket.polar_rad = (low, high);
        (low < high).then_some(bracket)
    }

    fn start(&self) -> (f64, f64) {
        let (sin, cos) = libm::sincos(self.location.angle_rad);
        (
            self.location.distance_m * cos,
            self.location.distance_m * sin,
        )
    }

    /// Distance of the hoop's axis from the horizontal path in a direction.
    fn axis_offset(&self, polar: f64) -> f64 {
        self.location.distance_m * libm::sin(polar - self.location.angle_rad).abs()
    }

    fn passes_ring(&self, polar: f64) -> bool {
        self.axis_offset(polar) < self.reach_m && libm::cos(polar - self.location.angle_rad) > 0.0
    }

    /// Whether the horizontal path meets the board where a bounce can lead within reach of the
    /// ring: in front of the hoop, or on the side that the path comes from.
    fn banks_to_ring(&self, polar: f64) -> bool {
        let (sin, cos) = libm::sincos(polar);
        if cos <= 1e-6 {
            return false;
        }
        let (x, y) = self.start();
        // Distances to the side where the ball can first and last touch the board, positive on the
        // side that the path comes from.
        let side = 1.0_f64.copysign(sin);
        let across = |plane: f64| side * (y - (x - plane) * sin / cos);
        let first = across(self.face_x_m + self.ball_radius_m);
        let last = across(self.last_plane_x_m);
        last <= self.board_half_width_m && first > -self.reach_m
    }

    /// Lengths of the horizontal path to where the ball can first touch the board's face, and to
    /// the last plane, if it comes near the board.
    fn path_to_board(&self, polar: f64) -> Option<(f64, f64)> {
        let (sin, cos) = libm::sincos(polar);
        let (x, y) = self.start();
        let length_to = |plane: f64| (x - plane) / cos;
        let first = length_to(self.face_x_m + self.ball_radius_m);
        let last = length_to(self.last_plane_x_m);
        let near = self.board_half_width_m + self.reach_m;
        let [from, to] = [first, last].map(|length| y - length * sin);
        let comes_near = from.min(to) < near && from.max(to) > -near;
        (cos > 1e-6 && comes_near).then_some((first, last))
    }

    /// Least and greatest speed with which a shot in this direction can go in, m/s; `None` if there
    /// is none.
    #[must_use]
    pub fn speeds_m_s(&self, pitch_rad: f64, polar_rad: f64) -> Option<(f64, f64)> {
        let near = (self.location.distance_m - self.reach_m).max(1e-3);
        let far = self.location.distance_m + self.reach_m;
        let board = self.path_to_board(polar_rad);
        let end = board.map_or(far, |(_, last)| last).max(near);
        // A slower shot is below the ring's reach all the way from `near` to `end`.
        let lengths =
            (0..=PATH_POINTS).map(|i| near + (end - near) * f64::from(i) / f64::from(PATH_POINTS));
        let least = self.least_speed_through(lengths, -self.contact_m, pitch_rad);
        // A faster shot passes above the ring on both sides, and above the board both where the
        // ball would touch it (on the way up) and at the last plane (on the way down). The speed
        // through a height has one minimum along the path, so it is greatest at an end.
        let greatest = |lengths: [f64; 2], z: f64| {
            let speeds = lengths.map(|s| self.speed_through(s.max(1e-3), z, pitch_rad));
            speeds[0].max(speeds[1])
        };
        let over_ring = greatest([near, far], self.contact_m);
        let over_board = board.map_or(0.0, |(first, last)| {
            greatest([first, last], self.board_top_m)
        });
        let most = over_ring.max(over_board).min(self.release_speed_max_m_s);
        (least < most).then_some((least, most))
    }

    /// The least speed of the paths that pass the height `z` at the horizontal distances `lengths`.
    fn least_speed_through(
        &self,
        lengths: impl Iterator<Item = f64>,
        z: f64,
        pitch_rad: f64,
    ) -> f64 {
        let in_vacuum = lengths.map(|s| (self.parabola_speed_through(s, z, pitch_rad), s));
        let Some((_, spins)) = &self.air else {
            return in_vacuum
                .map(|(speed, _)| speed)
                .fold(f64::INFINITY, f64::min);
        };
        let mut in_vacuum: Vec<_> = in_vacuum.collect();
        in_vacuum.sort_by(|a, b| a.0.total_cmp(&b.0));
        let lifts = spins[0] != spins[1];
        let mut least = f64::INFINITY;
        for (speed, s) in in_vacuum {
            // Drag makes every speed greater.
            if !lifts && speed >= least {
                break;
            }
            // A faster path lies above a slower one, so one flight tells whether `s` needs less.
            if least == f64::INFINITY || self.passes_above(least, s, z, pitch_rad) {
                let [slow, fast] = self.speeds_in_air(s, z, pitch_rad);
                least = least.min(slow).min(fast);
            }
        }
        least
    }

    /// Whether a path with this speed, of either spin, is above the height `z` at the horizontal
    /// distance `s`.
    fn passes_above(&self, speed_m_s: f64, s: f64, z: f64, pitch_rad: f64) -> bool {
        let Some((simulator, spins)) = &self.air else {
            return self.parabola_speed_through(s, z, pitch_rad) < speed_m_s;
        };
        let is_above = |backspin_rad_s| {
            let release = Release {
                speed_m_s,
                ..self.release(pitch_rad, backspin_rad_s)
            };
            simulator.height_at_length_m(&release, s) > z
        };
        is_above(spins[0]) || spins[0] != spins[1] && is_above(spins[1])
    }

    /// A release towards the hoop, without a speed.
    fn release(&self, pitch_rad: f64, backspin_rad_s: f64) -> Release {
        Release {
            distance_m: self.location.distance_m,
            court_angle_rad: self.location.angle_rad,
            height_above_hoop_m: self.start_height_m,
            speed_m_s: 0.0,
            pitch_rad,
            polar_rad: self.location.angle_rad,
            backspin_rad_s,
            rifle_spin_rad_s: 0.0,
            side_spin_rad_s: 0.0,
        }
    }

    /// The greatest speed of the paths that pass the height `z` at the horizontal distance `s`;
    /// infinite if there is none.
    fn speed_through(&self, s: f64, z: f64, pitch_rad: f64) -> f64 {
        if self.air.is_some() {
            let [slow, fast] = self.speeds_in_air(s, z, pitch_rad);
            slow.max(fast)
        } else {
            self.parabola_speed_through(s, z, pitch_rad)
        }
    }

    /// The speeds with air, for both spins.
    fn speeds_in_air(&self, s: f64, z: f64, pitch_rad: f64) -> [f64; 2] {
        let Some((simulator, spins)) = &self.air else {
            return [self.parabola_speed_through(s, z, pitch_rad); 2];
        };
        let speed = |backspin_rad_s| {
            let release = self.release(pitch_rad, backspin_rad_s);
            simulator
                .speed_through_m_s(&release, s, z)
                .unwrap_or(f64::INFINITY)
        };
        let first = speed(spins[0]);
        if spins[0] == spins[1] {
            [first; 2]
        } else {
            [first, speed(spins[1])]
        }
    }

    /// Speed of the parabola that passes the height `z` at the horizontal distance `s`; infinite if
    /// there is none.
    fn parabola_speed_through(&self, s: f64, z: f64, pitch_rad: f64) -> f64 {
        let (sin, cos) = libm::sincos(pitch_rad);
        let over = self.start_height_m - z + s * sin / cos;
        if over <= 0.0 || cos <= 1e-6 {
            return f64::INFINITY;
        }
        s / cos * (0.5 * self.gravity_m_s2 / over).sqrt()
    }

    /// Whether the bracket contains a shot.
    #[must_use]
    pub fn contains(&self, shot: &Nominal) -> bool {
        shot.polar_rad >= self.polar_rad.0
            && shot.polar_rad <= self.polar_rad.1
            && self
                .speeds_m_s(shot.pitch_rad, shot.polar_rad)
                .is_some_and(|(least, most)| shot.speed_m_s >= least && shot.speed_m_s <= most)
    }
}

/// The simulator of a profile with drag or lift, and the least and the greatest backspin whose lift
/// counts, rad/s.
fn paths_in_air(profile: &Profile) -> Option<(Simulator, [f64; 2])> {
    /// Standard deviations of the errors in spin that are counted.
    const DEVIATIONS: f64 = 4.0;
    let physics = profile.physics();
    if physics.drag_per_m() == 0.0 && physics.lift_factor() == 0.0 {
        return None;
    }
    let mut spins = [0.0; 2];
    if physics.lift_factor() != 0.0 {
        let (low, high) = profile.backspin_range_rad_s();
        let error = DEVIATIONS * profile.shooter().dispersion.backspin_rad_s(high);
        spins = [low - error, high + error];
    }
    Some((profile.simulator().clone(), spins))
}

/// The least speed with which a parabola reaches a point `s` away and `rise` above (Brancazio
/// 1981):
/// `v^2 = g (rise + sqrt(rise^2 + s^2))`.
fn least_speed_m_s(s: f64, rise: f64, gravity: f64) -> f64 {
    (gravity * (rise + (rise * rise + s * s).sqrt())).sqrt()
}

#[cfg(test)]
mod tests {
    use super::least_speed_m_s;
    use crate::units::FOOT_M;

    #[test]
    fn val_least_speed_to_the_hoop_from_the_line() {
        let speed = least_speed_m_s(13.75 * FOOT_M, 3.0 * FOOT_M, 32.2 * FOOT_M) / FOOT_M;
        assert!((speed - 23.4471).abs() < 5e-5, "{speed}");
    }
}
