use serde::{Deserialize, Serialize};

use super::{GradientPoint, KernelKind, SolverSettings, Substeps};

/// A table of solver settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// The defaults.
    #[default]
    Standard,
    /// A museum piece: the choices of the program this project grew from, to compare with. One step of
    /// 1/60 s with three iterations, kernels with the constants of three dimensions, a density weighted
    /// with masses that walls and bodies have no part in, displacements divided by the number of
    /// neighbours. Compresses, boils and gains energy; nothing else uses it.
    Seed,
}

impl Preset {
    /// All settings of the preset.
    pub fn settings(self) -> SolverSettings {
        match self {
            Preset::Standard => SolverSettings::default(),
            Preset::Seed => SolverSettings {
                preset: self,
                substeps: Substeps::Fixed(1),
                iterations: 3,
                kernel: KernelKind::Poly6Spiky3d,
                gradients: Some(GradientPoint::Predicted),
                mass_density: Some(MassDensityDescription::default()),
                settle_substeps: Some(0),
                ..SolverSettings::default()
            },
        }
    }

    pub(crate) fn is_standard(&self) -> bool {
        *self == Preset::Standard
    }
}

/// A density weighted with masses, rho_i = sum_j m_j W_ij, and its constraint as printed in Macklin &
/// Müller 2013 (equations 1 to 14): for comparison. Liquids are one-sided with a free surface and
/// two-sided without. Walls and bodies have no part in the density: they only keep particles out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct MassDensityDescription {
    /// Constraint force mixing epsilon of liquids [1/(kg m^2)].
    pub liquid_mixing: f64,
    /// Constraint force mixing epsilon of gases [1/(kg m^2)].
    pub gas_mixing: f64,
    /// Artificial pressure k, with n = 4 [kg m^2].
    pub artificial_pressure: f64,
    /// Distance at which it has this size in liquids, as a part of the kernel radius.
    pub liquid_reference: f64,
    /// Distance at which it has this size in gases, as a part of the kernel radius.
    pub gas_reference: f64,
    /// What the displacement of a particle is divided by.
    pub averaging: Averaging,
}

impl Default for MassDensityDescription {
    fn default() -> Self {
        MassDensityDescription {
            liquid_mixing: 0.01,
            gas_mixing: 0.05,
            artificial_pressure: 0.1,
            liquid_reference: 0.2,
            gas_reference: 0.25,
            averaging: Averaging::Neighbors,
        }
    }
}

/// What the displacement of a particle is divided by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Averaging {
    /// Its number of neighbours: a column sinks to a fraction of its height.
    #[default]
    Neighbors,
    /// Nothing.
    None,
}
