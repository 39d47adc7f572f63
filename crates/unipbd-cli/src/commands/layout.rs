//! `layout`: a layout of Lichtblick and Foxglove for a log.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::Path;

use crate::args::LayoutArgs;
use crate::exit::{Exit, Failure};
use crate::layout::layout as layout_of;
use crate::read::{Log, LogError, Record, Records};
use crate::render::{RenderOptions, Survey, View};
use crate::report::Console;

pub(super) fn layout(arguments: &LayoutArgs, console: Console) -> Result<Exit, Failure> {
    let log = Log::open(&arguments.log)?;
    let text = format!("{:#}", layout_of(log.setting(), view(&log)?, &topics(&arguments.log)?, &log.header().gauges));
    let Some(path) = &arguments.output else {
        console.line(text)?;
        return Ok(Exit::Success);
    };
    if !arguments.force && path.symlink_metadata().is_ok() {
        return Err(Failure::usage(format!("{} exists already: choose another name or add --force", path.display())));
    }
    fs::write(path, text + "\n").map_err(|cause| Failure::io(format!("cannot write {}: {cause}", path.display())))?;
    console.note(format_args!("wrote {}; in the viewer: Layouts, Import from file", path.display()));
    Ok(Exit::Success)
}

/// The region that the scene names, or the one that holds all frames.
fn view(log: &Log) -> Result<View, Failure> {
    let setting = log.setting();
    if let Some((min, max)) = setting.view {
        return Ok(View { min, max });
    }
    let mut survey = Survey::new(setting, RenderOptions::default());
    for frame in log.frames()? {
        survey.include(&frame?.snapshot)?;
    }
    let found = survey.finish().view;
    Ok(found.unwrap_or(View { min: [0.0; 2], max: [1.0; 2] }))
}

fn topics(path: &Path) -> Result<Vec<String>, LogError> {
    let file = File::open(path).map_err(|cause| LogError::Io(path.to_owned(), cause))?;
    let mut records = Records::new(file, path)?;
    let mut topics = BTreeSet::new();
    while let Some(record) = records.next()? {
        if let Record::Channel { topic, .. } = record {
            topics.insert(topic);
        }
    }
    Ok(topics.into_iter().collect())
}
