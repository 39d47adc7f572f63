//! Arguments of `run` for viewers that watch it.

use clap::Args;

use crate::live::{DEFAULT_ADDRESS, LiveOptions};

/// Viewers of a run.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Live")]
pub struct LiveArgs {
    /// Let Lichtblick or Foxglove watch and steer the run at ws://ADDRESS [default: 127.0.0.1:8765]
    ///
    /// They show what the log holds while it is made, pause the run, move it by single frames and change its speed,
    /// gravity and motors. HOST:PORT or a port; port 0 takes a free one. Whoever reaches the port can steer the run.
    /// The last frame stays until the viewers have left.
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1, default_missing_value = DEFAULT_ADDRESS)]
    pub live: Option<LiveOptions>,
    /// Simulated seconds per second, 0 for as fast as it can [default: 1, real time]
    #[arg(long, value_name = "FACTOR", requires = "live", allow_negative_numbers = true, value_parser = speed)]
    pub speed: Option<f64>,
    /// Wait for a viewer to start the run
    #[arg(long, requires = "live")]
    pub paused: bool,
}

impl LiveArgs {
    /// Where the run listens and how it goes, if it is live.
    pub fn options(&self) -> Option<LiveOptions> {
        let live = self.live.clone()?;
        Some(LiveOptions { speed: self.speed.unwrap_or(live.speed), paused: self.paused, ..live })
    }
}

fn speed(text: &str) -> Result<f64, String> {
    crate::live::speed(text.trim().parse().unwrap_or(f64::NAN))
}
