//! `plot`: gauges and other numbers of a log over time.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use unipbd_core::observe::{Diagnostics, Quantity, Table};
use unipbd_core::scene::nearest;

use crate::args::PlotArgs;
use crate::exit::{Exit, Failure};
use crate::read::Log;
use crate::record::{is_input, same_file};
use crate::render::{Curve, Existing, PlotOptions, write_plot};
use crate::report::format::plural;
use crate::report::{Console, Form};

pub(super) fn plot(arguments: &PlotArgs, console: Console) -> Result<Exit, Failure> {
    let path = output(arguments);
    if same_file(&arguments.log, &path) {
        return Err(Failure::usage(is_input(&path)));
    }
    let rows = rows(arguments, console)?;
    let curves = curves(&rows, &arguments.gauges, &arguments.log)?;
    for curve in curves.iter().filter(|curve| curve.points.iter().all(|point| point[1].is_nan())) {
        console.warning(format_args!("{} has nothing to read at any time", curve.name));
    }
    let existing = if arguments.force { Existing::Replace } else { Existing::Keep };
    let options = PlotOptions { width: arguments.width, background: arguments.background, existing };
    write_plot(&curves, options, &path)?;
    match console.form {
        Form::Json => console.object(&serde_json::json!({
            "type": "plotted",
            "path": path.display().to_string(),
            "curves": curves.iter().map(|curve| &curve.name).collect::<Vec<_>>(),
            "frames": rows.len(),
        }))?,
        Form::Text => {
            let drawn = plural(curves.len() as u64, "curve");
            console.note(format_args!("wrote {}: {drawn} of {}", path.display(), plural(rows.len() as u64, "frame")));
        }
    }
    Ok(Exit::Success)
}

fn output(arguments: &PlotArgs) -> PathBuf {
    let name = || Path::new(arguments.log.file_name().unwrap_or_default()).with_extension("svg");
    arguments.output.clone().unwrap_or_else(name)
}

/// The numbers of the frames that are asked for.
fn rows(arguments: &PlotArgs, console: Console) -> Result<Vec<Diagnostics>, Failure> {
    let log = Log::open(&arguments.log)?;
    let (mut frames, mut rows, mut read) = (log.frames()?, Vec::new(), 0);
    for frame in frames.by_ref() {
        let frame = frame?;
        let time = frame.snapshot.time;
        read += 1;
        let wanted =
            arguments.from.is_none_or(|from| time >= from - 1e-9) && arguments.to.is_none_or(|to| time <= to + 1e-9);
        rows.extend(frame.diagnostics.filter(|_| wanted).map(|numbers| Diagnostics { time, ..numbers }));
    }
    if frames.truncated() {
        console.warning("the log was cut off: the frames before are plotted");
    }
    match (rows.is_empty(), read) {
        (true, 0) => Err(Failure::usage("the log has no frames")),
        (true, _) => Err(Failure::usage(format!("none of the {} in this range has numbers", plural(read, "frame")))),
        (false, _) => Ok(rows),
    }
}

/// The curves of these names; of all gauges, where none is given.
fn curves(rows: &[Diagnostics], names: &[String], log: &Path) -> Result<Vec<Curve>, Failure> {
    let known: BTreeSet<&str> =
        rows.iter().flat_map(|row| row.gauges.iter().map(|gauge| gauge.name.as_str())).collect();
    if names.is_empty() {
        // In the order of the scene.
        let gauges = rows.iter().map(|row| &row.gauges).max_by_key(|gauges| gauges.len());
        let curves: Vec<Curve> = gauges.into_iter().flatten().filter_map(|one| gauge(rows, &one.name)).collect();
        let hint = "the log has no gauges: name what to plot with --gauge";
        return if curves.is_empty() { Err(Failure::usage(format!("{hint}; {}", listed()))) } else { Ok(curves) };
    }
    let unknown = |name: &str| {
        let columns = columns();
        let near = nearest(name, known.iter().copied().chain(columns.iter().map(String::as_str)));
        let near = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
        let gauges = match known.is_empty() {
            true => "no gauges".to_owned(),
            false => format!("the gauges {}", known.iter().copied().collect::<Vec<_>>().join(", ")),
        };
        Failure::usage(format!("{} has no \"{name}\"{near}\nit has {gauges}; {}", log.display(), listed()))
    };
    let found = |name: &String| gauge(rows, name).or_else(|| quantity(rows, name)).ok_or_else(|| unknown(name));
    names.iter().map(found).collect()
}

/// The readings of a gauge.
fn gauge(rows: &[Diagnostics], name: &str) -> Option<Curve> {
    let of = |row: &Diagnostics| row.gauges.iter().position(|gauge| gauge.name == name);
    let kind = rows.iter().find_map(|row| Some(row.gauges[of(row)?].kind))?;
    let value = |row: &Diagnostics| of(row).map_or(f64::NAN, |place| row.gauges[place].value);
    Some(Curve {
        name: name.to_owned(),
        quantity: kind.name().replace('_', " "),
        unit: kind.unit().to_owned(),
        points: rows.iter().map(|row| [row.time, value(row)]).collect(),
    })
}

/// A number of the diagnostics, by the name of its column.
fn quantity(rows: &[Diagnostics], name: &str) -> Option<Curve> {
    let column = |of: &Quantity<Diagnostics>| of.columns().iter().position(|column| column == name);
    let (quantity, place) = Diagnostics::QUANTITIES.iter().find_map(|of| Some((of, column(of)?)))?;
    let value = |row: &Diagnostics| (quantity.read)(row).columns()[place].number();
    value(&rows[0])?;
    let label = name.replace('_', " ");
    Some(Curve {
        name: label.clone(),
        quantity: label,
        unit: quantity.unit.to_owned(),
        points: rows.iter().map(|row| [row.time, value(row).unwrap_or(f64::NAN)]).collect(),
    })
}

/// Columns of the diagnostics that are numbers.
fn columns() -> Vec<String> {
    let numbers = Diagnostics::QUANTITIES.iter().flat_map(|of| {
        let values = (of.read)(&Diagnostics::default()).columns();
        of.columns().into_iter().zip(values).filter(|(_, value)| value.number().is_some()).map(|(name, _)| name)
    });
    numbers.collect()
}

fn listed() -> String {
    format!("its quantities are {}", columns().join(", "))
}
