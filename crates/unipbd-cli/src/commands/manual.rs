//! `man`: manual pages.

use std::path::Path;

use clap::CommandFactory;
use clap_mangen::Man;

use crate::args::{Arguments, ManArgs};
use crate::exit::{Exit, Failure};
use crate::report::Console;

pub(super) fn manual(arguments: &ManArgs, console: Console) -> Result<Exit, Failure> {
    match &arguments.directory {
        Some(folder) => {
            clap_mangen::generate_to(Arguments::command(), folder).map_err(|error| unwritten(folder, &error))?
        }
        None => {
            let mut page = Vec::new();
            // Writing into memory does not fail.
            let _ = Man::new(Arguments::command()).render(&mut page);
            console.line(String::from_utf8_lossy(&page).trim_end())?;
        }
    }
    Ok(Exit::Success)
}

fn unwritten(folder: &Path, error: &std::io::Error) -> Failure {
    Failure::new(Exit::Io, format!("manual pages cannot be written into {}: {error}", folder.display()))
}
