//! From a scene to a running solver: the only place that names concrete groups and effects.

mod bodies;
mod carve;
mod density;
mod fluids;
mod materials;
mod waves;

use crate::constraints::{ConstraintGroup, ShapeMatching};
use crate::coupling::{Met, RigidBodies, Ropes, is_outlined};
use crate::effects::SmokeAdvection;
use crate::math::{Vector64, real, vector};
use crate::neighbors::{ListCost, Neighbors};
use crate::parallel::Parallelism;
use crate::particles::{NewParticle, OptionalColumns, Particles};
use crate::periodic::{Periodic, PeriodicAxis};
use crate::phase::{MaterialIndex, Phase};
use crate::rigid::{Bodies, Waypoint, waypoints};
use crate::rng::Rng;
use crate::scene::{BodySolver, CheckedScene, Points, Problems, Scene, Slip, disc_points};
use crate::sleep::LiquidSleep;
use crate::sources::{EmitterSystem, RemovalRules};
use crate::step::{Parts, Solver, SubstepRule};
use crate::walls::Walls;

/// Skin, in spacings, that covers the moves of the projection, so that velocity passes find their pairs.
const LEAST_SKIN: f64 = 0.05;
/// Streams of random numbers, far apart for different purposes.
const BLOCK_STREAM: u64 = 1 << 32;
const DISC_STREAM: u64 = 2 << 32;

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
    solver.settle(scene.solver.settle_substeps, scene.starts_under_weight());
    solver
}

fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn parts(scene: &Scene, seed: u64) -> Parts {
    let periodic = periodic(scene);
    let effects = fluids::effects(scene, seed);
    let least_skin = if effects.is_empty() && scene.smoke.is_empty() { 0.0 } else { LEAST_SKIN * scene.spacing };
    let removal = RemovalRules::new(scene, periodic);
    let optional = OptionalColumns {
        temperature: !scene.gas.is_empty(),
        age: removal.as_ref().is_some_and(RemovalRules::needs_age),
        rest: scene.solver.sleep,
    };
    let mut particles = particles(scene, seed, optional);
    let mut ropes = Ropes::default();
    scene.rope.iter().for_each(|rope| ropes.add(rope, scene, &mut particles));
    let mut rigid = rigid_bodies(scene, &mut particles);
    if let Some(rigid) = &mut rigid {
        for (number, rope) in scene.rope.iter().enumerate() {
            ropes.fasten(number, rope, scene.spacing, rigid);
        }
    }
    let seen = rigid.as_ref().is_some_and(RigidBodies::is_seen);
    particles.fit();
    // Sums and corrections of each iteration, and about one pass for each effect.
    let passes = 2.0 * f64::from(scene.solver.iterations) + effects.len() as f64;
    let cost = ListCost { radius: scene.solver.kernel_radius, passes };
    let reach = real(scene.solver.kernel_radius * scene.spacing);
    let density = density::of(scene, periodic);
    let pressure_scale = density.pressure_scale;
    let sourced = !scene.emitter.is_empty() || !scene.injector.is_empty();
    let emitters = sourced.then(|| EmitterSystem::new(scene, seed));
    let scene_emitters = emitters.as_ref().map(|emitters| emitters.columns().collect());
    let mut groups = groups(scene, density.group, rigid.as_ref());
    let of_others = groups.len();
    groups.extend(ropes.groups());
    Parts {
        particles,
        materials: materials::shown(scene),
        forces: fluids::forces(scene),
        walls: Walls::new(scene),
        outlines: density.outlines,
        without_slip: density.without_slip,
        neighbors: Neighbors::new(periodic, reach, real(least_skin), cost),
        search_positions: fluids::search_positions(scene),
        pressure_grid: fluids::pressure_grid(scene, periodic),
        rope_groups: of_others..groups.len(),
        groups,
        scene_ropes: ropes.len(),
        ropes,
        effects,
        smoke: (!scene.smoke.is_empty()).then(|| SmokeAdvection::new(scene)),
        emitters,
        scene_emitters,
        kit: kit(scene),
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
        no_bodies: no_bodies(scene),
        sample_material: seen.then(|| scene.materials().count() as MaterialIndex - 1),
        gauges: scene.gauge.clone(),
        remake: fluids::remake(scene, seed, periodic),
        spacing: scene.spacing,
        frame_time: 1.0 / scene.fps,
        seed,
        parallelism: Parallelism::Serial,
        rigid,
    }
}

fn groups(
    scene: &Scene,
    density: Box<dyn ConstraintGroup>,
    rigid: Option<&RigidBodies>,
) -> Vec<Box<dyn ConstraintGroup>> {
    let mut groups = fluids::groups(scene, density);
    if let Some(rigid) = rigid.filter(|rigid| rigid.any_matched()) {
        groups.push(Box::new(ShapeMatching::new(rigid.members(), scene.spacing, scene.contacts.friction_rule)));
    }
    groups
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

/// Materials and settings alone: new emitters and ropes are made of them, and checked with them.
fn kit(scene: &Scene) -> Scene {
    Scene {
        spacing: scene.spacing,
        fps: scene.fps,
        duration: 1.0 / scene.fps,
        solver: scene.solver.clone(),
        liquid: scene.liquid.clone(),
        gas: scene.gas.clone(),
        smoke: scene.smoke.clone(),
        solid: scene.solid.clone(),
        ..Scene::default()
    }
}

/// The empty set of bodies to which a first body is added.
fn no_bodies(scene: &Scene) -> RigidBodies {
    let fluid = scene.materials().any(|material| material.phase().is_fluid());
    let met = fluid.then(|| Met { first_sample: 0, outlines: lets_outlines(scene) });
    RigidBodies::new(Bodies::new(scene.spacing), bodies::contacts(scene), met, scene.spacing)
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

/// Whether bodies that no fluid moves are walls to it by their outlines. Surface tension,
/// fluids that stick to bodies, bodies of particles, sleep and the options of papers still find samples of bodies.
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
