//! The density constraint with another kernel, with constraint force mixing or with an artificial pressure (Macklin &
//! Müller 2013).

use super::kernels::{Formula, Tensile};
use crate::bytes::held;
use crate::constraints::{ConstraintGroup, Corrections, Density, DensityGroup, Needs, Substep};
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::passes::{self, Records};
use crate::phase::Phase;
use crate::scene::Scene;

/// Distance at which the artificial pressure has its nominal size, as a part of the kernel radius (Macklin & Müller
/// 2013, section 4).
const REFERENCE: f64 = 0.2;

/// The density constraints of all liquids and gases, with the options of the paper.
pub struct LegacyDensity {
    density: Density<Formula>,
    /// Weight of one neighbour [m^2].
    volume: Real,
    /// Constraint force mixing over the squared volume in units, by material [1/(kg m^2)]; empty for none.
    mixing: Vec<Real>,
    pressure: Option<ArtificialPressure>,
}

/// The artificial pressure of equations 13 and 14, for liquids alone.
struct ArtificialPressure {
    shape: Tensile<Formula>,
    /// Half of its k [m^2].
    half: Real,
    /// That over the inverse mass, by row.
    strength: Vec<Real>,
    sums: Vec<Vector>,
    records: Records,
}

impl LegacyDensity {
    /// The group of a scene, around its density group. `volume` is the weight of one neighbour there, and `unit`
    /// that of its responses [m^2].
    pub fn new(scene: &Scene, kernel: Kernel<Formula>, [volume, unit]: [Real; 2], density: Density<Formula>) -> Self {
        let (legacy, unit) = (&scene.legacy, f64::from(unit));
        let at_rest = legacy.constraint_mixing * kernel.lattice(scene.spacing).gradient_squared * unit * unit;
        let mixing = scene.materials().map(|material| match material.phase().is_fluid() {
            true => real(at_rest / material.particle_mass(scene.spacing)),
            false => 0.0,
        });
        let pressure = (legacy.artificial_pressure > 0.0).then(|| ArtificialPressure {
            shape: Tensile::new(kernel.shape(), REFERENCE * scene.solver.kernel_radius * scene.spacing),
            half: 0.5 * real(legacy.artificial_pressure * scene.spacing * scene.spacing),
            strength: Vec::new(),
            sums: Vec::new(),
            records: Records::default(),
        });
        let mixing = if legacy.constraint_mixing > 0.0 { mixing.collect() } else { Vec::new() };
        LegacyDensity { density, volume, mixing, pressure }
    }

    /// Adds to the denominators of equation 11. The sums are multiplied by the squared volume later.
    fn mix(&mut self, now: Substep<'_>) {
        if self.mixing.is_empty() {
            return;
        }
        let (mixing, material_of) = (&self.mixing, now.particles.materials());
        now.parallelism.update(self.density.responses_mut(), |i, response| {
            *response += mixing[usize::from(material_of[i])];
        });
    }
}

impl ArtificialPressure {
    fn project(&mut self, volume: Real, now: Substep<'_>, out: &mut Corrections) {
        let (half, rows) = (self.half, now.particles.listed());
        let (inverse_masses, phases) = (now.particles.inverse_masses(), now.particles.phases());
        self.strength.resize(now.particles.dense(), 0.0);
        now.parallelism.fill(&mut self.strength, |i| match phases[i] {
            Phase::Liquid if i < rows && inverse_masses[i] > 0.0 => half / inverse_masses[i],
            _ => 0.0,
        });
        self.sums.resize(rows, Vector::ZERO);
        let (positions, records) = (now.particles.positions(), &mut self.records);
        passes::correction(now.pairs(), self.shape, positions, &self.strength, records, &mut self.sums);
        let sums = &self.sums;
        now.parallelism.update(&mut out.displacements_mut()[..rows], |i, displacement| {
            *displacement -= sums[i] * (volume * inverse_masses[i]);
        });
    }
}

impl ConstraintGroup for LegacyDensity {
    fn name(&self) -> &str {
        self.density.name()
    }

    fn needs(&self) -> Needs {
        self.density.needs()
    }

    fn begin_substep(&mut self, now: Substep<'_>) {
        self.density.begin_substep(now);
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.density.begin_iteration(now);
        self.mix(now);
        self.density.end_iteration(now, out);
        if let Some(pressure) = &mut self.pressure {
            pressure.project(self.volume, now, out);
        }
    }

    fn memory_bytes(&self) -> usize {
        let of = |pressure: &ArtificialPressure| {
            held(&pressure.strength) + held(&pressure.sums) + pressure.records.memory_bytes()
        };
        self.density.memory_bytes() + held(&self.mixing) + self.pressure.as_ref().map_or(0, of)
    }

    fn violation(&self) -> Option<f64> {
        self.density.violation()
    }

    fn as_density(&self) -> Option<&dyn DensityGroup> {
        self.density.as_density()
    }
}
