use serde::{Deserialize, Serialize};

use super::{
    Block, BodyDescription, ContactDescription, Disc, Emitter, Expect, Gas, Gauge, HalfPlane, Heater, Injector,
    JointDescription, LegacySettings, Liquid, Obstacle, Points, Rope, Shaking, Sink, Smoke, Solid, SolverSettings,
    Tank, Wave,
};

/// A whole scene. All quantities are in SI units; angles carry the suffix `_deg`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Scene {
    /// Title shown by viewers and `unipbd info`.
    pub name: String,
    /// What the scene shows and what to look at.
    pub description: String,
    /// Rest distance between neighbouring particles, dx [m].
    pub spacing: f64,
    /// Gravitational acceleration [m/s^2].
    pub gravity: [f64; 2],
    /// Simulated time of a run [s].
    pub duration: f64,
    /// Output frames per simulated second [1/s].
    pub fps: f64,
    /// Seed of every random choice: jitter, wind, noise.
    pub seed: u64,
    /// How the constraints are solved.
    pub solver: SolverSettings,
    /// How contacts of bodies are solved.
    #[serde(skip_serializing_if = "ContactDescription::is_default")]
    pub contacts: ContactDescription,
    /// Options of the papers and the program that this project grew from.
    #[serde(skip_serializing_if = "LegacySettings::is_default")]
    pub legacy: LegacySettings,
    /// An acceleration that is added to gravity over time.
    #[serde(skip_serializing_if = "no_shaking")]
    pub shaking: Shaking,
    /// The air around an open scene.
    pub environment: Environment,
    /// Periodic axes and the region outside which particles are removed.
    pub domain: Domain,
    /// What pictures show.
    pub view: View,
    /// Liquids, one table each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub liquid: Vec<Liquid>,
    /// Gases, one table each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gas: Vec<Gas>,
    /// Smokes, one table each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub smoke: Vec<Smoke>,
    /// Solids, one table each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub solid: Vec<Solid>,
    /// Rectangles filled with particles at the start.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub block: Vec<Block>,
    /// Discs filled with particles at the start.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub disc: Vec<Disc>,
    /// Particles at places given one by one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<Points>,
    /// Sources of particles.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub emitter: Vec<Emitter>,
    /// Static straight walls without end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub half_plane: Vec<HalfPlane>,
    /// Static containers: particles stay inside.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tank: Vec<Tank>,
    /// Rigid bodies, one table each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub body: Vec<BodyDescription>,
    /// Joints between bodies, or a body and the world.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub joint: Vec<JointDescription>,
    /// Ropes of points.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rope: Vec<Rope>,
    /// Static boxes: particles stay outside.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub obstacle: Vec<Obstacle>,
    /// Waves of the start.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub wave: Vec<Wave>,
    /// Sources of particles at random places of a region.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub injector: Vec<Injector>,
    /// Regions that take particles away.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sink: Vec<Sink>,
    /// Regions that warm or cool gas.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub heater: Vec<Heater>,
    /// Numbers that a run reads of itself, once per frame.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gauge: Vec<Gauge>,
    /// What a run is expected to do.
    #[serde(skip_serializing_if = "is_default")]
    pub expect: Expect,
}

impl Default for Scene {
    fn default() -> Self {
        Scene {
            name: String::new(),
            description: String::new(),
            spacing: 0.1,
            gravity: [0.0, -9.81],
            duration: 5.0,
            fps: 60.0,
            seed: 0,
            solver: SolverSettings::default(),
            contacts: ContactDescription::default(),
            legacy: LegacySettings::default(),
            shaking: Shaking::default(),
            environment: Environment::default(),
            domain: Domain::default(),
            view: View::default(),
            liquid: Vec::new(),
            gas: Vec::new(),
            smoke: Vec::new(),
            solid: Vec::new(),
            block: Vec::new(),
            disc: Vec::new(),
            points: Vec::new(),
            emitter: Vec::new(),
            half_plane: Vec::new(),
            tank: Vec::new(),
            body: Vec::new(),
            joint: Vec::new(),
            rope: Vec::new(),
            obstacle: Vec::new(),
            wave: Vec::new(),
            injector: Vec::new(),
            sink: Vec::new(),
            heater: Vec::new(),
            gauge: Vec::new(),
            expect: Expect::default(),
        }
    }
}

fn no_shaking(shaking: &Shaking) -> bool {
    *shaking == Shaking::default()
}

fn is_default(expect: &Expect) -> bool {
    *expect == Expect::default()
}

/// The air around an open scene: what drag pulls towards.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// Velocity of the surrounding air [m/s].
    pub velocity: [f64; 2],
    /// Amplitude of smooth random gusts added to the velocity [m/s].
    pub gusts: f64,
    /// Length over which a gust changes [m]; 0 means 10 spacings.
    pub gust_length: f64,
    /// Time over which a gust changes [s]; 0 means 0.5 s.
    pub gust_time: f64,
}

/// Periodic axes and the region outside which particles are removed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Domain {
    /// `[from, to]` of a periodic x axis [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub periodic_x: Option<[f64; 2]>,
    /// `[from, to]` of a periodic y axis [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub periodic_y: Option<[f64; 2]>,
    /// Lower left corner of the region outside which particles are removed [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remove_below: Option<[f64; 2]>,
    /// Upper right corner of the region outside which particles are removed [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remove_above: Option<[f64; 2]>,
}

/// What pictures show.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct View {
    /// Lower left corner of the picture [m]; left out, the picture fits the particles and walls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<[f64; 2]>,
    /// Upper right corner of the picture [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<[f64; 2]>,
}
