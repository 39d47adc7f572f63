//! Box2D 3 on a setup of bodies, by the C sources that `boxdd-sys` ships.
#![allow(unsafe_code)]

use boxdd_sys::ffi::*;

use super::{DENSITY, Engine, FPS, FRICTION, GRAVITY, Kind, Pose, SIZE, Setup};
use crate::readback::ReadBack;

/// How contacts are solved.
#[derive(Clone, Copy)]
pub struct Tuning {
    pub substeps: i32,
    /// Stiffness of a contact; Box2D allows an eighth of the substeps' rate [1/s].
    pub hertz: f32,
    /// Overlap that is left alone, 5 mm for each metre of the unit of length [m].
    pub slop: f32,
}

impl Tuning {
    /// That of its documentation.
    pub const DEFAULT: Tuning = Tuning { substeps: 4, hertz: 30.0, slop: 0.005 };
    /// Twice as stiff, five times as exact.
    pub const STIFF: Tuning = Tuning { substeps: 8, hertz: 60.0, slop: 0.001 };

    /// The unit of length, a global of Box2D: engines with different ones run in turn.
    fn set_unit(self) {
        // SAFETY: a positive number; nothing else runs.
        unsafe { b2SetLengthUnitsPerMeter(self.slop / 0.005) }
    }
}

struct Box2d {
    world: b2WorldId,
    bodies: Vec<b2BodyId>,
    tuning: Tuning,
}

/// Box2D with these settings.
pub fn engine(setup: &Setup, tuning: Tuning) -> Result<Box<dyn Engine>, String> {
    tuning.set_unit();
    // SAFETY: definitions come from Box2D's own defaults, ids from the calls before, and pointers live as long as the calls.
    let engine = unsafe {
        let mut definition = b2DefaultWorldDef();
        definition.gravity = vector(0.0, -GRAVITY);
        definition.enableSleep = false;
        definition.workerCount = 1;
        definition.contactHertz = tuning.hertz;
        // The default of its usual unit of length.
        definition.contactSpeed = 3.0;
        let world = b2CreateWorld(&raw const definition);
        add_walls(world, setup.width);
        let bodies = setup.places.iter().map(|&place| add_body(world, setup.kind, place)).collect();
        Box2d { world, bodies, tuning }
    };
    engine.check(setup)?;
    Ok(Box::new(engine))
}

fn vector(x: f64, y: f64) -> b2Vec2 {
    b2Vec2 { x: x as f32, y: y as f32 }
}

/// The shape of a body or wall.
///
/// # Safety
/// Box2D must be in a state to give its defaults: always.
unsafe fn surface() -> b2ShapeDef {
    // SAFETY: it has no conditions.
    let mut shape = unsafe { b2DefaultShapeDef() };
    shape.density = DENSITY as f32;
    shape.material.friction = FRICTION as f32;
    shape
}

/// # Safety
/// The world exists.
unsafe fn add_body(world: b2WorldId, kind: Kind, [x, y]: [f64; 2]) -> b2BodyId {
    // SAFETY: the world exists, and definitions are Box2D's own.
    unsafe {
        let mut definition = b2DefaultBodyDef();
        definition.type_ = b2BodyType_b2_dynamicBody;
        definition.position = vector(x, y);
        let (body, surface) = (b2CreateBody(world, &raw const definition), surface());
        let half = (SIZE / 2.0) as f32;
        match kind {
            Kind::Discs => {
                let circle = b2Circle { center: vector(0.0, 0.0), radius: half };
                b2CreateCircleShape(body, &raw const surface, &raw const circle)
            }
            Kind::Boxes => {
                let square = b2MakeBox(half, half);
                b2CreatePolygonShape(body, &raw const surface, &raw const square)
            }
        };
        body
    }
}

/// Thick static boxes around the space of the bodies.
///
/// # Safety
/// The world exists.
unsafe fn add_walls(world: b2WorldId, width: Option<f64>) {
    const THICK: f64 = 10.0;
    const LONG: f64 = 500.0;
    let wall = |half: [f64; 2], centre: [f64; 2]| {
        // SAFETY: the world exists, and definitions are Box2D's own.
        unsafe {
            let mut definition = b2DefaultBodyDef();
            definition.position = vector(centre[0], centre[1]);
            let (body, surface) = (b2CreateBody(world, &raw const definition), surface());
            let shape = b2MakeBox(half[0] as f32, half[1] as f32);
            b2CreatePolygonShape(body, &raw const surface, &raw const shape);
        }
    };
    wall([LONG, THICK], [0.0, -THICK]);
    if let Some(width) = width {
        wall([THICK, LONG], [-THICK, LONG]);
        wall([THICK, LONG], [width + THICK, LONG]);
    }
}

impl Box2d {
    fn check(&self, setup: &Setup) -> Result<(), String> {
        // SAFETY: the world and its bodies exist; a body has one shape.
        let (gravity, sleeps, workers, mass, friction, unit) = unsafe {
            let mut shape = std::mem::zeroed();
            b2Body_GetShapes(self.bodies[0], &raw mut shape, 1);
            (
                b2World_GetGravity(self.world).y,
                b2World_IsSleepingEnabled(self.world),
                b2World_GetWorkerCount(self.world),
                b2Body_GetMass(self.bodies[0]),
                b2Shape_GetFriction(shape),
                b2GetLengthUnitsPerMeter(),
            )
        };
        ReadBack::default()
            .number("gravity", -GRAVITY, f64::from(gravity))
            .same("sleep", false, sleeps)
            .same("threads", 1, workers)
            .same("bodies", setup.places.len(), self.bodies.len())
            .number("mass", setup.kind.mass(), f64::from(mass))
            .number("friction", FRICTION, f64::from(friction))
            .number("slop", f64::from(self.tuning.slop), 0.005 * f64::from(unit))
            .done()
    }
}

impl Engine for Box2d {
    fn name(&self) -> String {
        // SAFETY: it has no conditions.
        let version = unsafe { b2GetVersion() };
        let Tuning { substeps, hertz, slop } = self.tuning;
        let of = format!("Box2D {}.{}.{}", version.major, version.minor, version.revision);
        format!("{of}, {substeps} substeps, {hertz} Hz, slop {:.0} mm", 1e3 * slop)
    }

    fn step(&mut self) {
        self.tuning.set_unit();
        // SAFETY: the world exists.
        unsafe { b2World_Step(self.world, 1.0 / FPS as f32, self.tuning.substeps) }
    }

    fn pose(&self, body: usize) -> Pose {
        // SAFETY: the body exists.
        let (place, turn) = unsafe { (b2Body_GetPosition(self.bodies[body]), b2Body_GetRotation(self.bodies[body])) };
        Pose { place: [f64::from(place.x), f64::from(place.y)], angle: f64::from(turn.s).atan2(f64::from(turn.c)) }
    }
}

impl Drop for Box2d {
    fn drop(&mut self) {
        // SAFETY: the world exists, and is not used again.
        unsafe { b2DestroyWorld(self.world) }
    }
}
