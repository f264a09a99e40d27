//! The program `bankshot`: see `bankshot --help`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
