//! Free flight: parabolas, and the first touch on them.

mod board_touch;
mod flight_events;
pub(crate) mod height_crossing;
mod ring_search;

pub(crate) use flight_events::FlightEvents;
