//! Constraint groups: the constraints between particles.
//!
//! A group solves all its constraints from one state and adds the displacements of rows to
//! [`Corrections`]; the loop applies them and goes on to the next group. Groups are open: implement
//! [`ConstraintGroup`] anywhere and hand it to [`Solver::add_group`](crate::Solver::add_group), or
//! implement [`Constraint`] and let [`Batch`] do the rest.

mod batch;
mod corrections;
mod density;
mod distance;
mod projection;
mod shape_matching;
mod surface_tension;
mod viscosity;

use std::ops::BitOr;

pub use batch::{Batch, Constraint};
pub(crate) use corrections::CorrectionParts;
pub use corrections::Corrections;
#[doc(hidden)]
pub use corrections::OutlineLoad;
pub(crate) use density::GRID_VELOCITY_SHARE;
#[doc(hidden)]
pub use density::{Density, DensityMaterial, DensitySettings};
pub use distance::{Distance, Tether};
#[doc(hidden)]
pub use shape_matching::{Member, ShapeMatching};
#[doc(hidden)]
pub use surface_tension::SurfaceTension;
#[doc(hidden)]
pub use viscosity::Viscosity;

use crate::math::{Real, Vector, Vector64};
use crate::neighbors::Neighbors;
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::passes::Pairs;
use crate::rigid::{Bodies, Mobilities, Mobility};
use crate::rows::RowIndex;
use crate::walls::{Outlines, Walls};

/// The data that a group needs from the loop; data that no group needs is not computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs(u8);

impl Needs {
    /// Nothing beyond the particles.
    pub const NOTHING: Needs = Needs(0);
    /// The neighbour list of the dense particles.
    pub const NEIGHBORS: Needs = Needs(1);
    /// The row of a particle by its id.
    pub const ROWS: Needs = Needs(2);
    /// A call of [`ConstraintGroup::finish_velocities`].
    pub const VELOCITY_PASS: Needs = Needs(4);
    /// The bodies that viscous fluids do not slip along.
    pub const WITHOUT_SLIP: Needs = Needs(8);

    /// Whether all of `other` is needed.
    pub const fn contains(self, other: Needs) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Needs {
    type Output = Needs;
    fn bitor(self, other: Needs) -> Needs {
        Needs(self.0 | other.0)
    }
}

/// One substep as groups and effects see it.
#[derive(Clone, Copy)]
pub struct Substep<'a> {
    /// Length of the substep \[s].
    pub dt: Real,
    /// Simulated time at the start of the substep \[s].
    pub time: f64,
    /// Largest pressure over density that a fluid may push with [m^2/s^2].
    pub pressure_limit: Real,
    /// Part of their stiffness that fluids have, 0 to 1.
    pub stiffness: Real,
    /// Whether the start of a run is being brought to its rest density: no force but that of the density acts.
    pub settling: bool,
    /// The particles, at their predicted or projected positions.
    pub particles: &'a Particles,
    /// Rows by id; kept only where a group [needs](Needs::ROWS) it.
    pub rows: &'a RowIndex,
    /// Neighbours of the dense rows; built only where a group [needs](Needs::NEIGHBORS) it.
    pub neighbors: &'a Neighbors,
    /// Bodies that viscous fluids do not slip along; listed only where a group [needs](Needs::WITHOUT_SLIP) them.
    pub without_slip: WithoutSlip<'a>,
    /// Bodies that are light beside the fluids they meet.
    pub light: &'a [LightBody],
    /// Static walls.
    pub walls: &'a Walls,
    /// Outlines of bodies that are walls too.
    pub outlines: &'a Outlines,
    /// How to spread work over threads.
    pub parallelism: Parallelism,
}

/// A body that is light beside the fluid it displaces.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct LightBody {
    /// Ids of its samples, from the first to one past the last.
    pub(crate) samples: (u32, u32),
    /// Its centre of mass, where it is predicted to be \[m].
    pub(crate) centre: Vector64,
    /// How it answers to a load.
    pub(crate) mobility: Mobility,
}

/// Bodies that viscous fluids do not slip along.
#[doc(hidden)]
#[derive(Clone, Copy)]
pub struct WithoutSlip<'a> {
    /// Their outlines, where they are predicted to be.
    pub(crate) outlines: &'a Outlines,
    /// All bodies, and how they answer to loads.
    pub(crate) bodies: Option<(&'a Bodies, &'a Mobilities)>,
}

impl<'a> Substep<'a> {
    /// The neighbour pairs of the dense rows, for the passes of [`simd`](crate::simd).
    pub fn pairs(&self) -> Pairs<'a> {
        Pairs::new(self.neighbors.list(), self.neighbors.periodic(), self.parallelism)
    }
}

/// A batch of constraints that are solved together.
pub trait ConstraintGroup: Send + Sync {
    /// The name under which the group is timed and logged.
    fn name(&self) -> &str;

    /// Requirements of the group on the loop.
    fn needs(&self) -> Needs;

    /// Called once per substep, after prediction and neighbour search.
    fn begin_substep(&mut self, now: Substep<'_>) {
        let _ = now;
    }

    /// One iteration: adds the wanted displacements of rows to `out`.
    fn project(&mut self, now: Substep<'_>, out: &mut Corrections);

    /// Changes velocities after they were updated from the displacements (with
    /// [`Needs::VELOCITY_PASS`]).
    fn finish_velocities(&mut self, now: Substep<'_>, velocities: &mut [Vector]) {
        let _ = (now, velocities);
    }

    /// Memory held by columns of its own \[bytes].
    fn memory_bytes(&self) -> usize {
        0
    }

    /// Largest violation after the last projection, in the group's own unit.
    fn violation(&self) -> Option<f64> {
        None
    }

    /// Adds the pressures over density that its forces bring about in fluid particles [m^2/s^2].
    fn add_pressures(&self, now: Substep<'_>, pressures: &mut [Real]) {
        let _ = (now, pressures);
    }

    /// This group as the one that holds the density, if it does.
    fn as_density(&self) -> Option<&dyn DensityGroup> {
        None
    }

    /// State to be saved beside the particles: words that [`restore`](Self::restore) takes.
    fn save(&self) -> Vec<u64> {
        Vec::new()
    }

    /// Restores the state that [`save`](Self::save) returned.
    fn restore(&mut self, saved: &[u64]) {
        let _ = saved;
    }
}

/// A group that holds the density of the fluids.
#[doc(hidden)]
pub trait DensityGroup: ConstraintGroup {
    /// Density errors and multipliers by row, after the last projection.
    fn columns(&self) -> DensityColumns<'_>;

    /// Density errors by row, at the present positions.
    fn measure_density(&self, now: Substep<'_>) -> Vec<Real>;

    /// Pressure over density by row [m^2/s^2], from the momentum that the multipliers of the last substep carry.
    fn measure_pressure(&self, now: Substep<'_>) -> Option<Vec<Real>> {
        let _ = now;
        None
    }

    /// The largest of these pressures, sought among the rows with the largest multipliers [m^2/s^2].
    fn measure_pressure_max(&self, now: Substep<'_>) -> Option<Real> {
        let _ = now;
        None
    }
}

/// Results of a density group, by row.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct DensityColumns<'a> {
    /// C = rho/rho0 - 1.
    pub error: &'a [Real],
    /// Lagrange multipliers [kg m^2].
    pub multiplier: &'a [Real],
}
