//! Free flight: parabolas, and the first touch on them.

mod arc;
mod board_touch;
pub(crate) mod parabola;
mod ring_search;

pub(crate) use arc::FlightArc;
