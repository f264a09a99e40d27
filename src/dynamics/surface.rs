//! Board and ring as surfaces that the ball meets, each in a frame of its own.
//!
//! At a contact the unit normal `n` points from the surface to the ball's centre; `(n, 1, 2)` is
//! right-handed: `(i, j, k)` at the board, `(u_n, u_phi, u_theta)` at the ring (Eq. 6). In that
//! frame both surfaces obey one set of equations; they differ in how the frame turns as the ball
//! moves along the surface, `n' = (bend_1 v_1, bend_2 v_2)`: not at all at the board, and by
//! `1/(R-u)` and `-cos(phi)/D_theta` at the ring (Eq. 7).

use super::state::{Law, State, Triple};
use crate::lane::Lane;

/// The ball on one surface, in the frame `(n, 1, 2)` of the contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<L = f64> {
    /// Compression u of the ball.
    pub(crate) compression: L,
    /// Distance R - u from the centre to the contact point.
    pub(crate) lever: L,
    /// Velocity of the centre along (n, 1, 2).
    pub(crate) v: Triple<L>,
    /// Angular velocity along (n, 1, 2).
    pub(crate) w: Triple<L>,
    /// Gravity along (n, 1, 2), an acceleration.
    pub(crate) g: Triple<L>,
    pub(crate) bend_1: L,
    pub(crate) bend_2: L,
}

impl<L: Lane> Touch<L> {
    /// Velocity of the contact point along the surface (Eqs. 4 and 14).
    #[inline(always)]
    pub(crate) fn slip(&self) -> (L, L) {
        (
            self.v.1 - self.lever * self.w.2,
            self.v.2 + self.lever * self.w.1,
        )
    }

    /// Normal acceleration k u + c u' of the ball (Eqs. 2 and 12); negative just before parting.
    #[inline(always)]
    pub(crate) fn normal(&self, law: &Law<L>) -> L {
        law.stiffness * self.compression - law.damping * self.v.0
    }

    /// What turns the velocity's own components: the normal acceleration seen without forces.
    #[inline(always)]
    pub(crate) fn bending(&self) -> L {
        self.bend_1 * self.v.1.squared() + self.bend_2 * self.v.2.squared()
    }

    /// Rate of the slip from motion alone (no force): `-(v_n (n' + w x n) + (R-u) w_n (n x n'))`.
    #[inline(always)]
    pub(crate) fn drift(&self) -> (L, L) {
        let (turn_1, turn_2) = (self.bend_1 * self.v.1, self.bend_2 * self.v.2);
        let screw = self.lever * self.w.0;
        (
            screw * turn_2 - self.v.0 * (turn_1 + self.w.2),
            -(screw * turn_1) - self.v.0 * (turn_2 - self.w.1),
        )
    }

    /// Rate of the slip without friction: from motion and gravity.
    #[inline(always)]
    pub(crate) fn drive(&self) -> (L, L) {
        let drift = self.drift();
        (self.g.1 + drift.0, self.g.2 + drift.1)
    }

    /// Rate of slip that a unit of friction (per unit of mass) makes: 1 + lever^2 m/I.
    #[inline(always)]
    pub(crate) fn slip_per_push(&self, law: &Law<L>) -> L {
        self.lever.squared() * law.mass_over_inertia + 1.0
    }

    /// Rate along a direction at which the drive changes, over u'' (the normal velocity in
    /// [`Touch::drift`] being what changes it most).
    #[inline(always)]
    pub(crate) fn give(&self, along: (L, L)) -> L {
        (self.bend_1 * self.v.1 + self.w.2) * along.0
            + (self.bend_2 * self.v.2 - self.w.1) * along.1
    }
}

/// A surface the ball can touch. Implementations are zero-sized and resolve at compile time.
pub(crate) trait Surface<L: Lane>: Copy {
    /// Directions of the contact frame in space.
    type Frame: Copy;

    /// Place and motion of the ball relative to the surface.
    fn meet(self, law: &Law<L>, state: &State<L>) -> (Touch<L>, Self::Frame);

    /// Components along x, y, z of a vector given along (n, 1, 2).
    fn to_space(self, frame: Self::Frame, vector: Triple<L>) -> Triple<L>;

    /// As [`Surface::to_space`], of a vector along the surface, given along (1, 2).
    fn along_to_space(self, frame: Self::Frame, vector: (L, L)) -> Triple<L>;
}

/// The front face of the board, a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Board;

impl<L: Lane> Surface<L> for Board {
    type Frame = ();

    #[inline(always)]
    fn meet(self, law: &Law<L>, state: &State<L>) -> (Touch<L>, ()) {
        let touch = Touch {
            compression: law.board_touch_x - state.position_m.0,
            lever: state.position_m.0 - law.board_face_x,
            v: state.velocity_m_s,
            w: state.spin_rad_s,
            g: Triple(law.zero, law.zero, -law.gravity),
            bend_1: law.zero,
            bend_2: law.zero,
        };
        (touch, ())
    }

    #[inline(always)]
    fn to_space(self, _frame: (), vector: Triple<L>) -> Triple<L> {
        vector
    }

    #[inline(always)]
    fn along_to_space(self, _frame: (), (first, second): (L, L)) -> Triple<L> {
        Triple(first.lit(0.0), first, second)
    }
}

/// The ring, a circle of radius R_H without thickness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring;

/// The angles of the hoop coordinates (Eq. 6).
#[derive(Clone, Copy, Debug)]
pub(crate) struct RingFrame<L> {
    cos_theta: L,
    sin_theta: L,
    cos_phi: L,
    sin_phi: L,
}

impl<L: Lane> RingFrame<L> {
    /// Components along (u_n, u_phi, u_theta) of a vector given along x, y, z.
    #[inline(always)]
    fn to_hoop(self, v: Triple<L>) -> Triple<L> {
        let outward = v.0 * self.cos_theta + v.1 * self.sin_theta;
        Triple(
            v.2 * self.sin_phi - outward * self.cos_phi,
            v.2 * self.cos_phi + outward * self.sin_phi,
            v.1 * self.cos_theta - v.0 * self.sin_theta,
        )
    }
}

impl<L: Lane> Surface<L> for Ring {
    type Frame = RingFrame<L>;

    #[inline(always)]
    fn meet(self, law: &Law<L>, state: &State<L>) -> (Touch<L>, RingFrame<L>) {
        let Triple(x, y, z) = state.position_m;
        let axis = (x.squared() + y.squared()).sqrt();
        let inward = law.ring_radius - axis;
        let lever = (inward.squared() + z.squared()).sqrt();
        // One division for two.
        let per_both = law.one / (axis * lever);
        let (per_axis, per_lever) = (per_both * lever, per_both * axis);
        let frame = RingFrame {
            cos_theta: x * per_axis,
            sin_theta: y * per_axis,
            cos_phi: inward * per_lever,
            sin_phi: z * per_lever,
        };
        let touch = Touch {
            compression: law.radius - lever,
            lever,
            v: frame.to_hoop(state.velocity_m_s),
            w: frame.to_hoop(state.spin_rad_s),
            g: Triple(
                -law.gravity * frame.sin_phi,
                -law.gravity * frame.cos_phi,
                law.zero,
            ),
            bend_1: per_lever,
            bend_2: -frame.cos_phi * per_axis,
        };
        (touch, frame)
    }

    #[inline(always)]
    fn to_space(self, frame: RingFrame<L>, vector: Triple<L>) -> Triple<L> {
        let outward = vector.1 * frame.sin_phi - vector.0 * frame.cos_phi;
        Triple(
            outward * frame.cos_theta - vector.2 * frame.sin_theta,
            outward * frame.sin_theta + vector.2 * frame.cos_theta,
            vector.0 * frame.sin_phi + vector.1 * frame.cos_phi,
        )
    }

    #[inline(always)]
    fn along_to_space(self, frame: RingFrame<L>, (first, second): (L, L)) -> Triple<L> {
        let outward = first * frame.sin_phi;
        Triple(
            outward * frame.cos_theta - second * frame.sin_theta,
            outward * frame.sin_theta + second * frame.cos_theta,
            first * frame.cos_phi,
        )
    }
}
