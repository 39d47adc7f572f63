//! Starts of liquids at rest without the pressure grid: their pressure is there in the first frame.

use unipbd_core::scene::{Scene, Substeps};
use unipbd_core::{Solver, Vector};
use unipbd_tests::{bars, build, run, scene};

const SPACING: f64 = 0.05;
const GRAVITY: f64 = 9.81;
const WIDTH: f64 = 2.0;

/// A tank with these tables in it, and a gauge of the force on its floor.
fn tank(depth: f64, tables: &str) -> Scene {
    scene(&format!(
        r#"
        spacing = {SPACING}
        [solver]
        pressure_grid = "off"
        [[liquid]]
        name = "water"
        [[liquid]]
        name = "oil"
        density = 500.0
        [[tank]]
        name = "tank"
        min = [0.0, 0.0]
        max = [{WIDTH}, {}]
        open = ["top"]
        [[gauge]]
        name = "floor"
        kind = "force"
        on = "tank bottom"
        direction = [0.0, -1.0]
        {tables}
        "#,
        3.0 * depth
    ))
}

fn block(material: &str, [left, bottom]: [f64; 2], [right, top]: [f64; 2]) -> String {
    format!("[[block]]\nmaterial = \"{material}\"\nmin = [{left}, {bottom}]\nmax = [{right}, {top}]\n")
}

fn pool(depth: f64) -> Scene {
    tank(depth, &block("water", [0.0, 0.0], [WIDTH, depth]))
}

fn layers(depth: f64) -> Scene {
    let water = block("water", [0.0, 0.0], [WIDTH, 0.5 * depth]);
    tank(depth, &(water + &block("oil", [0.0, 0.5 * depth], [WIDTH, depth])))
}

/// A disc of half the density of water lies half in it, as it floats.
fn float(depth: f64) -> Scene {
    let disc = format!("[[body]]\nradius = 0.25\ndensity = 500.0\nposition = [{}, {depth}]\n", 0.5 * WIDTH);
    tank(depth, &(block("water", [0.0, 0.0], [WIDTH, depth]) + &disc))
}

/// Weight of all particles of liquids and of all bodies \[N].
fn weight(solver: &Solver) -> f64 {
    let area = SPACING * SPACING;
    let of_row = |material: u16| match &solver.materials()[usize::from(material)] {
        liquid if liquid.phase.is_fluid() => liquid.density * area,
        _ => 0.0,
    };
    let liquids: f64 = solver.material_indices().iter().map(|&material| of_row(material)).sum();
    GRAVITY * (liquids + solver.bodies().iter().map(|body| body.mass).sum::<f64>())
}

struct Start {
    /// Mean force on the floor over the first 0.05 s, and the largest in half a second, over the weight.
    force: f64,
    burst: f64,
    /// Largest root mean square of the velocities in half a second, over the root of g dx.
    speed: f64,
}

fn measured(scene: &Scene) -> Start {
    let mut solver = build(scene, 1);
    let weight = weight(&solver);
    let (mut force, mut burst, mut energy) = (0.0, 0.0_f64, 0.0_f64);
    run(&mut solver, 30, |solver| {
        let now = solver.gauges()[0].value / weight;
        force += if solver.frame() <= 3 { now / 3.0 } else { 0.0 };
        burst = burst.max(now);
        energy = energy.max(solver.diagnostics().kinetic_energy);
    });
    Start { force, burst, speed: (2.0 * energy / (weight * SPACING)).sqrt() }
}

/// Checks starts of these tanks, 20 to 60 dx deep, at several numbers of substeps.
fn check(case: &'static str, tank: impl Fn(f64) -> Scene, fastest: f64) {
    for layers in [20.0, 40.0, 60.0] {
        for substeps in [Substeps::Auto, Substeps::Fixed(4), Substeps::Fixed(16)] {
            let mut scene = tank(layers * SPACING);
            scene.solver.substeps = substeps;
            let start = measured(&scene);
            bars(case, |bars| {
                let name = |what: &str| format!("{layers} deep, {substeps:?}: {what}");
                bars.within(&name("first force on the floor over the weight"), start.force, 0.97, 1.03);
                bars.at_most(&name("largest force over the weight"), start.burst, 1.1);
                bars.at_most(&name("largest v_rms over the root of g dx"), start.speed, fastest);
            });
        }
    }
}

// Without its weight a pool 40 dx deep begins at 0.24 to 0.97 of it, reaches 1.7 to 1.9, and 0.2 to 0.8 of the root of g dx.

#[test]
fn a_still_tank_presses_on_its_floor_from_the_first_frame_on() {
    check("still tank", pool, 0.18);
}

#[test]
fn so_do_layers_of_two_liquids() {
    check("layers 2:1", layers, 0.18);
}

/// Four substeps are too few around a body 60 dx deep, however it starts: without its weight it reaches 1.9.
#[test]
fn so_does_a_tank_with_a_float() {
    check("floating disc", float, 0.7);
}

/// Places by id.
fn places(scene: &Scene, threads: usize) -> Vec<(u32, Vector)> {
    let solver = build(scene, threads);
    let mut places: Vec<_> = solver.ids().iter().copied().zip(solver.positions().iter().copied()).collect();
    places.sort_by_key(|&(id, _)| id);
    places
}

#[test]
fn the_start_has_the_same_bits_on_any_number_of_threads() {
    let scene = pool(60.0 * SPACING);
    assert_eq!(places(&scene, 1), places(&scene, 3));
}

/// Those whose places at the start depend on gravity.
fn weighed(scene: &Scene) -> Vec<bool> {
    let mut floating = scene.clone();
    floating.gravity = [0.0, 0.0];
    places(scene, 1).into_iter().zip(places(&floating, 1)).map(|(with, without)| with != without).collect()
}

#[test]
fn what_does_not_rest_starts_without_its_weight() {
    let depth = 20.0 * SPACING;
    let column = block("water", [0.0, 0.0], [0.4 * WIDTH, depth]);
    let beside = block("oil", [0.4 * WIDTH, 0.0], [WIDTH, depth]);
    let step = block("water", [0.4 * WIDTH, 0.0], [WIDTH, 0.5 * depth]);
    let moving = block("water", [0.0, 0.0], [WIDTH, depth]) + "velocity = [0.1, 0.0]\n";
    let in_the_air = block("water", [0.0, 0.5 * depth], [WIDTH, depth]);
    for (case, tables) in [
        ("column", column.clone()),
        ("liquids side by side", column.clone() + &beside),
        ("step", column + &step),
        ("stream", moving),
        ("slab in the air", in_the_air),
    ] {
        assert!(!weighed(&tank(depth, &tables)).contains(&true), "{case}");
    }
}

#[test]
fn a_drop_above_a_pool_leaves_the_pool_its_weight() {
    let depth = 20.0 * SPACING;
    let drop = block("water", [0.4 * WIDTH, 1.5 * depth], [0.6 * WIDTH, 2.0 * depth]);
    let scene = tank(depth, &(block("water", [0.0, 0.0], [WIDTH, depth]) + &drop));
    let weighed = weighed(&scene);
    let (of_pool, of_drop) = weighed.split_at(800);
    assert!(of_pool.iter().filter(|moved| **moved).count() > 700, "the pool is compressed");
    assert!(!of_drop.contains(&true), "the drop is not");
}
