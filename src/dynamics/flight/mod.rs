//! Free flight, and the first touch on it.
//!
//! Without air, at the paper's solids, an arc is a parabola and its events have nearly closed forms
//! ([`FlightEvents`]). Otherwise it is a sequence of polynomials ([`FlightSegment`]).

mod board_touch;
mod drag_polynomial;
mod drag_segment;
mod flight_path;
mod flight_segment;
pub(crate) mod height_crossing;
mod height_path;
mod lift_segment;
mod next_segment;
mod parabola_events;
mod ring_search;
mod safe_step;
mod undisturbed_flight;

pub(crate) use drag_segment::{drag_segment, far_segment, is_far};
pub(crate) use flight_path::FlightPath;
pub(crate) use flight_segment::FlightSegment;
pub(crate) use lift_segment::lift_segment;
pub(crate) use next_segment::next_segment;
pub(crate) use parabola_events::FlightEvents;
pub(crate) use undisturbed_flight::{
    UndisturbedFlight, falls_through, height_at_length_m, highest_point_m,
};
