//! The program `jabuka`: runs the command that its arguments name.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
