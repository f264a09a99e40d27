//! Position, velocity and spin of the ball, and the constants as the equations use them.

use crate::lane::Lane;
use crate::physics::Physics;

/// Three components along x, y and z (or along the axes that the name says).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple<L>(pub L, pub L, pub L);

impl<L: Lane> Triple<L> {
    #[inline(always)]
    pub(crate) fn plus(self, other: Self, times: L) -> Self {
        Self(
            self.0 + other.0 * times,
            self.1 + other.1 * times,
            self.2 + other.2 * times,
        )
    }

    #[inline(always)]
    pub(crate) fn when(self, mask: L::Mask, other: Self) -> Self {
        Self(
            self.0.when(mask, other.0),
            self.1.when(mask, other.1),
            self.2.when(mask, other.2),
        )
    }
}

/// The nine state variables: position of the ball's centre, its velocity and its angular velocity.
///
/// Origin at the centre of the hoop, x from the backboard to the court, z up, right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<L = f64> {
    /// Position of the centre, m.
    pub position_m: Triple<L>,
    /// Velocity of the centre, m/s.
    pub velocity_m_s: Triple<L>,
    /// Angular velocity, rad/s.
    pub spin_rad_s: Triple<L>,
}

/// Time derivative of a [`State`] other than the velocity itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rate<L = f64> {
    pub(crate) velocity_m_s: Triple<L>,
    pub(crate) acceleration_m_s2: Triple<L>,
    pub(crate) spin_rate_rad_s2: Triple<L>,
}

impl<L: Lane> Rate<L> {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let sum = |a: Triple<L>, b: Triple<L>| Triple(a.0 + b.0, a.1 + b.1, a.2 + b.2);
        Self {
            velocity_m_s: sum(self.velocity_m_s, other.velocity_m_s),
            acceleration_m_s2: sum(self.acceleration_m_s2, other.acceleration_m_s2),
            spin_rate_rad_s2: sum(self.spin_rate_rad_s2, other.spin_rate_rad_s2),
        }
    }
}

impl<L: Lane> State<L> {
    /// The state after `dt` at the given rate (an Euler step; the building block of RK4).
    #[inline(always)]
    pub(crate) fn advanced(&self, rate: &Rate<L>, dt: L) -> Self {
        Self {
            position_m: self.position_m.plus(rate.velocity_m_s, dt),
            velocity_m_s: self.velocity_m_s.plus(rate.acceleration_m_s2, dt),
            spin_rad_s: self.spin_rad_s.plus(rate.spin_rate_rad_s2, dt),
        }
    }

    /// The classical Runge-Kutta combination of four rates over `dt`.
    #[inline(always)]
    pub(crate) fn combined(&self, rates: [&Rate<L>; 4], dt: L) -> Self {
        let [k1, k2, k3, k4] = rates;
        let ends = k1.plus(k4);
        let middle = k2.plus(k3);
        self.advanced(&ends.plus(&middle.plus(&middle)), dt * (1.0 / 6.0))
    }

    /// The state after `dt` of free flight.
    #[inline(always)]
    pub(crate) fn flown(&self, law: &Law<L>, dt: L) -> Self {
        let p = self.position_m.plus(self.velocity_m_s, dt);
        let Triple(vx, vy, vz) = self.velocity_m_s;
        Self {
            position_m: Triple(p.0, p.1, p.2 - law.half_gravity * dt * dt),
            velocity_m_s: Triple(vx, vy, vz - law.gravity * dt),
            spin_rad_s: self.spin_rad_s,
        }
    }

    /// `self` where `mask` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn when(self, mask: L::Mask, other: Self) -> Self {
        Self {
            position_m: self.position_m.when(mask, other.position_m),
            velocity_m_s: self.velocity_m_s.when(mask, other.velocity_m_s),
            spin_rad_s: self.spin_rad_s.when(mask, other.spin_rad_s),
        }
    }

    /// Square of the distance of the centre from the hoop's axis, D_theta of the paper.
    #[inline(always)]
    pub(crate) fn axis_square(&self) -> L {
        let Triple(x, y, _) = self.position_m;
        x.squared() + y.squared()
    }
}

impl State<f64> {
    /// The state mirrored in the plane of symmetry (y -> -y).
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let Triple(x, y, z) = self.position_m;
        let Triple(vx, vy, vz) = self.velocity_m_s;
        let Triple(wx, wy, wz) = self.spin_rad_s;
        Self {
            position_m: Triple(x, -y, z),
            velocity_m_s: Triple(vx, -vy, vz),
            spin_rad_s: Triple(-wx, wy, -wz),
        }
    }
}

/// The constants of [`Physics`] in the form the equations use: per unit of ball mass, one copy per
/// lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law<L = f64> {
    pub(crate) radius: L,
    pub(crate) ring_radius: L,
    /// x of the centre of a ball that just touches the board.
    pub(crate) board_touch_x: L,
    /// x of the board's face.
    pub(crate) board_face_x: L,
    pub(crate) board_half_width: L,
    pub(crate) board_bottom_z: L,
    pub(crate) board_top_z: L,
    pub(crate) gravity: L,
    pub(crate) half_gravity: L,
    /// 1/g, s^2/m.
    pub(crate) per_gravity: L,
    /// k/m, 1/s^2.
    pub(crate) stiffness: L,
    /// c/m, 1/s.
    pub(crate) damping: L,
    /// c/k, s: from the release (N = 0) of a ball on its way out to its parting (u = 0), about.
    pub(crate) release_to_part: L,
    pub(crate) friction: L,
    /// m/I, 1/m^2.
    pub(crate) mass_over_inertia: L,
    pub(crate) zero: L,
    pub(crate) one: L,
    /// Stands for an event that will not happen.
    pub(crate) never: L,
}

impl Law {
    /// The constants per unit of mass.
    pub(crate) fn new(physics: &Physics) -> Self {
        let radius = physics.ball_radius_m;
        let inertia = physics.inertia_ratio * radius * radius;
        let half_height = 0.5 * physics.board_height_m;
        Self {
            radius,
            ring_radius: physics.ring_radius_m,
            board_touch_x: radius - physics.board_distance_m,
            board_face_x: -physics.board_distance_m,
            board_half_width: 0.5 * physics.board_width_m,
            board_bottom_z: physics.board_centre_height_m - half_height,
            board_top_z: physics.board_centre_height_m + half_height,
            gravity: physics.gravity_m_s2,
            half_gravity: 0.5 * physics.gravity_m_s2,
            per_gravity: 1.0 / physics.gravity_m_s2,
            stiffness: physics.stiffness_n_m / physics.ball_mass_kg,
            damping: physics.damping_kg_s / physics.ball_mass_kg,
            release_to_part: physics.damping_kg_s / physics.stiffness_n_m,
            friction: physics.friction,
            mass_over_inertia: 1.0 / inertia,
            zero: 0.0,
            one: 1.0,
            never: 1e9,
        }
    }

    /// The same constants in every lane of the kind that `lit` makes.
    #[inline(always)]
    pub(crate) fn map<L: Lane>(&self, lit: impl Fn(f64) -> L) -> Law<L> {
        Law {
            radius: lit(self.radius),
            ring_radius: lit(self.ring_radius),
            board_touch_x: lit(self.board_touch_x),
            board_face_x: lit(self.board_face_x),
            board_half_width: lit(self.board_half_width),
            board_bottom_z: lit(self.board_bottom_z),
            board_top_z: lit(self.board_top_z),
            gravity: lit(self.gravity),
            half_gravity: lit(self.half_gravity),
            per_gravity: lit(self.per_gravity),
            stiffness: lit(self.stiffness),
            damping: lit(self.damping),
            release_to_part: lit(self.release_to_part),
            friction: lit(self.friction),
            mass_over_inertia: lit(self.mass_over_inertia),
            zero: lit(self.zero),
            one: lit(self.one),
            never: lit(self.never),
        }
    }
}
