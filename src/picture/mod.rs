//! Results that people look at: maps of the court and of the releases, and single shots, as SVG and PNG.

pub mod colours;
pub mod comparison;
pub mod court_map;
pub mod curves;
pub mod figures;
pub mod frame;
pub mod release_map;
pub mod report;
pub mod shot;
pub mod svg;
pub mod sweep_maps;
