//! The program `bankshot`: see `bankshot --help`.

fn main() -> std::process::ExitCode {
    bankshot::cli::main()
}
