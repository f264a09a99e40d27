//! What the library promises: results that depend on nothing but the input, errors for invalid
//! input, and values that change only with a note in the change log.

#[path = "../common/mod.rs"]
mod common;

mod instruction_sets;
mod invalid_input;
mod profiles;
mod regressions;
mod sample_replay;
mod threads;
