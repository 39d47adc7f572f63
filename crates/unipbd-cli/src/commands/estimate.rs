//! The cost of a scene: its first second of wall-clock time is run, the rest follows from the
//! number of particles over time.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use unipbd_core::SolverError;
use unipbd_core::observe::Diagnostics;
use unipbd_core::scene::{BYTES_PER_PARTICLE, Scene};

use crate::simulation::Simulation;

/// Particles from which the memory of the start is a fair sample.
const FAIR_SAMPLE: u64 = 500;

/// Wall-clock time for which the scene is run.
const PILOT: Duration = Duration::from_secs(1);

/// Particles of a scene, as an object.
pub(super) fn particles(scene: &Scene) -> Value {
    let estimate = scene.estimate();
    json!({
        "at_start": estimate.particles_at_start,
        "emitted": emitted(scene),
        "peak": estimate.particles_at_peak,
    })
}

/// Particles added by emitters that are never throttled.
pub(super) fn emitted(scene: &Scene) -> u64 {
    // Without removal, what is there at the end was there at the start or was emitted.
    let mut lasting = scene.clone();
    lasting.gas.iter_mut().for_each(|gas| gas.lifetime = None);
    lasting.smoke.iter_mut().for_each(|smoke| smoke.lifetime = None);
    let estimate = lasting.estimate();
    estimate.particles_at_peak - estimate.particles_at_start.min(estimate.particles_at_peak)
}

/// The estimated cost of a scene.
#[derive(Clone, Debug)]
pub(super) struct Cost {
    /// The state at time 0.
    pub start: Diagnostics,
    /// Most particles at once; a bound from above.
    pub peak: u64,
    /// Substeps of the first frame, or why it failed.
    pub first_frame: Result<u32, SolverError>,
    /// Memory of the solver at the start [B].
    pub memory_at_start: u64,
    /// Memory of the solver with the most particles [B].
    pub memory_at_peak: u64,
    /// Wall-clock time of the whole run.
    pub wall_time: Duration,
}

impl Cost {
    /// Looks at the start, at the first frame, and at as many more as fit into [`PILOT`].
    pub fn of(scene: &Scene, simulation: &mut Simulation) -> Self {
        let start = simulation.solver.diagnostics();
        let memory_at_start = simulation.solver.memory_bytes() as u64;
        let pilot = Pilot::run(simulation);
        let (particles, peak) = (start.particles(), scene.estimate().particles_at_peak);
        let memory = if particles >= FAIR_SAMPLE { memory_at_start.div_ceil(particles) } else { BYTES_PER_PARTICLE };
        Cost {
            peak,
            memory_at_peak: memory_at_start.max(memory.saturating_mul(peak)),
            wall_time: Duration::try_from_secs_f64(pilot.whole_run(scene)).unwrap_or(Duration::MAX),
            start,
            first_frame: pilot.first_frame,
            memory_at_start,
        }
    }
}

/// The beginning of a run.
struct Pilot {
    first_frame: Result<u32, SolverError>,
    /// Simulated time \[s] and wall-clock time \[s] at the end of each frame.
    frames: Vec<(f64, f64)>,
}

impl Pilot {
    fn run(simulation: &mut Simulation) -> Self {
        let clock = Instant::now();
        let mut frames = vec![(0.0, 0.0)];
        let mut first_frame = None;
        while clock.elapsed() < PILOT
            && let Some(frame) = simulation.next_frame()
        {
            let failed = frame.is_err();
            first_frame.get_or_insert(frame.map(|report| report.substeps));
            if failed {
                break;
            }
            frames.push((simulation.solver.time(), clock.elapsed().as_secs_f64()));
        }
        Pilot { first_frame: first_frame.unwrap_or(Ok(0)), frames }
    }

    /// Wall-clock time of the whole run \[s]: from here on a particle costs what it did in the second
    /// half of the pilot, when the number of substeps had settled.
    fn whole_run(&self, scene: &Scene) -> f64 {
        let Some(&(time, spent)) = self.frames.last() else { return 0.0 };
        let end = scene.duration;
        if time >= end * (1.0 - 1e-9) || time == 0.0 {
            return spent;
        }
        let half = self.frames.partition_point(|&(_, wall)| wall < 0.5 * spent).min(self.frames.len() - 2);
        let (half_time, half_spent) = self.frames[half];
        let work = |until: f64| Scene { duration: until, ..scene.clone() }.estimate().cost_seconds;
        let (sampled, ahead) = (work(time) - work(half_time), work(end) - work(time));
        let share = if sampled > 0.0 { ahead / sampled } else { (end - time) / (time - half_time) };
        spent + (spent - half_spent) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use unipbd_core::scene::{Block, Liquid};

    #[test]
    fn the_rest_of_a_run_costs_what_its_beginning_did() {
        let scene = Scene {
            duration: 10.0,
            liquid: vec![Liquid { name: "water".into(), ..Liquid::default() }],
            block: vec![Block::new("water", [0.0, 0.0], [1.0, 1.0])],
            ..Scene::default()
        };
        let frames = vec![(0.0, 0.0), (0.5, 0.6), (1.0, 1.0)];
        let pilot = Pilot { first_frame: Ok(4), frames };
        // Half a second took 0.4 s, nine more take 18 times as long.
        assert!((pilot.whole_run(&scene) - (1.0 + 18.0 * 0.4)).abs() < 1e-9);
        let empty = Scene { duration: 10.0, ..Scene::default() };
        assert!((pilot.whole_run(&empty) - (1.0 + 18.0 * 0.4)).abs() < 1e-9, "bodies alone, by time");
        let over = Scene { duration: 1.0, ..scene };
        assert_eq!(pilot.whole_run(&over), 1.0);
    }

    use unipbd_core::scene::{Emitter, Gas, Profile, Sheath, Smoke, SmokeSource};

    #[test]
    fn emitted_particles_are_counted_whether_or_not_they_live() {
        let emitter = Emitter {
            profile: Profile::Uniform,
            start: 1.0,
            stop: Some(3.0),
            throttle: false,
            sheath: Some(Sheath { thickness: 0.1, speed: Some(0.5), temperature: 0.0 }),
            smoke: Some(SmokeSource { material: "smoke".into(), per_particle: 4 }),
            ..Emitter::new("air", [0.0, 0.0], 0.2, 1.0)
        };
        let scene = Scene {
            spacing: 0.1,
            duration: 8.0,
            gas: vec![Gas { name: "air".into(), lifetime: Some(0.5), ..Gas::default() }],
            smoke: vec![Smoke { name: "smoke".into(), ..Smoke::default() }],
            emitter: vec![emitter],
            ..Scene::default()
        };
        // For 2 s: core 2 columns x 10 rows/s, sheath 2 columns x 5 rows/s, smoke 4 x 20 /s.
        assert_eq!(emitted(&scene), 40 + 20 + 160);
    }
}
