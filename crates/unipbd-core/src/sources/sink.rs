//! Sinks: regions that remove particles.

use super::injector::due_until;
use crate::math::wide;
use crate::particles::Particles;
use crate::scene::{Region, Scene, Sink};

/// A sink of a scene.
pub(super) struct RegionSink {
    region: Region,
    /// Whether it removes a material.
    takes: Vec<bool>,
    rate: f64,
    start: f64,
    stop: f64,
}

impl RegionSink {
    pub fn new(sink: &Sink, scene: &Scene) -> Self {
        let all = sink.materials.is_empty();
        RegionSink {
            region: sink.region.clone(),
            takes: scene.materials().map(|m| all || sink.materials.iter().any(|name| name == m.name())).collect(),
            rate: sink.rate.unwrap_or(f64::INFINITY),
            start: sink.start,
            stop: sink.stop.unwrap_or(f64::INFINITY),
        }
    }

    /// Maximum number of particles it may remove in the frame that ends at `time`.
    pub fn allowance(&self, time: f64, frame_time: f64) -> usize {
        if time < self.start || time >= self.stop {
            return 0;
        }
        if self.rate.is_infinite() {
            return usize::MAX;
        }
        let until = |time: f64| due_until((time - self.start).max(0.0) * self.rate) as usize;
        until(time) - until(time - frame_time)
    }

    /// Whether it would remove the particle in this row.
    pub fn takes(&self, particles: &Particles, row: usize) -> bool {
        self.takes[usize::from(particles.materials()[row])]
            && self.region.contains(wide(particles.positions()[row]).into())
    }
}
