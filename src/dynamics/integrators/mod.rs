//! The integrators of the equations of motion.

pub(crate) mod event_driven;
pub(crate) mod paper_rk4;
