//! Everything a run holds, and the frame loop over it.

use std::sync::OnceLock;

use super::integrate::BodyForce;
use super::pipeline::{Features, pipeline};
use super::substeps::{Demand, SubstepRule};
use super::timings::Timings;
use super::{FrameReport, SolverError, Stage};
use crate::constraints::{ConstraintGroup, Corrections, Needs, Substep};
use crate::effects::{Changes, Effect, SmokeAdvection};
use crate::math::{Real, Vector, wide};
use crate::neighbors::{Cover, Neighbors};
use crate::observe::{Event, Material, Severity};
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::phase::Phase;
use crate::rigid::RigidBodies;
use crate::rows::RowIndex;
use crate::sources::{EmitterSystem, RemovalRules};
use crate::walls::Walls;

/// What a scene is made of, before the loop sees it.
pub(crate) struct Parts {
    pub particles: Particles,
    pub materials: Vec<Material>,
    pub forces: Vec<BodyForce>,
    pub walls: Walls,
    pub neighbors: Neighbors,
    pub cover: Cover,
    pub groups: Vec<Box<dyn ConstraintGroup>>,
    pub effects: Vec<Box<dyn Effect>>,
    pub smoke: Option<SmokeAdvection>,
    pub rigid: Option<RigidBodies>,
    pub emitters: Option<EmitterSystem>,
    pub removal: Option<RemovalRules>,
    pub substeps: SubstepRule,
    pub iterations: u32,
    pub gravity: Vector,
    pub spacing: f64,
    pub frame_time: f64,
    pub seed: u64,
    pub parallelism: Parallelism,
}

/// Pressures up to this many times what depth and speed account for are believed.
const PRESSURE_MARGIN: f64 = 8.0;
/// Speed, in spacings per frame, that a compressed liquid may always reach.
const LEAST_SPEED: f64 = 2.0;

/// Where a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Clock {
    pub frame: u64,
    pub step: u64,
    pub time: f64,
    /// Length of the last substep [s].
    pub dt: f64,
    pub substeps: u32,
    pub list_builds: u32,
    /// Largest pressure over density that a liquid may push with [m^2/s^2].
    pub pressure_limit: f64,
    /// Fastest dense particle after the last substep [m/s].
    pub speed: f64,
    /// Advances whenever particles are added or removed.
    pub generation: u64,
}

/// A run.
pub(crate) struct World {
    pub parts: Parts,
    pub rows: RowIndex,
    pub clock: Clock,
    pub stages: Vec<Stage>,
    pub events: Vec<Event>,
    pub timings: Timings,
    /// Density errors at the positions of the last frame, once somebody asks for them.
    pub(super) measured: OnceLock<Vec<Real>>,
    /// Accelerations by row that a user added for the next substep [m/s^2].
    pub extra: Vec<Vector>,
    pub(super) corrections: Corrections,
    pub(super) changes: Changes,
    removed: Vec<u32>,
    pub(super) needs_rows: bool,
    capped: bool,
}

impl World {
    pub fn new(parts: Parts) -> Self {
        let mut world = World {
            parts,
            rows: RowIndex::default(),
            clock: Clock::default(),
            stages: Vec::new(),
            events: Vec::new(),
            timings: Timings::default(),
            measured: OnceLock::new(),
            extra: Vec::new(),
            corrections: Corrections::default(),
            changes: Changes::default(),
            removed: Vec::new(),
            needs_rows: false,
            capped: false,
        };
        world.plan();
        world
    }

    /// Decides the stages: called when the scene is built or its groups change.
    pub fn plan(&mut self) {
        let parts = &self.parts;
        let needs = parts.groups.iter().map(|group| group.needs()).fold(Needs::NOTHING, |a, b| a | b);
        let of_effects = parts.effects.iter().map(|effect| effect.needs()).fold(Needs::NOTHING, |a, b| a | b);
        self.stages = pipeline(Features {
            emitters: parts.emitters.is_some(),
            bodies: parts.rigid.is_some(),
            neighbors: parts.smoke.is_some() || (needs | of_effects).contains(Needs::NEIGHBORS),
            groups: !parts.groups.is_empty(),
            projection: !parts.groups.is_empty() || !parts.walls.is_empty(),
            velocity_passes: needs.contains(Needs::VELOCITY_PASS),
            effects: !parts.effects.is_empty(),
            smoke: parts.smoke.is_some(),
        });
        self.needs_rows = parts.emitters.is_some() || parts.rigid.is_some() || needs.contains(Needs::ROWS);
        self.index_rows();
    }

    /// Brings the row index up to date, where anyone asks for it.
    pub fn index_rows(&mut self) {
        if self.needs_rows {
            self.rows.rebuild(self.parts.particles.ids());
        }
    }

    /// Particles were added or removed: ids, rows and lists change.
    pub fn population_changed(&mut self) {
        self.clock.generation += 1;
        self.parts.neighbors.invalidate();
        self.index_rows();
    }

    /// One frame.
    pub fn frame(&mut self, mut hook: impl FnMut(&mut World)) -> Result<FrameReport, SolverError> {
        self.measured = OnceLock::new();
        let removed = self.remove();
        let ids_before = self.parts.particles.ids_given();
        let builds_before = self.parts.neighbors.builds();
        let substeps = self.choose_substeps();
        self.clock.pressure_limit = self.pressure_limit();
        let start = self.clock.frame as f64 * self.parts.frame_time;
        self.clock.dt = self.parts.frame_time / f64::from(substeps);
        self.clock.substeps = substeps;
        for substep in 0..substeps {
            self.clock.time = start + f64::from(substep) * self.clock.dt;
            hook(self);
            self.substep()?;
            self.clock.step += 1;
        }
        if let Some(rigid) = &mut self.parts.rigid {
            rigid.finish_frame(self.parts.frame_time);
        }
        self.clock.frame += 1;
        self.clock.time = self.clock.frame as f64 * self.parts.frame_time;
        self.clock.list_builds = (self.parts.neighbors.builds() - builds_before) as u32;
        let emitted = u64::from(self.parts.particles.ids_given() - ids_before);
        Ok(FrameReport { substeps, list_builds: self.clock.list_builds, emitted, removed })
    }

    /// Brings the start to its rest density: projection without gravity and without velocity.
    pub fn settle(&mut self, substeps: u32) {
        self.clock.dt = self.parts.frame_time;
        self.clock.pressure_limit = self.pressure_limit();
        if self.parts.particles.dense() > 0 {
            (0..substeps).for_each(|_| self.hold_still());
        }
        // The start can be observed like any other moment.
        if self.stages.contains(&Stage::FindNeighbors) {
            self.find_neighbors();
        }
        self.clock = Clock { generation: self.clock.generation, ..Clock::default() };
    }

    /// This moment as groups and effects see it.
    pub(super) fn now<'a>(parts: &'a Parts, rows: &'a RowIndex, clock: &Clock) -> Substep<'a> {
        Substep {
            dt: clock.dt as Real,
            time: clock.time,
            pressure_limit: clock.pressure_limit as Real,
            particles: &parts.particles,
            rows,
            neighbors: &parts.neighbors,
            walls: &parts.walls,
            parallelism: parts.parallelism,
        }
    }

    fn remove(&mut self) -> u64 {
        let Some(rules) = &mut self.parts.removal else { return 0 };
        rules.find(&self.parts.particles, self.clock.time, self.parts.parallelism, &mut self.removed);
        if self.removed.is_empty() {
            return 0;
        }
        self.parts.particles.remove_rows(&self.removed);
        self.population_changed();
        self.removed.len() as u64
    }

    fn choose_substeps(&mut self) -> u32 {
        let demand = self.demand();
        let choice = self.parts.substeps.choose(self.parts.frame_time, demand);
        let capped = choice.wanted > choice.substeps;
        if capped && !self.capped {
            let message = format!(
                "substeps capped at {}: {} were wanted for speed {:.3} m/s and pressure {:.3} m^2/s^2; \
                 raise solver.max_substeps to keep the target",
                choice.substeps, choice.wanted, demand.speed, demand.pressure
            );
            self.events.push(Event { time: self.clock.time, severity: Severity::Warning, message });
        }
        self.capped = capped;
        choice.substeps
    }

    /// What the number of substeps follows from.
    pub fn demand(&self) -> Demand {
        let parts = &self.parts;
        let emitted = parts.emitters.as_ref().map_or(0.0, |emitters| emitters.speed_max(self.clock.time));
        let moving = if self.clock.step == 0 { self.fastest() } else { self.clock.speed };
        let chain = parts.rigid.as_ref().map_or(0.0, |rigid| rigid.support_chain(wide(parts.gravity)));
        Demand { speed: moving.max(emitted), chain, pressure: self.depth_pressure().max(self.multiplier_pressure()) }
    }

    fn fastest(&self) -> f64 {
        let velocities = &self.parts.particles.velocity;
        let dense = self.parts.particles.dense();
        let square = self.parts.parallelism.max(dense, |row| velocities[row].length_squared());
        f64::from(square.max(0.0)).sqrt()
    }

    /// Pressure over density at the bottom of the liquid, from its extent along gravity [m^2/s^2].
    fn depth_pressure(&self) -> f64 {
        let parts = &self.parts;
        let gravity = parts.gravity.length();
        if gravity == 0.0 {
            return 0.0;
        }
        let (down, particles) = (parts.gravity / gravity, &parts.particles);
        let height = |row: usize| match particles.phase[row] {
            Phase::Liquid => particles.position[row].dot(down),
            _ => Real::NAN,
        };
        let low = parts.parallelism.max(particles.dense(), height);
        let high = parts.parallelism.max(particles.dense(), |row| -height(row));
        let depth = f64::from(low) + f64::from(high);
        if depth.is_finite() { f64::from(gravity) * depth * self.density_ratio() } else { 0.0 }
    }

    /// Pressure over density of the liquids after the last substep [m^2/s^2]: the largest one if it
    /// grows linearly with depth, taken from the mean square, so that a few particles squeezed in
    /// somewhere do not decide for all.
    fn multiplier_pressure(&self) -> f64 {
        if self.clock.step == 0 {
            return 0.0;
        }
        let particles = &self.parts.particles;
        let (sum, count) = self.over_liquids(|row| {
            let pressure = f64::from(particles.multiplier[row] * particles.inverse_mass[row]);
            pressure * pressure
        });
        (3.0 * sum / count.max(1.0)).sqrt() / (self.clock.dt * self.clock.dt)
    }

    /// The pressure that a liquid as deep and as fast as this one can reach, with a wide margin
    /// [m^2/s^2]. The speed is the fourth root of the mean fourth power: jets count, single drops do not.
    fn pressure_limit(&self) -> f64 {
        let velocities = &self.parts.particles.velocity;
        let (sum, count) = self.over_liquids(|row| {
            let square = f64::from(velocities[row].length_squared());
            square * square
        });
        let dynamic = 0.5 * (sum / count.max(1.0)).sqrt();
        let least = LEAST_SPEED * self.parts.spacing / self.parts.frame_time;
        PRESSURE_MARGIN * (self.depth_pressure() + dynamic) + least * least
    }

    /// Sum of a value over the liquid particles, and their number.
    fn over_liquids(&self, value: impl Fn(usize) -> f64 + Sync) -> (f64, f64) {
        let particles = &self.parts.particles;
        let liquid = |row: usize| particles.phase[row] == Phase::Liquid;
        let sum = self.parts.parallelism.sum(particles.dense(), |row| if liquid(row) { value(row) } else { 0.0 });
        (sum, self.parts.parallelism.sum(particles.dense(), |row| f64::from(u8::from(liquid(row)))))
    }

    /// Density of the heaviest liquid over that of the lightest: a light liquid carries a heavy one.
    fn density_ratio(&self) -> f64 {
        let liquids = self.parts.materials.iter().filter(|material| material.phase == Phase::Liquid);
        let (light, heavy) = liquids.fold((f64::INFINITY, 0.0_f64), |(light, heavy), liquid| {
            (light.min(liquid.density), heavy.max(liquid.density))
        });
        if heavy > 0.0 { heavy / light } else { 1.0 }
    }
}
