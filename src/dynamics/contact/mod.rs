//! The ball in contact with one or two solids.

pub(crate) mod contact_frame_step;
mod contact_pair;
mod coupled_oscillators;
pub(crate) mod friction;
pub(crate) mod oscillator;
pub(crate) mod other_solid_touch;
pub(crate) mod world_frame_step;
