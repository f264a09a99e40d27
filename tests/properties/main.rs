//! Symmetries and invariants that every right solution has.

#[path = "../common/mod.rs"]
mod common;

mod best_shot;
mod mechanics;
mod probability;
mod relations;
