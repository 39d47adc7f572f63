use crate::kernel::Kernel;
use crate::math::{Real, real};
use crate::phase::Phase;
use crate::scene::{GradientPoint, MaterialRef, Scene};

/// Settings of the density group.
#[derive(Clone, Debug, PartialEq)]
pub struct DensitySettings {
    /// Kernel radius h [m].
    pub kernel_radius: f64,
    /// Particle spacing dx [m].
    pub spacing: f64,
    /// What one neighbour counts: its volume, scaled so that the rest lattice reads 1 [m^2].
    pub volume: Real,
    /// Where gradients are taken.
    pub gradients: GradientPoint,
    /// Per material.
    pub materials: Vec<DensityMaterial>,
}

/// Settings of one material in the density group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityMaterial {
    /// Relaxation omega; 0 for a material without a density constraint.
    pub relaxation: Real,
    /// Smallest multiplier: 0 for a one-sided constraint, minus infinity for a two-sided one.
    pub multiplier_min: Real,
    /// The constraint is off below this density error.
    pub gate: Real,
    /// Floor of the denominator [1/(kg m^2)]: keeps thin places from being thrown about.
    pub response_min: Real,
    /// Pair repulsion below 0.8 spacings, as a fraction of the overlap.
    pub repulsion: Real,
}

/// The gas constraint is off below this density error: the edge of a plume.
const GAS_GATE: f64 = -0.3;
/// The denominator of a gas particle is at least this part of its value at rest.
const GAS_RESPONSE_FLOOR: f64 = 0.5;
/// Part of the overlap below 0.8 spacings that a pair of gas particles gives back per substep.
const GAS_REPULSION: f64 = 0.3;
/// Relaxation that is stable with a free surface.
const LIQUID_RELAXATION: f64 = 0.5;
/// Relaxation that is stable in filled domains: omega < 4/(3 lambda_max).
const GAS_RELAXATION: f64 = 0.4;

impl DensitySettings {
    /// The settings a scene asks for.
    pub fn new(scene: &Scene) -> Self {
        let radius = scene.solver.kernel_radius * scene.spacing;
        let kernel = Kernel::new(radius);
        let sums = kernel.lattice(scene.spacing);
        let volume = 1.0 / (sums.value + f64::from(kernel.value(0.0)));
        let rest_response = volume * volume * sums.gradient_squared;
        let default_gradients = if scene.gas.is_empty() { GradientPoint::Predicted } else { GradientPoint::Start };
        DensitySettings {
            kernel_radius: radius,
            spacing: scene.spacing,
            volume: real(volume),
            gradients: scene.solver.gradients.unwrap_or(default_gradients),
            materials: scene.materials().map(|material| DensityMaterial::new(material, scene, rest_response)).collect(),
        }
    }
}

impl DensityMaterial {
    fn new(material: MaterialRef<'_>, scene: &Scene, rest_response: f64) -> Self {
        let mass = material.density() * scene.spacing * scene.spacing;
        let relaxation = |default: f64| real(scene.solver.relaxation.unwrap_or(default));
        match material.phase() {
            Phase::Liquid => DensityMaterial {
                relaxation: relaxation(LIQUID_RELAXATION),
                multiplier_min: 0.0,
                gate: Real::NEG_INFINITY,
                response_min: real(1e-6 * rest_response / mass),
                repulsion: 0.0,
            },
            Phase::Gas => DensityMaterial {
                relaxation: relaxation(GAS_RELAXATION),
                multiplier_min: Real::NEG_INFINITY,
                gate: real(GAS_GATE),
                response_min: real(GAS_RESPONSE_FLOOR * rest_response / mass),
                repulsion: real(GAS_REPULSION),
            },
            Phase::Smoke | Phase::Rigid | Phase::Solid => DensityMaterial {
                relaxation: 0.0,
                multiplier_min: 0.0,
                gate: Real::NEG_INFINITY,
                response_min: 1.0,
                repulsion: 0.0,
            },
        }
    }
}
