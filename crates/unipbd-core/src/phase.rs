//! The phase of a particle, and the index of its material.

/// The kind of matter a particle stands for. It decides which constraints see the particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[non_exhaustive]
pub enum Phase {
    /// Incompressible fluid with a free surface: resists compression only.
    Liquid = 0,
    /// Fluid that fills its domain or a plume: resists compression and dilation.
    Gas = 1,
    /// Passive marker that moves with the surrounding carrier and is never projected.
    Smoke = 2,
    /// Lattice sample of a rigid body: counted in the density, moved with its body.
    Rigid = 3,
    /// Free solid point: a node of a rope or of a user's own constraints, or a grain.
    Solid = 4,
}

impl Phase {
    /// All phases, in the order of their codes.
    pub const ALL: [Phase; 5] = [Phase::Liquid, Phase::Gas, Phase::Smoke, Phase::Rigid, Phase::Solid];

    /// The lower-case name used in scene files, logs and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Phase::Liquid => "liquid",
            Phase::Gas => "gas",
            Phase::Smoke => "smoke",
            Phase::Rigid => "rigid",
            Phase::Solid => "solid",
        }
    }

    /// The phase with this code, if there is one.
    pub fn from_code(code: u8) -> Option<Phase> {
        Phase::ALL.get(usize::from(code)).copied()
    }

    /// Whether particles of this phase only follow the flow and take part in no constraint.
    pub const fn is_passive(self) -> bool {
        matches!(self, Phase::Smoke)
    }

    /// Whether particles of this phase are counted in the density of the fluid around them.
    pub const fn is_dense(self) -> bool {
        matches!(self, Phase::Liquid | Phase::Gas | Phase::Rigid)
    }

    /// Whether particles of this phase carry a density constraint of their own.
    pub const fn is_fluid(self) -> bool {
        matches!(self, Phase::Liquid | Phase::Gas)
    }
}

/// Index of a material in [`Solver::materials`](crate::Solver::materials).
pub type MaterialIndex = u16;

/// The material of all rows, if they have but one. No early return: the loop fills the vectors of the machine.
#[inline]
pub(crate) fn uniform(materials: &[MaterialIndex]) -> Option<MaterialIndex> {
    let &first = materials.first()?;
    (!materials.iter().fold(false, |any, &material| any | (material != first))).then_some(first)
}
