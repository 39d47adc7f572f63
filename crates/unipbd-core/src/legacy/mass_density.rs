//! The density constraint as printed in Macklin & Müller 2013, for comparison: see
//! [`MassDensityDescription`](crate::scene::MassDensityDescription).

use super::kernels::Formula;
use crate::bytes::held;
use crate::constraints::{ConstraintGroup, Corrections, DensityColumns, DensityGroup, Needs, Substep};
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::phase::Phase;
use crate::scene::{Averaging, MassDensityDescription, MaterialRef, Scene};

/// C_i = rho_i/rho0_i - 1 with rho_i = sum_j m_j W_ij, bodies and walls left out.
pub struct MassDensity {
    kernel: Kernel<Formula>,
    averaging: Averaging,
    relaxation: Real,
    materials: Vec<Matter>,
    error: Vec<Real>,
    multiplier: Vec<Real>,
    rows: Vec<Row>,
}

/// Coefficients of a material in the group; all zero where it is no fluid.
#[derive(Clone, Copy, Default)]
struct Matter {
    mass: Real,
    inverse_density: Real,
    mixing: Real,
    multiplier_min: Real,
    /// Artificial pressure k, and 1/W at the distance where it has this size.
    pressure: Real,
    inverse_reference: Real,
}

/// Values of a row that the second pass reads.
#[derive(Clone, Copy, Default)]
struct Row {
    /// Multiplier over rest density.
    scaled: Real,
    /// sum_j m_j grad W_ij.
    gradient: Vector,
    neighbors: u32,
}

impl MassDensity {
    /// The group of a scene that asks for it, with this kernel.
    pub fn new(scene: &Scene, kernel: Kernel<Formula>, description: &MassDensityDescription) -> Self {
        let radius = scene.solver.kernel_radius * scene.spacing;
        let matter = |material: MaterialRef<'_>| {
            let (mixing, reference) = match material.phase() {
                Phase::Liquid => (description.liquid_mixing, description.liquid_reference),
                Phase::Gas => (description.gas_mixing, description.gas_reference),
                _ => return Matter::default(),
            };
            Matter {
                mass: real(material.particle_mass(scene.spacing)),
                inverse_density: real(1.0 / material.density()),
                mixing: real(mixing),
                multiplier_min: if material.is_two_sided() { Real::NEG_INFINITY } else { 0.0 },
                pressure: real(description.artificial_pressure),
                inverse_reference: 1.0 / kernel.value(real(reference * radius)),
            }
        };
        MassDensity {
            kernel,
            averaging: description.averaging,
            relaxation: real(scene.solver.relaxation.unwrap_or(1.0)),
            materials: scene.materials().map(matter).collect(),
            error: Vec::new(),
            multiplier: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// First pass: densities and multipliers.
    fn step_multipliers(&mut self, now: Substep<'_>) {
        let (kernel, materials, relaxation) = (self.kernel, &self.materials, self.relaxation);
        let (positions, inverse_masses) = (now.particles.positions(), now.particles.inverse_masses());
        let (material_of, periodic) = (now.particles.materials(), now.neighbors.periodic());
        let (error, multiplier, rows) = (&mut self.error, &mut self.multiplier, &mut self.rows);
        now.parallelism.chunks3(error, multiplier, rows, |first, error, multiplier, rows| {
            for k in 0..rows.len() {
                let i = first + k;
                let own = &materials[usize::from(material_of[i])];
                if own.mass == 0.0 {
                    (error[k], multiplier[k], rows[k]) = (0.0, 0.0, Row::default());
                    continue;
                }
                let mut density = own.mass * kernel.value(0.0);
                let (mut gradient, mut response, mut neighbors) = (Vector::ZERO, 0.0, 0);
                now.neighbors.for_each(i, |j| {
                    let apart = periodic.min_image(positions[i] - positions[j]);
                    let (distance, mass) = (apart.length(), materials[usize::from(material_of[j])].mass);
                    if mass > 0.0 && distance < kernel.radius() {
                        let slope = apart * (kernel.slope(distance) * mass);
                        density += mass * kernel.value(distance);
                        gradient += slope;
                        response += inverse_masses[j] * slope.length_squared();
                        neighbors += 1;
                    }
                });
                response += inverse_masses[i] * gradient.length_squared();
                response *= own.inverse_density * own.inverse_density;
                error[k] = density * own.inverse_density - 1.0;
                // A kinematic particle pushes and never pulls: its own response is missing.
                let least = if inverse_masses[i] == 0.0 { 0.0 } else { own.multiplier_min };
                multiplier[k] = (relaxation * error[k] / (response + own.mixing)).max(least);
                rows[k] = Row { scaled: multiplier[k] * own.inverse_density, gradient, neighbors };
            }
        });
    }

    /// Second pass: dx_i = -w_i sum_j ((l_i + s/2) m_j/rho0_i + (l_j + s/2) m_i/rho0_j) grad W_ij over the
    /// number of neighbours, with s = k (W/W0)^4. For equal masses and densities this is equation 14.
    fn displacement(&self, now: Substep<'_>, i: usize) -> Vector {
        let (positions, material_of) = (now.particles.positions(), now.particles.materials());
        let (kernel, periodic) = (self.kernel, now.neighbors.periodic());
        let (own, row) = (&self.materials[usize::from(material_of[i])], self.rows[i]);
        let inverse_mass = now.particles.inverse_masses()[i];
        let mut sum = row.gradient * (inverse_mass * row.scaled);
        now.neighbors.for_each(i, |j| {
            let apart = periodic.min_image(positions[i] - positions[j]);
            let (distance, other) = (apart.length(), &self.materials[usize::from(material_of[j])]);
            if other.mass > 0.0 && distance < kernel.radius() {
                let ratio = kernel.value(distance) * own.inverse_reference;
                let squared = ratio * ratio;
                let volumes = own.inverse_density * inverse_mass * other.mass + other.inverse_density;
                let pressure = 0.5 * own.pressure * squared * squared * volumes;
                sum += apart * (kernel.slope(distance) * (self.rows[j].scaled + pressure));
            }
        });
        match self.averaging {
            Averaging::Neighbors => -sum / row.neighbors.max(1) as Real,
            Averaging::None => -sum,
        }
    }
}

impl ConstraintGroup for MassDensity {
    fn name(&self) -> &str {
        "density"
    }

    fn needs(&self) -> Needs {
        Needs::NEIGHBORS
    }

    fn begin_substep(&mut self, now: Substep<'_>) {
        let rows = now.particles.dense();
        self.error.resize(rows, 0.0);
        self.multiplier.resize(rows, 0.0);
        self.rows.resize(rows, Row::default());
    }

    fn memory_bytes(&self) -> usize {
        held(&self.error) + held(&self.multiplier) + held(&self.rows)
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.step_multipliers(now);
        let (group, rows) = (&*self, now.particles.dense());
        let (inverse_masses, material_of) = (now.particles.inverse_masses(), now.particles.materials());
        now.parallelism.update(&mut out.displacements_mut()[..rows], |i, displacement| {
            if inverse_masses[i] > 0.0 && group.materials[usize::from(material_of[i])].mass > 0.0 {
                *displacement += group.displacement(now, i);
            }
        });
    }

    fn violation(&self) -> Option<f64> {
        Some(f64::from(self.error.iter().copied().fold(0.0, Real::max)))
    }

    fn as_density(&self) -> Option<&dyn DensityGroup> {
        Some(self)
    }
}

impl DensityGroup for MassDensity {
    fn columns(&self) -> DensityColumns<'_> {
        DensityColumns { error: &self.error, multiplier: &self.multiplier }
    }

    fn measure_density(&self, now: Substep<'_>) -> Vec<Real> {
        let (positions, material_of) = (now.particles.positions(), now.particles.materials());
        let (kernel, periodic) = (self.kernel, now.neighbors.periodic());
        let mut errors = vec![0.0; now.particles.len()];
        now.parallelism.update(&mut errors[..now.particles.dense()], |i, error| {
            let own = &self.materials[usize::from(material_of[i])];
            if own.mass > 0.0 {
                let mut density = 0.0;
                now.neighbors.for_each_near(positions[i], kernel.radius(), |j| {
                    let distance = periodic.min_image(positions[i] - positions[j]).length();
                    density += self.materials[usize::from(material_of[j])].mass * kernel.value(distance);
                });
                *error = density * own.inverse_density - 1.0;
            }
        });
        errors
    }
}
