//! The program `jabuka`: runs the command that its arguments name.

fn main() -> std::process::ExitCode {
    jabuka::cli::main()
}
