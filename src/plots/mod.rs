//! Plots as SVG and PNG: maps of the court, maps of the releases, and single shots.
//!
//! The same input gives the same bytes on every machine and with any number of threads.

pub mod axes;
pub mod bank_direct_release_map;
pub mod best_by_pitch;
pub mod colormaps;
pub mod colour_key;
mod court_lines;
pub mod court_map;
pub mod measured_shots;
pub mod paper_figures;
pub mod physics_probabilities;
pub mod player_poster;
mod polyline_thinning;
pub mod probability_along_variable;
pub mod probability_curves;
pub mod rasterise;
pub mod rebound_map;
pub mod release_map;
pub mod session_changes;
pub mod shot_views;
pub mod shot_with_probability;
pub mod svg;
pub mod sweep_bank_direct_map;
pub mod sweep_best_shot_maps;
pub mod sweep_difference_map;
pub mod sweep_results;
pub mod team_maps;
