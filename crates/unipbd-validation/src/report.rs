//! The accuracy sheet.

use std::fmt::Write;

use unipbd_core::scene::SolverSettings;

use crate::case::{Case, Outcome};
use crate::cases::SUBSTEPS_PER_FRAME;
use crate::notes::NOTES;
use crate::runner::Failure;

/// The solver with this target.
pub fn settings(target: f64) -> SolverSettings {
    SolverSettings { target_compression: target, ..SolverSettings::default() }
}

/// One line of the sheet.
pub struct Entry {
    /// The case.
    pub case: &'static Case,
    /// Particles along its length.
    pub resolution: u32,
    /// Target compression.
    pub target: f64,
    /// Whether a coarse projection went before that of the particles.
    pub coarse: bool,
    /// What came of it.
    pub result: Result<Outcome, Failure>,
}

impl Entry {
    /// Runs one entry.
    pub fn run(case: &'static Case, resolution: u32, target: f64) -> Entry {
        Entry { case, resolution, target, coarse: false, result: case.run(resolution, &settings(target)) }
    }

    /// Runs one entry with a coarse projection.
    pub fn run_coarse(case: &'static Case, resolution: u32, target: f64) -> Entry {
        let settings = SolverSettings { coarse_projection: 3, ..settings(target) };
        Entry { case, resolution, target, coarse: true, result: case.run(resolution, &settings) }
    }

    /// `holds`, `misses` or why there is no result.
    pub fn verdict(&self) -> String {
        match &self.result {
            Err(failure) => format!("fails: {failure}"),
            Ok(outcome) if outcome.missed().next().is_none() => "holds".to_owned(),
            Ok(_) => "**misses**".to_owned(),
        }
    }
}

/// The whole sheet as markdown.
pub fn sheet(entries: &[Entry], charts: &[String]) -> String {
    let mut text = String::from(
        "# Accuracy\n\nMade by `cargo run --release -p unipbd-validation -- --full`; do not edit. Each case has a known \
         answer (`crates/unipbd-validation/src/cases`). Resolution is the number of particles along the length of the \
         case (substeps per frame for bodies); the target is `solver.target_compression`. Wall time is that of one \
         thread of the machine this was made on; pair visits are two passes per iteration over pi (h/dx)^2 neighbours.\n\n\
         A case that misses its band says so.\n",
    );
    for case in crate::cases::ALL {
        let of_case = || entries.iter().filter(|entry| entry.case.name == case.name);
        let (coarse, own): (Vec<&Entry>, Vec<&Entry>) = of_case().partition(|entry| entry.coarse);
        if own.is_empty() {
            continue;
        }
        let _ = writeln!(text, "\n## {}\n\nTruth: {}.\n", case.name.replace('_', " "), case.truth);
        table(&mut text, &own);
        text.push_str(&work(&own));
        if let Some(order) = order(&own) {
            let _ = writeln!(text, "\nOrder of convergence of the first figure with the spacing: {order:.2}.");
        }
        if !coarse.is_empty() {
            let _ = writeln!(text, "\n### {} with a coarse projection\n", case.name.replace('_', " "));
            table(&mut text, &coarse);
        }
    }
    if !charts.is_empty() {
        text.push_str(
            "\n## Run time against error\n\nFilled points are on the front: \
             nothing is 10 % cheaper without more error, or 10 % more exact at no more cost, which is how much both scatter. Each point \
             is run three times, those of wave and box nine times, in rounds over all curves, with relaxations half a percent apart: the \
             least processor time counts, and the mean of the errors, as those two hang on the arrangement by chance. The density error |C| is measured alike for all kernels, from positions alone: \
             by a cubic spline whose radius is that of the widest kernel compared. The coarse projection is drawn, not judged: it carries \
             one liquid in static walls alone. Nor are, for the wave and the box, settings whose worst C in the dam break is \
             above 6 %: what gives way like a sponge keeps a wave, but is no liquid.\n\n",
        );
        charts.iter().for_each(|chart| {
            let _ = writeln!(text, "![{chart}]({chart})");
        });
    }
    with_notes(&text)
}

/// A document with the notes that go with the sheet.
pub fn with_notes(document: &str) -> String {
    NOTES.iter().fold(document.to_owned(), |text, (heading, body)| with_section(&text, heading, body))
}

fn table(text: &mut String, entries: &[&Entry]) {
    text.push_str("| resolution | target | figure | value | band | verdict | wall [s] | pair visits |\n");
    text.push_str("|---|---|---|---|---|---|---|---|\n");
    entries.iter().for_each(|entry| rows(text, entry));
}

fn rows(text: &mut String, entry: &Entry) {
    let start = format!("| {} | {} |", entry.resolution, entry.target);
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
            format!("{:.2} | {:.1e}", outcome.cost.wall.as_secs_f64(), outcome.cost.pair_visits)
        } else {
            " | ".to_owned()
        };
        let _ =
            writeln!(text, "{start} {} | {:.4e} | {} | {verdict} | {cost} |", figure.what, figure.value, figure.band);
    }
}

/// Slope of log(error) over log(dx) at the default target.
fn order(entries: &[&Entry]) -> Option<f64> {
    let points: Vec<(f64, f64)> = entries
        .iter()
        .filter(|entry| entry.target == 0.01)
        .filter_map(|entry| Some((-f64::from(entry.resolution).ln(), entry.result.as_ref().ok()?.error().ln())))
        .filter(|(_, error)| error.is_finite())
        .collect();
    slope(&points)
}

/// How the work grows with the depth, at each target, where a case tells its substeps per frame.
pub fn work(entries: &[&Entry]) -> String {
    let mut text = String::new();
    let targets = entries.first().map_or(&[][..], |entry| entry.case.targets);
    for &target in targets {
        let of = |entry: &&Entry| {
            let figures = &entry.result.as_ref().ok()?.figures;
            let substeps = figures.iter().find(|figure| figure.what == SUBSTEPS_PER_FRAME)?.value;
            (entry.target == target).then(|| (f64::from(entry.resolution).ln(), substeps.ln()))
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

/// A document with this section: in place of the one of the same heading, or else at the end.
pub fn with_section(document: &str, heading: &str, body: &str) -> String {
    let (title, section) = (format!("## {heading}\n"), format!("## {heading}\n\n{}\n", body.trim_end()));
    let Some(start) = document.find(&format!("\n{title}")).map(|start| start + 1) else {
        return format!("{}\n\n{section}", document.trim_end());
    };
    let rest = &document[start + title.len()..];
    let rest = rest.find("\n## ").map_or("", |end| &rest[end..]);
    format!("{}{section}{rest}", &document[..start])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_is_put_in_place_of_the_old_one_or_at_the_end() {
        let document = "# Title\n\n## One\n\nold\n\n## Two\n\nstays\n";
        assert_eq!(with_section(document, "One", "new\n"), "# Title\n\n## One\n\nnew\n\n## Two\n\nstays\n");
        assert_eq!(with_section(document, "Two", "new"), "# Title\n\n## One\n\nold\n\n## Two\n\nnew\n");
        let longer = with_section(document, "Three", "new");
        assert_eq!(longer, format!("{document}\n## Three\n\nnew\n"));
        assert_eq!(with_section(&longer, "Three", "new"), longer);
    }
}
