//! The commands, one file each, and the text that some of them share.

pub(super) mod advise;
pub(super) mod angles;
pub(super) mod best;
pub(super) mod check;
pub(super) mod coach;
pub(super) mod compare;
pub(super) mod figures;
pub(super) mod fit;
pub(super) mod map;
pub(super) mod new;
pub(super) mod physics;
pub(super) mod plan;
mod plan_sweep_time_and_memory;
pub(super) mod report;
pub(super) mod sample_size;
pub(super) mod shot;
pub(super) mod simulate;
#[cfg(feature = "studio")]
pub(super) mod studio;
pub(super) mod sweep;
pub(super) mod sweep_status;
mod sweep_summary;
pub(super) mod table;
pub(super) mod team;
pub(super) mod trace;
mod trace_text;
