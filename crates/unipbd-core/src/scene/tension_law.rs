//! What surface tension means for the number of substeps.

use super::{Liquid, Scene};

/// Radius of the kernel of surface tension \[spacings].
pub(crate) const TENSION_RADIUS: f64 = 3.0;
/// Longest substep over sqrt(rho dx^3/sigma), the time of the shortest wave: at 0.25 particles of the surface boil.
const LONGEST: f64 = 0.15;
/// Least radius of curvature whose pressure is expected \[spacings].
const SMALLEST_RADIUS: f64 = 2.0;

/// What the tension of a liquid asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TensionLaw {
    /// Largest pressure over density that it may bring about [m^2/s^2].
    pub pressure: f64,
    /// Least number of substeps per second, by the fastest wave of particles [1/s].
    pub rate: f64,
}

impl TensionLaw {
    /// The largest values of all liquids of a scene.
    pub fn new(scene: &Scene) -> Self {
        let laws = scene.liquid.iter().map(|liquid| TensionLaw::of(liquid, scene.spacing));
        laws.fold(TensionLaw::default(), |a, b| TensionLaw {
            pressure: a.pressure.max(b.pressure),
            rate: a.rate.max(b.rate),
        })
    }

    fn of(liquid: &Liquid, spacing: f64) -> Self {
        let mass = liquid.particle_mass.unwrap_or(liquid.density * spacing * spacing);
        let sigma = liquid.surface_tension;
        TensionLaw {
            pressure: sigma * spacing / (SMALLEST_RADIUS * mass),
            rate: (sigma / (mass * spacing)).sqrt() / LONGEST,
        }
    }
}
