//! Horizontal bars on a logarithmic axis, and errors over time.

use unipbd_validation::chart::{Curve, Point, log_log, mark_front};

use crate::liquids::{Case, Outcome};

/// The outcomes of each solver and setting as a curve over its targets.
pub fn curves(outcomes: &[Outcome], seconds: f64) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for outcome in outcomes {
        let name = curve_of(&outcome.solver).to_owned();
        let point = Point { x: outcome.time / seconds, y: outcome.errors.mean(), counts: true, best: false };
        match curves.iter_mut().find(|curve| curve.name == name) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name, points: vec![point] }),
        }
    }
    curves
}

/// Solver and setting without the target, or the error allowed, that varies along the curve.
fn curve_of(solver: &str) -> &str {
    let solver = solver.split(", target").next().unwrap_or_default();
    solver.find("DFSPH").map_or(solver, |start| &solver[..start + "DFSPH".len()])
}

/// All solvers on one picture.
pub fn errors(case: &Case, particles: usize, curves: &mut [Curve]) -> String {
    mark_front(curves, 0.0);
    let title = format!("{} of {particles} particles, one thread", case.name);
    log_log(&title, "processor time per simulated second [s]", "mean of |C|, by one estimate for all", curves)
}

/// An SVG of named numbers, all above 0.
pub fn bars(title: &str, bars: &[(String, f64)]) -> String {
    const LEFT: f64 = 300.0;
    const WIDTH: f64 = 420.0;
    const ROW: f64 = 26.0;
    let most = bars.iter().map(|(_, value)| *value).fold(10.0, f64::max).log10().ceil();
    let least = bars.iter().map(|(_, value)| *value).fold(1.0, f64::min).log10().floor();
    let at = |value: f64| LEFT + WIDTH * (value.log10() - least) / (most - least);
    let height = 60.0 + ROW * bars.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"{height}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"800\" height=\"{height}\" fill=\"white\"/>\n<text x=\"10\" y=\"20\">{title}</text>\n"
    );
    for decade in least as i32..=most as i32 {
        let (x, value) = (at(10f64.powi(decade)), 10f64.powi(decade));
        svg += &format!(
            "<line x1=\"{x}\" x2=\"{x}\" y1=\"34\" y2=\"{}\" stroke=\"#ccc\"/>\n\
             <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">{value}</text>\n",
            height - 22.0,
            height - 8.0
        );
    }
    let zero = at(1.0);
    for (row, (name, value)) in bars.iter().enumerate() {
        let (y, end) = (38.0 + ROW * row as f64, at(*value));
        let (from, to) = (zero.min(end), zero.max(end));
        svg += &format!(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{name}</text>\n\
             <rect x=\"{from}\" y=\"{y}\" width=\"{}\" height=\"18\" fill=\"#3a86de\"/>\n\
             <text x=\"{}\" y=\"{}\">{value:.1}</text>\n",
            LEFT - 8.0,
            y + 14.0,
            (to - from).max(1.0),
            to + 6.0,
            y + 14.0
        );
    }
    svg + "</svg>\n"
}
