//! Bodies in water: one that is let go in a full tank, and floats that weigh next to nothing.

use std::f64::consts::PI;

use unipbd_core::scene::{Block, BodyDescription, BodyKind, Disc, Liquid, LiquidSurface, Scene};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::runner::{Cost, Failure};
use crate::scenes::{GRAVITY, SPACING, body, closed_tank, pool};

/// A disc of radius `resolution` spacings that is let go in a ring and in a box full of water.
pub const ADDED_MASS: Case = Case {
    name: "added_mass",
    truth: "potential flow: a = g (1 - s)/(s + Ca), Ca = (R^2 + r^2)/(R^2 - r^2) for a disc in a concentric ring, \
            1.2111 in a square box three times as wide",
    quick: 16,
    full: &[12, 16, 24],
    targets: &[0.01],
    run: added_mass,
};

/// Radius of the ring, and half the side of the box, over the radius of the disc.
const AROUND: f64 = 3.0;
/// Added mass of the disc in the box, over the mass of its water: by a series of 2 x 8 harmonics.
const IN_BOX: f64 = 1.2111;
/// The disc is watched over this part of its radius, in so many frames.
const WAY: f64 = 0.04;
const FRAMES: u32 = 8;

fn added_mass(trial: &Trial) -> Result<Measured, Failure> {
    let (mut figures, mut cost) = (Vec::new(), Cost::default());
    let in_ring = (AROUND * AROUND + 1.0) / (AROUND * AROUND - 1.0);
    let all: [(&'static str, f64, f64, fn(&Trial) -> Scene); 6] = [
        ("acceleration error at density ratio 0.1 in a box", 0.1, IN_BOX, filled_box),
        ("acceleration error at density ratio 0.5 in a box", 0.5, IN_BOX, filled_box),
        ("acceleration error at density ratio 2 in a box", 2.0, IN_BOX, filled_box),
        ("acceleration error at density ratio 0.1 in a ring", 0.1, in_ring, ring),
        ("acceleration error at density ratio 0.5 in a ring", 0.5, in_ring, ring),
        ("acceleration error at density ratio 2 in a ring", 2.0, in_ring, ring),
    ];
    for (what, ratio, added, scene) in all {
        let exact = GRAVITY * (1.0 - ratio) / (ratio + added);
        let radius = f64::from(trial.resolution) * SPACING;
        let time = (2.0 * WAY * radius / exact.abs()).sqrt();
        let mut scene = Scene { fps: f64::from(FRAMES) / time, ..scene(trial) };
        let mut disc = body("disc", [0.0; 2]);
        (disc.radius, disc.density) = (Some(radius), 1000.0 * ratio);
        scene.body.push(disc);
        let mut run = trial.start(&scene)?;
        run.frames(FRAMES, |_| ())?;
        let disc = run.solver.bodies().iter().find(|body| body.name == "disc").map(|disc| disc.velocity.y);
        let error = disc.unwrap_or(f64::NAN) / (exact * run.solver.time()) - 1.0;
        figures.push(Figure::new(what, error, trial.with_grid(Band::within(0.03))));
        cost = cost.and(run.cost);
    }
    let worst = figures.iter().map(|figure| figure.value.abs()).fold(0.0, f64::max);
    figures.insert(0, Figure::new("largest acceleration error", worst, Band::OPEN));
    Ok((figures, cost))
}

/// A closed box of this half side, in spacings, without water.
fn empty_box(trial: &Trial, half: f64) -> Scene {
    let corner = half * SPACING;
    Scene {
        liquid: vec![Liquid { surface: LiquidSurface::None, ..Liquid::new("water", 1000.0) }],
        ..closed_tank(trial, [-corner; 2], [corner; 2])
    }
}

fn filled_box(trial: &Trial) -> Scene {
    let half = AROUND * f64::from(trial.resolution);
    let corner = half * SPACING;
    Scene { block: vec![Block::new("water", [-corner; 2], [corner; 2])], ..empty_box(trial, half) }
}

fn ring(trial: &Trial) -> Scene {
    let cells = AROUND * f64::from(trial.resolution);
    let water = Disc {
        material: "water".to_owned(),
        center: [0.0; 2],
        radius: cells * SPACING,
        velocity: [0.0; 2],
        jitter: 0.0,
        temperature: 0.0,
    };
    let halves = [("upper", 1.0), ("lower", -1.0)].map(|(name, side)| half_ring(name, cells * SPACING, side));
    Scene { disc: vec![water], body: halves.into(), ..empty_box(trial, cells + THICKNESS) }
}

/// Least thickness of the ring \[spacings].
const THICKNESS: f64 = 8.0;

/// The upper or the lower half of what lies around a circle.
fn half_ring(name: &str, radius: f64, side: f64) -> BodyDescription {
    const CORNERS: u32 = 48;
    let arc = (0..=CORNERS).map(|k| {
        let angle = PI * f64::from(k) / f64::from(CORNERS);
        [radius * angle.cos(), side * radius * angle.sin()]
    });
    let out = radius + THICKNESS * SPACING;
    let around = [[-out, 0.0], [-out, side * out], [out, side * out], [out, 0.0]];
    let mut half = body(name, [0.0; 2]);
    half.outline = Some(arc.chain(around).collect());
    BodyDescription { kind: BodyKind::Static, ..half }
}

/// Boxes of `resolution` spacings on a pool.
pub const LIGHT_FLOATS: Case = Case {
    name: "light_floats",
    truth: "Archimedes: draft = density ratio x height; rest",
    quick: 12,
    full: &[12, 16, 24],
    targets: &[0.01],
    run: light_floats,
};

fn light_floats(trial: &Trial) -> Result<Measured, Failure> {
    let (mut figures, mut cost) = (Vec::new(), Cost::default());
    let all = [
        ("speed over sqrt(g b) at density ratio 0.05", "draft error at density ratio 0.05 [dx]", 0.05),
        ("speed over sqrt(g b) at density ratio 0.01", "draft error at density ratio 0.01 [dx]", 0.01),
        ("speed over sqrt(g b) at density ratio 0.001", "draft error at density ratio 0.001 [dx]", 0.001),
    ];
    for (of_speed, of_draft, ratio) in all {
        let (speed, draft, spent) = float(trial, ratio)?;
        figures.push(Figure::new(of_speed, speed, trial.with_grid(Band::between(0.0, 0.03))));
        figures.push(Figure::new(of_draft, draft, Band::OPEN));
        cost = cost.and(spent);
    }
    Ok((figures, cost))
}

/// Root mean square of the speed over sqrt(g b), draft error \[spacings], and cost.
fn float(trial: &Trial, ratio: f64) -> Result<(f64, f64, Cost), Failure> {
    let size = f64::from(trial.resolution) * SPACING;
    let (width, depth) = (4.0 * f64::from(trial.resolution), 2.0 * f64::from(trial.resolution));
    let mut scene = pool((width, depth), width, trial);
    let mut float = body("float", [0.5 * width * SPACING, depth * SPACING + size * (0.5 - ratio)]);
    (float.size, float.density) = (Some([size, size]), 1000.0 * ratio);
    scene.body.push(float);
    let mut run = trial.start(&scene)?;
    run.frames(120, |_| ())?;
    let (mut square, mut place) = (0.0, 0.0);
    run.frames(120, |solver| {
        let float = &solver.bodies()[0];
        square += float.velocity.length_squared() / 120.0;
        place += float.position.y / 120.0;
    })?;
    let count = run.solver.diagnostics().count(unipbd_core::Phase::Liquid) as f64;
    let level = (count * SPACING * SPACING + ratio * size * size) / (width * SPACING);
    let draft = level - (place - 0.5 * size);
    Ok(((square / (GRAVITY * size)).sqrt(), (draft - ratio * size) / SPACING, run.cost))
}
