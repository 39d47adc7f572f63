//! Heaps and a pyramid of bodies: unipbd beside rapier2d, one thread, no sleep, 60 steps a second.

use cpu_time::ProcessTime;

use rapier2d::prelude::*;
use unipbd_core::BuildOptions;
use unipbd_core::scene::{BodyDescription, ContactDescription, HalfPlane, Scene, SolverSettings, Substeps, Tank};

/// Side of a box and diameter of a disc [m].
const SIZE: f64 = 0.5;
const FPS: f64 = 60.0;

#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Discs,
    Boxes,
}

pub struct Settled {
    pub solver: &'static str,
    /// Milliseconds of processor time per frame: mean over the whole run.
    pub milliseconds: f64,
    /// Largest overlap of two bodies at the end [m].
    pub penetration: f64,
    /// Whether all stands as it should.
    pub stands: bool,
}

/// Bodies that are let fall in a tank this wide.
fn heap(count: usize) -> (f64, Vec<[f64; 2]>) {
    let columns = (count as f64 / 2.0).sqrt().round() as usize * 2;
    let pitch = 1.1 * SIZE;
    let at = |k: usize| {
        let (column, row) = (k % columns, k / columns);
        // Every second row is shifted, so that columns do not stay upright.
        let shift = if row % 2 == 0 { 0.0 } else { 0.3 * SIZE };
        [(column as f64 + 0.6) * pitch + shift, (row as f64 + 0.6) * pitch]
    };
    (columns as f64 * pitch + 2.0 * SIZE, (0..count).map(at).collect())
}

/// A pyramid of this many rows on the floor.
fn pyramid(rows: usize) -> Vec<[f64; 2]> {
    let row = |row: usize| {
        let across = rows - row;
        (0..across).map(move |k| [1.05 * SIZE * (k as f64 - 0.5 * (across - 1) as f64), SIZE * (row as f64 + 0.5)])
    };
    (0..rows).flat_map(row).collect()
}

fn body(kind: Kind, position: [f64; 2]) -> BodyDescription {
    match kind {
        Kind::Boxes => BodyDescription::rectangle([SIZE, SIZE], position),
        Kind::Discs => BodyDescription {
            radius: Some(SIZE / 2.0),
            size: None,
            ..BodyDescription::rectangle([SIZE, SIZE], position)
        },
    }
}

fn floor() -> HalfPlane {
    HalfPlane { friction: 0.5, ..HalfPlane::new([0.0, 0.0], [0.0, 1.0]) }
}

fn ours(
    kind: Kind,
    places: &[[f64; 2]],
    width: Option<f64>,
    (substeps, iterations): (u32, u32),
) -> unipbd_core::Solver {
    let scene = Scene {
        spacing: SIZE / 10.0,
        body: places.iter().map(|&place| body(kind, place)).collect(),
        tank: width.map(|width| Tank::new([0.0, 0.0], [width, 1000.0])).into_iter().collect(),
        half_plane: if width.is_none() { vec![floor()] } else { Vec::new() },
        solver: SolverSettings { substeps: Substeps::Fixed(substeps), ..SolverSettings::default() },
        contacts: ContactDescription { iterations: Some(iterations), ..ContactDescription::default() },
        ..Scene::default()
    };
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn theirs(
    kind: Kind,
    places: &[[f64; 2]],
    width: Option<f64>,
    iterations: usize,
) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, -9.81);
    world.integration_parameters.dt = 1.0 / FPS as f32;
    world.integration_parameters.num_solver_iterations = iterations;
    let half = (SIZE / 2.0) as f32;
    let mut wall = |x: f32, y: f32, normal: Vector| {
        let place = RigidBodyBuilder::fixed().translation(Vector::new(x, y));
        world.insert(place, ColliderBuilder::new(SharedShape::halfspace(normal)).friction(0.5));
    };
    wall(0.0, 0.0, Vector::new(0.0, 1.0));
    if let Some(width) = width {
        wall(0.0, 0.0, Vector::new(1.0, 0.0));
        wall(width as f32, 0.0, Vector::new(-1.0, 0.0));
    }
    let add = |&[x, y]: &[f64; 2]| {
        let place = RigidBodyBuilder::dynamic().translation(Vector::new(x as f32, y as f32)).can_sleep(false);
        let shape = match kind {
            Kind::Boxes => ColliderBuilder::cuboid(half, half),
            Kind::Discs => ColliderBuilder::ball(half),
        };
        world.insert(place, shape.friction(0.5).density(1000.0)).0
    };
    let handles = places.iter().map(add).collect();
    (world, handles)
}

fn overlap(world: &PhysicsWorld) -> f64 {
    let points = world.contact_pairs().flat_map(|pair| pair.manifolds()).flat_map(|manifold| &manifold.points);
    points.map(|point| f64::from(-point.dist)).fold(0.0, f64::max)
}

/// Substeps of rapier2d in a heap: its default.
const THEIR_SUBSTEPS: u32 = 4;

/// A heap that settles for some seconds, frame by frame in turn: unipbd by each of these numbers of
/// substeps and iterations, then rapier2d.
pub fn settle(kind: Kind, count: usize, seconds: f64, substeps: &[(u32, u32)]) -> Vec<(String, Settled)> {
    let (width, places) = heap(count);
    let mut mine: Vec<_> = substeps.iter().map(|&n| ours(kind, &places, Some(width), n)).collect();
    let (mut theirs, _) = theirs(kind, &places, Some(width), THEIR_SUBSTEPS as usize);
    let frames = (seconds * FPS) as u32;
    let mut spent = vec![0.0; mine.len() + 1];
    for _ in 0..frames {
        for (solver, spent) in mine.iter_mut().zip(&mut spent) {
            let begin = ProcessTime::now();
            solver.step_frame().expect("the heap does not diverge");
            *spent += begin.elapsed().as_secs_f64();
        }
        let begin = ProcessTime::now();
        theirs.step();
        spent[mine.len()] += begin.elapsed().as_secs_f64();
    }
    let depths = mine.iter().map(|solver| solver.diagnostics().contact_penetration).chain([overlap(&theirs)]);
    let settled = |(k, penetration): (usize, f64)| {
        let (solver, substeps) = match substeps.get(k) {
            Some((substeps, iterations)) => ("unipbd", format!("{substeps} x {iterations}")),
            None => ("rapier2d", THEIR_SUBSTEPS.to_string()),
        };
        (substeps, Settled { solver, milliseconds: 1e3 * spent[k] / f64::from(frames), penetration, stands: true })
    };
    depths.enumerate().map(settled).collect()
}

/// Steps until a pyramid falls or the time is over: whether its top, which `step` returns, stayed within
/// half a box of its place, and the milliseconds per frame.
fn watch(top: [f64; 2], seconds: f64, mut step: impl FnMut() -> [f64; 2]) -> (bool, f64) {
    let (frames, begin) = ((seconds * FPS) as u32, ProcessTime::now());
    for frame in 1..=frames {
        let place = step();
        if (place[0] - top[0]).abs() > 0.5 * SIZE || (place[1] - top[1]).abs() > 0.5 * SIZE {
            return (false, 1e3 * begin.elapsed().as_secs_f64() / f64::from(frame));
        }
    }
    (true, 1e3 * begin.elapsed().as_secs_f64() / f64::from(frames))
}

/// A pyramid for some seconds at this many substeps in unipbd.
pub fn stand(rows: usize, seconds: f64, substeps: u32) -> Settled {
    let places = pyramid(rows);
    let mut solver = ours(Kind::Boxes, &places, None, (substeps, 1));
    let (stands, milliseconds) = watch(places[places.len() - 1], seconds, || {
        solver.step_frame().expect("the pyramid does not diverge");
        solver.bodies()[places.len() - 1].position.into()
    });
    let penetration = solver.diagnostics().contact_penetration;
    Settled { solver: "unipbd", milliseconds, penetration, stands }
}

/// The same in rapier2d, whose solver iterations are its substeps.
pub fn stand_peer(rows: usize, seconds: f64, iterations: u32) -> Settled {
    let places = pyramid(rows);
    let (mut world, handles) = theirs(Kind::Boxes, &places, None, iterations as usize);
    let (stands, milliseconds) = watch(places[places.len() - 1], seconds, || {
        world.step();
        let place = world.bodies[handles[handles.len() - 1]].translation();
        [f64::from(place.x), f64::from(place.y)]
    });
    Settled { solver: "rapier2d", milliseconds, penetration: overlap(&world), stands }
}
