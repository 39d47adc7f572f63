//! Progress of a run on standard error: a bar on a terminal, plain lines elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use unipbd_core::observe::{Diagnostics, Event, Severity};

use super::format::{count, duration, percent};
use super::{Console, Form, Verbosity};

/// Longest wall-clock time without a plain line.
const SILENCE: Duration = Duration::from_secs(5);
/// Plain lines of a run that is quick.
const LINES: u64 = 10;

enum Display {
    Nothing,
    Bar(ProgressBar),
    Lines { next_frame: u64, last: Instant },
}

/// Shows how far a run has come.
pub struct Progress {
    console: Console,
    display: Display,
    frames: u64,
    duration: f64,
    speed: Speed,
}

impl Progress {
    /// Progress of a run of `frames` frames and `duration` simulated seconds.
    pub fn new(console: Console, frames: u64, duration: f64) -> Self {
        Progress { console, display: choose_display(console, frames), frames, duration, speed: Speed::start() }
    }

    /// Shows a finished frame.
    pub fn frame(&mut self, diagnostics: &Diagnostics) {
        self.speed.add(diagnostics.time);
        if let Display::Bar(bar) = &self.display {
            bar.set_position(diagnostics.frame);
            bar.set_message(self.short_text(diagnostics));
        }
        if self.line_is_due(diagnostics.frame) {
            let share = 100 * diagnostics.frame / self.frames.max(1);
            self.console.note(format_args!("{share:3} %  {}", self.text(diagnostics)));
        }
    }

    /// A line for every tenth of the run, and where it is slow, every few seconds.
    fn line_is_due(&mut self, frame: u64) -> bool {
        let Display::Lines { next_frame, last } = &mut self.display else { return false };
        if frame < *next_frame && last.elapsed() < SILENCE {
            return false;
        }
        let tenths = frame * LINES / self.frames.max(1);
        *next_frame = ((tenths + 1) * self.frames).div_ceil(LINES);
        *last = Instant::now();
        true
    }

    /// Shows events without disturbing the bar.
    pub fn events(&self, events: &[Event]) {
        for event in events {
            self.apart(|console| match event.severity {
                Severity::Warning => console.warning(format_args!("{} (at {:.3} s)", event.message, event.time)),
                Severity::Info => console.detail(format_args!("{:.3} s: {}", event.time, event.message)),
            });
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }

    fn apart(&self, print: impl FnOnce(&Console)) {
        match &self.display {
            Display::Bar(bar) => bar.suspend(|| print(&self.console)),
            _ => print(&self.console),
        }
    }

    fn remaining(&self, diagnostics: &Diagnostics) -> String {
        let left = (self.duration - diagnostics.time).max(0.0);
        let speed = self.speed.simulated_per_wall();
        if speed > 0.0 { remaining(left / speed) } else { "?".into() }
    }

    fn text(&self, diagnostics: &Diagnostics) -> String {
        format!(
            "{:.2}/{:.2} s  frame {}/{}  {}x  ETA {}  {} particles  density error {} mean, {} max",
            diagnostics.time,
            self.duration,
            diagnostics.frame,
            self.frames,
            significant(self.speed.simulated_per_wall()),
            self.remaining(diagnostics),
            count(diagnostics.particles()),
            percent(diagnostics.density_error_mean),
            percent(diagnostics.density_error_max),
        )
    }

    /// As [`text`](Self::text), for the 80 columns of a terminal, less the bar.
    fn short_text(&self, diagnostics: &Diagnostics) -> String {
        format!(
            "{:.2}/{:.2} s {}/{} {}x ETA {} {} particles, C {} max {}",
            diagnostics.time,
            self.duration,
            diagnostics.frame,
            self.frames,
            significant(self.speed.simulated_per_wall()),
            self.remaining(diagnostics),
            count(diagnostics.particles()),
            percent(diagnostics.density_error_mean),
            percent(diagnostics.density_error_max),
        )
    }
}

fn choose_display(console: Console, frames: u64) -> Display {
    let data_shares_terminal = console.form == Form::Json && std::io::stdout().is_terminal();
    if console.verbosity == Verbosity::Quiet {
        Display::Nothing
    } else if std::io::stderr().is_terminal() && !data_shares_terminal {
        let bar = ProgressBar::with_draw_target(Some(frames), ProgressDrawTarget::stderr_with_hz(10));
        let style = ProgressStyle::with_template("[{bar:8}] {wide_msg}").expect("the template is well-formed");
        bar.set_style(style.progress_chars("=> "));
        Display::Bar(bar)
    } else {
        Display::Lines { next_frame: frames.div_ceil(LINES), last: Instant::now() }
    }
}

/// Simulated seconds per second of wall-clock time, over the last few seconds: both are summed with a
/// weight that falls with age, so that a few quick frames at the start do not count for more than they took.
struct Speed {
    simulated: f64,
    wall: f64,
    last: Instant,
    last_time: f64,
}

impl Speed {
    fn start() -> Self {
        Speed { simulated: 0.0, wall: 0.0, last: Instant::now(), last_time: 0.0 }
    }

    fn add(&mut self, time: f64) {
        let wall = self.last.elapsed().as_secs_f64();
        if time > self.last_time {
            self.advance(time - self.last_time, wall);
            self.last = Instant::now();
            self.last_time = time;
        }
    }

    fn advance(&mut self, simulated: f64, wall: f64) {
        const MEMORY: f64 = 3.0; // [s] of wall-clock time
        let keep = (-wall / MEMORY).exp();
        self.simulated = keep * self.simulated + simulated;
        self.wall = keep * self.wall + wall;
    }

    fn simulated_per_wall(&self) -> f64 {
        if self.wall > 0.0 { self.simulated / self.wall } else { 0.0 }
    }
}

/// Whole seconds are enough for a guess.
fn remaining(seconds: f64) -> String {
    match seconds.round() {
        seconds if seconds < 60.0 => format!("{seconds} s"),
        seconds if seconds < 1e7 => duration(Duration::from_secs_f64(seconds)),
        _ => "> 100 days".into(),
    }
}

/// Two significant digits below 10.
pub(super) fn significant(value: f64) -> String {
    match value {
        value if value >= 9.95 => format!("{value:.0}"),
        value if value >= 0.995 => format!("{value:.1}"),
        value if value >= 0.0995 => format!("{value:.2}"),
        value => format!("{value:.3}"),
    }
}
