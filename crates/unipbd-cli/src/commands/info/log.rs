//! Information about the contents of a log.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::{Value, json};
use unipbd_core::observe::Diagnostics;
use unipbd_core::phase::Phase;

use crate::exit::{Exit, Failure};
use crate::read::{Log, LogError, Traffic, topics};
use crate::report::clean::one_line;
use crate::report::format::{bytes, count, percent, plural};
use crate::report::json::Numbers;
use crate::report::{Console, Form};

/// Information that needs a walk through the whole log.
#[derive(Debug, Default)]
struct Content {
    frames: u64,
    start: f64,
    end: f64,
    particles: u64,
    events: u64,
    last: Option<Diagnostics>,
    last_hash: Option<u64>,
    truncated: bool,
    topics: BTreeMap<String, Traffic>,
}

pub(super) fn info(path: &Path, console: Console) -> Result<Exit, Failure> {
    let log = Log::open(path)?;
    let mut content = read_frames(&log)?;
    content.topics = topics(path)?;
    let size = path.metadata().map_or(0, |metadata| metadata.len());
    match console.form {
        Form::Json => console.object(&object(&log, &content, size))?,
        Form::Text => console.line(text(&log, &content, size))?,
    }
    Ok(Exit::Success)
}

fn read_frames(log: &Log) -> Result<Content, LogError> {
    let mut content = Content::default();
    let mut frames = log.frames()?;
    for frame in frames.by_ref() {
        let frame = frame?;
        if content.frames == 0 {
            content.start = frame.snapshot.time;
        }
        content.frames += 1;
        content.end = frame.snapshot.time;
        content.particles = frame.snapshot.positions.len() as u64;
        content.events += frame.events.len() as u64;
        if frame.diagnostics.is_some() {
            (content.last, content.last_hash) = (frame.diagnostics, frame.state_hash);
        }
    }
    content.truncated = frames.truncated();
    Ok(content)
}

fn text(log: &Log, content: &Content, size: u64) -> String {
    let header = log.header();
    let setting = log.setting();
    let mut lines = vec![{
        let name = if setting.name.is_empty() { log.path().display().to_string() } else { setting.name.clone() };
        one_line(&name).into_owned()
    }];
    lines.push(format!(
        "  duration    {} s, {} of 1/{} s",
        (1e6 * (content.end - content.start)).round() / 1e6,
        plural(content.frames, "frame"),
        header.fps
    ));
    if content.truncated {
        lines.push("              cut off: the run was killed, or is still going".into());
    }
    lines.push(format!("  size        {}{}", bytes(size), per_particle(content, size)));
    lines.push(format!("  spacing     {} m, seed {}", setting.spacing, header.seed));
    lines.push(format!("  materials   {}", materials(log)));
    let fields = log.fields().to_string();
    lines.push(format!("  fields      {}", if fields.is_empty() { "none besides positions" } else { &fields }));
    if !header.overrides.is_empty() {
        lines.push(format!("  changes     {}", one_line(&header.overrides.join(", "))));
    }
    lines.push(format!("  written by  unipbd {}, scene sha256 {}", one_line(log.version()), header.scene_sha256()));
    lines.push("  topics      sizes before compression".into());
    for (name, traffic) in &content.topics {
        let messages = plural(traffic.messages, "message");
        let name = one_line(name);
        lines.push(format!("    {name:<20} {messages:>16}  {:>8}", bytes(traffic.bytes)));
    }
    if let Some(last) = &content.last {
        lines.extend(last_lines(last, content));
    }
    lines.join("\n")
}

fn materials(log: &Log) -> String {
    let named = log.setting().materials.iter();
    named
        .map(|material| format!("{} ({})", one_line(&material.name), material.phase.name()))
        .collect::<Vec<_>>()
        .join(", ")
}

fn per_particle(content: &Content, size: u64) -> String {
    let points = content.topics.get("/particles").map_or(0, |traffic| traffic.bytes / 16);
    if points == 0 { String::new() } else { format!(", {:.1} B per particle and frame", size as f64 / points as f64) }
}

fn last_lines(last: &Diagnostics, content: &Content) -> Vec<String> {
    let held: Vec<String> = Phase::ALL
        .into_iter()
        .filter(|phase| last.count(*phase) > 0)
        .map(|phase| format!("{} {}", count(last.count(phase)), phase.name()))
        .collect();
    let mut lines = vec![
        format!("  at the end ({:.3} s)", last.time),
        format!("    particles      {} ({})", count(content.particles), held.join(", ")),
        format!(
            "    density error  {} mean, {} worst",
            percent(last.density_error_mean),
            percent(last.density_error_max)
        ),
        format!("    substeps       {} a frame, {} in all", last.substeps, count(last.step)),
        format!("    energy         {:.4e} J kinetic, {:.4e} J potential", last.kinetic_energy, last.potential_energy),
        format!("    largest speed  {:.3} m/s", last.speed_max),
    ];
    lines.extend(last.gauges.iter().map(|gauge| {
        let name = one_line(&gauge.name);
        match gauge.value.is_nan() {
            true => format!("    gauge {name}: nothing to read"),
            false => format!("    gauge {name}: {} {}", rounded(gauge.value), gauge.kind.unit()),
        }
    }));
    if let Some(hash) = content.last_hash {
        lines.push(format!("    state hash     {hash:016x}"));
    }
    lines
}

/// A reading with five digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

fn object(log: &Log, content: &Content, size: u64) -> Value {
    let (header, setting) = (log.header(), log.setting());
    let materials = setting.materials.iter().map(|material| {
        json!({
            "name": material.name,
            "phase": material.phase.name(),
            "density": material.density,
            "color": material.color,
        })
    });
    let topics = content
        .topics
        .iter()
        .map(|(name, traffic)| (name.clone(), json!({ "messages": traffic.messages, "bytes": traffic.bytes })));
    json!({
        "type": "log",
        "path": log.path().display().to_string(),
        "name": setting.name,
        "version": log.version(),
        "sha256": header.scene_sha256(),
        "overrides": header.overrides,
        "seed": header.seed,
        "fps": header.fps,
        "spacing": setting.spacing,
        "gravity": header.gravity,
        "fields": log.fields().to_string(),
        "bytes": size,
        "truncated": content.truncated,
        "frames": content.frames,
        "duration": content.end - content.start,
        "particles": content.particles,
        "events": content.events,
        "materials": materials.collect::<Vec<_>>(),
        "topics": topics.collect::<serde_json::Map<_, _>>(),
        "last": content.last.as_ref().map(|last| last_line(last, content)),
    })
}

/// The numbers of a frame as `run --json` has them, and the hash of its state.
#[derive(Serialize)]
struct LastLine<'a> {
    #[serde(flatten)]
    numbers: Numbers<'a>,
    state_hash: Option<String>,
}

fn last_line<'a>(last: &'a Diagnostics, content: &Content) -> LastLine<'a> {
    LastLine { numbers: Numbers(last), state_hash: content.last_hash.map(|hash| format!("{hash:016x}")) }
}
