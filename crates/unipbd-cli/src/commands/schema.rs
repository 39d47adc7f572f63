//! `schema`: the format of scene files for editors.

use crate::exit::{Exit, Failure};
use crate::report::Console;
use crate::scene_file;

pub(super) fn schema(console: Console) -> Result<Exit, Failure> {
    console.line(format_args!("{:#}", scene_file::schema()))?;
    Ok(Exit::Success)
}
