//! The constants of [`Physics`] in the form that the equations use: per unit of ball mass, and one
//! copy for each lane.

use super::ball_params::BallParams;
use super::physics::{BoardEdge, Physics};
use super::solids::{Board, Material, Rectangle, Ring, SolidId};
use crate::math::real::Real;
use crate::math::vector::Vec3;

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
        let gravity = physics.gravity_less_buoyancy_m_s2();
        let (drag, lift) = (physics.drag_per_m(), physics.lift_factor());
        Self {
            ball: BallParams {
                radius,
                mass_over_inertia: 1.0 / inertia,
                gravity,
                half_gravity: 0.5 * gravity,
                inverse_gravity: 1.0 / gravity,
                drag,
                drag_strength: (drag.sqrt() / gravity).sqrt(),
                lift,
                has_air: drag != 0.0 || lift != 0.0,
                has_lift: lift != 0.0,
                never_s: 1e9,
            },
            board: board(physics),
            ring: ring(physics),
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
    /// Whether arcs of flight are parabolas that end at the paper's solids: then the first touch
    /// has nearly a closed form.
    #[inline(always)]
    pub(crate) fn has_paper_flight(&self) -> bool {
        !self.ball.has_air && !self.board.has_edges && !self.ring.has_bracket
    }

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

fn material(physics: &Physics, solid: SolidId) -> Material<f64> {
    let contact = physics.contact(solid);
    Material {
        stiffness: contact.stiffness_n_m / physics.ball_mass_kg,
        damping: contact.damping_kg_s / physics.ball_mass_kg,
        relaxation_time: contact.damping_kg_s / contact.stiffness_n_m,
        friction_coefficient: contact.friction,
    }
}

fn board(physics: &Physics) -> Board {
    let edge = physics.board_edge.radius_m();
    let half_width = 0.5 * physics.board_width_m - edge;
    let half_height = 0.5 * physics.board_height_m - edge;
    let centre_z = physics.board_centre_z_m();
    let (bottom_z, top_z) = (centre_z - half_height, centre_z + half_height);
    let core_x = -physics.board_distance_m - edge;
    Board {
        touch_x: physics.ball_radius_m - physics.board_distance_m,
        face_x: -physics.board_distance_m,
        half_width,
        bottom_z,
        top_z,
        core: Rectangle {
            low: Vec3::new(core_x, -half_width, bottom_z),
            high: Vec3::new(core_x, half_width, top_z),
            reach: physics.ball_radius_m + edge,
            radius: edge,
        },
        has_edges: physics.board_edge != BoardEdge::None,
        material: material(physics, SolidId::Board),
    }
}

fn ring(physics: &Physics) -> Ring {
    let tube = physics.ring_tube_radius_m();
    let half_width = 0.5 * physics.bracket_width_m;
    let reach = physics.ball_radius_m + tube;
    Ring {
        radius: physics.ring_radius_m,
        tube_radius: tube,
        reach,
        bracket: Rectangle {
            low: Vec3::new(-physics.board_distance_m, -half_width, 0.0),
            high: Vec3::new(-physics.ring_radius_m, half_width, 0.0),
            reach,
            radius: tube,
        },
        has_bracket: physics.bracket_width_m > 0.0,
        material: material(physics, SolidId::Ring),
    }
}
