//! The ball in contact with one or two solids.

mod contact_pair;
pub(crate) mod contact_step;
mod coupled_oscillators;
pub(crate) mod friction;
pub(crate) mod oscillator;
pub(crate) mod other_solid_touch;
pub(crate) mod world_contact_step;
