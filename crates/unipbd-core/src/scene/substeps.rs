//! How many substeps speed and pressure ask for.

use super::Scene;

/// Way per substep, in spacings, that the Courant-Friedrichs-Lewy condition allows.
const COURANT: f64 = 0.4;

/// The law that the solver's choice and the estimate of a scene follow alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SubstepLaw {
    spacing: f64,
    target: f64,
    /// D/omega of the law C_max = (D/omega) P dt^2/dx^2.
    compressibility: f64,
}

impl SubstepLaw {
    pub fn new(scene: &Scene) -> Self {
        SubstepLaw {
            spacing: scene.spacing,
            target: scene.solver.target_compression,
            compressibility: scene.solver.compressibility(),
        }
    }

    /// Substeps of a frame of this length [s] by speed [m/s] (CFL), by the trust region (the compression
    /// within one substep stays below 0.2), and by the target compression at this pressure over density
    /// [m^2/s^2].
    pub fn wanted(&self, frame: f64, speed: f64, pressure: f64) -> [f64; 3] {
        let root = (pressure / self.target * self.compressibility).sqrt();
        [
            frame * speed / (COURANT * self.spacing),
            2.0 * frame * pressure.sqrt() / self.spacing,
            frame / self.spacing * root,
        ]
    }
}
