//! What a scene will cost: the estimate from its description, corrected by its first frame.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use unipbd_core::SolverError;
use unipbd_core::observe::Diagnostics;
use unipbd_core::scene::{BYTES_PER_PARTICLE, SECONDS_PER_PARTICLE_AND_SUBSTEP, Scene};

use crate::simulation::Simulation;

/// Particles from which the first frame is a fair sample of the machine.
const FAIR_SAMPLE: u64 = 500;

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

/// What a scene will cost.
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
    /// Looks at the start and at one frame.
    pub fn of(scene: &Scene, simulation: &mut Simulation) -> Self {
        let estimate = scene.estimate();
        let start = simulation.solver.diagnostics();
        let memory_at_start = simulation.solver.memory_bytes() as u64;
        let clock = Instant::now();
        let first_frame = simulation.next_frame().map_or(Ok(0), |frame| frame.map(|report| report.substeps));
        let measured = clock.elapsed().as_secs_f64();
        let particles = start.particles();
        let expected = particles as f64 * f64::from(estimate.substeps) * SECONDS_PER_PARTICLE_AND_SUBSTEP;
        let fair = particles >= FAIR_SAMPLE && expected > 0.0;
        let factor = if fair { measured / expected } else { 1.0 };
        let memory = if fair { memory_at_start.div_ceil(particles) } else { BYTES_PER_PARTICLE };
        Cost {
            peak: estimate.particles_at_peak,
            memory_at_peak: memory_at_start.max(memory.saturating_mul(estimate.particles_at_peak)),
            wall_time: Duration::try_from_secs_f64(estimate.cost_seconds * factor).unwrap_or(Duration::MAX),
            start,
            first_frame,
            memory_at_start,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use unipbd_core::scene::{Emitter, Gas, Profile, Sheath, Smoke, SmokeSource};

    #[test]
    fn emitted_particles_are_counted_whether_or_not_they_live() {
        let emitter = Emitter {
            name: String::new(),
            material: "air".into(),
            position: [0.0, 0.0],
            direction: [0.0, 1.0],
            width: 0.2,
            speed: 1.0,
            profile: Profile::Uniform,
            temperature: 1.0,
            jitter: 0.0,
            start: 1.0,
            stop: Some(3.0),
            throttle: false,
            sheath: Some(Sheath { thickness: 0.1, speed: Some(0.5), temperature: 0.0 }),
            smoke: Some(SmokeSource { material: "smoke".into(), per_particle: 4 }),
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
