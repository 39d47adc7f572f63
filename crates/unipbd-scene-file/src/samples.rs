//! Samples of motions and accelerations, read from CSV files beside the scene file.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use unipbd_core::scene::{AccelerationTable, KeyPath, MOST_SAMPLES, MotionTable, Scene};

use super::diagnostic::printable;
use super::source::{Fault, FaultKind};
use super::tree::Node;

/// Larger files are refused unread \[byte].
const LARGEST: u64 = 16 << 20;

/// An error in a file: a message that names it, and a hint for the user.
struct Wrong {
    message: String,
    hint: String,
}

/// Reads the files that a scene names, from its folder, into its tables. The keys `file` are empty then.
pub(super) fn load(scene: &mut Scene, folder: &Path, tree: &Node) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut fail = |path: KeyPath, wrong: Wrong| {
        let fault = Fault::new(path.clone(), tree.nearest_span(&path), wrong.message);
        faults.push(fault.hint(wrong.hint).kind(FaultKind::Meaning));
    };
    for (index, body) in scene.body.iter_mut().enumerate() {
        let Some(motion) = body.motion.as_mut().filter(|motion| !motion.file.is_empty()) else { continue };
        let file = std::mem::take(&mut motion.file);
        let path = KeyPath::entry("body", index).then("motion").then("file");
        match table(folder, &file, &["x", "y", "angle_deg"]).and_then(|read| alone(&motion.table, read, &file)) {
            Ok([time, x, y, angle_deg]) => motion.table = Some(MotionTable { time, x, y, angle_deg }),
            Err(wrong) => fail(path, wrong),
        }
    }
    if !scene.shaking.file.is_empty() {
        let file = std::mem::take(&mut scene.shaking.file);
        let read = table(folder, &file, &["ax", "ay"]).and_then(|read| alone(&scene.shaking.table, read, &file));
        match read {
            Ok([time, ax, ay]) => scene.shaking.table = Some(AccelerationTable { time, ax, ay }),
            Err(wrong) => fail(KeyPath::key("shaking").then("file"), wrong),
        }
    }
    faults
}

/// Refuses a table beside the file.
fn alone<T, const N: usize>(given: &Option<T>, read: Vec<Vec<f64>>, file: &str) -> Result<[Vec<f64>; N], Wrong> {
    if given.is_some() {
        let message = format!("{} is given beside `table`", printable(file));
        return Err(Wrong { message, hint: "keep one of them".to_owned() });
    }
    Ok(read.try_into().unwrap_or_else(|_| std::array::from_fn(|_| Vec::new())))
}

/// The columns of a file: time, then those of these names, empty where the file has none.
fn table(folder: &Path, file: &str, names: &[&str]) -> Result<Vec<Vec<f64>>, Wrong> {
    let text = text_of(&folder.join(file), file)?;
    let place = |line: Option<u64>| match line {
        Some(line) => format!("{}, line {line}", printable(file)),
        None => printable(file),
    };
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let broken = |error: csv::Error| {
        let line = error.position().map(csv::Position::line);
        let (message, hint) = match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                (format!("has {len} values for {expected_len} columns"), "separate values by commas")
            }
            _ => ("cannot be read".to_owned(), "write numbers, separated by commas"),
        };
        Wrong { message: format!("{}: {message}", place(line)), hint: hint.to_owned() }
    };
    let columns = columns(reader.headers().map_err(broken)?, names)
        .map_err(|message| Wrong { message: format!("{}: {message}", place(None)), hint: header_hint(names) })?;
    let mut values = vec![Vec::new(); names.len() + 1];
    let mut record = StringRecord::new();
    while reader.read_record(&mut record).map_err(broken)? {
        let line = record.position().map(csv::Position::line);
        let wrong = |message: String, hint: &str| Wrong {
            message: format!("{}: {message}", place(line)),
            hint: hint.to_owned(),
        };
        for (text, column) in record.iter().zip(&columns) {
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            let number = number.ok_or_else(|| {
                let shown: String = printable(text).chars().take(30).collect();
                wrong(format!("\"{shown}\" is no number"), "write an ordinary number, such as 1.5")
            })?;
            values[*column].push(number);
        }
        if let [.., before, now] = values[0][..]
            && now <= before
        {
            return Err(wrong(format!("time must increase, found {now} after {before}"), "sort the lines by time"));
        }
        if values[0].len() > MOST_SAMPLES {
            return Err(wrong(format!("there are more than {MOST_SAMPLES} samples"), "keep fewer lines"));
        }
    }
    Ok(values)
}

/// The text of a file of bounded size.
fn text_of(path: &Path, file: &str) -> Result<String, Wrong> {
    let wrong = |message: String, hint: &str| Wrong { message, hint: hint.to_owned() };
    let hint = "the path is relative to the folder of the scene file";
    let cannot = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => wrong(format!("there is no file {}", printable(file)), hint),
        _ => wrong(format!("cannot read {}: {error}", printable(file)), hint),
    };
    let opened = File::open(path).map_err(cannot)?;
    if !opened.metadata().is_ok_and(|found| found.is_file()) {
        return Err(wrong(format!("{} is no file", printable(file)), hint));
    }
    let mut bytes = Vec::new();
    opened.take(LARGEST + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("{} is larger than {} MiB", printable(file), LARGEST >> 20);
        return Err(wrong(message, "keep fewer lines"));
    }
    let text = String::from_utf8(bytes);
    text.map(|text| text.trim_start_matches('\u{feff}').to_owned())
        .map_err(|_| wrong(format!("{} is no UTF-8 text", printable(file)), "save the file as UTF-8"))
}

/// The number of each column of a header: 0 for time, then in the order of the names.
fn columns(header: &StringRecord, names: &[&str]) -> Result<Vec<usize>, String> {
    let mut found = Vec::new();
    for word in header {
        let known = std::iter::once("time").chain(names.iter().copied()).position(|name| name == word);
        let shown: String = printable(word).chars().take(30).collect();
        let column = known.ok_or_else(|| format!("its header has an unknown column \"{shown}\""))?;
        if found.contains(&column) {
            return Err(format!("its header has the column \"{word}\" twice"));
        }
        found.push(column);
    }
    match (found.contains(&0), found.len()) {
        (false, _) => Err("its header has no column \"time\"".to_owned()),
        (true, 1) => Err("it has no column besides time".to_owned()),
        (true, _) => Ok(found),
    }
}

fn header_hint(names: &[&str]) -> String {
    format!("the first line names the columns: time, and one or more of {}", names.join(", "))
}
