//! `info`: what is in a scene or a log.

mod log;
mod scene;

pub(super) use scene::bodies;

use crate::args::{InfoArgs, is_log};
use crate::exit::{Exit, Failure};
use crate::report::Console;

pub(super) fn info(arguments: &InfoArgs, console: Console) -> Result<Exit, Failure> {
    if !is_log(&arguments.path) {
        return scene::info(&arguments.path, &arguments.changes, console);
    }
    arguments.changes.refuse_for_log()?;
    log::info(&arguments.path, console)
}
