//! The integrators of the equations of motion.

pub(crate) mod event_driven;
pub(crate) mod paper_rk4;
pub(crate) mod shot_in_frame;
pub(crate) mod shot_in_world;
pub(crate) mod shot_progress;
