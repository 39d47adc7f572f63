//! How many substeps speed and pressure ask for.

use super::Scene;

/// Way per substep, in spacings, that the Courant-Friedrichs-Lewy condition allows.
const COURANT: f64 = 0.4;
/// The same where a coarse projection goes before, at a target compression of 1 %: it goes as the root of the target...
const COARSE_COURANT: f64 = 0.8;
/// ...within these limits.
const COARSE_COURANT_RANGE: [f64; 2] = [0.2, 1.6];

/// The law that the solver's choice and the estimate of a scene follow alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SubstepLaw {
    spacing: f64,
    target: f64,
    /// D/omega of the law C_max = (D/omega) P dt^2/dx^2.
    compressibility: f64,
    /// Whether a grid carries the pressure.
    coarse: bool,
}

impl SubstepLaw {
    pub fn new(scene: &Scene) -> Self {
        SubstepLaw {
            spacing: scene.spacing,
            target: scene.solver.target_compression,
            compressibility: scene.solver.compressibility(scene.gradients()),
            coarse: scene.solver.coarse_projection > 0,
        }
    }

    /// Substeps of a frame of this length [s] by speed [m/s] (CFL), by the trust region (the compression
    /// within one substep stays below 0.2), and by the target compression at this pressure over density
    /// [m^2/s^2].
    pub fn wanted(&self, frame: f64, speed: f64, pressure: f64) -> [f64; 3] {
        if self.coarse {
            // The grid holds the pressure; the particles only what is left of it.
            let [least, most] = COARSE_COURANT_RANGE;
            let courant = (COARSE_COURANT * (self.target / 0.01).sqrt()).clamp(least, most);
            return [frame * speed / (courant * self.spacing), 0.0, 0.0];
        }
        let root = (pressure / self.target * self.compressibility).sqrt();
        [
            frame * speed / (COURANT * self.spacing),
            2.0 * frame * pressure.sqrt() / self.spacing,
            frame / self.spacing * root,
        ]
    }
}
