//! The library against other authorities: closed forms, the paper, other integrators and other
//! methods, and published results. The authority is named in each module or test.
//!
//! Tests named `campaign_` take a minute or more and are ignored. Each has its command.

#[path = "../common/mod.rs"]
mod common;

mod fit_coverage;
mod integrators;
mod joint_coverage;
mod joint_decisions;
mod nominal_tables;
mod paper_figures;
mod probability_methods;
mod published;
mod real_hoop;
mod search;
mod sensitivity;
mod tracked_shots;
