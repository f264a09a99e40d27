//! Files of measured shots: releases, landings or trajectories, with the columns of whoever wrote
//! them.

pub mod column_map_proposal;
mod column_texts;
pub mod columns;
pub mod court_frame;
pub mod decisions;
mod implausible_columns;
pub mod made_or_missed;
mod other_units;
mod places;
pub mod read;
pub mod rejected_shots;
mod row_reader;
pub mod session_days;
pub mod shooter_shots;
mod shots_by_place;
pub mod source;
pub mod table;
mod tracked_shots;
