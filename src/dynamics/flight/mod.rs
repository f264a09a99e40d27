//! Free flight: parabolas, and the first touch on them.

mod flight_events;
mod board_touch;
pub(crate) mod height_crossing;
mod ring_search;

pub(crate) use flight_events::FlightArc;
