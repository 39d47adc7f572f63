//! The complete state of a run, and the frame loop.

use std::ops::Range;
use std::sync::OnceLock;

use super::budget::Budget;
use super::clock::Clock;
use super::fluid_parts::Remake;
use super::integrate::BodyForce;
use super::pipeline::{Features, Plan};
use super::substeps::{Choice, SubstepRule};
use super::timings::Timings;
use super::watched::{Errors, Watched};
use super::{FrameReport, SolverError, Stage};
use crate::constraints::{ConstraintGroup, CorrectionParts, Corrections, Needs, Substep, WithoutSlip};
use crate::coupling::{RigidBodies, Ropes};
use crate::effects::{Changes, Effect, SmokeAdvection};
use crate::math::{Real, Vector, Vector64};
use crate::neighbors::{Neighbors, SavedList, SearchPositions};
use crate::observe::{Event, Material};
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::phase::MaterialIndex;
use crate::pressure_grid::PressureGrid;
use crate::rigid::{Wall, Waypoint};
use crate::rows::RowIndex;
use crate::scene::{Gauge, Scene};
use crate::sleep::LiquidSleep;
use crate::sources::{EmitterSystem, RemovalRules};
use crate::walls::{Outlines, Walls};

/// Contacts of a body in a dense heap: six neighbours, each contact shared by two bodies.
const CONTACTS_PER_BODY: usize = 3;

/// The parts of a scene that the loop works on.
pub(crate) struct Parts {
    pub particles: Particles,
    pub materials: Vec<Material>,
    pub forces: Vec<BodyForce>,
    pub walls: Walls,
    /// Outlines of bodies that are walls of the fluid.
    pub outlines: Outlines,
    /// Outlines of bodies that viscous fluids do not slip along.
    pub without_slip: Outlines,
    pub neighbors: Neighbors,
    pub search_positions: SearchPositions,
    pub pressure_grid: Option<PressureGrid>,
    pub groups: Vec<Box<dyn ConstraintGroup>>,
    /// Those of ropes among the groups.
    pub rope_groups: Range<usize>,
    pub ropes: Ropes,
    /// Number of ropes of the scene: the first.
    pub scene_ropes: usize,
    pub effects: Vec<Box<dyn Effect>>,
    pub smoke: Option<SmokeAdvection>,
    pub rigid: Option<RigidBodies>,
    pub emitters: Option<EmitterSystem>,
    /// Columns of each emitter of the scene; `None` where it has neither emitters nor injectors.
    pub scene_emitters: Option<Vec<usize>>,
    /// Materials and settings of the scene alone, for new emitters and ropes.
    pub kit: Scene,
    pub removal: Option<RemovalRules>,
    pub sleep: Option<LiquidSleep>,
    pub substeps: SubstepRule,
    pub iterations: u32,
    /// Violation of every group below which the iteration stops.
    pub tolerance: f64,
    /// Pressure over density per multiplier, inverse mass and squared substep: the gradient of the
    /// rest lattice is slightly too small, and the multipliers are too large by the same factor.
    pub pressure_scale: f64,
    pub gravity: Vector,
    /// That of the scene or the last edit, without the shaking, in double precision [m/s^2].
    pub exact_gravity: Vector64,
    /// Acceleration that is added to it: `offset` in m/s^2. Empty where the scene is not shaken.
    pub shaking: Vec<Waypoint>,
    /// Walls as solids, in the order in which contacts number them.
    pub solid_walls: Vec<Wall>,
    /// Number of bodies in the scene, and a mark of them and their joints.
    pub scene_bodies: usize,
    pub scene_mark: u64,
    /// No bodies, between the walls of the scene: the first body is added to them.
    pub no_bodies: RigidBodies,
    /// Material of the samples of bodies, where fluids see them.
    pub sample_material: Option<MaterialIndex>,
    /// Gauges read in each frame, in the order of the scene.
    pub gauges: Vec<Gauge>,
    /// Makes what fluids know of bodies, in a scene of fluids that began without bodies.
    pub remake: Option<Remake>,
    pub spacing: f64,
    pub frame_time: f64,
    pub seed: u64,
    pub parallelism: Parallelism,
}

/// State at the start of a frame.
pub(crate) struct Begun {
    removed: u64,
    ids: u32,
    builds: u64,
}

/// Whether the rows still belong to the same particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Population {
    Same,
    Changed,
}

/// Measurements after a frame, made on first access, by row.
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
    pub(super) plan: Plan,
    pub events: Vec<Event>,
    pub timings: Timings,
    pub(super) budget: Budget,
    pub(super) measured: Measured,
    pub(super) corrections: Corrections,
    pub(super) changes: Changes,
    /// Buffer for the velocity changes by groups.
    pub(super) velocities: Vec<Vector>,
    /// The criterion for the number of substeps of the last frame.
    pub(super) choice: Choice,
    /// History of the density errors of each material.
    pub(super) watched: Vec<Watched>,
    /// Buffer of the density errors by material.
    pub(super) material_errors: Vec<Errors>,
    /// Effects that are limited for stability, with a warning already issued.
    pub(super) cut: Vec<&'static str>,
    /// Iterations of the frame so far.
    pub(super) iterated: u32,
    /// Rows stepped in the frame so far, all substeps together.
    pub(super) stepped: u64,
    pub(super) removed: Vec<u32>,
    pub(super) needs_rows: bool,
    /// Whether a hook saw the running substep.
    pub(super) hooked: bool,
    /// Impulses on the measured walls in the frame so far [kg m/s].
    pub(super) wall_impulses: Vec<Vector64>,
    /// Mean forces on the measured walls in the last frame \[N].
    pub(super) wall_forces: Vec<Vector64>,
    /// Whether a frame was run since the build or the last restore: only then are the forces on walls known.
    pub(super) loads_known: bool,
}

impl World {
    pub fn new(parts: Parts) -> Self {
        let mut world = World {
            parts,
            rows: RowIndex::default(),
            clock: Clock::default(),
            plan: Plan::default(),
            events: Vec::new(),
            timings: Timings::default(),
            budget: Budget::default(),
            measured: Measured::default(),
            watched: Vec::new(),
            material_errors: Vec::new(),
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
            loads_known: false,
        };
        world.clear_wall_impulses();
        world.wall_forces.clone_from(&world.wall_impulses);
        world.replan();
        world
    }

    fn clear_wall_impulses(&mut self) {
        self.wall_impulses.clear();
        self.wall_impulses.resize(self.parts.walls.measured().len(), Vector64::ZERO);
    }

    /// Selects the stages: called when the scene is built or its groups change.
    pub fn replan(&mut self) {
        let needs = self.parts.groups.iter().map(|group| group.needs()).fold(Needs::NOTHING, |a, b| a | b);
        self.set_outlines(needs.contains(Needs::WITHOUT_SLIP));
        let parts = &self.parts;
        let of_effects = parts.effects.iter().map(|effect| effect.needs()).fold(Needs::NOTHING, |a, b| a | b);
        let measured_walls = parts.walls.measured().len();
        self.plan = Plan::new(Features {
            removal: parts.removal.is_some(),
            emitters: self.emits(),
            pressure_grid: parts.pressure_grid.is_some(),
            bodies: parts.rigid.is_some(),
            samples: parts.rigid.as_ref().is_some_and(RigidBodies::has_followers),
            sleep: parts.sleep.is_some(),
            neighbors: parts.smoke.is_some() || (needs | of_effects).contains(Needs::NEIGHBORS),
            groups: !parts.groups.is_empty(),
            density: parts.groups.iter().any(|group| group.as_density().is_some()),
            walls: !parts.walls.is_empty(),
            measured_walls: measured_walls > 0,
            velocity_passes: needs.contains(Needs::VELOCITY_PASS),
            effects: !parts.effects.is_empty(),
            smoke: parts.smoke.is_some(),
        });
        self.corrections.select(CorrectionParts {
            loads: parts.rigid.is_some(),
            grid_shifts: parts.pressure_grid.is_some(),
            walls: measured_walls,
            outlines: parts.outlines.len(),
            without_slip: parts.without_slip.len(),
        });
        self.needs_rows = self.emits() || parts.rigid.is_some() || needs.contains(Needs::ROWS);
        self.index_rows();
    }

    /// Takes the outlines of the bodies that there are; whether a group needs those without slip.
    fn set_outlines(&mut self, without_slip: bool) {
        let Parts { rigid, outlines, without_slip: sticking, materials, .. } = &mut self.parts;
        let fluids = materials.iter().filter(|material| material.phase.is_fluid());
        let heaviest = fluids.map(|material| material.density).fold(0.0, f64::max);
        rigid.iter_mut().for_each(|rigid| rigid.set_heaviest(heaviest));
        match rigid {
            Some(rigid) => rigid.set_outlines(outlines),
            None => outlines.set(std::iter::empty()),
        }
        match rigid.as_ref().filter(|_| without_slip) {
            Some(rigid) => rigid.set_without_slip(sticking),
            None => sticking.set(std::iter::empty()),
        }
    }

    /// Updates the row index, if it is needed.
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

    /// One frame, or the rest of a frame that was interrupted by an error.
    pub fn frame(&mut self) -> Result<FrameReport, SolverError> {
        let begun = self.begin_frame()?;
        while self.begin_substep() {
            self.finish_substep()?;
        }
        self.end_frame(begun)
    }

    /// Runs the stages that begin a frame and chooses the number of its substeps.
    pub fn begin_frame(&mut self) -> Result<Begun, SolverError> {
        self.measured = Measured::default();
        self.removed.clear();
        if self.clock.done == 0 {
            self.budget.begin_frame();
            (self.iterated, self.stepped) = (0, 0);
            self.parts.rigid.iter_mut().for_each(|rigid| rigid.bodies.begin_frame());
            self.shake(self.clock.time);
            self.wake_shaken();
            self.run_all(|plan| &plan.begin)?;
            if !self.sleeps() {
                let before = self.clock.dt;
                self.clear_wall_impulses();
                self.clock.substeps = self.choose_substeps();
                self.clock.dt = self.parts.frame_time / f64::from(self.clock.substeps);
                self.keep_pressure_asleep(before);
            }
            self.budget.begin_substeps();
        }
        Ok(Begun {
            removed: self.removed.len() as u64,
            ids: self.parts.particles.ids_given(),
            builds: self.parts.neighbors.builds(),
        })
    }

    fn run_all(&mut self, stages: impl Fn(&Plan) -> &[Stage]) -> Result<(), SolverError> {
        (0..stages(&self.plan).len()).try_for_each(|index| self.run_timed(stages(&self.plan)[index]))
    }

    /// Sets the clock to the next substep; false when the frame is done.
    pub fn begin_substep(&mut self) -> bool {
        let start = self.clock.frame as f64 * self.parts.frame_time;
        self.clock.time = start + f64::from(self.clock.done) * self.clock.dt;
        self.clock.done < self.clock.substeps
    }

    /// Rows of the longest loop: particles, or contacts of bodies, of which each body has a few.
    pub fn rows_to_share(&self) -> usize {
        let bodies = self.parts.rigid.as_ref().map_or(0, |rigid| rigid.bodies.len());
        self.parts.particles.len().max(CONTACTS_PER_BODY * bodies)
    }

    /// The stages of the substep.
    pub fn finish_substep(&mut self) -> Result<(), SolverError> {
        self.wake_what_hooks_moved();
        self.shake(self.clock.time + 0.5 * self.clock.dt);
        self.substep()?;
        self.clock.step += 1;
        self.clock.done += 1;
        Ok(())
    }

    /// Runs the stages that end a frame and sets the clock to its end.
    pub fn end_frame(&mut self, begun: Begun) -> Result<FrameReport, SolverError> {
        self.run_all(|plan| &plan.end)?;
        self.check_finite()?;
        self.watch_density();
        self.budget.end_frame(self.clock.substeps);
        let inverse = 1.0 / self.parts.frame_time;
        self.wall_forces = self.wall_impulses.iter().map(|impulse| *impulse * inverse).collect();
        self.loads_known = true;
        self.clock.done = 0;
        self.clock.frame += 1;
        self.clock.time = self.clock.frame as f64 * self.parts.frame_time;
        self.shake(self.clock.time);
        self.clock.list_builds = (self.parts.neighbors.builds() - begun.builds) as u32;
        Ok(FrameReport {
            substeps: self.clock.substeps,
            list_builds: self.clock.list_builds,
            emitted: u64::from(self.parts.particles.ids_given() - begun.ids),
            removed: begun.removed,
            rows_stepped: self.stepped,
        })
    }

    /// Rebuilds the list of a saved state, and discards earlier measurements.
    pub fn restore_list(&mut self, list: &SavedList) {
        self.loads_known = false;
        self.measured = Measured::default();
        self.parts.neighbors.restore(&self.parts.particles, list, self.parts.parallelism);
        if let Some(sleep) = &mut self.parts.sleep {
            sleep.forget();
        }
        self.index_rows();
    }

    /// Rows were edited between two frames: speeds, ids and lists are rebuilt.
    pub fn edited(&mut self, population: Population) {
        self.measured = Measured::default();
        if population == Population::Changed {
            self.population_changed();
        }
        self.clock.speed = self.fastest();
        self.parts.particles.start_here();
        self.find_neighbors_if_listed();
    }

    /// The current moment, as passed to groups and effects.
    pub(super) fn now<'a>(parts: &'a Parts, rows: &'a RowIndex, clock: &Clock) -> Substep<'a> {
        Substep {
            dt: clock.dt as Real,
            time: clock.time,
            pressure_limit: clock.pressure_limit as Real,
            stiffness: clock.stiffness as Real,
            settling: clock.settling,
            particles: &parts.particles,
            rows,
            neighbors: &parts.neighbors,
            light: parts.rigid.as_ref().map_or(&[], RigidBodies::light),
            without_slip: WithoutSlip {
                outlines: &parts.without_slip,
                bodies: parts.rigid.as_ref().map(RigidBodies::movers),
            },
            walls: &parts.walls,
            outlines: &parts.outlines,
            parallelism: parts.parallelism,
        }
    }
}
