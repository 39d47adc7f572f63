//! rapier2d on a setup of bodies.

use rapier2d::prelude::*;

use super::{DENSITY, Engine, FPS, FRICTION, GRAVITY, Kind, Pose, SIZE, Setup};
use crate::readback::ReadBack;

struct Rapier {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    iterations: usize,
}

/// rapier2d with this many solver iterations, which are its substeps: 4 by default.
pub fn engine(setup: &Setup, iterations: u32) -> Result<Box<dyn Engine>, String> {
    let iterations = iterations as usize;
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, -GRAVITY as f32);
    world.integration_parameters.dt = 1.0 / FPS as f32;
    world.integration_parameters.num_solver_iterations = iterations;
    add_walls(&mut world, setup.width);
    let half = (SIZE / 2.0) as f32;
    let add = |&[x, y]: &[f64; 2]| {
        let place = RigidBodyBuilder::dynamic().translation(Vector::new(x as f32, y as f32)).can_sleep(false);
        let shape = match setup.kind {
            Kind::Boxes => ColliderBuilder::cuboid(half, half),
            Kind::Discs => ColliderBuilder::ball(half),
        };
        world.insert(place, shape.friction(FRICTION as f32).density(DENSITY as f32)).0
    };
    let bodies = setup.places.iter().map(add).collect();
    let engine = Rapier { world, bodies, iterations };
    engine.check(setup)?;
    Ok(Box::new(engine))
}

fn add_walls(world: &mut PhysicsWorld, width: Option<f64>) {
    let mut wall = |x: f32, normal: Vector| {
        let place = RigidBodyBuilder::fixed().translation(Vector::new(x, 0.0));
        world.insert(place, ColliderBuilder::new(SharedShape::halfspace(normal)).friction(FRICTION as f32));
    };
    wall(0.0, Vector::new(0.0, 1.0));
    if let Some(width) = width {
        wall(0.0, Vector::new(1.0, 0.0));
        wall(width as f32, Vector::new(-1.0, 0.0));
    }
}

impl Rapier {
    fn check(&self, setup: &Setup) -> Result<(), String> {
        let (parameters, first) = (&self.world.integration_parameters, &self.world.bodies[self.bodies[0]]);
        let (body, collider) = (first.mass_properties().local_mprops, &self.world.colliders[first.colliders()[0]]);
        ReadBack::default()
            .number("frame", 1.0 / FPS, f64::from(parameters.dt))
            .same("solver iterations", self.iterations, parameters.num_solver_iterations)
            .same("threads", 1, rayon::current_num_threads())
            .same("bodies", setup.places.len(), self.bodies.len())
            .number("mass", setup.kind.mass(), f64::from(body.mass().max(collider.mass())))
            .number("friction", FRICTION, f64::from(collider.friction()))
            .done()
    }
}

impl Engine for Rapier {
    fn name(&self) -> String {
        format!("rapier2d 0.36, {} substeps", self.iterations)
    }

    fn step(&mut self) {
        self.world.step();
    }

    fn pose(&self, body: usize) -> Pose {
        let body = &self.world.bodies[self.bodies[body]];
        let place = body.translation();
        Pose { place: [f64::from(place.x), f64::from(place.y)], angle: f64::from(body.rotation().angle()) }
    }
}
