//! The constants of [`Physics`] in the form that the equations use: per unit of ball mass, and one copy
//! for each lane.

use super::ball_params::BallParams;
use super::physics::Physics;
use super::solids::{Board, Material, Ring, SolidId};
use crate::math::real::Real;

/// The parameters of the equations of motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ModelParams<T = f64> {
    pub(crate) ball: BallParams<T>,
    pub(crate) board: Board<T>,
    pub(crate) ring: Ring<T>,
}

impl ModelParams {
    /// The parameters of a valid physics.
    pub(crate) fn new(physics: &Physics) -> Self {
        let radius = physics.ball_radius_m;
        let inertia = physics.inertia_ratio * radius * radius;
        let half_height = 0.5 * physics.board_height_m;
        let material = |_: SolidId| Material {
            stiffness: physics.stiffness_n_m / physics.ball_mass_kg,
            damping: physics.damping_kg_s / physics.ball_mass_kg,
            relaxation_time: physics.damping_kg_s / physics.stiffness_n_m,
            friction_coefficient: physics.friction,
        };
        Self {
            ball: BallParams {
                radius,
                mass_over_inertia: 1.0 / inertia,
                gravity: physics.gravity_m_s2,
                half_gravity: 0.5 * physics.gravity_m_s2,
                inverse_gravity: 1.0 / physics.gravity_m_s2,
                never_s: 1e9,
            },
            board: Board {
                touch_x: radius - physics.board_distance_m,
                face_x: -physics.board_distance_m,
                half_width: 0.5 * physics.board_width_m,
                bottom_z: physics.board_centre_height_m - half_height,
                top_z: physics.board_centre_height_m + half_height,
                material: material(SolidId::Board),
            },
            ring: Ring {
                radius: physics.ring_radius_m,
                material: material(SolidId::Ring),
            },
        }
    }

    /// The same parameters in every lane; `splat` makes the lanes.
    #[inline(always)]
    pub(crate) fn map<T: Real>(&self, splat: impl Fn(f64) -> T) -> ModelParams<T> {
        ModelParams {
            ball: self.ball.map(&splat),
            board: self.board.map(&splat),
            ring: self.ring.map(&splat),
        }
    }
}

impl<T: Real> ModelParams<T> {
    /// `value` in every lane.
    #[inline(always)]
    pub(crate) fn splat(&self, value: f64) -> T {
        self.ball.splat(value)
    }
    #[inline(always)]
    pub(crate) fn zero(&self) -> T {
        self.ball.zero()
    }
    #[inline(always)]
    pub(crate) fn one(&self) -> T {
        self.ball.one()
    }
    /// `value` in every lane of a mask.
    #[inline(always)]
    pub(crate) fn splat_mask(&self, value: bool) -> T::Mask {
        self.ball.splat_mask(value)
    }
}
