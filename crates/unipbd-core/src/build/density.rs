//! The density group of a scene.

use crate::constraints::{ConstraintGroup, Density, DensitySettings};
use crate::kernel::{Kernel, Shape};
use crate::legacy::{Formula, LegacyDensity, MassDensity};
use crate::periodic::Periodic;
use crate::scene::Scene;
use crate::walls::Outlines;

/// A density group, and the scale of its pressure for the loop.
pub(super) struct Built {
    pub group: Box<dyn ConstraintGroup>,
    /// Room for the outlines of bodies that are walls of the fluid.
    pub outlines: Outlines,
    /// The same of bodies that viscous fluids do not slip along.
    pub without_slip: Outlines,
    /// Pressure over density per multiplier, inverse mass and squared substep, on the lattice at rest.
    pub pressure_scale: f64,
}

/// The density group that a scene asks for.
pub(super) fn of(scene: &Scene, periodic: Periodic) -> Built {
    if scene.legacy.changes_density() {
        let kernel = Formula::of(scene);
        return built((scene, periodic), &kernel, |settings| match &scene.legacy.mass_density {
            Some(description) => Box::new(MassDensity::new(scene, kernel, description)),
            None => Box::new(LegacyDensity::new(
                scene,
                kernel,
                [settings.volume, settings.unit],
                Density::new(kernel, settings),
            )),
        });
    }
    let kernel = Kernel::new(scene.solver.kernel_radius * scene.spacing);
    built((scene, periodic), &kernel, |settings| Box::new(Density::new(kernel, settings)))
}

fn built<K: Shape>(
    (scene, periodic): (&Scene, Periodic),
    kernel: &Kernel<K>,
    group: impl FnOnce(DensitySettings) -> Box<dyn ConstraintGroup>,
) -> Built {
    let settings = DensitySettings::new(scene, kernel);
    let pressure_scale = f64::from(settings.volume) * settings.moment;
    let upheld = settings.upheld.then_some(scene.spacing);
    let room = |upheld| Outlines::new(Kernel::new(scene.solver.kernel_radius * scene.spacing), upheld, periodic);
    Built { group: group(settings), outlines: room(upheld), without_slip: room(None), pressure_scale }
}
