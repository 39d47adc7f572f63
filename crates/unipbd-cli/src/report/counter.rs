//! Progress through a known or unknown number of frames.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Console, Verbosity};

/// A bar that counts frames; nothing where standard error is no terminal.
pub struct Counter(Option<ProgressBar>);

impl Counter {
    /// A counter of `total` frames with a word for what is done to them.
    pub fn new(console: Console, activity: &'static str, total: Option<u64>) -> Self {
        if console.verbosity == Verbosity::Quiet || !std::io::stderr().is_terminal() {
            return Counter(None);
        }
        let bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr_with_hz(10)).with_message(activity);
        let template = "[{bar:20}] {pos}/{len} frames  {msg}  ETA {eta}";
        let style = ProgressStyle::with_template(template).expect("the template is well-formed");
        bar.set_style(style.progress_chars("=> "));
        Counter(Some(bar))
    }

    /// Shows that so many frames are done.
    pub fn show(&self, count: u64) {
        if let Some(bar) = &self.0 {
            bar.set_position(count);
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
