//! `recover`: the log of a run that was killed, made complete.

use crate::args::RecoverArgs;
use crate::exit::{Exit, Failure};
use crate::read::Log;
use crate::record::{Destination, Existing, Recorder};
use crate::report::format::plural;
use crate::report::{Console, Counter, Form};

pub(super) fn recover(arguments: &RecoverArgs, console: Console) -> Result<Exit, Failure> {
    let log = Log::open(&arguments.log)?;
    if log.totals().is_some() && arguments.output.is_none() {
        console.note(format_args!("{} is complete: nothing to do", arguments.log.display()));
        return Ok(Exit::Success);
    }
    let destination = match &arguments.output {
        None => Destination::explicit(&arguments.log, Existing::Replace)?,
        Some(path) => {
            let existing = if arguments.force { Existing::Replace } else { Existing::Refuse };
            Destination::explicit(path, existing)?.sparing(&arguments.log)?
        }
    };
    let (frames, damage) = copy(&log, &destination, console)?;
    if let Some(damage) = damage {
        if arguments.output.is_none() {
            let _ = std::fs::remove_file(destination.written());
            return Err(Failure::io(format!(
                "{damage}\nhint: -o NEW.mcap keeps the {} before it in a new log",
                plural(frames, "frame")
            )));
        }
        console.warning(damage);
    }
    let path = destination.commit()?;
    match console.form {
        Form::Json => console.object(&serde_json::json!({
            "type": "recovered", "path": path.display().to_string(), "frames": frames,
        }))?,
        Form::Text => console.note(format_args!("wrote {} with {}", path.display(), plural(frames, "frame"))),
    }
    Ok(Exit::Success)
}

/// Writes the frames of a log again; the number of frames, and what ended them before the end of the file.
fn copy(log: &Log, destination: &Destination, console: Console) -> Result<(u64, Option<String>), Failure> {
    let mut recorder = Recorder::create(destination.written(), log.header(), log.fields())?;
    let counter = Counter::new(console, "recovering", None);
    let (mut count, mut damage) = (0, None);
    for frame in log.frames()? {
        match frame {
            Ok(frame) => {
                recorder.record(&frame.snapshot, frame.diagnostics.as_ref(), frame.state_hash, &frame.events)?;
                count += 1;
                counter.show(count);
            }
            Err(error) => damage = Some(error.to_string()),
        }
    }
    counter.finish();
    recorder.finish()?;
    Ok((count, damage))
}
