//! Everything a run holds, and the frame loop over it.

use crate::bytes::held;
use std::sync::OnceLock;

use super::integrate::{self, BodyForce};
use super::pipeline::{Features, pipeline};
use super::substeps::{Choice, SubstepRule};
use super::timings::Timings;
use super::{FrameReport, SolverError, Stage};
use crate::constraints::{ConstraintGroup, Corrections, Needs, Substep};
use crate::coupling::RigidBodies;
use crate::effects::{Changes, Effect, SmokeAdvection};
use crate::math::{Real, Vector, Vector64};
use crate::neighbors::{Neighbors, SavedList, SearchPositions};
use crate::observe::{Event, Material};
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::pressure_grid::CoarseProjection;
use crate::rows::RowIndex;
use crate::sleep::LiquidSleep;
use crate::sources::{EmitterSystem, RemovalRules};
use crate::walls::Walls;

/// Settling ends where no particle moves farther than this many spacings in a substep.
const SETTLED: f64 = 1e-5;
/// Projections that settle any start...
const SETTLING: f64 = 100.0;
/// ...and those that each layer takes where the liquid is no wider than...
const SETTLING_PER_LAYER: f64 = 3.0;
/// ...this many spacings: walls make the rows beside them too dense, and a wider one hardly rises by that.
const NARROW: f64 = 16.0;

/// What a scene is made of, before the loop sees it.
pub(crate) struct Parts {
    pub particles: Particles,
    pub materials: Vec<Material>,
    pub forces: Vec<BodyForce>,
    pub walls: Walls,
    pub neighbors: Neighbors,
    pub search_positions: SearchPositions,
    pub coarse: Option<CoarseProjection>,
    pub groups: Vec<Box<dyn ConstraintGroup>>,
    pub effects: Vec<Box<dyn Effect>>,
    pub smoke: Option<SmokeAdvection>,
    pub rigid: Option<RigidBodies>,
    pub emitters: Option<EmitterSystem>,
    pub removal: Option<RemovalRules>,
    pub sleep: Option<LiquidSleep>,
    pub substeps: SubstepRule,
    pub iterations: u32,
    /// Violation of every group at which the iteration stops.
    pub tolerance: f64,
    /// Pressure over density per multiplier, inverse mass and squared substep: the gradient of the
    /// rest lattice falls a little short, and the multipliers are as much too large.
    pub pressure_scale: f64,
    pub gravity: Vector,
    pub spacing: f64,
    pub frame_time: f64,
    pub seed: u64,
    pub parallelism: Parallelism,
}

/// Where a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Clock {
    pub frame: u64,
    pub step: u64,
    pub time: f64,
    /// Length of the last substep [s].
    pub dt: f64,
    pub substeps: u32,
    /// Substeps done of a frame that an error interrupted.
    pub done: u32,
    pub list_builds: u32,
    /// Largest pressure over density that a fluid may push with [m^2/s^2].
    pub pressure_limit: f64,
    /// Part of their stiffness that fluids have.
    pub stiffness: f64,
    /// Whether the last frame was denied substeps.
    pub capped: bool,
    /// Fastest dense particle after the last substep [m/s].
    pub speed: f64,
    /// Advances whenever particles are added or removed.
    pub generation: u64,
}

/// Where a frame began.
pub(crate) struct Begun {
    removed: u64,
    ids: u32,
    builds: u64,
}

/// Whether the rows are still those of the same particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Population {
    Same,
    Changed,
}

/// What is measured after a frame, once somebody asks for it, by row.
#[derive(Default)]
pub(crate) struct Measured {
    /// Density errors at the positions of the last frame.
    pub density: OnceLock<Vec<Real>>,
    /// Pressure over density [m^2/s^2].
    pub pressure: OnceLock<Vec<Real>>,
}

/// A run.
pub(crate) struct World {
    pub parts: Parts,
    pub rows: RowIndex,
    pub clock: Clock,
    pub stages: Vec<Stage>,
    pub events: Vec<Event>,
    pub timings: Timings,
    pub(super) measured: Measured,
    pub(super) corrections: Corrections,
    pub(super) changes: Changes,
    /// Room for the velocities that groups change.
    pub(super) velocities: Vec<Vector>,
    /// Why the last frame took the substeps it took.
    pub(super) choice: Choice,
    /// Effects that are cut to what is stable, and were warned of.
    pub(super) cut: Vec<&'static str>,
    /// Iterations of the frame so far.
    pub(super) iterated: u32,
    /// Rows stepped in the frame so far, all substeps together.
    pub(super) stepped: u64,
    removed: Vec<u32>,
    pub(super) needs_rows: bool,
    /// Whether a hook saw the running substep.
    pub(super) hooked: bool,
    /// Impulses on the measured walls in the frame so far [kg m/s].
    pub(super) wall_impulses: Vec<Vector64>,
    /// Mean forces on the measured walls in the last frame [N].
    pub(super) wall_forces: Vec<Vector64>,
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
            measured: Measured::default(),
            cut: Vec::new(),
            corrections: Corrections::default(),
            changes: Changes::default(),
            velocities: Vec::new(),
            choice: Choice::default(),
            iterated: 0,
            stepped: 0,
            removed: Vec::new(),
            needs_rows: false,
            hooked: false,
            wall_impulses: Vec::new(),
            wall_forces: Vec::new(),
        };
        world.forget_walls();
        world.wall_forces.clone_from(&world.wall_impulses);
        world.plan();
        world
    }

    fn forget_walls(&mut self) {
        self.wall_impulses.clear();
        self.wall_impulses.resize(self.parts.walls.measured().len(), Vector64::ZERO);
    }

    /// Decides the stages: called when the scene is built or its groups change.
    pub fn plan(&mut self) {
        let parts = &self.parts;
        let needs = parts.groups.iter().map(|group| group.needs()).fold(Needs::NOTHING, |a, b| a | b);
        let of_effects = parts.effects.iter().map(|effect| effect.needs()).fold(Needs::NOTHING, |a, b| a | b);
        self.stages = pipeline(Features {
            emitters: parts.emitters.is_some(),
            coarse: parts.coarse.is_some(),
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
        if let Some(sleep) = &mut self.parts.sleep {
            sleep.forget();
        }
        self.index_rows();
    }

    /// One frame, or the rest of one that an error interrupted.
    pub fn frame(&mut self) -> Result<FrameReport, SolverError> {
        let begun = self.begin_frame();
        while self.begin_substep() {
            self.finish_substep()?;
        }
        Ok(self.end_frame(begun))
    }

    /// Removes what is to go and decides how many substeps the frame takes.
    pub fn begin_frame(&mut self) -> Begun {
        self.measured = Measured::default();
        let mut removed = 0;
        if self.clock.done == 0 {
            removed = self.remove();
            (self.iterated, self.stepped) = (0, 0);
            if !self.sleeps() {
                let before = self.clock.dt;
                self.forget_walls();
                self.clock.substeps = self.choose_substeps();
                self.clock.dt = self.parts.frame_time / f64::from(self.clock.substeps);
                self.keep_pressure_asleep(before);
            }
        }
        Begun { removed, ids: self.parts.particles.ids_given(), builds: self.parts.neighbors.builds() }
    }

    /// Sets the clock to the next substep; false when the frame is done.
    pub fn begin_substep(&mut self) -> bool {
        let start = self.clock.frame as f64 * self.parts.frame_time;
        self.clock.time = start + f64::from(self.clock.done) * self.clock.dt;
        self.clock.done < self.clock.substeps
    }

    /// The stages of the substep.
    pub fn finish_substep(&mut self) -> Result<(), SolverError> {
        self.wake_what_hooks_moved();
        self.substep()?;
        self.clock.step += 1;
        self.clock.done += 1;
        Ok(())
    }

    /// Sets the clock to the end of the frame.
    pub fn end_frame(&mut self, begun: Begun) -> FrameReport {
        self.fall_asleep();
        if let Some(rigid) = &mut self.parts.rigid {
            rigid.follow_particles(&self.parts.particles, &self.rows);
            rigid.finish_frame(self.parts.frame_time);
        }
        let inverse = 1.0 / self.parts.frame_time;
        self.wall_forces = self.wall_impulses.iter().map(|impulse| *impulse * inverse).collect();
        self.clock.done = 0;
        self.clock.frame += 1;
        self.clock.time = self.clock.frame as f64 * self.parts.frame_time;
        self.clock.list_builds = (self.parts.neighbors.builds() - begun.builds) as u32;
        FrameReport {
            substeps: self.clock.substeps,
            list_builds: self.clock.list_builds,
            emitted: u64::from(self.parts.particles.ids_given() - begun.ids),
            removed: begun.removed,
            rows_stepped: self.stepped,
        }
    }

    /// Makes the list of a saved state again, and forgets what was measured before.
    pub fn restore_list(&mut self, list: &SavedList) {
        self.measured = Measured::default();
        self.parts.neighbors.restore(&self.parts.particles, list, self.parts.parallelism);
        if let Some(sleep) = &mut self.parts.sleep {
            sleep.forget();
        }
        self.index_rows();
    }

    /// Rows were edited between two frames: speeds, ids and lists are found again.
    pub fn edited(&mut self, population: Population) {
        self.measured = Measured::default();
        if population == Population::Changed {
            self.population_changed();
        }
        self.clock.speed = self.fastest();
        self.parts.particles.start_here();
        if self.stages.contains(&Stage::FindNeighbors) {
            self.find_neighbors();
        }
    }

    /// Brings the start to its rest density: projection without gravity and without velocity.
    pub fn settle(&mut self, substeps: Option<u32>) {
        let substeps = substeps.unwrap_or_else(|| self.settling());
        self.clock.dt = self.parts.frame_time;
        self.clock.pressure_limit = self.pressure_limit();
        self.clock.stiffness = 1.0;
        if self.parts.particles.dense() > 0 {
            // Once nothing moves any more, nothing will.
            let still = SETTLED * self.parts.spacing;
            (0..substeps).find(|_| self.relax_once() <= still);
            integrate::zero_displacements(&mut self.parts.particles);
        }
        // The start can be observed like any other moment.
        if self.stages.contains(&Stage::FindNeighbors) {
            self.find_neighbors();
        }
        self.clock = Clock { generation: self.clock.generation, ..Clock::default() };
    }

    /// Projections that bring the start to its rest density, if nothing is said about them.
    fn settling(&self) -> u32 {
        let [width, layers] = self.extent().map(|extent| extent / self.parts.spacing);
        (SETTLING_PER_LAYER * layers * (NARROW / width).min(1.0)).max(SETTLING) as u32
    }

    /// This moment as groups and effects see it.
    pub(super) fn now<'a>(parts: &'a Parts, rows: &'a RowIndex, clock: &Clock) -> Substep<'a> {
        Substep {
            dt: clock.dt as Real,
            time: clock.time,
            pressure_limit: clock.pressure_limit as Real,
            stiffness: clock.stiffness as Real,
            particles: &parts.particles,
            rows,
            neighbors: &parts.neighbors,
            walls: &parts.walls,
            parallelism: parts.parallelism,
        }
    }

    pub fn memory_bytes(&self) -> usize {
        let parts = &self.parts;
        let shared = parts.particles.memory_bytes() + parts.neighbors.memory_bytes() + self.rows.memory_bytes();
        let groups = parts.groups.iter().map(|group| group.memory_bytes()).sum::<usize>();
        let effects = parts.effects.iter().map(|effect| effect.memory_bytes()).sum::<usize>();
        let coarse = parts.coarse.as_ref().map_or(0, CoarseProjection::memory_bytes);
        let room = coarse + self.corrections.memory_bytes() + self.changes.memory_bytes() + held(&self.velocities);
        shared + groups + effects + room
    }

    fn remove(&mut self) -> u64 {
        let Some(rules) = &mut self.parts.removal else { return 0 };
        rules.find(&self.parts.particles, self.clock.time, self.parts.parallelism, &mut self.removed);
        if self.removed.is_empty() {
            return 0;
        }
        let places = self.places(&self.removed);
        self.parts.particles.remove_rows(&self.removed);
        self.population_changed();
        self.wake_near(&places);
        self.removed.len() as u64
    }
}
