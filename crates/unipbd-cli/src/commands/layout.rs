//! `layout`: a layout of Lichtblick and Foxglove for a log; `run --layout` writes the same.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use serde_json::Value;

use crate::args::LayoutArgs;
use crate::exit::{Exit, Failure};
use crate::layout::{is_layout, layout as layout_of};
use crate::read::{Log, topics};
use crate::record::{Fields, Header};
use crate::render::{RenderOptions, Survey, View};
use crate::report::Console;
use crate::simulation::Simulation;

/// Most bytes of a file that may be a layout.
const LARGEST: u64 = 1 << 20;

pub(super) fn layout(arguments: &LayoutArgs, console: Console) -> Result<Exit, Failure> {
    let layout = of_log(&arguments.log)?;
    let Some(path) = &arguments.output else {
        console.line(format_args!("{layout:#}"))?;
        return Ok(Exit::Success);
    };
    check_free(path, arguments.force)?;
    write(path, &layout)?;
    console.note(format_args!("wrote {}; in the viewer: Layouts, Import from file", path.display()));
    Ok(Exit::Success)
}

/// The layout that fits a log.
pub(super) fn of_log(path: &Path) -> Result<Value, Failure> {
    let log = Log::open(path)?;
    let names: Vec<String> = topics(path)?.into_keys().collect();
    Ok(layout_of(log.setting(), view(&log)?, &names, &log.header().gauges))
}

/// The layout that fits the first frame of a run.
pub(super) fn of_start(simulation: &Simulation, header: &Header) -> Value {
    let setting = &header.setting;
    let of_scene = setting.view.map(|(min, max)| View { min, max });
    let view = of_scene.unwrap_or_else(|| View::fit(setting, [&simulation.snapshot(Fields::default())]));
    layout_of(setting, view, &["/boundary", "/particles", "/scene"].map(String::from), &header.gauges)
}

/// Refuses to replace what is no layout of ours.
pub(super) fn check_free(path: &Path, force: bool) -> Result<(), Failure> {
    if force || path.symlink_metadata().is_err() || is_ours(path) {
        return Ok(());
    }
    let path = path.display();
    Err(Failure::usage(format!("{path} exists already and is no layout of unipbd: choose another name or add --force")))
}

fn is_ours(path: &Path) -> bool {
    // Of a pipe one would read for ever.
    let is_file = path.metadata().is_ok_and(|found| found.is_file());
    let text = || {
        let mut text = Vec::new();
        File::open(path).ok()?.take(LARGEST).read_to_end(&mut text).ok()?;
        serde_json::from_slice(&text).ok()
    };
    is_file && text().is_some_and(|found: Value| is_layout(&found))
}

/// Writes a layout.
pub(super) fn write(path: &Path, layout: &Value) -> Result<(), Failure> {
    fs::write(path, format!("{layout:#}\n"))
        .map_err(|cause| Failure::io(format!("cannot write {}: {cause}", path.display())))
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
