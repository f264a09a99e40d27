//! The physical model: constants, geometry of the solids, and the state of the ball.

pub(crate) mod ball_params;
mod ball_state;
pub(crate) mod constants_per_ball_mass;
pub mod league_courts;
pub mod named_places;
mod physics;
mod restitution;
pub(crate) mod solids;

pub use ball_state::BallState;
pub(crate) use ball_state::StateDerivative;
mod physics_checks;
mod physics_constants;
mod physics_error;
mod physics_presets;
mod physics_values;
pub use physics::{Air, BoardEdge, ContactLaw, Physics};
pub use physics_constants::{CONSTANTS, Constant};
pub use physics_error::PhysicsError;
pub use physics_presets::{DEFAULT_PRESET, PRESETS, Preset};
pub use physics_values::PhysicsValue;
pub use restitution::{contact_time_s, damping_for_restitution_kg_s, restitution_of_damping};
pub use solids::SolidId;
