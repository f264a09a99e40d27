//! Plots and report pages: the same bytes every time, none in `docs/` out of date, and safe with
//! any name.
#![cfg(feature = "app")]

mod browser;
#[path = "../common/mod.rs"]
mod common;
mod compare_command;
mod figures;
mod half_court;
mod places;
mod release_maps;
mod report_pages;
mod shot_plots;
mod support;
mod terminal;
