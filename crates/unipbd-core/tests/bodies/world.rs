//! A small free-standing loop: bodies, walls, contacts, nothing else.

use unipbd_core::Vector64;
use unipbd_core::rigid::Wall;
use unipbd_core::rigid::contact::{ContactSettings, Contacts};
use unipbd_core::rigid::{Bodies, BodySpec, Pose, Surface, Twist};
use unipbd_core::scene::ContactMethod;
use unipbd_core::shapes::Shape;

pub const GRAVITY: f64 = 9.81;
pub const FRAME: f64 = 1.0 / 60.0;

pub fn at(x: f64, y: f64) -> Vector64 {
    Vector64::new(x, y)
}

pub fn floor(surface: Surface) -> Wall {
    Wall::half_plane(Vector64::ZERO, Vector64::Y, surface)
}

pub fn never_asleep() -> ContactSettings {
    ContactSettings { sleep: None, ..ContactSettings::default() }
}

/// Split Jacobi, without sleep: a mirrored scene stays mirrored.
pub fn mirrored() -> ContactSettings {
    ContactSettings { method: ContactMethod::SplitJacobi, ..never_asleep() }
}

/// A body with this shape, place and surface, as heavy as water.
pub fn body(shape: Shape, position: Vector64, surface: Surface) -> BodySpec {
    BodySpec { pose: Pose { position, angle: 0.0 }, surface, ..BodySpec::new(shape) }
}

pub fn unit_box(position: Vector64) -> BodySpec {
    body(Shape::rectangle(1.0, 1.0), position, Surface::with_friction(0.5))
}

pub struct World {
    pub bodies: Bodies,
    pub contacts: Contacts,
    pub gravity: Vector64,
    pub substeps: u32,
    pub time: f64,
}

impl World {
    /// Spacing 0.1 m, 8 substeps per frame, no sleep.
    pub fn new(walls: &[Wall]) -> World {
        World::with_settings(walls, never_asleep())
    }

    pub fn with_settings(walls: &[Wall], settings: ContactSettings) -> World {
        let (bodies, contacts) = (Bodies::new(0.1), Contacts::new(walls, settings));
        World { bodies, contacts, gravity: at(0.0, -GRAVITY), substeps: 8, time: 0.0 }
    }

    pub fn add(&mut self, spec: BodySpec) -> u32 {
        self.bodies.add(spec).expect("the shape is sound")
    }

    pub fn substep(&mut self, dt: f64) {
        let World { bodies, contacts, gravity, time, .. } = self;
        contacts.begin_substep(bodies, dt, *gravity);
        bodies.predict(dt, *time, *gravity);
        contacts.warm_start(bodies);
        contacts.iterate(bodies);
        contacts.iterate(bodies);
        bodies.integrate(dt);
        contacts.restitute(bodies);
        contacts.depenetrate(bodies);
        *time += dt;
    }

    pub fn frame(&mut self) {
        for _ in 0..self.substeps {
            self.substep(FRAME / f64::from(self.substeps));
        }
        self.contacts.finish_frame(&mut self.bodies, FRAME);
        self.bodies.finish_frame(FRAME);
    }

    pub fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / FRAME).round() as u32 {
            self.frame();
        }
    }

    pub fn ids(&self) -> impl Iterator<Item = u32> + use<> {
        0..self.bodies.len() as u32
    }

    pub fn position(&self, id: u32) -> Vector64 {
        self.bodies.pose(id).position
    }

    pub fn velocity(&self, id: u32) -> Twist {
        self.bodies.velocity(id)
    }

    pub fn fastest(&self) -> f64 {
        self.ids().map(|id| self.velocity(id).linear.length()).fold(0.0, f64::max)
    }

    pub fn fastest_in(&mut self, seconds: f64) -> f64 {
        let mut fastest = 0.0f64;
        for _ in 0..(seconds / FRAME).round() as u32 {
            self.frame();
            fastest = fastest.max(self.fastest());
        }
        fastest
    }

    /// Deepest overlap of any contact \[m].
    pub fn penetration(&self) -> f64 {
        self.contacts.points().map(|point| -point.gap).fold(0.0, f64::max)
    }

    pub fn kinetic_energy(&self) -> f64 {
        let energy = |b: &unipbd_core::rigid::Body| {
            0.5 * b.mass * b.velocity.length_squared() + 0.5 * b.inertia * b.angular_velocity * b.angular_velocity
        };
        self.bodies.views().iter().map(energy).sum()
    }

    pub fn momentum(&self) -> Vector64 {
        self.bodies.views().iter().map(|b| b.velocity * b.mass).sum()
    }
}
