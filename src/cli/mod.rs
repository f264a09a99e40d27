//! The command line: parses options, calls the library, prints answers. Only this module prints.

mod command_line;
mod commands;
mod config_files;
mod failure;
mod fit_folder;
mod measured_shots_flags;
mod nominal_shot_flags;
mod plot_files;
mod progress_bars;
mod run_folder;
mod signals;
mod terminal;
mod value_parsers;

use clap::{CommandFactory, Parser};
use command_line::{Arguments, Command};
use commands::{
    advise, best, check, compare, compare_sessions, design, figures, fit, new, physics, plan,
    probability, report, simulate, sweep, sweep_status, table, team, trace,
};
use failure::{Failure, code};
use std::process::ExitCode;

/// Runs the program. `--help` lists the exit codes.
pub(crate) fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let printed = error.print();
            return ExitCode::from(match (error.use_stderr(), printed) {
                (true, _) => code::USAGE,
                (false, Ok(())) => code::DONE,
                (false, Err(_)) => code::IO,
            });
        }
    };
    signals::handle();
    match std::panic::catch_unwind(|| run(&arguments)) {
        Ok(Ok(code)) => ExitCode::from(code),
        Ok(Err(failure)) => {
            terminal::print_error(&failure.message);
            ExitCode::from(failure.code)
        }
        Err(_) => {
            terminal::print_error(
                "this is a bug in bankshot; please report it with the command and its input",
            );
            ExitCode::from(code::BUG)
        }
    }
}

fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let quiet = arguments.quiet;
    if let Some(instructions) = arguments.simd {
        instructions.use_by_default();
    }
    let pool = thread_pool(arguments.threads)?;
    pool.install(|| match &arguments.command {
        Command::Best(options) => best::run(options, quiet),
        Command::Compare(options) => compare::run(options, quiet),
        Command::Fit(options) => fit::run(options, quiet),
        Command::Advise(options) => advise::run(options, quiet),
        Command::CompareSessions(options) => compare_sessions::run(options),
        Command::Design(options) => design::run(options, quiet),
        Command::New(options) => new::run(options, quiet),
        Command::Team(options) => team::run(options, quiet),
        Command::Table(options) => table::run(options, quiet),
        Command::Check(options) => check::run(options, quiet),
        Command::Physics(options) => physics::run(options, quiet),
        Command::Plan(options) => plan::run(options, quiet),
        Command::Probability(options) => probability::run(options, quiet),
        Command::Simulate(options) => simulate::run(options, quiet),
        Command::Sweep(options) => sweep::run(options, quiet),
        Command::Status(options) => sweep_status::status(options),
        Command::Verify(options) => sweep_status::verify(options, quiet),
        Command::Missing(options) => sweep_status::missing(options),
        Command::Merge(options) => sweep::merge(options, quiet),
        Command::Report(options) => report::run(options, quiet),
        Command::Figures { out } => figures::run(out, quiet),
        Command::Trace(options) => trace::run(options, quiet),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "bankshot", &mut script);
            terminal::print_bytes(&script)
        }
        Command::Man { command } => {
            terminal::print_bytes(manual_page(command.as_deref())?.as_bytes())
        }
    })
}

/// The manual page of the program, or of one of its commands.
fn manual_page(command: Option<&str>) -> Result<String, Failure> {
    let mut program = Arguments::command();
    program.build();
    let page = match command {
        None => program,
        Some(name) => program
            .find_subcommand(name)
            .filter(|_| name != "help")
            .cloned()
            .ok_or_else(|| Failure::usage(format!("man {name}: there is no such command")))?,
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page)
        .render(&mut text)
        .map_err(|error| Failure::io("the manual page", &error))?;
    // The page of a command is not installed under a name of its own: it is printed by `bankshot
    // man COMMAND`.
    let mut text = String::from_utf8_lossy(&text).into_owned();
    for command in Arguments::command().get_subcommands() {
        let name = command.get_name().replace('-', "\\-");
        text = text.replace(
            &format!("bankshot\\-{name}(1)"),
            &format!("bankshot {name} (see: bankshot man {name})"),
        );
    }
    Ok(text.replace("bankshot\\-help(1)", "bankshot help"))
}

/// The greatest number of threads for each core. More only cost time and memory.
const MAX_THREADS_PER_CORE: usize = 4;

fn thread_pool(threads: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = MAX_THREADS_PER_CORE * cores;
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, |threads| usize::from(threads).min(most)))
        .build()
        .map_err(|error| Failure {
            code: code::IO,
            message: format!("threads cannot be started: {error}"),
        })
}
