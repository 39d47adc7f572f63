use super::threads::Threads;
use super::view::SubstepView;
use super::world::{Parts, World};
use super::{SolverError, Stage};
use crate::constraints::ConstraintGroup;
use crate::effects::Effect;
use crate::parallel::Parallelism;

/// A running simulation. Made by [`Scene::build`](crate::scene::Scene::build).
///
/// The frame is the unit of time: [`step_frame`](Solver::step_frame) takes the number of substeps that
/// follows from the state at the start of the frame.
pub struct Solver {
    pub(crate) world: World,
    threads: Threads,
}

/// Counts of one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FrameReport {
    /// Substeps done.
    pub substeps: u32,
    /// Neighbour lists built.
    pub list_builds: u32,
    /// Particles added by emitters.
    pub emitted: u64,
    /// Particles removed.
    pub removed: u64,
    /// Rows stepped, all substeps together: all but the sleeping ones.
    pub rows_stepped: u64,
}

impl Solver {
    /// A solver on this many threads.
    pub(crate) fn new(parts: Parts, threads: usize) -> Self {
        Solver { world: World::new(parts), threads: Threads::new(threads) }
    }

    /// Advances by one frame and returns its counts.
    ///
    /// # Errors
    /// [`SolverError::Diverged`] when a particle is absurdly fast or its velocity not finite.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # let water = vec![Liquid::new("water", 1000.0)];
    /// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
    /// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
    /// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// let report = solver.step_frame()?;
    /// assert!(report.substeps >= 1);
    /// assert_eq!(solver.positions().len(), solver.velocities().len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_frame(&mut self) -> Result<FrameReport, SolverError> {
        self.on_threads(World::frame)
    }

    /// Advances by one frame and calls `hook` at the start of each of its substeps, on the calling
    /// thread: for custom force fields and for kinematic particles.
    ///
    /// ```no_run
    /// # use unipbd_core::{Solver, SolverError, Vector};
    /// # fn spring(solver: &mut Solver) -> Result<(), SolverError> {
    /// solver.step_frame_with(|substep| -> Result<(), SolverError> {
    ///     for row in 0..substep.ids().len() {
    ///         let toward_origin = -9.0 * substep.positions()[row];
    ///         substep.add_acceleration(row, toward_origin);
    ///     }
    ///     Ok(())
    /// })?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// The error of `hook`, or a [`SolverError`] converted to its type, such as [`SolverError::Hook`] for an acceleration
    /// that is not finite or absurd. After an error of the hook the run
    /// stands between two substeps; the next call continues with the rest of the frame.
    pub fn step_frame_with<E: From<SolverError>>(
        &mut self,
        mut hook: impl FnMut(&mut SubstepView<'_>) -> Result<(), E>,
    ) -> Result<FrameReport, E> {
        let begun = self.on_threads(World::begin_frame)?;
        while self.world.begin_substep() {
            self.world.hooked = self.world.parts.particles.asleep() > 0;
            if let Err(error) = hook(&mut SubstepView::new(&mut self.world)) {
                self.world.parts.particles.clear_accelerations();
                return Err(error);
            }
            if let Err(error) = self.world.check_accelerations() {
                self.world.parts.particles.clear_accelerations();
                return Err(error.into());
            }
            self.on_threads(World::finish_substep)?;
        }
        Ok(self.on_threads(|world| world.end_frame(begun))?)
    }

    /// Projects the start without gravity until it is at rest density.
    pub(crate) fn settle(&mut self, substeps: Option<u32>, weigh: bool) {
        self.on_threads(|world| world.settle(substeps, weigh));
    }

    /// Adds a constraint group behind those of the scene. The stages are planned anew.
    pub fn add_group(&mut self, group: Box<dyn ConstraintGroup>) {
        // It may move sleeping liquid.
        self.on_threads(World::wake_for_good);
        self.world.parts.groups.push(group);
        self.world.replan();
    }

    /// Adds a velocity pass behind those of the scene. The stages are planned anew.
    ///
    /// A saved state holds no added effect: add it again after a restore.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # use unipbd_core::{constraints::{Needs, Substep}, effects::{Changes, Effect}};
    /// # let water = vec![Liquid::new("water", 1000.0)];
    /// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
    /// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
    /// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
    /// /// Air that carries everything along x.
    /// struct Wind;
    ///
    /// impl Effect for Wind {
    ///     fn name(&self) -> &'static str {
    ///         "wind"
    ///     }
    ///     fn needs(&self) -> Needs {
    ///         Needs::default()
    ///     }
    ///     fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
    ///         out.velocity.iter_mut().for_each(|change| change.x += 2.0 * now.dt);
    ///     }
    /// }
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// solver.add_effect(Box::new(Wind));
    /// solver.step_frame()?;
    /// assert!(solver.diagnostics().momentum.x > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_effect(&mut self, effect: Box<dyn Effect>) {
        // It may move sleeping liquid.
        self.on_threads(World::wake_for_good);
        self.world.parts.effects.push(effect);
        self.world.replan();
    }

    /// Wakes all bodies and liquids that sleep.
    pub fn wake(&mut self) {
        self.on_threads(World::wake_all);
    }

    /// Wakes a body, the bodies it sleeps with, and the liquid around them; tells whether there is such a body. Bodies
    /// are named by their place in [`Solver::bodies`].
    pub fn wake_body(&mut self, body: u32) -> bool {
        let there = self.bodies().get(body as usize).is_some_and(|body| !body.removed);
        if there {
            self.on_threads(|world| world.wake_body(body));
        }
        there
    }

    /// The row of the particle with this id, if it exists. Rows change from step to step, ids never do.
    ///
    /// Takes time proportional to the number of particles; for many lookups go once through
    /// [`ids`](Solver::ids).
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # let water = vec![Liquid::new("water", 1000.0)];
    /// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
    /// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
    /// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// let id = solver.ids()[0];
    /// solver.step_frame()?;
    /// let row = solver.row_of(id).expect("nothing removes particles here");
    /// let place = solver.positions()[row]; // where the same particle is now
    /// # assert!(place.is_finite());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn row_of(&self, id: u32) -> Option<usize> {
        self.ids().iter().position(|&other| other == id)
    }

    /// The stages of a substep of this scene, in order.
    pub fn stages(&self) -> &[Stage] {
        &self.world.plan.substep
    }

    /// The speed from which on a run counts as diverged [m/s]: a million spacings in a frame.
    pub fn speed_limit(&self) -> f64 {
        self.world.speed_limit()
    }

    /// The radius within which particles act on each other \[m].
    pub(crate) fn reach(&self) -> f64 {
        f64::from(self.world.parts.neighbors.radius())
    }

    /// Threads in use. Never changes results.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    /// From now on, uses this many threads.
    pub fn set_threads(&mut self, threads: usize) {
        self.threads = Threads::new(threads);
        // Until the next step: readers of the state must not ask for a pool that is gone.
        self.world.parts.parallelism = Parallelism::Serial;
    }

    pub(crate) fn on_threads<T: Send>(&mut self, work: impl FnOnce(&mut World) -> T + Send) -> T {
        let world = &mut self.world;
        self.threads.run(world.rows_to_share(), |parallelism| {
            world.parts.parallelism = parallelism;
            work(world)
        })
    }

    /// Read-only access: the loops of `work` run on the same threads as the last step.
    pub(crate) fn look_on_threads<T: Send>(&self, work: impl FnOnce(&World) -> T + Send) -> T {
        self.threads.run(self.world.rows_to_share(), |_| work(&self.world))
    }
}
