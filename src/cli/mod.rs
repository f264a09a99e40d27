//! The command line: parses options, calls the library, prints answers. Only this module prints.
//!
//! [`main`] is the program; [`answer_of`] runs one command inside another program.

mod command_line;
mod commands;
mod config_files;
mod embedded_session;
mod failure;
mod fit_folder;
mod fixed_value_flags;
mod loaded_profile;
mod measured_shots_flags;
mod nominal_shot_flags;
mod output_files;
mod plot_files;
mod profile_flags;
mod progress_bars;
mod run_folder;
mod scatter_flags;
mod signals;
mod terminal;
mod value_lists;
mod value_parsers;

use crate::probability::Progress;
use clap::{CommandFactory, FromArgMatches};
use command_line::{Arguments, Command};
#[cfg(feature = "studio")]
use commands::studio;
use commands::{
    advise, angles, best, check, coach, compare, figures, fit, map, new, physics, plan, report,
    sample_size, shot, simulate, sweep, sweep_status, table, team, trace,
};
use failure::{Failure, code};
use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;

pub use embedded_session::{CommandAnswer, stop};

/// Runs the program. `--help` lists the exit codes.
#[must_use]
pub fn main() -> ExitCode {
    ExitCode::from(main_with(std::env::args_os()))
}

/// Runs the program with other arguments than those of the process; the first is the name of the
/// program. Returns the exit code.
#[must_use]
pub fn main_with(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    if is_help_of_all(&arguments) {
        return match command_line::command(true).print_help() {
            Ok(()) => code::DONE,
            Err(_) => code::IO,
        };
    }
    let arguments = match parsed(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let printed = error.print();
            return match (error.use_stderr(), printed) {
                (true, _) => code::USAGE,
                (false, Ok(())) => code::DONE,
                (false, Err(_)) => code::IO,
            };
        }
    };
    signals::handle();
    progress_bars::begin_log();
    run_caught(&arguments)
}

/// The arguments, read.
fn parsed(arguments: impl IntoIterator<Item = OsString>) -> Result<Arguments, clap::Error> {
    let command = command_line::command(false);
    let matches = command.try_get_matches_from(arguments)?;
    Arguments::from_arg_matches(&matches)
}

/// Whether all commands are asked for: `bankshot help --all`.
fn is_help_of_all(arguments: &[OsString]) -> bool {
    let words: Vec<&str> = arguments
        .iter()
        .skip(1)
        .filter_map(|word| word.to_str())
        .collect();
    words == ["help", "--all"] || words == ["--help", "--all"]
}

/// Runs a command inside another program: its answer is returned instead of printed. The first
/// argument is the name of the program. One command runs at a time; `progress` may end it with
/// [`stop`].
#[must_use]
pub fn answer_of(arguments: &[String], progress: Arc<dyn Progress + Send>) -> CommandAnswer {
    let arguments = arguments.iter().map(OsString::from);
    embedded_session::run(progress, || match parsed(arguments) {
        Ok(arguments) => run_caught(&arguments),
        Err(error) => {
            let text = error.render().to_string();
            if error.use_stderr() {
                terminal::print_remark(text.trim_end());
                code::USAGE
            } else {
                terminal::print_answer(&text).unwrap_or(code::IO)
            }
        }
    })
}

/// How the studio runs the commands.
#[cfg(feature = "studio")]
const STUDIO_COMMANDS: crate::studio::Commands = crate::studio::Commands {
    run: |arguments, progress| {
        let answer = answer_of(arguments, progress);
        crate::studio::Finished {
            exit_code: answer.exit_code,
            answer: answer.answer,
            remarks: answer.remarks,
        }
    },
    stop,
};

/// Runs a command. Its exit code; what failed is printed.
fn run_caught(arguments: &Arguments) -> u8 {
    match std::panic::catch_unwind(|| run(arguments)) {
        Ok(Ok(code)) => code,
        Ok(Err(failure)) => {
            terminal::print_error(&failure.message);
            failure.code
        }
        Err(payload) if embedded_session::is_stop(payload.as_ref()) => {
            terminal::print_remark("stopped");
            code::INTERRUPTED
        }
        Err(_) => {
            terminal::print_error(
                "this is a bug in bankshot; please report it with the command and its input",
            );
            code::BUG
        }
    }
}

fn run(arguments: &Arguments) -> Result<u8, Failure> {
    terminal::set_quiet(arguments.quiet);
    terminal::set_details(arguments.details);
    if let Some(instructions) = arguments.simd {
        instructions.use_by_default();
    }
    let pool = thread_pool(arguments.threads)?;
    pool.install(|| match &arguments.command {
        Command::Best(options) => best::run(options),
        Command::Map(options) => map::run(options),
        Command::Fit(options) => fit::run(options),
        Command::Advise(options) => advise::run(options),
        Command::Compare(options) => compare::run(options),
        Command::SampleSize(options) => sample_size::run(options),
        Command::New(options) => new::run(options),
        Command::Coach(options) => coach::run(options),
        Command::Team(options) => team::run(options),
        Command::Table(options) => table::run(options),
        Command::Check(options) => check::run(options),
        Command::Angles(options) => angles::run(options),
        Command::Physics(options) => physics::run(options),
        Command::Plan(options) => plan::run(options),
        Command::Shot(options) => shot::run(options),
        Command::Simulate(options) => simulate::run(options),
        Command::Sweep(options) => sweep::run(options),
        Command::Status(options) => sweep_status::status(options),
        Command::Verify(options) => sweep_status::verify(options),
        Command::Missing(options) => sweep_status::missing(options),
        Command::Merge(options) => sweep::merge(options),
        Command::Report(options) => report::run(options),
        #[cfg(feature = "studio")]
        Command::Studio(options) => studio::run(options, STUDIO_COMMANDS),
        Command::Figures { out } => figures::run(out),
        Command::Trace(options) => trace::run(options),
        Command::Schema => {
            terminal::print_answer(&format!("{:#}\n", crate::config::schema::schema()))
        }
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
            .ok_or_else(|| {
                let program = Arguments::command();
                let names = program.get_subcommands().map(clap::Command::get_name);
                let meant = crate::units::suggestion(name, names);
                Failure::usage(format!("man {name}: there is no such command{meant}"))
            })?,
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
    // What rayon's own variable asks for is bounded too.
    let wanted = std::env::var("RAYON_NUM_THREADS").ok();
    let wanted = wanted.and_then(|text| text.parse().ok());
    let wanted = threads.map(usize::from).or(wanted).unwrap_or(0);
    rayon::ThreadPoolBuilder::new()
        .num_threads(wanted.min(most))
        .build()
        .map_err(|error| Failure {
            code: code::IO,
            message: format!("threads cannot be started: {error}"),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::Silent;

    struct StopAtOnce;

    impl Progress for StopAtOnce {
        fn begin(&self, _stage: &str, _total: u64) {}
        fn advance(&self, _units: u64) {
            stop();
        }
        fn end(&self) {}
    }

    fn arguments(words: &[&str]) -> Vec<String> {
        words.iter().map(|word| (*word).to_owned()).collect()
    }

    #[test]
    fn contract_an_embedded_command_answers_fails_and_can_be_stopped() {
        let silent = || Arc::new(Silent);
        let profile = concat!(env!("CARGO_MANIFEST_DIR"), "/configs/free_throw.toml");
        let answer = answer_of(&arguments(&["bankshot", "check", profile]), silent());
        assert_eq!(answer.exit_code, 0);
        assert!(String::from_utf8(answer.answer).unwrap().contains("valid"));
        let faulty = answer_of(&arguments(&["bankshot", "check", "no.toml"]), silent());
        assert_eq!(faulty.exit_code, 2);
        assert!(faulty.remarks.contains("no.toml"), "{faulty:?}");
        let unknown = answer_of(&arguments(&["bankshot", "chek"]), silent());
        assert_eq!(unknown.exit_code, 2);
        let command = ["bankshot", "probability", profile, "--speed", "24 ft/s"];
        let shot = [
            "--pitch",
            "53 deg",
            "--backspin",
            "3 rev/s",
            "--target",
            "1e-5",
        ];
        let command = [&command[..], &shot].concat();
        let stopped = answer_of(&arguments(&command), Arc::new(StopAtOnce));
        assert_eq!(stopped.exit_code, code::INTERRUPTED);
        assert_eq!(stopped.remarks, "stopped\n");
    }
}
