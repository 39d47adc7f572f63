//! Bars: a measured figure against its limit, printed and checked.

use std::io::Write;

/// Prints a line past the capture of the test harness: figures and skips are for reading.
pub fn say(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Whether full sizes run; says so where they do not.
pub fn full_size(what: &str) -> bool {
    let full = std::env::var_os("UNIPBD_FULL").is_some_and(|value| value != "0");
    if !full {
        say(format_args!("SKIP {what}: full size, run with UNIPBD_FULL=1"));
    }
    full
}

/// The bars of one case.
pub struct Bars {
    case: &'static str,
    missed: Vec<String>,
}

/// Checks all bars of a case and fails once, naming all that were missed.
#[track_caller]
pub fn bars(case: &'static str, check: impl FnOnce(&mut Bars)) {
    let mut bars = Bars { case, missed: Vec::new() };
    check(&mut bars);
    assert!(bars.missed.is_empty(), "{case} misses:\n  {}", bars.missed.join("\n  "));
}

impl Bars {
    /// The figure may be this large.
    pub fn at_most(&mut self, what: &str, found: f64, limit: f64) {
        self.within(what, found, f64::NEG_INFINITY, limit);
    }

    /// The figure must be this large.
    pub fn at_least(&mut self, what: &str, found: f64, limit: f64) {
        self.within(what, found, limit, f64::INFINITY);
    }

    /// The figure must lie in this range.
    pub fn within(&mut self, what: &str, found: f64, low: f64, high: f64) {
        let range = match (low.is_finite(), high.is_finite()) {
            (true, true) => format!("{low} to {high}"),
            (true, false) => format!("at least {low}"),
            _ => format!("at most {high}"),
        };
        let holds = (low..=high).contains(&found);
        let line = format!("{}: {what}: {found:.6} (bar: {range})", self.case);
        say(format_args!("{} {line}", if holds { "BAR " } else { "MISS" }));
        if !holds {
            self.missed.push(line);
        }
    }
}
