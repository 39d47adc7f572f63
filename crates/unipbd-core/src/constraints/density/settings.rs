use crate::kernel::{Kernel, Shape};
use crate::math::{Real, real};
use crate::passes::Reach;
use crate::phase::Phase;
use crate::scene::{GradientPoint, MaterialRef, Scene};

/// Settings of the density group.
#[derive(Clone, Debug, PartialEq)]
pub struct DensitySettings {
    /// Particle spacing dx \[m].
    pub spacing: f64,
    /// Weight of one neighbour: its volume, scaled so that the rest lattice reads 1 [m^2].
    pub volume: Real,
    /// The power of two below it: [responses](crate::passes::DensityOutput::response) are taken in this unit [m^2].
    pub unit: Real,
    /// A power of two about as large as multipliers: their steps are summed in this unit [kg m^2].
    pub step_unit: Real,
    /// -sum of y dW/dy over the rest lattice [1/m^2].
    pub moment: f64,
    /// Where gradients are taken.
    pub gradients: GradientPoint,
    /// The inverse mass of all dense particles, where they have but one [1/kg].
    pub uniform_inverse_mass: Option<Real>,
    /// Whether walls [uphold](crate::walls::Coverage::upholding) the lowest row: of liquids, which have a level. Fluids
    /// that fill their domain have none, and would only be held back along the walls.
    pub upheld: bool,
    /// Pair repulsion, where there is gas.
    pub repulsion: Option<Reach>,
    /// Farthest that a particle is shifted in one substep, where any material is \[m].
    pub farthest_shift: Option<Real>,
    /// Where the fastest goes less far in a substep, all are shifted less \[m].
    pub whole_shift: Real,
    /// Part of each displacement that velocities follow; the rest moves particles alone.
    pub velocity_share: Real,
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
    /// The same for kinematic particles, whose own response is missing from the denominator: their weak contacts must
    /// not throw other particles [1/(kg m^2)].
    pub kinematic_response_min: Real,
    /// Mass of a particle \[kg]: times the pressure limit it bounds the multiplier.
    pub mass: Real,
    /// How far it is shifted down the gradient of the kernel sum, to even out the arrangement [m^2].
    pub shifting: Real,
    /// Repulsion strength; the product of two, times an inverse mass, is the part of its overlap that
    /// a pair gives back per substep [kg^1/2].
    pub repulsion: Real,
}

/// The gas constraint is off below this density error: the edge of a plume.
const GAS_GATE: f64 = -0.3;
/// The denominator of a particle that resists dilation too is at least this part of its value at rest.
const FILLED_RESPONSE_FLOOR: f64 = 0.5;
/// The denominator of a kinematic particle, of any fluid, is at least this part of its value at rest.
const KINEMATIC_RESPONSE_FLOOR: f64 = 0.5;
/// Gas particles nearer than this many spacings repel each other...
const REPULSION_REACH: f64 = 0.8;
/// ...as much as at this many spacings where they are nearer still: particles thrown together in one
/// substep must not be thrown apart in the next...
const REPULSION_FULL: f64 = 0.6;
/// ...by this part of their overlap per substep.
const GAS_REPULSION: f64 = 0.8;
/// No particle is shifted farther than this in one substep \[spacings].
const FARTHEST_SHIFT: f64 = 0.05;
/// Where the fastest goes less far in a substep than this, all are shifted in proportion: an arrangement is
/// strained by the way it goes, however many substeps that takes, and what rests is left alone \[spacings].
const WHOLE_SHIFT: f64 = 0.15;
/// Where the pressure grid carries the pressure, velocities follow this part of a displacement: disorder is left
/// to the particles. Followed wholly, a drop drawn out loses 5 % of its energy; not at all, a dam break gains
/// 0.7 %. Less at low speeds spares drops, but slows ramps by 2 % and the Rayleigh-Taylor instability by 4 %.
pub(crate) const GRID_VELOCITY_SHARE: Real = 0.3;
/// Density errors at which shifting ends and is whole: at an edge it would spread into the void.
const SHIFT_GATE: [Real; 2] = [-0.15, -0.05];

impl DensitySettings {
    /// The settings a scene asks for, with this kernel.
    pub fn new<K: Shape>(scene: &Scene, kernel: &Kernel<K>) -> Self {
        let sums = kernel.lattice(scene.spacing);
        let volume = 1.0 / (sums.value + f64::from(kernel.value(0.0)));
        let rest_response = volume * volume * sums.gradient_squared;
        let two_sided = scene.materials().any(|material| material.is_two_sided());
        let materials = scene.materials().map(|material| DensityMaterial::new(material, scene, rest_response));
        let materials: Vec<DensityMaterial> = materials.collect();
        let shifts = materials.iter().any(|material| material.shifting > 0.0);
        let repels = materials.iter().any(|material| material.repulsion > 0.0);
        DensitySettings {
            spacing: scene.spacing,
            volume: real(volume),
            unit: real(power_of_two_below(volume)),
            step_unit: real(power_of_two_below(volume * lightest_mass(scene, |other| other.phase().is_fluid()))),
            moment: sums.moment,
            gradients: scene.gradients(),
            uniform_inverse_mass: uniform_mass(scene).map(|mass| real(1.0 / mass)),
            upheld: !two_sided,
            repulsion: repels.then(|| repulsion_reach(scene.spacing)),
            farthest_shift: shifts.then(|| real(FARTHEST_SHIFT * scene.spacing)),
            whole_shift: real(WHOLE_SHIFT * scene.spacing),
            velocity_share: if scene.uses_pressure_grid() { GRID_VELOCITY_SHARE } else { 1.0 },
            materials,
        }
    }
}

impl DensityMaterial {
    fn new(material: MaterialRef<'_>, scene: &Scene, rest_response: f64) -> Self {
        let mass = material.particle_mass(scene.spacing);
        if !material.phase().is_fluid() {
            return DensityMaterial::NONE;
        }
        let response = rest_response / mass;
        let one_sided = DensityMaterial {
            relaxation: real(scene.solver.relaxation_of_liquids(scene.gradients())),
            multiplier_min: 0.0,
            gate: Real::NEG_INFINITY,
            response_min: real(1e-6 * response),
            kinematic_response_min: real(KINEMATIC_RESPONSE_FLOOR * response),
            mass: real(mass),
            shifting: 0.0,
            repulsion: 0.0,
        };
        if !material.is_two_sided() {
            return one_sided;
        }
        let filled = DensityMaterial {
            relaxation: real(scene.solver.relaxation_of_filled()),
            multiplier_min: Real::NEG_INFINITY,
            response_min: real(FILLED_RESPONSE_FLOOR * response),
            ..one_sided
        };
        // The lightest sets the force: a heavier one moves less.
        if material.phase() == Phase::Gas {
            // Gas has edges, and streams of it meet: it is held apart by a push that velocities follow.
            let lightest = lightest_mass(scene, |other| other.is_two_sided());
            let repulsion = real((GAS_REPULSION * lightest).sqrt());
            return DensityMaterial { gate: real(GAS_GATE), repulsion, ..filled };
        }
        // Beside a light liquid with a surface that is hardly at all: shifting would crush it.
        let lightest = lightest_mass(scene, |other| other.phase() == Phase::Liquid);
        let shifting = scene.solver.shifting_of_filled() / f64::from(scene.solver.iterations.max(1));
        DensityMaterial { shifting: real(2.0 * shifting / rest_response * (lightest / mass)), ..filled }
    }

    /// A material without a density constraint.
    const NONE: DensityMaterial = DensityMaterial {
        relaxation: 0.0,
        multiplier_min: 0.0,
        gate: Real::NEG_INFINITY,
        response_min: 1.0,
        kinematic_response_min: 1.0,
        mass: 0.0,
        shifting: 0.0,
        repulsion: 0.0,
    };

    /// How far a particle with this density error is shifted down the gradient [m^2].
    #[inline]
    pub fn shift(&self, error: Real) -> Real {
        let [none, whole] = SHIFT_GATE;
        self.shifting * ((error - none) / (whole - none)).clamp(0.0, 1.0)
    }
}

/// The largest power of two that is not above a positive number; 1 for infinity.
fn power_of_two_below(value: f64) -> f64 {
    const MANTISSA: u64 = (1 << (f64::MANTISSA_DIGITS - 1)) - 1;
    if value.is_finite() { f64::from_bits(value.to_bits() & !MANTISSA) } else { 1.0 }
}

/// The smallest mass of a particle of these materials \[kg].
fn lightest_mass(scene: &Scene, counts: impl Fn(&MaterialRef<'_>) -> bool) -> f64 {
    let masses = scene.materials().filter(counts).map(|material| material.particle_mass(scene.spacing));
    masses.fold(f64::INFINITY, f64::min)
}

/// Distances at which a repulsion begins and grows no more.
fn repulsion_reach(spacing: f64) -> Reach {
    Reach { full: real(REPULSION_FULL * spacing), none: real(REPULSION_REACH * spacing) }
}

/// The mass of every dense particle, if it is the same for all and none is kinematic \[kg].
fn uniform_mass(scene: &Scene) -> Option<f64> {
    let dense = scene.materials().filter(|material| material.phase().is_dense());
    let mut masses = dense.map(|material| material.particle_mass(scene.spacing));
    let first = masses.next()?;
    let uniform = scene.emitter.is_empty() && scene.body.is_empty() && masses.all(|mass| mass == first);
    uniform.then_some(first)
}
