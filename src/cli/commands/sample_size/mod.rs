//! `bankshot sample-size`: what a test of some size will tell, before anyone shoots.

mod against;
mod changes;
mod designed_tests;
mod options;
mod tested_shot;
mod text_json;
mod tracker;

use self::designed_tests::DesignedTests;
use crate::answers::json::{self, document};
use crate::cli::failure::{Failure, code};
use crate::cli::terminal::{print_answer, print_next, print_text};

pub(crate) use options::SampleSizeOptions;

pub(crate) fn run(options: &SampleSizeOptions) -> Result<u8, Failure> {
    let tests = DesignedTests::simulate(options)?;
    if options.json {
        let answer = document(&tests.answer(&options.change), tests.units);
        return print_answer(&json::text(&answer));
    }
    print_text(&tests.text(options))?;
    print_next(None, "");
    Ok(code::DONE)
}
