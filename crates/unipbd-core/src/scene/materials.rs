use serde::{Deserialize, Serialize};

use crate::phase::Phase;

/// A liquid: resists compression, has a free surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Liquid {
    /// Name by which blocks and emitters refer to it.
    pub name: String,
    /// Rest density [kg/m^2].
    pub density: f64,
    /// Mass of a particle; left out, that of a square of the spacing \[kg].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub particle_mass: Option<f64>,
    /// XSPH smoothing (Schechter & Bridson 2012), 0 to 1: the fraction of velocity differences that each substep
    /// smooths. The viscosity that comes of it grows with the number of substeps.
    pub xsph: f64,
    /// Kinematic viscosity nu, of any strength, whatever the number of substeps [m^2/s].
    pub kinematic_viscosity: f64,
    /// Whether it has a free surface, or fills its domain and resists dilation too.
    pub surface: LiquidSurface,
    /// Surface tension sigma: the force along a line of the surface, in two dimensions a point \[N]. It is that of
    /// three dimensions [N/m] times the depth of the scene: 0.0728 for water in a sheet one metre thick. Between two
    /// liquids it is the sum of both.
    pub surface_tension: f64,
    /// Angle between its surface and walls or bodies, measured within it: 0 spreads, 180 pearls off; without surface
    /// tension it has no effect \[deg].
    pub contact_angle: f64,
    /// Drag against the air that grows with the square of the speed [1/m].
    pub quadratic_drag: f64,
    /// Factor on gravity.
    pub gravity_factor: f64,
    /// Colour in pictures and logs, `"#rrggbb"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

impl Default for Liquid {
    fn default() -> Self {
        Liquid {
            name: String::new(),
            density: 1000.0,
            particle_mass: None,
            xsph: 0.0,
            kinematic_viscosity: 0.0,
            surface: LiquidSurface::Free,
            surface_tension: 0.0,
            contact_angle: 90.0,
            quadratic_drag: 0.0,
            gravity_factor: 1.0,
            color: None,
        }
    }
}

/// Whether a liquid has a free surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum LiquidSurface {
    /// It resists compression alone and parts freely.
    #[default]
    Free,
    /// It fills its domain: it resists compression and dilation.
    None,
}

/// A gas: fills its domain or a plume, resists compression and dilation, carries heat and smoke.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Gas {
    /// Name by which blocks and emitters refer to it.
    pub name: String,
    /// Rest density [kg/m^2].
    pub density: f64,
    /// Mass of a particle; left out, that of a square of the spacing \[kg].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub particle_mass: Option<f64>,
    /// Acceleration is `gravity_factor` x temperature x gravity; negative lets hot gas rise.
    pub gravity_factor: f64,
    /// Drag rate k towards the environment velocity where the gas is thin [1/s].
    pub drag: f64,
    /// Drag that grows with the square of the speed [1/m].
    pub quadratic_drag: f64,
    /// Strength of vorticity confinement, the acceleration over vorticity times spacing (0 is off; above 5 in scenes of a
    /// few metres it adds energy) [1/s].
    pub vorticity: f64,
    /// Baroclinic turbulence beta, dimensionless: vorticity grows by beta grad(rho/rho0) x g, with
    /// rho/rho0 = 1 + `gravity_factor` x temperature, and less where the gas is thin.
    pub baroclinic: f64,
    /// Diffusivity of temperature [m^2/s].
    pub conductivity: f64,
    /// XSPH smoothing, 0 to 1: the fraction of velocity differences that each substep smooths.
    pub xsph: f64,
    /// Kinematic viscosity nu [m^2/s].
    pub kinematic_viscosity: f64,
    /// Time after which a particle is removed \[s]; left out, it stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lifetime: Option<f64>,
    /// A particle with no smoke within this distance is removed \[m]; left out, it stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep_radius: Option<f64>,
    /// Age below which `keep_radius` removes nothing \[s].
    pub keep_age: f64,
    /// Colour in pictures and logs, `"#rrggbb"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

impl Default for Gas {
    fn default() -> Self {
        Gas {
            name: String::new(),
            density: 1.2,
            particle_mass: None,
            gravity_factor: -0.3,
            drag: 0.0,
            quadratic_drag: 0.0,
            vorticity: 0.0,
            baroclinic: 0.0,
            conductivity: 0.0,
            xsph: 0.0,
            kinematic_viscosity: 0.0,
            lifetime: None,
            keep_radius: None,
            keep_age: 0.3,
            color: None,
        }
    }
}

/// Smoke: passive markers that show how the carrier around them moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Smoke {
    /// Name by which emitters refer to it.
    pub name: String,
    /// Time after which a marker is removed \[s]; left out, it stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lifetime: Option<f64>,
    /// Colour in pictures and logs, `"#rrggbb"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

/// A solid: free points with a mass, held together by constraints alone; no fluid feels them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Solid {
    /// Name by which points refer to it.
    pub name: String,
    /// Mass per area: a point has this times the square of the spacing [kg/m^2].
    pub density: f64,
    /// Factor on gravity.
    pub gravity_factor: f64,
    /// Colour in pictures and logs, `"#rrggbb"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

impl Default for Solid {
    fn default() -> Self {
        Solid { name: String::new(), density: 1000.0, gravity_factor: 1.0, color: None }
    }
}

/// A material of a scene, whatever its kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaterialRef<'a> {
    /// A liquid.
    Liquid(&'a Liquid),
    /// A gas.
    Gas(&'a Gas),
    /// A smoke.
    Smoke(&'a Smoke),
    /// A solid.
    Solid(&'a Solid),
    /// The samples of all rigid bodies.
    Rigid,
}

/// Name of the material of all samples of rigid bodies.
const RIGID: &str = "bodies";

impl<'a> MaterialRef<'a> {
    /// The name given in the scene.
    pub fn name(&self) -> &'a str {
        match self {
            MaterialRef::Liquid(liquid) => &liquid.name,
            MaterialRef::Gas(gas) => &gas.name,
            MaterialRef::Smoke(smoke) => &smoke.name,
            MaterialRef::Solid(solid) => &solid.name,
            MaterialRef::Rigid => RIGID,
        }
    }

    /// The phase of its particles.
    pub fn phase(&self) -> Phase {
        match self {
            MaterialRef::Liquid(_) => Phase::Liquid,
            MaterialRef::Gas(_) => Phase::Gas,
            MaterialRef::Smoke(_) => Phase::Smoke,
            MaterialRef::Solid(_) => Phase::Solid,
            MaterialRef::Rigid => Phase::Rigid,
        }
    }

    /// Rest density [kg/m^2]; 0 for smoke, which has no mass, and bodies, which have each their own.
    pub fn density(&self) -> f64 {
        match self {
            MaterialRef::Liquid(liquid) => liquid.density,
            MaterialRef::Gas(gas) => gas.density,
            MaterialRef::Smoke(_) | MaterialRef::Rigid => 0.0,
            MaterialRef::Solid(solid) => solid.density,
        }
    }

    /// Mass of one of its particles \[kg]; 0 for smoke and bodies.
    pub fn particle_mass(&self, spacing: f64) -> f64 {
        let given = match self {
            MaterialRef::Liquid(liquid) => liquid.particle_mass,
            MaterialRef::Gas(gas) => gas.particle_mass,
            _ => None,
        };
        given.unwrap_or(self.density() * spacing * spacing)
    }

    /// Kinematic viscosity [m^2/s].
    pub fn kinematic_viscosity(&self) -> f64 {
        match self {
            MaterialRef::Liquid(liquid) => liquid.kinematic_viscosity,
            MaterialRef::Gas(gas) => gas.kinematic_viscosity,
            _ => 0.0,
        }
    }

    /// Whether its density constraint resists dilation as well as compression.
    pub fn is_two_sided(&self) -> bool {
        match self {
            MaterialRef::Liquid(liquid) => liquid.surface == LiquidSurface::None,
            MaterialRef::Gas(_) => true,
            _ => false,
        }
    }

    /// The colour given in the scene.
    pub fn color(&self) -> Option<&'a str> {
        match self {
            MaterialRef::Liquid(liquid) => liquid.color.as_deref(),
            MaterialRef::Gas(gas) => gas.color.as_deref(),
            MaterialRef::Smoke(smoke) => smoke.color.as_deref(),
            MaterialRef::Solid(solid) => solid.color.as_deref(),
            MaterialRef::Rigid => None,
        }
    }
}

impl super::Scene {
    /// All materials in index order: liquids, gases, smokes, solids, each in file order, then the bodies.
    pub fn materials(&self) -> impl Iterator<Item = MaterialRef<'_>> {
        let liquids = self.liquid.iter().map(MaterialRef::Liquid);
        let gases = self.gas.iter().map(MaterialRef::Gas);
        let smokes = self.smoke.iter().map(MaterialRef::Smoke);
        let solids = self.solid.iter().map(MaterialRef::Solid);
        let bodies = (!self.body.is_empty()).then_some(MaterialRef::Rigid);
        liquids.chain(gases).chain(smokes).chain(solids).chain(bodies)
    }

    /// Index and description of the material with this name.
    pub fn material(&self, name: &str) -> Option<(usize, MaterialRef<'_>)> {
        self.materials().enumerate().find(|(_, material)| material.name() == name)
    }
}
