//! The diagnostics. A quantity is declared here and computed in `step/diagnose.rs`; all else follows.

use super::quantity::{Entry, Field, Quantity, Table, Value, entries, table};
use crate::math::Vector64;
use crate::phase::Phase;
use crate::scene::GaugeKind;

table! {
    /// The state of a run at one moment, in numbers. Computed when asked for, from the state alone.
    ///
    /// C = rho/rho0 - 1 is the density error: positive where a fluid is compressed, negative where it is dilated.
    pub struct Diagnostics {
        /// Simulated time.
        #[quantity(1, "s")]
        pub time: f64,
        /// Frames done.
        #[quantity(2)]
        pub frame: u64,
        /// Substeps done since the start.
        #[quantity(3)]
        pub step: u64,
        /// Substeps of the last frame.
        #[quantity(4)]
        pub substeps: u32,
        /// Substeps that the last frame asked for; more than it took where the cap bound.
        #[quantity(25)]
        pub substeps_wanted: u32,
        /// Reason for the number of substeps.
        #[quantity(26)]
        pub substeps_reason: SubstepReason,
        /// Constraint iterations of the last frame.
        #[quantity(5)]
        pub iterations: u32,
        /// Neighbour lists built in the last frame.
        #[quantity(6)]
        pub list_builds: u32,
        /// Particles by phase.
        #[quantity(7)]
        pub counts: [u64; Phase::ALL.len()],
        /// Mean of max(C, 0) over fluid particles: compression alone.
        #[quantity(12, "1")]
        pub density_error_mean: f64,
        /// Mean of |C| over fluid particles: compression and dilation.
        #[quantity(31, "1")]
        pub density_error_mean_abs: f64,
        /// Largest C over fluid particles.
        #[quantity(13, "1")]
        pub density_error_max: f64,
        /// Smallest C over fluid particles: the largest dilation.
        #[quantity(14, "1")]
        pub density_error_min: f64,
        /// Largest pressure over density, read as `Solver::pressures` is, at the 256 particles with the largest
        /// multipliers.
        #[quantity(15, "m^2/s^2")]
        pub pressure_max: f64,
        /// Kinetic energy.
        #[quantity(16, "J")]
        pub kinetic_energy: f64,
        /// Potential energy in the uniform gravity of the scene and its shaking, zero at the origin.
        #[quantity(17, "J")]
        pub potential_energy: f64,
        /// Linear momentum.
        #[quantity(18, "kg m/s")]
        pub momentum: Vector64,
        /// Angular momentum about the origin.
        #[quantity(20, "kg m^2/s")]
        pub angular_momentum: f64,
        /// Largest particle speed.
        #[quantity(21, "m/s")]
        pub speed_max: f64,
        /// Deepest overlap of bodies with each other and with walls.
        #[quantity(27, "m")]
        pub contact_penetration: f64,
    }
    derived {
        /// Number of all particles.
        #[quantity(29)]
        particles = Diagnostics::particles,
        /// Kinetic and potential energy.
        #[quantity(30, "J")]
        energy = Diagnostics::energy,
    }
    beside {
        /// Per material, in index order.
        pub materials: Vec<MaterialDiagnostics>,
        /// Per constraint group, in solving order.
        pub groups: Vec<GroupDiagnostics>,
        /// Per measured wall, in the order of the scene.
        pub walls: Vec<WallForce>,
        /// Per gauge, in the order of the scene.
        pub gauges: Vec<GaugeReading>,
    }
}

entries! {
    materials = 23;
    /// Diagnostics of one material.
    pub struct MaterialDiagnostics {
        /// Number of particles.
        #[quantity(2)]
        pub count: u64,
        /// Mean of max(C, 0): compression alone.
        #[quantity(3, "1")]
        pub density_error_mean: f64,
        /// Mean of |C|: compression and dilation.
        #[quantity(6, "1")]
        pub density_error_mean_abs: f64,
        /// Largest C.
        #[quantity(4, "1")]
        pub density_error_max: f64,
        /// Smallest C: the largest dilation.
        #[quantity(5, "1")]
        pub density_error_min: f64,
    }
}

entries! {
    groups = 24;
    /// Diagnostics of one constraint group.
    pub struct GroupDiagnostics {
        /// Largest constraint violation, in the group's own unit.
        #[quantity(2)]
        pub violation: f64,
    }
}

entries! {
    walls = 28;
    /// The force on a wall that has a name; the sides of a tank are `NAME left` and so on.
    pub struct WallForce {
        /// Mean force of fluids and bodies over the last frame.
        #[quantity(2, "N")]
        pub force: Vector64,
        /// Mean force of the fluids, and of bodies made of particles, over the last frame.
        #[quantity(4, "N")]
        pub fluid_force: Vector64,
        /// Mean force of the contacts of rigid bodies over the last frame.
        #[quantity(6, "N")]
        pub contact_force: Vector64,
    }
}

entries! {
    gauges = 32;
    /// The reading of a gauge.
    pub struct GaugeReading {
        /// Reading in the unit of its kind; not a number where there is nothing to read.
        #[quantity(2)]
        pub value: f64,
        /// Kind: level and front [m], pressure [N/m], force [N], flow_rate [m^2/s].
        #[quantity(3)]
        pub kind: GaugeKind,
    }
}

impl Diagnostics {
    /// Number of particles of one phase.
    pub fn count(&self, phase: Phase) -> u64 {
        self.counts[phase as usize]
    }

    /// Number of all particles.
    pub fn particles(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Kinetic and potential energy [J].
    pub fn energy(&self) -> f64 {
        self.kinetic_energy + self.potential_energy
    }
}

/// Reason for the number of substeps of a frame.
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
    /// The shortest waves of surface tension.
    Capillary,
    /// The speed and spin of rigid bodies.
    Bodies,
    /// The height of stacked bodies, and the mass ratio of bodies that act on each other.
    Support,
    /// Less would do now, but the number falls slowly.
    Hysteresis,
    /// More would be wanted, but a frame must not take longer ([`Solver::set_budget`](crate::Solver::set_budget)).
    Budget,
}

impl SubstepReason {
    /// All reasons.
    pub const ALL: [SubstepReason; 9] = [
        SubstepReason::Fixed,
        SubstepReason::Speed,
        SubstepReason::TrustRegion,
        SubstepReason::Compression,
        SubstepReason::Capillary,
        SubstepReason::Bodies,
        SubstepReason::Support,
        SubstepReason::Hysteresis,
        SubstepReason::Budget,
    ];

    /// The word for it in messages and logs.
    pub const fn name(self) -> &'static str {
        match self {
            SubstepReason::Fixed => "fixed",
            SubstepReason::Speed => "speed",
            SubstepReason::TrustRegion => "trust_region",
            SubstepReason::Compression => "compression",
            SubstepReason::Capillary => "capillary",
            SubstepReason::Bodies => "bodies",
            SubstepReason::Support => "support",
            SubstepReason::Hysteresis => "hysteresis",
            SubstepReason::Budget => "budget",
        }
    }
}

impl Field for SubstepReason {
    fn value(&self) -> Value<'static> {
        Value::Word(self.name())
    }

    fn set(&mut self, value: Value<'_>) {
        let known = SubstepReason::ALL.into_iter().find(|reason| value == Value::Word(reason.name()));
        *self = known.unwrap_or(*self);
    }
}

impl Field for GaugeKind {
    fn value(&self) -> Value<'static> {
        Value::Word(self.name())
    }

    fn set(&mut self, value: Value<'_>) {
        let known = GaugeKind::ALL.into_iter().find(|kind| value == Value::Word(kind.name()));
        *self = known.unwrap_or(*self);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<T: Table>(first_tag: u32) {
        let mut tags: Vec<u32> = (1..first_tag).collect();
        let mut names = Vec::new();
        for quantity in T::QUANTITIES {
            assert!(quantity.description.ends_with('.'), "{}: {:?}", quantity.name, quantity.description);
            let columns = quantity.columns();
            assert_eq!((quantity.read)(&T::default()).columns().len(), columns.len());
            tags.extend((quantity.tag..).take(columns.len()));
            names.extend(columns);
        }
        let unique = |count: usize, kind: &str| assert_eq!(count, names.len(), "{kind} of {} repeat", T::TYPE);
        tags.sort_unstable();
        tags.dedup();
        unique(tags.len() - (first_tag as usize - 1), "tags");
        unique(names.iter().collect::<std::collections::BTreeSet<_>>().len(), "names");
    }

    #[test]
    fn names_and_tags_are_unique() {
        check::<Diagnostics>(1);
        check::<MaterialDiagnostics>(2);
        check::<GroupDiagnostics>(2);
        check::<WallForce>(2);
        check::<GaugeReading>(2);
        let tags: Vec<u32> = Diagnostics::QUANTITIES.iter().map(|quantity| quantity.tag).collect();
        for taken in [22, MaterialDiagnostics::TAG, GroupDiagnostics::TAG, WallForce::TAG, GaugeReading::TAG] {
            assert!(!tags.contains(&taken), "{taken} is the state hash or a list");
        }
    }

    #[test]
    fn a_quantity_that_is_written_reads_as_it_was() {
        let values = [Value::Count(7), Value::Number(0.5), Value::Vector(Vector64::new(1.0, -2.0))];
        let values = values.into_iter().chain([Value::Word("support"), Value::ByPhase([1, 2, 3, 4, 5])]);
        let mut written = 0;
        for value in values {
            for quantity in Diagnostics::QUANTITIES {
                let mut state = Diagnostics::default();
                let before = (quantity.read)(&state);
                if let Some(write) = quantity.write {
                    write(&mut state, value);
                    let same_kind = std::mem::discriminant(&before) == std::mem::discriminant(&value);
                    let expected = if same_kind { value } else { before };
                    assert_eq!((quantity.read)(&state), expected, "{}", quantity.name);
                    written += usize::from(same_kind);
                }
            }
        }
        assert_eq!(written, Diagnostics::QUANTITIES.iter().filter(|quantity| quantity.write.is_some()).count());
    }
}
