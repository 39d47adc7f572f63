use std::time::{Duration, Instant};

/// Lag that a run catches up with; beyond, it goes on from where it is.
const CAUGHT_UP: Duration = Duration::from_millis(100);

/// Keeps simulated time with the clock.
#[derive(Debug, Default)]
pub struct Pace {
    anchor: Option<Anchor>,
}

/// A moment at which clock and run were together.
#[derive(Clone, Copy, Debug)]
struct Anchor {
    clock: Instant,
    time: f64,
    speed: f64,
}

impl Pace {
    pub fn new() -> Self {
        Pace::default()
    }

    /// The run stands still: it starts anew from there.
    pub fn rest(&mut self) {
        self.anchor = None;
    }

    /// When a run at this simulated time \[s] may go on, at this many simulated seconds per second; `None` is at once.
    pub fn due(&mut self, time: f64, speed: f64, now: Instant) -> Option<Instant> {
        if speed <= 0.0 {
            self.anchor = None;
            return None;
        }
        let anchor = self.anchor.filter(|anchor| anchor.speed == speed && anchor.time <= time);
        let anchor = anchor.unwrap_or(Anchor { clock: now, time, speed });
        let due = anchor.clock + Duration::from_secs_f64((time - anchor.time) / speed);
        let late = now.saturating_duration_since(due) > CAUGHT_UP;
        self.anchor = Some(if late { Anchor { clock: now, time, speed } } else { anchor });
        Some(due)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_due_with_the_clock_and_lost_time_is_not_made_up_for() {
        let (mut pace, start) = (Pace::new(), Instant::now());
        assert_eq!(pace.due(0.0, 2.0, start), Some(start));
        assert_eq!(pace.due(1.0, 2.0, start), Some(start + Duration::from_millis(500)));
        let late = start + Duration::from_secs(9);
        assert!(pace.due(1.0, 2.0, late).unwrap() < late);
        assert_eq!(pace.due(1.5, 2.0, late), Some(late + Duration::from_millis(250)));
        assert_eq!(pace.due(1.5, 0.0, late), None);
    }
}
