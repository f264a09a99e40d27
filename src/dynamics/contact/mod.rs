//! The ball in contact with one or two solids.

pub(crate) mod approach;
pub(crate) mod double;
pub(crate) mod event_time;
pub(crate) mod friction;
pub(crate) mod macro_step;
pub(crate) mod normal_force;
pub(crate) mod oscillator;
