//! Gas that fills its domain: vortices, buoyancy, fronts. Lengths in spacings: dx = 1 m.

use std::f64::consts::TAU;

use unipbd_core::math::{Vector64, wide};
use unipbd_core::scene::Scene;
use unipbd_core::{Phase, Solver};
use unipbd_tests::{Kick, Spread, bars, build, crowded, kinetic_energy, mean_of, of_phase, run, scene};

const BOX: f64 = 64.0;
const WAVE: f64 = TAU / BOX;
const SPEED: f64 = 120.0;

/// Four vortices in a periodic box (Taylor & Green 1937).
fn taylor_green(x: Vector64) -> Vector64 {
    let (a, b) = (WAVE * x.x, WAVE * x.y);
    Vector64::new(a.sin() * b.cos(), -a.cos() * b.sin()) * SPEED
}

struct Decay {
    viscosity: f64,
    compression: f64,
    energy_max: f64,
    energy: f64,
    crowded: f64,
}

fn vortices(vorticity: f64, frames: u64) -> Decay {
    let mut scene = scene(
        r#"
        spacing = 1.0
        gravity = [0.0, 0.0]
        [solver]
        substeps = 8
        [domain]
        periodic_x = [0.0, 64.0]
        periodic_y = [0.0, 64.0]
        [[gas]]
        name = "air"
        [[block]]
        material = "air"
        min = [0.0, 0.0]
        max = [64.0, 64.0]
        jitter = 0.1
        "#,
    );
    scene.gas[0].vorticity = vorticity;
    let mut solver = build(&scene, 2);
    let start = mean_of(solver.positions().iter().map(|x| 0.5 * taylor_green(wide(*x)).length_squared()));
    solver.add_group(Box::new(Kick::new(taylor_green)));
    let (mut compression, mut energy, mut crowd) = (Spread::default(), Spread::default(), Spread::default());
    run(&mut solver, frames, |solver| {
        compression.add(solver.diagnostics().density_error_max);
        energy.add(kinetic_energy(solver) / start);
        if solver.frame() % 10 == 0 {
            crowd.add(crowded(solver.positions().iter().map(|x| wide(*x)).collect(), 0.6));
        }
    });
    let left = kinetic_energy(&solver) / start;
    Decay {
        viscosity: -left.ln() / (4.0 * WAVE * WAVE * solver.time()),
        compression: compression.max(),
        energy_max: energy.max(),
        energy: left,
        crowded: crowd.max(),
    }
}

#[test]
fn taylor_green_vortices_decay_slowly_and_never_gain_energy() {
    let decay = vortices(0.0, 60);
    bars("Taylor-Green vortices, L = 64 dx, u = 120 dx/s, n = 8", |bars| {
        bars.at_most("effective viscosity over 1 s [dx^2/s]", decay.viscosity, 9.0);
        bars.at_most("peak C", decay.compression, 0.15);
        bars.at_most("largest energy over that of the start", decay.energy_max, 1.0);
        bars.at_most("part with a neighbour nearer than 0.6 dx", decay.crowded, 0.001);
    });
}

#[test]
fn confinement_feeds_vortices_and_its_negative_starves_them() {
    let energy = |strength: f64| vortices(strength, 30).energy;
    let [negative, none, positive] = [-2.0, 0.0, 2.0].map(energy);
    bars("vorticity confinement, energy left after 0.5 s", |bars| {
        bars.at_least("strength 2 over none", positive / none, 1.005);
        bars.at_most("strength -2 over none", negative / none, 0.995);
    });
}

/// A hot square of 16 dx in a cool periodic box of 64 dx.
fn parcel() -> Scene {
    scene(
        r#"
        spacing = 1.0
        gravity = [0.0, -490.0]
        [solver]
        substeps = 6
        [domain]
        periodic_x = [0.0, 64.0]
        periodic_y = [0.0, 64.0]
        [[gas]]
        name = "air"
        gravity_factor = -0.3
        [[block]]
        material = "air"
        min = [24.0, 24.0]
        max = [40.0, 40.0]
        temperature = 1.0
        jitter = 0.1
        [[block]]
        material = "air"
        min = [0.0, 24.0]
        max = [24.0, 40.0]
        jitter = 0.1
        [[block]]
        material = "air"
        min = [40.0, 24.0]
        max = [64.0, 40.0]
        jitter = 0.1
        [[block]]
        material = "air"
        min = [0.0, 0.0]
        max = [64.0, 24.0]
        jitter = 0.1
        [[block]]
        material = "air"
        min = [0.0, 40.0]
        max = [64.0, 64.0]
        jitter = 0.1
        "#,
    )
}

/// Mean height of the hot gas.
fn hot_height(solver: &Solver) -> f64 {
    let hot = of_phase(solver, Phase::Gas).filter(|&row| solver.temperatures()[row] > 0.5);
    mean_of(hot.map(|row| f64::from(solver.positions()[row].y)))
}

/// Incompressibility leaves half of the buoyancy of a patch as symmetric as a square to the patch and
/// turns the rest into return flow; the mean over a periodic box is not held back. So the start is
/// a = g' ((1 - phi)/2 + phi), with phi the part of the box that is hot.
#[test]
fn a_hot_parcel_rises_as_fast_as_its_added_mass_allows() {
    let mut solver = build(&parcel(), 2);
    let before = hot_height(&solver);
    run(&mut solver, 12, |_| ());
    let part = 1.0 / 16.0;
    let acceleration = 0.3 * 490.0 * (0.5 * (1.0 - part) + part);
    let expected = 0.5 * acceleration * solver.time() * solver.time();
    let rise = (hot_height(&solver) - before) / expected;
    bars("hot parcel", |bars| bars.within("rise at 0.2 s over theory", rise, 0.95, 1.08));
}

/// Hot gas on the left, cool gas on the right, in a box four times as long as high. Ten rows stand in
/// 9.7 dx: without some pressure everywhere, the gas would part from floor and ceiling.
fn lock() -> Scene {
    let layer = |(row, side): (u32, f64)| {
        format!(
            r#"
            [[block]]
            material = "air"
            min = [{}, {}]
            max = [{}, {}]
            temperature = {}
            jitter = 0.1
            "#,
            if side < 0.0 { -80.0 } else { 0.0 },
            9.7 * f64::from(row),
            if side < 0.0 { 0.0 } else { 80.0 },
            9.7 * f64::from(row + 1),
            -0.5 * side
        )
    };
    let layers: String = (0..4).flat_map(|row| [(row, -1.0), (row, 1.0)]).map(layer).collect();
    scene(&format!(
        r#"
        spacing = 1.0
        gravity = [0.0, -490.0]
        [solver]
        substeps = 6
        [[gas]]
        name = "air"
        gravity_factor = -0.3
        {layers}
        [[tank]]
        min = [-80.0, 0.0]
        max = [80.0, {HEIGHT}]
        "#
    ))
}

const HEIGHT: f64 = 4.0 * 9.7;

/// How far the hot gas has come under the ceiling, and the cool gas along the floor.
fn fronts(solver: &Solver) -> [f64; 2] {
    let place = |hot: bool| {
        let side = if hot { 1.0 } else { -1.0 };
        let rows = of_phase(solver, Phase::Gas).filter(|&row| (solver.temperatures()[row] > 0.0) == hot);
        let places = rows.map(|row| wide(solver.positions()[row]));
        let near = places.filter(|x| if hot { x.y > 0.75 * HEIGHT } else { x.y < 0.25 * HEIGHT });
        let mut way: Vec<f64> = near.map(|x| side * x.x).collect();
        way.sort_by(f64::total_cmp);
        // The outermost few may be strays.
        way[way.len() - 8]
    };
    [place(true), place(false)]
}

/// Speeds of both fronts over that of theory, by least squares.
fn speeds_of_fronts(scene: &Scene) -> [f64; 2] {
    let mut solver = build(scene, 2);
    let (mut times, mut ways) = (Vec::new(), Vec::new());
    run(&mut solver, 100, |solver| {
        let way = fronts(solver);
        if way.iter().all(|way| (20.0..60.0).contains(way)) {
            times.push(solver.time());
            ways.push(way);
        }
    });
    let theory = 0.5 * f64::sqrt(0.3 * 490.0 * HEIGHT);
    [0, 1].map(|front| {
        let (time, way) = (mean_of(times.iter().copied()), mean_of(ways.iter().map(|way| way[front])));
        let products = times.iter().zip(&ways).map(|(t, w)| (t - time) * (w[front] - way));
        products.sum::<f64>() / times.iter().map(|t| (t - time) * (t - time)).sum::<f64>() / theory
    })
}

#[test]
fn lock_exchange_fronts_run_at_half_of_the_long_wave_speed() {
    // Starts that differ by how long they settled scatter by 0.02: single ones tell little.
    let starts = [60, 80, 100, 120].map(|settle_substeps| {
        let mut scene = lock();
        scene.solver.settle_substeps = Some(settle_substeps);
        speeds_of_fronts(&scene)
    });
    let mean = |front: usize| mean_of(starts.iter().map(|speeds| speeds[front]));
    bars("lock exchange, H = 39 dx", |bars| {
        bars.within("hot front over 0.5 sqrt(g' H)", mean(0), 0.92, 1.05);
        bars.within("cool front over 0.5 sqrt(g' H)", mean(1), 0.92, 1.05);
    });
}
