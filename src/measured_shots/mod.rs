//! Files of measured shots: releases, landings or trajectories, with the columns of whoever wrote
//! them.

pub mod columns;
pub mod court_frame;
mod map_proposal;
pub mod read;
pub mod table;
