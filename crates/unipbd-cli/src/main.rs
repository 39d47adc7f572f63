//! The `unipbd` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    unipbd_cli::main_with_args(std::env::args_os()).into()
}
