//! Velocity passes after the projection: viscosity, drag, vorticity confinement, heat, and the
//! advection of smoke. None of them moves a constrained particle.

mod baroclinic;
mod conduction;
mod confinement;
mod drag;
mod heating;
mod smoke;
mod wind;
mod xsph;

#[doc(hidden)]
pub use self::{
    baroclinic::Baroclinic,
    conduction::Conduction,
    confinement::VorticityConfinement,
    drag::{Drag, DragLaw},
    heating::Heating,
    smoke::{Advected, SmokeAdvection},
    wind::Wind,
    xsph::Xsph,
};

use crate::bytes::held;
use crate::constraints::{Needs, Substep};
use crate::math::{Real, Vector};
use crate::scene::{Gas, MaterialRef, Scene};

/// A pass over the velocities (and temperatures) at the end of a substep.
pub trait Effect: Send + Sync {
    /// The name under which the effect is timed.
    fn name(&self) -> &'static str;

    /// The data that the effect needs from the loop.
    fn needs(&self) -> Needs {
        Needs::NEIGHBORS
    }

    /// Adds the changes to `out`; the loop applies them to all rows but those of kinematic particles.
    fn apply(&mut self, now: Substep<'_>, out: &mut Changes);

    /// Gravity was changed [m/s^2].
    fn set_gravity(&mut self, gravity: Vector) {
        let _ = gravity;
    }

    /// Memory held by columns of its own \[bytes].
    fn memory_bytes(&self) -> usize {
        0
    }

    /// The part of the effect's strength that was stable in the last substep: 1 unless it was cut.
    fn stable_fraction(&self) -> f64 {
        1.0
    }
}

/// Changes of the dense rows, zero unless an effect adds to them.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    /// Change of velocity [m/s].
    pub velocity: Vec<Vector>,
    /// Change of temperature; empty in a scene without temperatures.
    pub temperature: Vec<Real>,
}

impl Changes {
    pub(crate) fn memory_bytes(&self) -> usize {
        held(&self.velocity) + held(&self.temperature)
    }

    /// Back to zero for this many dense rows.
    pub(crate) fn reset(&mut self, rows: usize, temperatures: bool) {
        self.velocity.clear();
        self.velocity.resize(rows, Vector::ZERO);
        self.temperature.clear();
        self.temperature.resize(if temperatures { rows } else { 0 }, 0.0);
    }
}

/// One number per material, taken from the gases; 0 for all others.
fn per_gas(scene: &Scene, value: impl Fn(&Gas) -> f64) -> Vec<Real> {
    let of = |material: MaterialRef<'_>| match material {
        MaterialRef::Gas(gas) => value(gas) as Real,
        _ => 0.0,
    };
    scene.materials().map(of).collect()
}

/// Whether any material has the property.
fn any(values: &[Real]) -> bool {
    values.iter().any(|&value| value != 0.0)
}
