use super::error::RenderError;
use crate::snapshot::Snapshot;

/// Slack in comparing times, in fractions of the interval between frames: times in logs are rounded.
const SLACK: f64 = 0.01;

/// Which frames to draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// One picture: the frame nearest to this time \[s]; left out, the last frame.
    pub time: Option<f64>,
    /// No frame before this time \[s].
    pub from: Option<f64>,
    /// No frame after this time \[s].
    pub to: Option<f64>,
    /// One frame of so many; left out, all, or as many as a film needs.
    pub every: Option<u64>,
}

impl Selection {
    pub(super) fn check(&self) -> Result<(), RenderError> {
        let times = [self.time, self.from, self.to];
        if times.iter().flatten().any(|time| !time.is_finite()) {
            return Err(RenderError::Job("times must be numbers"));
        }
        if self.every == Some(0) {
            return Err(RenderError::Job("one frame of 0 is none: --every must be at least 1"));
        }
        if matches!((self.from, self.to), (Some(from), Some(to)) if from > to) {
            return Err(RenderError::Job("--from lies after --to"));
        }
        Ok(())
    }

    fn contains(&self, time: f64) -> bool {
        self.from.is_none_or(|from| time >= from - 1e-9) && self.to.is_none_or(|to| time <= to + 1e-9)
    }

    /// The one frame to draw.
    pub(super) fn single(
        &self,
        frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    ) -> Result<Snapshot, RenderError> {
        let mut best: Option<Snapshot> = None;
        for frame in frames {
            let frame = frame?;
            if !self.contains(frame.time) {
                continue;
            }
            if let (Some(time), Some(before)) = (self.time, &best)
                && (frame.time - time).abs() >= (before.time - time).abs()
            {
                break;
            }
            best = Some(frame);
        }
        best.ok_or(RenderError::NoFrames)
    }

    /// The frames to draw, in order.
    pub(super) fn many(
        &self,
        frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    ) -> impl Iterator<Item = Result<Snapshot, RenderError>> {
        let every = self.every.unwrap_or(1);
        let mut counted = 0;
        let to = self.to.unwrap_or(f64::INFINITY) + 1e-9;
        frames.take_while(move |frame| frame.as_ref().map_or(true, |frame| frame.time <= to)).filter(move |frame| {
            let Ok(frame) = frame else { return true };
            let counts = self.contains(frame.time);
            let chosen = counts && counted % every == 0;
            counted += u64::from(counts);
            chosen
        })
    }
}

/// Fits the frames of a run to the frames a second of a film.
pub(super) struct Cadence {
    speed: f64,
    most_fps: f64,
    every: Option<u64>,
}

impl Cadence {
    pub fn new(speed: f64, most_fps: f64, every: Option<u64>) -> Cadence {
        Cadence { speed, most_fps, every }
    }

    /// The frames a second, and the frames to show. Where the run has more frames than the film can
    /// take, those that come first in each interval of the film are shown.
    pub fn apply<I: Iterator<Item = Result<Snapshot, RenderError>>>(
        &self,
        mut frames: I,
    ) -> Result<(f64, impl Iterator<Item = Result<Snapshot, RenderError>> + use<I>), RenderError> {
        let first = frames.next().ok_or(RenderError::NoFrames)??;
        let second = frames.next().transpose()?;
        let interval = second.as_ref().map_or(0.0, |second| second.time - first.time);
        let natural = if interval > 0.0 { self.speed / interval } else { self.most_fps };
        let thinned = self.every.is_none() && natural > self.most_fps * (1.0 + SLACK);
        let fps = if thinned { self.most_fps } else { natural };
        let step = self.speed / fps;
        let [start, mut shown] = [first.time, 0.0];
        let chosen = [first].into_iter().chain(second).map(Ok).chain(frames).filter(move |frame| {
            let Ok(frame) = frame else { return true };
            let due = start + shown * step - SLACK * interval;
            let show = !thinned || frame.time >= due;
            shown += if show { 1.0 } else { 0.0 };
            show
        });
        Ok((fps, chosen))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(count: u64, fps: f64) -> impl Iterator<Item = Result<Snapshot, RenderError>> {
        (0..count).map(move |k| Ok(Snapshot { time: k as f64 / fps, ..Snapshot::default() }))
    }

    #[test]
    fn film_of_a_fast_log_is_thinned_to_the_most_frames_a_second_without_drift() {
        let (fps, chosen) = Cadence::new(1.0, 25.0, None).apply(frames(601, 60.0)).unwrap();
        let times: Vec<f64> = chosen.map(|frame| frame.unwrap().time).collect();
        assert_eq!(fps, 25.0);
        assert_eq!(times.len(), 251);
        for (k, time) in times.iter().enumerate() {
            assert!((time - k as f64 / 25.0).abs() < 1.0 / 60.0, "frame {k} shows {time}");
        }
    }

    #[test]
    fn slow_motion_shows_every_frame() {
        let (fps, chosen) = Cadence::new(0.25, 25.0, None).apply(frames(100, 60.0)).unwrap();
        assert!((fps - 15.0).abs() < 1e-9);
        assert_eq!(chosen.count(), 100);
    }

    #[test]
    fn single_picture_is_the_nearest_frame_or_the_last() {
        let at = |time| Selection { time, ..Selection::default() }.single(frames(61, 60.0)).unwrap().time;
        assert!((at(Some(0.508)) - 30.0 / 60.0).abs() < 1e-12);
        assert_eq!(at(Some(99.0)), 1.0);
        assert_eq!(at(None), 1.0);
    }

    #[test]
    fn an_unreadable_frame_is_never_skipped() {
        let broken = frames(4, 60.0).chain([Err(RenderError::View)]);
        let selection = Selection { every: Some(3), from: Some(0.0), ..Selection::default() };
        assert!(selection.many(broken).any(|frame| frame.is_err()));
    }

    #[test]
    fn span_and_every_choose_frames() {
        let selection = Selection { from: Some(0.5), to: Some(0.75), every: Some(5), ..Selection::default() };
        let times: Vec<f64> =
            selection.many(frames(61, 60.0)).map(|frame| (frame.unwrap().time * 60.0).round()).collect();
        assert_eq!(times, [30.0, 35.0, 40.0, 45.0]);
    }
}
