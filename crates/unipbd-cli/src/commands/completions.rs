//! `completions`: what a shell completes after `unipbd`.

use clap::CommandFactory;

use crate::args::{Arguments, CompletionsArgs};
use crate::exit::{Exit, Failure};
use crate::report::Console;

pub(super) fn completions(arguments: &CompletionsArgs, console: Console) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "unipbd", &mut script);
    console.line(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Exit::Success)
}
