//! An obstacle of any outline is a body of `kind = "static"`: liquids, gas and bodies stay outside of it, also in
//! its hollows, and the forces of all of them on it can be read.

use crate::outlines::{fluid, list, star};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use unipbd_core::math::wide;
use unipbd_core::rigid::Body;
use unipbd_core::scene::Scene;
use unipbd_core::{Phase, Solver, Vector64};
use unipbd_tests::{bars, build, mean_of, run, scene};

/// A trough with slanted sides, eight hundred litres of water in it, and a heavy box on its floor.
const TROUGH: &str = r#"
spacing = 0.05
[solver]
substeps = 8
[[liquid]]
name = "water"
xsph = 0.05
[[block]]
material = "water"
min = [-0.5, 0.0]
max = [0.5, 0.8]
[[body]]
name = "trough"
kind = "static"
position = [0.0, 0.0]
outline = [[-1.7, 2.5], [-1.9, 2.4], [-0.7, -0.2], [0.7, -0.2], [1.9, 2.4], [1.7, 2.5], [0.5, 0.0], [-0.5, 0.0]]
[[body]]
name = "stone"
size = [0.3, 0.3]
position = [0.0, 0.15]
density = 2500.0
"#;

/// Depth of the deepest fluid particle inside a body \[m].
fn deepest(solver: &Solver, body: &Body) -> f64 {
    let shape = unipbd_core::shapes::Shape::Polygon(body.outline.clone());
    let fluid = solver.positions().iter().zip(solver.phases()).filter(|(_, phase)| phase.is_fluid());
    let depth = |x: &unipbd_core::Vector| {
        let seen = Vector64::from_angle(-body.angle).rotate(wide(*x) - body.position);
        -shape.nearest(seen).distance
    };
    fluid.map(|(x, _)| depth(x)).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn a_concave_obstacle_holds_water_and_a_stone_and_feels_their_weight() {
    let scene = scene(TROUGH);
    let mut solver = build(&scene, 2);
    let water = solver.phases().iter().filter(|phase| **phase == Phase::Liquid).count();
    let (mut inside, mut carried, mut floor) = (f64::NEG_INFINITY, Vector64::ZERO, Vector64::ZERO);
    run(&mut solver, 480, |solver| inside = inside.max(deepest(solver, &solver.bodies()[0])));
    run(&mut solver, 60, |solver| {
        let trough = &solver.bodies()[0];
        carried += (trough.fluid_force + trough.contact_force) / 60.0;
        floor += trough.contact_force / 60.0;
    });
    let kept = solver.positions().iter().zip(solver.phases());
    let kept = kept.filter(|(x, phase)| **phase == Phase::Liquid && x.y > -0.01 && x.x.abs() < 1.75).count();
    let stone = &solver.bodies()[1];
    let weight = 9.81 * (1000.0 * scene.spacing * scene.spacing * water as f64 + stone.mass);
    bars("concave obstacle", |bars| {
        bars.within("weight carried over weight", -carried.y / weight, 0.98, 1.02);
        bars.at_most("sideways force over weight", carried.x.abs() / weight, 0.02);
        bars.at_most("depth of water inside [spacings]", inside / scene.spacing, 0.1);
        bars.at_least("water kept", kept as f64 / water as f64, 1.0);
        bars.within("height of the stone over the floor", stone.position.y / 0.15, 0.99, 1.01);
        // Flush on the floor it has no water below: it presses with its weight and that of the water above it.
        bars.at_least("force of the stone on the floor over its weight", -floor.y / (9.81 * stone.mass), 1.0);
    });
}

/// A jet of hot gas below a vault that is open downwards.
const VAULT: &str = r#"
spacing = 0.02
[[gas]]
name = "air"
drag = 20.0
lifetime = 3.0
[[smoke]]
name = "smoke"
lifetime = 3.0
[[emitter]]
material = "air"
position = [0.0, 0.1]
width = 0.12
speed = 1.5
temperature = 1.0
smoke = { material = "smoke", per_particle = 3 }
[[body]]
name = "vault"
kind = "static"
position = [0.0, 0.8]
outline = [[-0.25, -0.1], [-0.2, -0.1], [-0.2, 0.1], [0.2, 0.1], [0.2, -0.1], [0.25, -0.1], [0.25, 0.15], [-0.25, 0.15]]
[[tank]]
min = [-0.8, 0.0]
max = [0.8, 2.0]
open = ["top"]
"#;

#[test]
fn gas_fills_a_vault_and_flows_round_it() {
    let mut solver = build(&scene(VAULT), 2);
    let (mut inside, mut lift) = (f64::NEG_INFINITY, 0.0f64);
    run(&mut solver, 180, |solver| {
        inside = inside.max(deepest(solver, &solver.bodies()[0]));
        lift = lift.max(solver.bodies()[0].fluid_force.y);
    });
    let count = |place: fn(Vector64) -> bool| solver.positions().iter().filter(|x| place(wide(**x))).count() as f64;
    bars("vault in a jet", |bars| {
        bars.at_most("depth of gas inside [spacings]", inside / 0.02, 0.1);
        bars.at_least("particles in the hollow", count(|x| x.x.abs() < 0.2 && x.y > 0.7 && x.y < 0.9), 100.0);
        bars.at_least("particles above", count(|x| x.y > 1.0), 100.0);
        bars.at_least("lift of the jet [N]", lift, 0.01);
    });
}

/// Greatest root of the mean square of the speeds in the last second of four \[spacings/s].
fn stirred(scene: &Scene) -> f64 {
    let mut solver = build(scene, 2);
    let mut most = 0.0f64;
    run(&mut solver, 180, |_| ());
    run(&mut solver, 60, |solver| {
        most = most.max(mean_of(fluid(solver).map(|(_, v)| v.length_squared())).sqrt() / scene.spacing);
    });
    most
}

/// Cells of the grid that lie within a wall but for a corner hold no particle: taken for air, they draw water in.
#[test]
fn water_rests_around_sunk_outlines_and_in_a_round_vessel() {
    let disc = |radius: f64| format!("radius = {radius}");
    let askew = "size = [0.5, 0.5]\nangle_deg = 28.0".to_owned();
    let star = format!("outline = [{}]", list(star(0.35, 0.16)));
    let sunk = [
        ("disc", 0.05, 1.6, [1.013, 0.76], disc(0.35)),
        ("disc", 0.05, 1.6, [0.98, 0.72], disc(0.35)),
        ("disc", 0.04, 1.6, [1.03, 0.76], disc(0.3)),
        ("disc near the surface", 0.05, 1.2, [1.013, 0.76], disc(0.35)),
        ("disc half out of it", 0.04, 0.64, [1.01, 0.76], disc(0.35)),
        ("box", 0.05, 1.6, [1.013, 0.76], askew),
        ("star", 0.025, 1.6, [1.01, 0.71], star),
    ];
    for (name, spacing, depth, [x, y], outline) in sunk {
        let scene = scene(&format!(
            r#"
            spacing = {spacing}
            [solver]
            pressure_grid = "on"
            [[liquid]]
            name = "water"
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [2.0, {depth}]
            [[tank]]
            min = [0.0, 0.0]
            max = [2.0, 3.0]
            [[body]]
            kind = "static"
            position = [{x}, {y}]
            {outline}
            "#
        ));
        bars("water at rest", |bars| {
            let what = format!("speed around a {name} at ({x}, {y}) [dx/s]");
            bars.at_most(&what, stirred(&scene), if name.contains("half out") { 0.5 } else { 0.2 });
        });
    }
    let sides: Vec<_> = (0..24).map(|k| Vector64::from_angle(TAU * (f64::from(k) + 0.5) / 24.0)).collect();
    let spacing = 0.04;
    let places = (-20..20).flat_map(|i| (-20..8).map(move |j| Vector64::new(f64::from(i) + 0.37, f64::from(j) + 0.21)));
    let inside = places.map(|x| x * spacing).filter(|x| sides.iter().all(|side| side.dot(*x) < 0.8 - 0.45 * spacing));
    let planes = sides.iter().fold(String::new(), |mut text, side| {
        let (at, normal) = (*side * 0.8, -*side);
        let _ = writeln!(text, "[[half_plane]]\npoint = [{}, {}]\nnormal = [{}, {}]", at.x, at.y, normal.x, normal.y);
        text
    });
    let scene = scene(&format!(
        r#"
        spacing = {spacing}
        [solver]
        pressure_grid = "on"
        [[liquid]]
        name = "water"
        xsph = 0.05
        [[points]]
        material = "water"
        positions = [{}]
        {planes}
        "#,
        list(inside)
    ));
    bars("water at rest", |bars| {
        bars.at_most("speed in a circle of half-planes [dx/s]", stirred(&scene), 0.5);
    });
}

/// As air, these cells would let a full ring fall into them.
#[test]
fn water_does_not_fall_in_a_full_ring() {
    let half = |side: f64| {
        let arc = (0..=48).map(|k| Vector64::from_angle(PI * f64::from(k) / 48.0) * 0.9);
        let around = [[-1.1, 0.0], [-1.1, 1.1], [1.1, 1.1], [1.1, 0.0]].map(|[x, y]| Vector64::new(x, y));
        let outline = list(arc.chain(around).map(|x| Vector64::new(x.x, side * x.y)));
        format!("[[body]]\nkind = \"static\"\nposition = [0.0, 0.0]\noutline = [{outline}]\n")
    };
    let scene = scene(&format!(
        r#"
        spacing = 0.025
        [solver]
        pressure_grid = "on"
        [[liquid]]
        name = "water"
        surface = "none"
        [[disc]]
        material = "water"
        center = [0.0, 0.0]
        radius = 0.9
        [[tank]]
        min = [-1.1, -1.1]
        max = [1.1, 1.1]
        open = []
        {}{}
        "#,
        half(1.0),
        half(-1.0)
    ));
    let mut solver = build(&scene, 2);
    let mut fastest = 0.0f64;
    run(&mut solver, 10, |solver| {
        let (sum, count) = fluid(solver).fold((0.0, 0.0), |(sum, count), (_, v)| (sum + v.y, count + 1.0));
        fastest = fastest.max((sum / count).abs());
    });
    bars("water at rest", |bars| {
        bars.at_most("greatest mean speed in a full ring, over g times a frame", fastest * 60.0 / 9.81, 0.01);
    });
}
