//! The parts of a scene that depend on whether its fluids meet bodies.

use super::{density, materials};
use crate::constraints::{ConstraintGroup, SurfaceTension, Viscosity};
use crate::effects::{Baroclinic, Conduction, Drag, DragLaw, Effect, Heating, VorticityConfinement, Xsph};
use crate::math::{Vector, real};
use crate::neighbors::SearchPositions;
use crate::periodic::Periodic;
use crate::phase::MaterialIndex;
use crate::pressure_grid::{Accuracy, Mixture, PressureGrid};
use crate::rng::Rng;
use crate::scene::{BodyDescription, GradientPoint, MaterialRef, PressureGridUse, Scene};
use crate::sources::RemovalRules;
use crate::step::{BodyForce, FluidParts, Remake, SubstepRule};

/// Stream of random numbers of gusts.
const WIND_STREAM: u64 = 3 << 32;

/// The function that remakes these parts for a first body; `None` for scenes without fluids, or with bodies.
pub(super) fn remake(scene: &Scene, seed: u64, periodic: Periodic) -> Option<Remake> {
    let fluid = scene.materials().any(|material| material.phase().is_fluid());
    if !fluid || !scene.body.is_empty() {
        return None;
    }
    let mut alone = scene.clone();
    (alone.block, alone.disc, alone.points, alone.wave) = Default::default();
    // The grid stays, or stays away: its choice counted the particles.
    alone.solver.pressure_grid = if scene.uses_pressure_grid() { PressureGridUse::On } else { PressureGridUse::Off };
    Some(Box::new(move |bodies| {
        // Any body: its place and shape do not matter.
        let body = if bodies { vec![BodyDescription::disc(alone.spacing, [0.0; 2])] } else { Vec::new() };
        let mut scene = Scene { body, ..alone.clone() };
        if bodies && periodic.any() {
            // The grid does not support them there.
            scene.solver.pressure_grid = PressureGridUse::Off;
        }
        fluid_parts(&scene, seed, periodic)
    }))
}

fn fluid_parts(scene: &Scene, seed: u64, periodic: Periodic) -> FluidParts {
    let rigid = (!scene.body.is_empty()).then(|| scene.materials().count() as MaterialIndex - 1);
    FluidParts {
        materials: materials::shown(scene),
        forces: forces(scene),
        search_positions: search_positions(scene),
        pressure_grid: pressure_grid(scene, periodic),
        groups: groups(scene, density::of(scene, periodic).group),
        effects: effects(scene, seed),
        removal: RemovalRules::new(scene, periodic),
        substeps: SubstepRule::new(scene),
        sample_material: rigid,
    }
}

/// Where neighbours are searched.
pub(super) fn search_positions(scene: &Scene) -> SearchPositions {
    match scene.gradients() {
        GradientPoint::Predicted => SearchPositions::Predicted,
        GradientPoint::Start | GradientPoint::Early => SearchPositions::StartAndPredicted,
    }
}

/// The pressure grid, where the scene uses one.
pub(super) fn pressure_grid(scene: &Scene, periodic: Periodic) -> Option<PressureGrid> {
    if !scene.uses_pressure_grid() {
        return None;
    }
    let mixture = Mixture::new(scene);
    // The light fluid feels the residual of the heavy one.
    let tolerance = scene.solver.pressure_tolerance * mixture.lightest().sqrt();
    let accuracy = Accuracy { tolerance, most: scene.solver.pressure_steps };
    let periods = (scene.cells_of_periods().unwrap_or_default(), periodic);
    Some(PressureGrid::new(real(scene.spacing), periods, (mixture, accuracy), 1.0 / scene.fps))
}

/// The groups of fluids.
pub(super) fn groups(scene: &Scene, density: Box<dyn ConstraintGroup>) -> Vec<Box<dyn ConstraintGroup>> {
    let mut groups: Vec<Box<dyn ConstraintGroup>> = Vec::new();
    // A force is applied before the constraints that act against it.
    if let Some(tension) = SurfaceTension::new(scene) {
        groups.push(Box::new(tension));
    }
    if let Some(viscosity) = Viscosity::new(scene) {
        groups.push(Box::new(viscosity));
    }
    if scene.materials().any(|material| material.phase().is_fluid()) {
        groups.push(density);
    }
    groups
}

/// The effects of a scene, in the order in which they add their changes.
pub(super) fn effects(scene: &Scene, seed: u64) -> Vec<Box<dyn Effect>> {
    let wind = Rng::new(seed, WIND_STREAM).state();
    let effects = [
        boxed(Xsph::new(scene)),
        boxed(Drag::new(scene, DragLaw::Thin, wind)),
        boxed(Drag::new(scene, DragLaw::Quadratic, wind)),
        boxed(Baroclinic::new(scene)),
        boxed(Conduction::new(scene)),
        boxed(Heating::new(scene)),
        boxed(VorticityConfinement::new(scene)),
    ];
    effects.into_iter().flatten().collect()
}

fn boxed(effect: Option<impl Effect + 'static>) -> Option<Box<dyn Effect>> {
    effect.map(|effect| Box::new(effect) as Box<dyn Effect>)
}

/// The body force of gravity on each material.
pub(super) fn forces(scene: &Scene) -> Vec<BodyForce> {
    scene.materials().map(|material| body_force(material, scene)).collect()
}

fn body_force(material: MaterialRef<'_>, scene: &Scene) -> BodyForce {
    let (factor, thermal) = match material {
        MaterialRef::Liquid(liquid) => (liquid.gravity_factor, false),
        MaterialRef::Gas(gas) => (gas.gravity_factor, true),
        MaterialRef::Solid(solid) => (solid.gravity_factor, false),
        // For bodies that are particles: all other samples have no inertia of their own.
        MaterialRef::Rigid => (1.0, false),
        MaterialRef::Smoke(_) => return BodyForce { acceleration: Vector::ZERO, factor: 0.0, thermal: false },
    };
    BodyForce::new(scene.gravity.into(), factor, thermal)
}
