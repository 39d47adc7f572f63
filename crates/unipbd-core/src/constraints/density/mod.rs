//! The density constraint of all fluids: C = rho/rho0 - 1 (Macklin & Müller 2013, equation 1).
//!
//! The density is a number density: every dense particle counts with its volume, whatever its mass,
//! so two liquids meet without a gap. Mass enters only as the inverse mass of what moves. Liquids
//! resist compression alone, gas dilation too. One relaxed Jacobi step per substep replaces the many
//! iterations of a large step (Macklin et al. 2019).

mod light;
mod places;
mod pressure;
mod settings;
mod solve;

pub(crate) use settings::GRID_VELOCITY_SHARE;
pub use settings::{DensityMaterial, DensitySettings};

use super::{ConstraintGroup, Corrections, DensityColumns, DensityGroup, Needs, Substep};
use crate::bytes::held;
use crate::kernel::{Kernel, Shape, WendlandC2};
use crate::math::{Real, Vector};
use crate::passes::Records;
use crate::walls::Coverage;
use places::Places;

/// The density constraints of all liquids and gases of a scene.
pub struct Density<K = WendlandC2> {
    settings: DensitySettings,
    kernel: Kernel<K>,
    coverage: Coverage,
    /// Kernel sums by row: sum W, sum grad W, sum w |grad W|^2.
    sums: Sums,
    error: Vec<Real>,
    multiplier: Vec<Real>,
    /// Change of each multiplier in the iteration, in units of its own.
    step: Vec<Real>,
    wall_gradient: Vec<Vector>,
    places: Places,
    /// Repulsion strength by row.
    strength: Vec<Real>,
    records: Records,
}

/// Kernel sums over the neighbours of each row, the row itself left out.
#[derive(Clone, Debug, Default)]
struct Sums {
    value: Vec<Real>,
    gradient: Vec<Vector>,
    response: Vec<Real>,
}

impl Sums {
    fn memory_bytes(&self) -> usize {
        held(&self.value) + held(&self.gradient) + held(&self.response)
    }

    fn resize(&mut self, rows: usize) {
        self.value.resize(rows, 0.0);
        self.gradient.resize(rows, Vector::ZERO);
        self.response.resize(rows, 0.0);
    }
}

impl<K: Shape> Density<K> {
    /// A group with this kernel and these settings.
    pub fn new(kernel: Kernel<K>, settings: DensitySettings) -> Self {
        Density {
            kernel,
            coverage: match settings.upheld {
                true => Coverage::upholding(&kernel, settings.spacing),
                false => Coverage::new(&kernel),
            },
            places: Places::new(settings.gradients, settings.spacing),
            settings,
            sums: Sums::default(),
            error: Vec::new(),
            multiplier: Vec::new(),
            step: Vec::new(),
            wall_gradient: Vec::new(),
            strength: Vec::new(),
            records: Records::default(),
        }
    }

    fn resize(&mut self, rows: usize) {
        self.sums.resize(rows);
        self.error.resize(rows, 0.0);
        self.multiplier.resize(rows, 0.0);
        self.wall_gradient.resize(rows, Vector::ZERO);
    }

    /// The first half of an iteration: the kernel sums.
    pub(crate) fn begin_iteration(&mut self, now: Substep<'_>) {
        self.places.find(now);
        self.sum_kernels(now);
    }

    /// The sums of w |unit grad W|^2 of the iteration that has begun, by row [1/(kg m^2)].
    pub(crate) fn responses_mut(&mut self) -> &mut [Real] {
        &mut self.sums.response
    }

    /// The second half: multipliers and displacements.
    pub(crate) fn end_iteration(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.step_multipliers(now);
        self.give_way(now);
        self.shift(now, out);
        self.correct(now, out);
        self.load_bodies(now, out);
        self.load_walls(now, out);
        self.load_outlines(now, out);
        self.repel(now, out);
    }
}

impl<K: Shape> ConstraintGroup for Density<K> {
    fn name(&self) -> &str {
        "density"
    }

    fn needs(&self) -> Needs {
        Needs::NEIGHBORS
    }

    fn begin_substep(&mut self, now: Substep<'_>) {
        self.resize(now.particles.listed());
        self.multiplier.fill(0.0);
        self.step.resize(now.particles.dense(), 0.0);
        // No moving particle is near the rows behind the listed ones.
        self.step[now.particles.listed()..].fill(0.0);
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.begin_iteration(now);
        self.end_iteration(now, out);
    }

    fn memory_bytes(&self) -> usize {
        held(&self.error)
            + held(&self.multiplier)
            + held(&self.step)
            + held(&self.wall_gradient)
            + self.places.memory_bytes()
            + held(&self.strength)
            + self.sums.memory_bytes()
            + self.records.memory_bytes()
    }

    fn violation(&self) -> Option<f64> {
        let worst = self.error.iter().copied().fold(0.0, Real::max);
        Some(f64::from(worst))
    }

    fn as_density(&self) -> Option<&dyn DensityGroup> {
        Some(self)
    }
}

impl<K: Shape> DensityGroup for Density<K> {
    fn columns(&self) -> DensityColumns<'_> {
        DensityColumns { error: &self.error, multiplier: &self.multiplier }
    }

    fn measure_density(&self, now: Substep<'_>) -> Vec<Real> {
        self.measure(now)
    }

    fn measure_pressure(&self, now: Substep<'_>) -> Option<Vec<Real>> {
        Some(self.read_pressures(now))
    }

    fn measure_pressure_max(&self, now: Substep<'_>) -> Option<Real> {
        Some(self.read_largest_pressure(now))
    }
}
