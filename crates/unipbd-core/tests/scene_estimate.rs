//! Estimates against counts done by hand.

use unipbd_core::scene::{
    BYTES_PER_PARTICLE, Block, Emitter, Gas, Liquid, PressureGridUse, Scene, SmokeSource, SolverSettings, Substeps,
};
use unipbd_core::step::{Demand, SubstepRule};

/// The particles alone carry the pressure: their substeps follow the depth.
fn plain() -> SolverSettings {
    SolverSettings { pressure_grid: PressureGridUse::Off, ..SolverSettings::default() }
}

fn water(min: [f64; 2], max: [f64; 2]) -> Scene {
    let block = Block { material: "water".into(), min, max, velocity: [0.0; 2], jitter: 0.0, temperature: 0.0 };
    let liquid = Liquid { name: "water".into(), ..Liquid::default() };
    Scene { liquid: vec![liquid], block: vec![block], solver: plain(), ..Scene::default() }
}

fn jet() -> Scene {
    let emitter = Emitter { start: 1.0, ..Emitter::new("air", [0.0; 2], 1.0, 2.0) };
    let gas = Gas { name: "air".into(), lifetime: Some(2.0), ..Gas::default() };
    Scene { gas: vec![gas], emitter: vec![emitter], duration: 10.0, solver: plain(), ..Scene::default() }
}

#[test]
fn block_is_counted_by_its_lattice() {
    let estimate = water([0.0, 0.0], [2.0, 4.0]).estimate();
    assert_eq!(estimate.particles_at_start, 800);
    assert_eq!(estimate.particles_at_peak, 800);
    assert_eq!(estimate.memory_bytes, 800 * BYTES_PER_PARTICLE);
    assert_eq!(estimate.emitted_per_second, 0.0);
}

#[test]
fn automatic_substeps_grow_with_the_root_of_depth() {
    // C = (0.183/0.57) g depth / n^2 frame^2 / dx^2 <= 1 % at g = 9.81, dx = 0.1: n = 2.96 per root of a metre.
    let substeps = |depth| water([0.0, 0.0], [1.0, depth]).estimate().substeps;
    assert_eq!(substeps(1.0), 3);
    assert_eq!(substeps(4.0), 6);
    assert_eq!(substeps(16.0), 12);
}

#[test]
fn estimate_and_solver_choose_the_same_substeps() {
    for depth in [1.0, 3.0, 10.0] {
        for speed in [0.0, 5.0, 40.0] {
            let mut scene = water([0.0, 0.0], [1.0, depth]);
            scene.block[0].velocity = [0.0, speed];
            let demand = Demand { speed, pressure: 9.81 * depth, ..Demand::default() };
            let choice = SubstepRule::new(&scene).choose(1.0 / 60.0, demand);
            assert_eq!(scene.estimate().substeps, choice.substeps, "depth {depth}, speed {speed}");
        }
    }
}

#[test]
fn automatic_substeps_follow_speed_and_stop_at_their_cap() {
    let mut scene = water([0.0, 0.0], [1.0, 1.0]);
    scene.block[0].velocity = [59.0, 0.0];
    assert_eq!(scene.estimate().substeps, 25);
    scene.solver.max_substeps = 7;
    assert_eq!(scene.estimate().substeps, 7);
    scene.solver.substeps = Substeps::Fixed(3);
    assert_eq!(scene.estimate().substeps, 3);
}

#[test]
fn emitted_gas_peaks_at_rate_times_lifetime() {
    let estimate = jet().estimate();
    assert_eq!((estimate.particles_at_start, estimate.emitted_per_second), (0, 200.0));
    assert_eq!(estimate.particles_at_peak, 400);
    // Rises from 1 s to 3 s, then stays: 200 * 2 * 2 / 2 + 400 * 7 particle seconds.
    let expected = 3200.0 * 60.0 * f64::from(estimate.substeps) * 60e-9;
    assert!((estimate.cost_seconds / expected - 1.0).abs() < 1e-9, "{estimate:?}");
}

#[test]
fn smoke_without_lifetime_gathers_until_the_end() {
    let mut scene = jet();
    scene.emitter[0].smoke = Some(SmokeSource { material: "soot".into(), per_particle: 3 });
    scene.emitter[0].stop = Some(6.0);
    assert_eq!(scene.estimate().emitted_per_second, 800.0);
    assert_eq!(scene.estimate().particles_at_peak, 400 + 5 * 600);
}

#[test]
fn heavy_liquid_on_a_light_one_needs_more_substeps() {
    let mut scene = water([0.0, 0.0], [1.0, 1.0]);
    scene.liquid.push(Liquid { name: "oil".into(), density: 250.0, ..Liquid::default() });
    let mut upper = scene.block[0].clone();
    (upper.min, upper.max, upper.material) = ([0.0, 1.0], [1.0, 2.0], "oil".into());
    scene.block.push(upper);
    let stable = scene.estimate().substeps;
    scene.block[0].material = "oil".into();
    scene.block[1].material = "water".into();
    let inverted = scene.estimate().substeps;
    assert!((2 * stable - 1..=2 * stable).contains(&inverted), "{stable} {inverted}");
}
