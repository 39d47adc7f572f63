use super::world::{Parts, World};
use super::{SolverError, Stage};
use crate::constraints::ConstraintGroup;
use crate::parallel::Parallelism;

/// A running simulation. Made by [`Scene::build`](crate::scene::Scene::build).
pub struct Solver {
    pub(crate) world: World,
    pool: Option<rayon::ThreadPool>,
}

/// What one frame did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameReport {
    /// Substeps done.
    pub substeps: u32,
    /// Neighbour lists built.
    pub list_builds: u32,
    /// Particles added by emitters.
    pub emitted: u64,
    /// Particles removed.
    pub removed: u64,
}

impl Solver {
    /// A solver on this many threads; with one, no pool is made.
    pub(crate) fn new(mut parts: Parts, threads: usize) -> Self {
        let pool = (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()).flatten();
        parts.parallelism = if pool.is_some() { Parallelism::Pool } else { Parallelism::Serial };
        Solver { world: World::new(parts), pool }
    }

    /// Advances by one frame and says what it did.
    ///
    /// # Errors
    /// [`SolverError::Diverged`] when a particle is absurdly fast or its velocity not finite.
    pub fn step_frame(&mut self) -> Result<FrameReport, SolverError> {
        self.on_threads(|world| world.frame(|_| ()))
    }

    /// Projects the start without gravity until it is at rest density.
    pub(crate) fn settle(&mut self, substeps: u32) {
        self.on_threads(|world| world.settle(substeps));
    }

    /// Adds a constraint group behind those of the scene. The stages are planned anew.
    pub fn add_group(&mut self, group: Box<dyn ConstraintGroup>) {
        self.world.parts.groups.push(group);
        self.world.plan();
    }

    /// The stages of a substep of this scene, in order.
    pub fn stages(&self) -> &[Stage] {
        &self.world.stages
    }

    fn on_threads<T: Send>(&mut self, work: impl FnOnce(&mut World) -> T + Send) -> T {
        let world = &mut self.world;
        match &self.pool {
            Some(pool) => pool.install(|| work(world)),
            None => work(world),
        }
    }
}
