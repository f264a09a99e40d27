//! Files of measured shots: releases, landings or trajectories, with the columns of whoever wrote
//! them.

mod column_map_proposal;
pub mod columns;
pub mod court_frame;
mod implausible_columns;
pub mod read;
pub mod table;
