//! What a run shows of itself: diagnostics, events, the shapes of its walls.

use crate::math::Vector64;
use crate::phase::Phase;

/// The state of a run at one moment, in numbers. Computed when asked for, from the state alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics {
    /// Simulated time [s].
    pub time: f64,
    /// Frames done.
    pub frame: u64,
    /// Substeps done since the start.
    pub step: u64,
    /// Substeps of the last frame.
    pub substeps: u32,
    /// Substeps that the last frame asked for; more than it took where the cap bound.
    pub substeps_wanted: u32,
    /// What decided the number of substeps.
    pub substeps_reason: SubstepReason,
    /// Constraint iterations of the last frame.
    pub iterations: u32,
    /// Neighbour lists built in the last frame.
    pub list_builds: u32,
    /// Particles by phase, in the order of [`Phase::ALL`].
    pub count_by_phase: [u64; Phase::ALL.len()],
    /// Mean of max(C, 0) over fluid particles, C = rho/rho0 - 1, as a fraction.
    pub density_error_mean: f64,
    /// Largest C over fluid particles, as a fraction.
    pub density_error_max: f64,
    /// Smallest C over fluid particles (dilation), as a fraction.
    pub density_error_min: f64,
    /// Largest pressure over density [m^2/s^2], read as [`Solver::pressures`](crate::Solver::pressures) are, at the
    /// 256 particles with the largest multipliers.
    pub pressure_max: f64,
    /// Kinetic energy [J].
    pub kinetic_energy: f64,
    /// Potential energy in the uniform gravity of the scene, zero at the origin [J].
    pub potential_energy: f64,
    /// Linear momentum [kg m/s].
    pub momentum: Vector64,
    /// Angular momentum about the origin [kg m^2/s].
    pub angular_momentum: f64,
    /// Largest particle speed [m/s].
    pub speed_max: f64,
    /// Deepest overlap of bodies with each other and with walls [m].
    pub contact_penetration: f64,
    /// Per material, in index order.
    pub materials: Vec<MaterialDiagnostics>,
    /// Per constraint group, in solving order.
    pub groups: Vec<GroupDiagnostics>,
    /// Per measured wall, in the order of the scene.
    pub walls: Vec<WallForce>,
}

impl Diagnostics {
    /// Number of particles of one phase.
    pub fn count(&self, phase: Phase) -> u64 {
        self.count_by_phase[phase as usize]
    }

    /// Number of all particles.
    pub fn particles(&self) -> u64 {
        self.count_by_phase.iter().sum()
    }
}

/// What decided the number of substeps of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SubstepReason {
    /// The scene gives the number.
    #[default]
    Fixed,
    /// The fastest particle or emitter (Courant-Friedrichs-Lewy).
    Speed,
    /// The pressure, so that no substep compresses by more than an eighth.
    TrustRegion,
    /// The pressure and the target of the scene for the largest compression.
    Compression,
    /// The height of stacked bodies.
    Support,
    /// Less would do now, but the number falls slowly.
    Hysteresis,
}

impl SubstepReason {
    /// The word for it in messages and logs.
    pub const fn name(self) -> &'static str {
        match self {
            SubstepReason::Fixed => "fixed",
            SubstepReason::Speed => "speed",
            SubstepReason::TrustRegion => "trust_region",
            SubstepReason::Compression => "compression",
            SubstepReason::Support => "support",
            SubstepReason::Hysteresis => "hysteresis",
        }
    }
}

/// Diagnostics of one material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialDiagnostics {
    /// Name of the material.
    pub name: String,
    /// Number of particles.
    pub count: u64,
    /// Mean of max(C, 0), as a fraction.
    pub density_error_mean: f64,
    /// Largest C, as a fraction.
    pub density_error_max: f64,
    /// Smallest C (dilation), as a fraction.
    pub density_error_min: f64,
}

/// Diagnostics of one constraint group.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupDiagnostics {
    /// Name of the group.
    pub name: String,
    /// Largest constraint violation, in the group's own unit.
    pub violation: f64,
}

/// The force of the fluids on a wall that has a name.
#[derive(Clone, Debug, PartialEq)]
pub struct WallForce {
    /// Name of the wall; the sides of a tank are `NAME left` and so on.
    pub name: String,
    /// Mean force over the last frame [N].
    pub force: Vector64,
}

/// How grave an [`Event`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Good to know.
    Info,
    /// The result may be less accurate than asked for.
    Warning,
}

/// Something that happened during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Simulated time [s].
    pub time: f64,
    /// How grave it is.
    pub severity: Severity,
    /// What happened.
    pub message: String,
}

/// A wall as a line to draw: straight pieces from point to point [m]. Its solid side lies to the
/// right of the way: a box full of wall runs clockwise, a tank to stay in counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct WallOutline {
    /// Corners in order.
    pub points: Vec<Vector64>,
    /// Whether the last point joins the first.
    pub closed: bool,
    /// Half-planes have no end: the line is a stretch of one.
    pub endless: bool,
}

/// A material as a run knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name given in the scene.
    pub name: String,
    /// Phase of its particles.
    pub phase: Phase,
    /// Rest density [kg/m^2]; 0 for smoke.
    pub density: f64,
    /// Colour as red, green, blue.
    pub color: [u8; 3],
}
