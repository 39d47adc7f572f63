//! How many substeps speed and pressure ask for.

use super::{Scene, TensionLaw};

/// Substeps of a frame of 1/60 s that ropes and soft bodies need with the grid at least: at one a buoy shakes on its rope,
/// at four it pulls with its lift.
const TIED: f64 = 4.0 * 60.0;
/// Way per substep, in spacings, that the Courant-Friedrichs-Lewy condition allows.
pub(crate) const COURANT: f64 = 0.4;
/// The same with the pressure grid, at a target compression of 1 %: it goes as the root of the target...
const GRID_COURANT: f64 = 0.8;
/// ...shorter for fluids that fill their domain: their compression falls with the substeps alone...
const FILLED_GRID_COURANT: f64 = 0.5;
/// ...within these limits.
const GRID_COURANT_RANGE: [f64; 2] = [0.2, 1.6];

/// The law that the solver's choice and the estimate of a scene follow alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SubstepLaw {
    spacing: f64,
    target: f64,
    courant: f64,
    /// Whether particles alone hold the pressure.
    alone: bool,
    /// Whether all fluids have a surface.
    free: bool,
    /// Whether particles alone hold gas in a closed tank: its buoyancy presses on the lid.
    pub confines_gas: bool,
    /// Substeps per second that ropes and soft bodies need where the grid holds the pressure.
    tied: f64,
    /// D/omega of the law C_max = (D/omega) P dt^2/dx^2.
    compressibility: f64,
    /// What surface tension asks for.
    tension: TensionLaw,
}

impl SubstepLaw {
    pub fn new(scene: &Scene) -> Self {
        let (spacing, target) = (scene.spacing, scene.solver.target_compression);
        let tension = TensionLaw::new(scene);
        let confines_gas = !scene.gas.is_empty() && scene.has_closed_tank() && !scene.uses_pressure_grid();
        let free = !scene.materials().any(|material| material.phase().is_fluid() && material.is_two_sided());
        if scene.uses_pressure_grid() {
            // The grid holds the pressure; the particles only what is left of it.
            let [least, most] = GRID_COURANT_RANGE;
            let courant = if free { GRID_COURANT } else { FILLED_GRID_COURANT };
            let courant = (courant * (target / 0.01).sqrt()).clamp(least, most);
            return SubstepLaw {
                spacing,
                target,
                courant,
                alone: false,
                free,
                confines_gas,
                tied: if scene.has_tied_particles() { TIED } else { 0.0 },
                compressibility: 0.0,
                tension,
            };
        }
        let compressibility = scene.solver.compressibility(scene.gradients());
        let (courant, alone, tied) = (COURANT, true, 0.0);
        SubstepLaw { spacing, target, courant, alone, free, confines_gas, tied, compressibility, tension }
    }

    /// Whether the compression of its particles is what carries a fluid that can expand: then it stores energy.
    pub fn stores_energy(&self) -> bool {
        self.alone && self.free
    }

    /// Largest pressure over density that surface tension may bring about [m^2/s^2].
    pub fn tension_pressure(&self) -> f64 {
        self.tension.pressure
    }

    /// Substeps of a frame of this length \[s] by speed [m/s] (CFL), by the trust region (the same for the speed that
    /// this pressure over density [m^2/s^2] may still bring about: the compression within one substep stays below
    /// an eighth), by the target compression at this pressure or what holds particles together, and by surface tension.
    pub fn wanted(&self, frame: f64, speed: f64, pressure: f64) -> [f64; 4] {
        let root = (pressure / self.target * self.compressibility).sqrt();
        // The fastest and the most pressed are seldom one, so not the 2 P of Bernoulli.
        let trusted = if self.alone { (speed * speed + pressure).sqrt() } else { 0.0 };
        [
            frame * speed / (self.courant * self.spacing),
            frame * trusted / (self.courant * self.spacing),
            (frame / self.spacing * root).max(frame * self.tied),
            frame * self.tension.rate,
        ]
    }
}
