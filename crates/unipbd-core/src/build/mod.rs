//! From a scene to a running solver: the only place that names concrete groups and effects.

mod bodies;
mod carve;
mod density;
mod ropes;
mod waves;

use crate::constraints::{ConstraintGroup, ShapeMatching, SurfaceTension, Viscosity};
use crate::coupling::{Met, RigidBodies, is_outlined};
use crate::effects::{
    Baroclinic, Conduction, Drag, DragLaw, Effect, Heating, SmokeAdvection, VorticityConfinement, Xsph,
};
use crate::math::{Vector, Vector64, real, vector};
use crate::neighbors::{ListCost, Neighbors, SearchPositions};
use crate::observe::Material;
use crate::parallel::Parallelism;
use crate::particles::{NewParticle, OptionalColumns, Particles};
use crate::periodic::{Periodic, PeriodicAxis};
use crate::phase::{MaterialIndex, Phase};
use crate::pressure_grid::{Accuracy, Mixture, PressureGrid};
use crate::rigid::{Bodies, Waypoint, waypoints};
use crate::rng::Rng;
use crate::scene::{BodySolver, CheckedScene, GradientPoint, MaterialRef, Points, Problems, Scene, Slip, disc_points};
use crate::sleep::LiquidSleep;
use crate::sources::{EmitterSystem, RemovalRules};
use crate::step::{BodyForce, Parts, Solver, SubstepRule};
use crate::walls::Walls;

/// Skin, in spacings, that covers the moves of the projection, so that velocity passes find their pairs.
const LEAST_SKIN: f64 = 0.05;
/// Streams of random numbers, far apart for different purposes.
const BLOCK_STREAM: u64 = 1 << 32;
const DISC_STREAM: u64 = 2 << 32;
const WIND_STREAM: u64 = 3 << 32;

/// How a scene is built.
#[derive(Clone, Debug, Default)]
pub struct BuildOptions {
    /// Threads to use; left out, all the machine has. Never changes results.
    pub threads: Option<usize>,
    /// Replaces the seed of the scene.
    pub seed: Option<u64>,
}

impl Scene {
    /// Checks the scene, builds a solver and settles its start.
    ///
    /// # Errors
    /// All [`Problems`] of a faulty scene.
    pub fn build(&self, options: BuildOptions) -> Result<Solver, Problems> {
        let problems = self.validate();
        if problems.0.is_empty() { Ok(solver(self, options)) } else { Err(problems) }
    }
}

impl CheckedScene {
    /// Builds a solver and settles its start.
    pub fn build(&self, options: BuildOptions) -> Solver {
        solver(self, options)
    }
}

/// The solver of a scene without problems.
fn solver(scene: &Scene, options: BuildOptions) -> Solver {
    let seed = options.seed.unwrap_or(scene.seed);
    let threads = options.threads.unwrap_or_else(available_threads);
    let mut solver = Solver::new(parts(scene, seed), threads);
    solver.settle(scene.solver.settle_substeps);
    solver
}

fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn parts(scene: &Scene, seed: u64) -> Parts {
    let periodic = periodic(scene);
    let effects = effects(scene, seed);
    let search_positions = match scene.gradients() {
        GradientPoint::Predicted => SearchPositions::Predicted,
        GradientPoint::Start | GradientPoint::Early => SearchPositions::StartAndPredicted,
    };
    let least_skin = if effects.is_empty() && scene.smoke.is_empty() { 0.0 } else { LEAST_SKIN * scene.spacing };
    let removal = RemovalRules::new(scene, periodic);
    let optional = OptionalColumns {
        temperature: !scene.gas.is_empty(),
        age: removal.as_ref().is_some_and(RemovalRules::needs_age),
        rest: scene.solver.sleep,
    };
    let mut particles = particles(scene, seed, optional);
    let ropes = ropes::Ropes::lay(scene, &mut particles);
    let mut rigid = rigid_bodies(scene, &mut particles);
    if let Some(rigid) = &mut rigid {
        ropes.tied.iter().for_each(|(id, body, place)| rigid.tie(*id, body, *place));
        bodies::join_ropes(scene, &ropes.ends, rigid);
    }
    let seen = rigid.as_ref().is_some_and(RigidBodies::is_seen);
    particles.fit();
    // Sums and corrections of each iteration, and about one pass for each effect.
    let passes = 2.0 * f64::from(scene.solver.iterations) + effects.len() as f64;
    let cost = ListCost { radius: scene.solver.kernel_radius, passes };
    let reach = real(scene.solver.kernel_radius * scene.spacing);
    let density = density::of(scene, periodic);
    let pressure_scale = density.pressure_scale;
    let groups = groups(scene, density.group, ropes, rigid.as_ref());
    Parts {
        particles,
        materials: shown_materials(scene),
        forces: scene.materials().map(|material| body_force(material, scene)).collect(),
        walls: Walls::new(scene),
        outlines: density.outlines,
        neighbors: Neighbors::new(periodic, reach, real(least_skin), cost),
        search_positions,
        pressure_grid: scene.uses_pressure_grid().then(|| pressure_grid(scene)),
        groups,
        effects,
        smoke: (!scene.smoke.is_empty()).then(|| SmokeAdvection::new(scene)),
        emitters: (!scene.emitter.is_empty() || !scene.injector.is_empty()).then(|| EmitterSystem::new(scene, seed)),
        removal,
        sleep: LiquidSleep::new(scene, periodic),
        substeps: SubstepRule::new(scene),
        iterations: scene.solver.iterations,
        tolerance: scene.solver.tolerance,
        pressure_scale,
        gravity: vector(scene.gravity.into()),
        exact_gravity: scene.gravity.into(),
        shaking: shaking(scene),
        solid_walls: bodies::walls(scene),
        scene_bodies: rigid.as_ref().map_or(0, |rigid| rigid.views().len()),
        scene_mark: rigid.as_ref().map_or(0, RigidBodies::mark),
        no_bodies: RigidBodies::new(Bodies::new(scene.spacing), bodies::contacts(scene), None, scene.spacing),
        sample_material: seen.then(|| scene.materials().count() as MaterialIndex - 1),
        gauges: scene.gauge.clone(),
        spacing: scene.spacing,
        frame_time: 1.0 / scene.fps,
        seed,
        parallelism: Parallelism::Serial,
        rigid,
    }
}

fn pressure_grid(scene: &Scene) -> PressureGrid {
    let mixture = Mixture::new(scene);
    // The light fluid feels the residual of the heavy one.
    let tolerance = scene.solver.pressure_tolerance * mixture.lightest().sqrt();
    let accuracy = Accuracy { tolerance, most: scene.solver.pressure_steps };
    let periods = (scene.cells_of_periods().unwrap_or_default(), periodic(scene));
    PressureGrid::new(real(scene.spacing), periods, (mixture, accuracy), 1.0 / scene.fps)
}

fn groups(
    scene: &Scene,
    density: Box<dyn ConstraintGroup>,
    ropes: ropes::Ropes,
    rigid: Option<&RigidBodies>,
) -> Vec<Box<dyn ConstraintGroup>> {
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
    if let Some(rigid) = rigid.filter(|rigid| rigid.any_matched()) {
        groups.push(Box::new(ShapeMatching::new(rigid.members(), scene.spacing, scene.contacts.friction_rule)));
    }
    groups.extend(ropes.groups());
    groups
}

/// The effects of a scene, in the order in which they add their changes.
fn effects(scene: &Scene, seed: u64) -> Vec<Box<dyn Effect>> {
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

/// The acceleration of a scene that is shaken, as a curve in the plane.
fn shaking(scene: &Scene) -> Vec<Waypoint> {
    let Some(table) = &scene.shaking.table else { return Vec::new() };
    let [ax, ay] = table.columns().map(|(_, values)| values);
    waypoints(&table.time, [ax, ay, &[]])
}

fn periodic(scene: &Scene) -> Periodic {
    let axis =
        |range: Option<[f64; 2]>| range.map(|[from, to]| PeriodicAxis { from: real(from), length: real(to - from) });
    Periodic { x: axis(scene.domain.periodic_x), y: axis(scene.domain.periodic_y) }
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

/// The bodies of a scene; their samples are added to the particles where there is a fluid to see them.
fn rigid_bodies(scene: &Scene, particles: &mut Particles) -> Option<RigidBodies> {
    if scene.body.is_empty() {
        return None;
    }
    let (bodies, contacts) = bodies::build(scene);
    let fluid = scene.materials().any(|material| material.phase().is_fluid());
    let seen = fluid || scene.body.iter().any(|body| body.solver == BodySolver::ShapeMatching);
    let outlines = fluid && lets_outlines(scene);
    let met = seen.then(|| Met { first_sample: particles.ids_given(), outlines });
    if seen {
        let material = scene.materials().count() as MaterialIndex - 1;
        for body in 0..bodies.len() as u32 {
            let view = &bodies.views()[body as usize];
            if outlines && is_outlined(view, scene.spacing) {
                continue;
            }
            let matched = bodies.elasticity(body as usize).is_some();
            let inverse_mass = if matched { real(view.samples.len() as f64 / view.mass) } else { 0.0 };
            for &sample in bodies.samples(body) {
                let place = bodies.pose(body).apply(sample);
                particles.push(NewParticle {
                    position: place,
                    velocity: vector(bodies.velocity_at(body, place)),
                    inverse_mass,
                    material,
                    phase: Phase::Rigid,
                    temperature: 0.0,
                });
            }
        }
    }
    Some(RigidBodies::new(bodies, contacts, met, scene.spacing))
}

/// Whether bodies that no fluid moves are walls to it by their outlines. What looks for samples of bodies still finds
/// them: surface tension, fluids that stick to bodies, bodies of particles, sleep, the options of papers.
fn lets_outlines(scene: &Scene) -> bool {
    let tense = scene.liquid.iter().any(|liquid| liquid.surface_tension != 0.0);
    let sticks = scene.body.iter().any(|body| body.slip == Slip::None);
    let matched = scene.body.iter().any(|body| body.solver == BodySolver::ShapeMatching);
    !(tense || sticks || matched || scene.solver.sleep || scene.legacy.changes_density())
}

/// The initial particles of a scene.
struct Filling<'a> {
    material: &'a str,
    points: Vec<Vector64>,
    velocity: [f64; 2],
    jitter: f64,
    temperature: f64,
    stream: u64,
}

fn particles(scene: &Scene, seed: u64, optional: OptionalColumns) -> Particles {
    let mut particles = Particles::new(optional);
    let solids = bodies::solids(scene);
    let waves = waves::Waves::new(scene, seed);
    for (number, block) in scene.block.iter().enumerate() {
        let filling = Filling {
            material: &block.material,
            points: carve::outside(waves.block_points(block, scene.spacing), &solids, scene.spacing),
            velocity: block.velocity,
            jitter: block.jitter,
            temperature: block.temperature,
            stream: BLOCK_STREAM + number as u64,
        };
        filling.pour(scene, seed, &mut particles);
    }
    for (number, disc) in scene.disc.iter().enumerate() {
        let filling = Filling {
            material: &disc.material,
            points: carve::outside(disc_points(disc, scene.spacing), &solids, scene.spacing),
            velocity: disc.velocity,
            jitter: disc.jitter,
            temperature: disc.temperature,
            stream: DISC_STREAM + number as u64,
        };
        filling.pour(scene, seed, &mut particles);
    }
    scene.points.iter().for_each(|points| add_points(points, scene, &mut particles));
    particles
}

fn add_points(points: &Points, scene: &Scene, particles: &mut Particles) {
    let Some((index, material)) = scene.material(&points.material) else { return };
    let mass = material.particle_mass(scene.spacing);
    for (number, &position) in points.positions.iter().enumerate() {
        let velocity = points.velocities.get(number).copied().unwrap_or(points.velocity);
        particles.push(NewParticle {
            position: position.into(),
            velocity: vector(velocity.into()),
            inverse_mass: points.motion.inverse_mass(mass),
            material: index as MaterialIndex,
            phase: material.phase(),
            temperature: real(points.temperature),
        });
    }
}

impl Filling<'_> {
    fn pour(&self, scene: &Scene, seed: u64, particles: &mut Particles) {
        let Some((index, material)) = scene.material(self.material) else { return };
        let mut rng = Rng::new(seed, self.stream);
        let mass = material.particle_mass(scene.spacing);
        for &point in &self.points {
            let shift = Vector64::new(rng.signed_unit(), rng.signed_unit()) * (self.jitter * scene.spacing);
            particles.push(NewParticle {
                position: point + shift,
                velocity: vector(self.velocity.into()),
                inverse_mass: real(1.0 / mass),
                material: index as MaterialIndex,
                phase: material.phase(),
                temperature: real(self.temperature),
            });
        }
    }
}

/// Colours of materials that name none, in turn within each phase.
const LIQUIDS: [[u8; 3]; 4] = [[58, 134, 222], [231, 111, 81], [42, 157, 143], [233, 196, 106]];
const GASES: [[u8; 3]; 2] = [[124, 152, 179], [179, 146, 172]];
const SMOKES: [[u8; 3]; 2] = [[232, 236, 241], [244, 190, 140]];

fn shown_materials(scene: &Scene) -> Vec<Material> {
    let mut counts = [0; Phase::ALL.len()];
    let shown = |material: MaterialRef<'_>| {
        let number = &mut counts[material.phase() as usize];
        let palette: &[[u8; 3]] = match material.phase() {
            Phase::Gas => &GASES,
            Phase::Smoke => &SMOKES,
            _ => &LIQUIDS,
        };
        let default = palette[*number % palette.len()];
        *number += 1;
        Material {
            name: material.name().to_owned(),
            phase: material.phase(),
            density: material.density(),
            color: material.color().and_then(parse_color).unwrap_or(default),
        }
    };
    scene.materials().map(shown).collect()
}

/// `"#rrggbb"` as red, green, blue.
fn parse_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let value = u32::from_str_radix(digits, 16).ok()?;
    let [_, red, green, blue] = value.to_be_bytes();
    Some([red, green, blue])
}
