//! The ball in contact with one or two solids.

pub(crate) mod contact_step;
pub(crate) mod double;
pub(crate) mod event_time;
pub(crate) mod friction;
pub(crate) mod normal_force;
pub(crate) mod oscillator;
pub(crate) mod other_solid_touch;
