//! The `inroads` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    inroads::cli::main()
}
