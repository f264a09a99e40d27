//! The command line: arguments in, work called, answers out. Only this layer prints.

mod arguments;
mod best;
mod compare;
mod failure;
mod nominal;
mod plan;
mod probability;
mod progress;
mod report;
mod signals;
mod simulate;
mod sweep;
mod terminal;
mod trace;

use arguments::{Arguments, Command};
use clap::{CommandFactory, Parser};
use failure::{Failure, code};
use std::process::ExitCode;

/// Runs the program; the exit code is documented in `--help`.
pub(crate) fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let printed = error.print();
            return ExitCode::from(match (error.use_stderr(), printed) {
                (true, _) => code::USAGE,
                (false, Ok(())) => code::WHOLE,
                (false, Err(_)) => code::IO,
            });
        }
    };
    signals::watch();
    let result = std::panic::catch_unwind(|| run(&arguments));
    match result {
        Ok(Ok(code)) => ExitCode::from(code),
        Ok(Err(failure)) => {
            terminal::complain(&failure.message);
            ExitCode::from(failure.code)
        }
        Err(_) => {
            terminal::complain(
                "this is a bug in bankshot; please report it with the command and its input",
            );
            ExitCode::from(code::BUG)
        }
    }
}

fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let pool = thread_pool(arguments.threads)?;
    pool.install(|| match &arguments.command {
        Command::Best(options) => best::run(options, arguments.quiet),
        Command::Compare(options) => compare::run(options, arguments.quiet),
        Command::Check(options) => plan::check(options),
        Command::Plan(options) => plan::run(options, arguments.quiet),
        Command::Probability(options) => probability::run(options, arguments.quiet),
        Command::Simulate(options) => simulate::run(options, arguments.quiet),
        Command::Sweep(options) => sweep::run(options, arguments.quiet),
        Command::Status(options) => sweep::status(options),
        Command::Verify(options) => sweep::verify(options, arguments.quiet),
        Command::Missing(options) => sweep::missing(options),
        Command::Merge(options) => sweep::merge(options, arguments.quiet),
        Command::Report(options) => report::run(options, arguments.quiet),
        Command::Figures { out } => compare::figures(out, arguments.quiet),
        Command::Trace(options) => trace::run(options, arguments.quiet),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "bankshot", &mut script);
            terminal::answer_bytes(&script)
        }
        Command::Man => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Arguments::command())
                .render(&mut page)
                .map_err(|error| Failure::io("the man page", &error))?;
            terminal::answer_bytes(&page)
        }
    })
}

fn thread_pool(threads: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure {
            code: code::IO,
            message: format!("threads cannot be started: {error}"),
        })
}
