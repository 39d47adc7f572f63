//! `export`: a log as files that other tools read.

use crate::args::{ExportArgs, ExportFormat};
use crate::exit::{Exit, Failure};
use crate::export::{self, ExportError, Exporter};
use crate::read::Log;
use crate::record::same_file;
use crate::report::format::plural;
use crate::report::{Console, Counter, Form};

pub(super) fn export(arguments: &ExportArgs, console: Console) -> Result<Exit, Failure> {
    if same_file(&arguments.log, &arguments.output) {
        return Err(Failure::usage(crate::record::is_input(&arguments.output)));
    }
    let format = format(arguments)?;
    let log = Log::open(&arguments.log)?;
    let mut exporter = exporter(format, &log, arguments)?;
    let counter = Counter::new(console, "exporting", log.totals().map(|totals| totals.frames));
    let mut frames = log.frames()?;
    let (mut read, mut taken) = (0_u64, 0_u64);
    for frame in frames.by_ref() {
        let frame = frame?;
        let time = frame.snapshot.time;
        let wanted = arguments.from.is_none_or(|from| time >= from - 1e-9)
            && arguments.to.is_none_or(|to| time <= to + 1e-9)
            && read.is_multiple_of(arguments.every);
        if wanted {
            exporter.add(read, &frame)?;
            taken += 1;
        }
        read += 1;
        counter.show(read);
    }
    counter.finish();
    if frames.truncated() {
        console.warning("the log was cut off: the frames before are exported");
    }
    if taken == 0 {
        return Err(Failure::usage(format!("none of the {} is in this range", plural(read, "frame"))));
    }
    let written = exporter.finish()?;
    match console.form {
        Form::Json => console.object(&serde_json::json!({
            "type": "exported",
            "frames": taken,
            "files": written.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
        }))?,
        Form::Text => {
            let shown = written.iter().take(3).map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ");
            let more = if written.len() > 3 { format!(" and {} more", written.len() - 3) } else { String::new() };
            console.note(format_args!("wrote {shown}{more} with {}", plural(taken, "frame")));
        }
    }
    Ok(Exit::Success)
}

fn format(arguments: &ExportArgs) -> Result<ExportFormat, Failure> {
    let is_npz = arguments.output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("npz"));
    match arguments.format {
        Some(format) => Ok(format),
        None if is_npz => Ok(ExportFormat::Npz),
        None => {
            Err(Failure::usage("give --format csv, parquet, npz or vtk (npz is meant where the output ends in .npz)"))
        }
    }
}

fn exporter(format: ExportFormat, log: &Log, arguments: &ExportArgs) -> Result<Box<dyn Exporter>, ExportError> {
    let (path, replace) = (arguments.output.as_path(), arguments.force);
    Ok(match format {
        ExportFormat::Csv => Box::new(export::Csv::new(path, replace, log)?),
        ExportFormat::Npz => Box::new(export::Npz::new(path, replace)?),
        #[cfg(feature = "parquet")]
        ExportFormat::Parquet => Box::new(export::Parquet::new(path, replace, log)?),
        ExportFormat::Vtk => Box::new(export::Vtk::new(path, replace, log)?),
    })
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Exists(_) => Failure::usage(error.to_string()),
            ExportError::Write(..) => Failure::io(error.to_string()),
        }
    }
}
