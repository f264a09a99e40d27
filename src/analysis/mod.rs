//! What a shooter can learn from a shot: its aim, its sensitivity, how it is missed, and maps about
//! it.

pub mod aim_past_hoop;
pub mod bank_aim;
pub mod miss_breakdown;
pub mod probability_curves;
pub mod rebounds;
pub mod release_map;
pub mod sensitivity;
