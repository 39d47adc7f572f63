//! The `unipbd` command line as a library: scene files, runs, logs, pictures.

pub mod args;
mod commands;
mod exit;
pub mod expect;
pub mod export;
pub mod instruction_set;
mod interrupt;
pub mod layout;
#[cfg(feature = "live")]
pub mod live;
pub mod read;
pub mod record;
pub mod render;
mod report;
pub mod simulation;
pub mod snapshot;
pub mod threads;

use std::ffi::OsString;

use clap::Parser;

pub use exit::Exit;
pub use unipbd_scene_file as scene_file;

/// Runs the command line with these arguments, the first of which is the name of the program.
///
/// Prints to standard output and standard error, and listens to Ctrl-C while a scene runs.
pub fn main_with_args(arguments: impl IntoIterator<Item = OsString>) -> Exit {
    let parsed = match args::with_default_command(arguments) {
        Ok(arguments) => args::Arguments::try_parse_from(arguments),
        Err(failure) => return report(&report::Console::new(&args::OutputArgs::default()), &failure),
    };
    match parsed {
        Ok(parsed) => {
            let console = report::Console::new(&parsed.output);
            if let Err(message) = instruction_set::from_environment() {
                return report(&console, &exit::Failure::usage(message));
            }
            commands::execute(&parsed.command, console).unwrap_or_else(|failure| report(&console, &failure))
        }
        Err(error) => {
            // Help and version are no errors; a closed pipe is nobody's fault.
            let _ = error.print();
            if error.use_stderr() { Exit::Usage } else { Exit::Success }
        }
    }
}

fn report(console: &report::Console, failure: &exit::Failure) -> Exit {
    match failure.label {
        exit::Label::Error => console.error(&failure.message),
        exit::Label::Own => console.raw(&failure.message),
        exit::Label::None => (),
    }
    failure.exit
}
