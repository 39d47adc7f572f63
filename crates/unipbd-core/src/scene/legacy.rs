use serde::{Deserialize, Serialize};

/// Options of Macklin & Müller 2013, of Macklin et al. 2014 and of the program that this project grew from. They are
/// there for comparison: the defaults of the other tables are better in every case measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct LegacySettings {
    /// Smoothing kernel of the density.
    pub kernel: LegacyKernel,
    /// Constraint force mixing of Macklin & Müller 2013 (equation 11), as a part of the denominator at rest.
    pub constraint_mixing: f64,
    /// Artificial pressure k of Macklin & Müller 2013 (equation 13, n = 4, 0.2 h), in squared spacings.
    pub artificial_pressure: f64,
    /// A density weighted with masses, as printed in Macklin & Müller 2013, instead of the number density.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_density: Option<MassDensityDescription>,
    /// Averaged Jacobi for contacts of bodies, with this over-relaxation omega, 1 to 2, as in Macklin et al. 2014
    /// (section 4.2): nothing lasts, and friction is that of positions (equations 23 to 25). Simple; stacks sink and
    /// creep. Where both bodies have n contacts each moves by (omega/n) times the sum of its corrections, as there;
    /// where they have not, masses are split instead, so that momentum is kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub averaged_contacts: Option<f64>,
    /// Mass scaling k of Macklin et al. 2014 (equation 21) [1/m]; 0 for none. Contacts see masses m exp(-k h), h the
    /// height above the lowest support of a heap: upper bodies weigh less on lower ones, and fewer substeps carry a
    /// heap. Loads of contacts are then those of the scaled masses, and an impact loses momentum.
    pub mass_scaling: f64,
}

impl LegacySettings {
    /// Whether the density constraint is another one than the default.
    pub(crate) fn changes_density(&self) -> bool {
        let number = (self.kernel, self.constraint_mixing, self.artificial_pressure);
        number != (LegacyKernel::WendlandC2, 0.0, 0.0) || self.mass_density.is_some()
    }

    /// Whether contacts of bodies are solved in another way than by default.
    pub(crate) fn changes_contacts(&self) -> bool {
        self.averaged_contacts.is_some() || self.mass_scaling > 0.0
    }

    pub(crate) fn is_default(&self) -> bool {
        *self == LegacySettings::default()
    }
}

/// The smoothing kernel of a density that is there for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum LegacyKernel {
    /// Wendland C2, the kernel of everything else: the most accurate.
    #[default]
    WendlandC2,
    /// The cubic spline of Monaghan 1992.
    CubicSpline,
    /// Density by poly6, gradients by spiky, as in Müller et al. 2003: inconsistent, a column at rest keeps boiling.
    Poly6Spiky,
    /// The same with the constants of three dimensions, per metre of depth. They matter with a density
    /// weighted with masses alone: a number density is scaled to its lattice at rest.
    #[serde(rename = "poly6_spiky_3d")]
    Poly6Spiky3d,
}

/// A density weighted with masses, rho_i = sum_j m_j W_ij, and its constraint as printed in Macklin &
/// Müller 2013 (equations 1 to 14). Liquids are one-sided with a free surface and
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
