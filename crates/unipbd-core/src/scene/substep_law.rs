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

/// What the number of substeps follows.
#[derive(Clone, Copy)]
pub(crate) struct Drive {
    /// Fastest particle [m/s].
    pub speed: f64,
    /// Largest pressure over density [m^2/s^2].
    pub pressure: f64,
    /// Acceleration of the fluids by gravity and hooks [m/s^2].
    pub acceleration: f64,
}

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

    /// Whether the compression of its particles is what carries a fluid that can expand, for it has a surface or bodies
    /// that give way: then it stores energy.
    pub fn stores_energy(&self, loaded: bool) -> bool {
        self.alone && (self.free || loaded)
    }

    /// Way of sound per substep, where particles alone hold the pressure \[spacings]: the law makes C = P/c^2.
    pub fn sound(&self) -> f64 {
        1.0 / self.compressibility.sqrt()
    }

    /// Largest pressure over density that surface tension may bring about [m^2/s^2].
    pub fn tension_pressure(&self) -> f64 {
        self.tension.pressure
    }

    /// Substeps of a frame of this length \[s] by speed (CFL), by the trust region (the same for the speed that the
    /// pressure may still bring about: the compression within one substep stays below an eighth), by the target
    /// compression or what holds particles together, and by surface tension.
    pub fn wanted(&self, frame: f64, Drive { speed, pressure, acceleration }: Drive) -> [f64; 4] {
        // The fastest and the most pressed are seldom one, so not the 2 P of Bernoulli.
        let trusted = if self.alone { (speed * speed + pressure).sqrt() } else { 0.0 };
        [
            frame * speed / (self.courant * self.spacing),
            frame * trusted / (self.courant * self.spacing),
            (frame * self.held_rate(pressure, acceleration)).max(frame * self.tied),
            frame * self.tension.rate,
        ]
    }

    /// Substeps per second that hold the target compression against this pressure, where particles carry it alone. What
    /// the grid leaves to them is a part of the way of a free fall: in pools of 5e-5 to 4e-3 m spacing the worst C is
    /// 0.6 to 1.6 % per spacing of g dt^2.
    fn held_rate(&self, pressure: f64, acceleration: f64) -> f64 {
        match self.alone {
            true => (pressure / self.target * self.compressibility).sqrt() / self.spacing,
            false => (acceleration / self.spacing).sqrt() * GRID_COURANT / self.courant,
        }
    }

    /// Speed that a fluid at rest, which has so far to fall \[m], may gain in its first frame: only with the grid does the
    /// number of substeps follow the speed alone.
    pub fn first_speed(&self, frame: f64, acceleration: f64, depth: f64) -> f64 {
        if self.alone { 0.0 } else { (acceleration * frame).min((2.0 * acceleration * depth).sqrt()) }
    }
}
