//! The accuracy sheet.

use std::fmt::Write;

use crate::case::Outcome;
use crate::cases::SUBSTEPS_PER_FRAME;
use crate::document::with_section;
use crate::notes::NOTES;
use crate::plan::Line;
use crate::runner::Failure;
use crate::stamp::{machine, stamp};

/// Result of a line of the sheet.
pub struct Entry {
    /// The case and how it ran.
    pub line: Line,
    /// Its figures, or why there are none.
    pub result: Result<Outcome, Failure>,
}

impl Entry {
    /// Runs a line.
    pub fn run(line: Line) -> Entry {
        Entry { line, result: line.case.run(line.resolution, &line.solver()) }
    }

    /// `holds`, `misses` or why there is no result.
    pub fn verdict(&self) -> String {
        match &self.result {
            Err(failure) => format!("fails: {}", failure.to_string().replace('\n', "; ")),
            Ok(outcome) if outcome.missed().next().is_none() => "holds".to_owned(),
            Ok(_) => "**misses**".to_owned(),
        }
    }
}

/// Introduction for readers of the sheet.
pub const INTRODUCTION: &str = "\
# Accuracy

Made by `cargo run --release -p unipbd-validation -- --full [CASE...]`; do not edit. Each case has a known \
answer (`crates/unipbd-validation/src/cases`), and its section says when and from which commit it was measured. \
Resolution is the number of particles along the length of the case (substeps per frame for bodies); the target is \
`solver.target_compression`. Times are processor time of one thread; pair visits are two passes per iteration over \
pi (h/dx)^2 neighbours.

A figure that misses its band says so, and each section counts them. A power near 0, or below, says that an error \
does not fall with the spacing: often as it is small against its scatter, or as the target bounds it.
";

/// Heading and body of the section of a case, from all of its entries.
pub fn section(entries: &[Entry]) -> Option<(String, String)> {
    let case = entries.first()?.line.case;
    let (grid, own): (Vec<&Entry>, Vec<&Entry>) = entries.iter().partition(|entry| entry.line.grid);
    let heading = case.name.replace('_', " ");
    let mut text =
        format!("Truth: {}.\n\nMeasured {}, on {}.\n\n{}\n\n", case.truth, stamp(), machine(), tally(entries));
    table(&mut text, &own);
    text.push_str(&work(&own));
    text.push_str(&orders(&own));
    if !grid.is_empty() {
        let _ = writeln!(text, "\n### {heading} with the pressure grid\n");
        table(&mut text, &grid);
    }
    Some((heading, text))
}

/// Heading of the section with the pictures of the sweep.
pub const CHARTS: &str = "Run time against error";

/// The section with the pictures of the sweep.
pub fn charts_section(charts: &[String]) -> String {
    let mut text = String::from(
        "By `cargo run --release -p unipbd-validation -- --sweep --full`. Filled points are on the front: \
         nothing is 10 % cheaper without more error, or 10 % more exact at no more cost, which is how much both scatter. Each point \
         is run three times, those of wave and box nine times, in rounds over all curves, with relaxations half a percent apart: the \
         least processor time counts, and the mean of the errors, as those two hang on the arrangement by chance. The density error |C| is measured alike for all kernels, from positions alone: \
         by a cubic spline whose radius is that of the widest kernel compared. The pressure grid is drawn, not judged: its \
         target bounds the way of a substep, not the compression. Nor are, for the wave and the box, settings whose worst C in the dam break is \
         above 6 %: what gives way like a sponge keeps a wave, but is no liquid.\n\n",
    );
    charts.iter().for_each(|chart| {
        let _ = writeln!(text, "![{chart}]({chart})");
    });
    text
}

/// A document with the notes that go with the sheet.
pub fn with_notes(document: &str) -> String {
    NOTES.iter().fold(document.to_owned(), |text, (heading, body)| with_section(&text, heading, body))
}

fn table(text: &mut String, entries: &[&Entry]) {
    text.push_str("| resolution | target | figure | value | band | verdict | time [s] | pair visits |\n");
    text.push_str("|---|---|---|---|---|---|---|---|\n");
    entries.iter().for_each(|entry| rows(text, entry));
}

fn rows(text: &mut String, entry: &Entry) {
    let start = format!("| {} | {} |", entry.line.resolution, entry.line.target);
    let Ok(outcome) = &entry.result else {
        let _ = writeln!(text, "{start} | | | {} | | |", entry.verdict());
        return;
    };
    for (index, figure) in outcome.figures.iter().enumerate() {
        let verdict = if figure.band.is_open() {
            ""
        } else if figure.holds() {
            "holds"
        } else {
            "**misses**"
        };
        let cost = if index == 0 {
            format!("{:.2} | {:.1e}", outcome.cost.processor.as_secs_f64(), outcome.cost.pair_visits)
        } else {
            " | ".to_owned()
        };
        let _ =
            writeln!(text, "{start} {} | {:.4e} | {} | {verdict} | {cost} |", figure.what, figure.value, figure.band);
    }
}

/// How many figures of a case hold their bands and how many miss them.
fn tally(entries: &[Entry]) -> String {
    let figures = entries.iter().filter_map(|entry| entry.result.as_ref().ok()).flat_map(|outcome| &outcome.figures);
    let (hold, miss): (Vec<_>, Vec<_>) = figures.filter(|figure| !figure.band.is_open()).partition(|f| f.holds());
    format!("Of {} figures with a band {} hold it.", hold.len() + miss.len(), hold.len())
}

/// How the errors of a case fall with the spacing at the default target: the powers of those that are known at three
/// spacings or more.
fn orders(entries: &[&Entry]) -> String {
    let default: Vec<&&Entry> = entries.iter().filter(|entry| entry.line.target == 0.01).collect();
    let outcomes = || default.iter().filter_map(|entry| Some((entry.line.resolution, entry.result.as_ref().ok()?)));
    let Some((_, first)) = outcomes().next() else { return String::new() };
    let errors = first.figures.iter().map(|figure| figure.what).filter(|what| what.contains("error"));
    let order = |what: &str| {
        let point = |(resolution, outcome): (u32, &Outcome)| {
            let error = outcome.figure(what)?.abs();
            (error.is_finite() && error > 0.0).then(|| (-f64::from(resolution).ln(), error.ln()))
        };
        let points: Vec<(f64, f64)> = outcomes().filter_map(point).collect();
        (points.len() >= 3).then(|| slope(&points)).flatten()
    };
    let known: Vec<String> = errors.filter_map(|what| Some(format!("{what}: {:.2}", order(what)?))).collect();
    if known.is_empty() {
        return String::new();
    }
    format!("\nPowers of the spacing by which errors fall, at the target of 0.01: {}.\n", known.join("; "))
}

/// How the work grows with the depth, at each target, where a case tells its substeps per frame.
fn work(entries: &[&Entry]) -> String {
    let mut text = String::new();
    let targets = entries.first().map_or(&[][..], |entry| entry.line.case.targets);
    for &target in targets {
        let of = |entry: &&Entry| {
            let figures = &entry.result.as_ref().ok()?.figures;
            let substeps = figures.iter().find(|figure| figure.what == SUBSTEPS_PER_FRAME)?.value;
            (entry.line.target == target).then(|| (f64::from(entry.line.resolution).ln(), substeps.ln()))
        };
        let points: Vec<(f64, f64)> = entries.iter().filter_map(of).collect();
        if let Some(power) = slope(&points) {
            let _ = writeln!(
                text,
                "\nAt target {target} the substeps per frame grow with the depth to the power {power:.2}: the work of a \
                 square of N particles with N^{:.2}.",
                1.0 + 0.5 * power
            );
        }
    }
    text
}

/// Slope of the line through points, by least squares.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
    let (top, bottom) =
        points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + (x - mx) * (y - my), b + (x - mx) * (x - mx)));
    (points.len() >= 2 && bottom > 0.0).then(|| top / bottom)
}
