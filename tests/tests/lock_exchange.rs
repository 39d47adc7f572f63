//! Two liquids side by side that fill a closed tank.

use unipbd_core::scene::Scene;
use unipbd_tests::{bars, build, run, scene};

/// A lock exchange of two fluids, from the file.
pub(crate) fn lock_exchange(kinds: &str, spacing: f64) -> Scene {
    scene(&format!(
        r#"
        spacing = {spacing}
        fps = 30
        {kinds}
        [[block]]
        material = "heavy"
        min = [0.0, 0.0]
        max = [4.0, 1.0]
        jitter = 0.2
        [[block]]
        material = "light"
        min = [4.0, 0.0]
        max = [8.0, 1.0]
        jitter = 0.2
        [[tank]]
        min = [0.0, 0.0]
        max = [8.0, 1.0]
        friction = 0.0
        "#
    ))
}

#[test]
fn both_fronts_of_a_lock_exchange_run_at_half_of_the_wave_speed() {
    let kind =
        |name: &str, density: f64| format!("[[liquid]]\nname = \"{name}\"\ndensity = {density}\nsurface = \"none\"\n");
    let spacing = 0.05;
    let mut solver = build(&lock_exchange(&(kind("heavy", 1000.0) + &kind("light", 900.0)), spacing), 2);
    let mut fronts: Vec<(f64, [f64; 2])> = Vec::new();
    run(&mut solver, 210, |solver| {
        let rows = 0..solver.positions().len();
        let place = |row: usize| (f64::from(solver.positions()[row].x), f64::from(solver.positions()[row].y));
        let is_heavy = |row: &usize| solver.material_indices()[*row] == 0;
        let heavy = rows.clone().filter(is_heavy).map(place).filter(|(_, y)| *y < 2.0 * spacing);
        let light = rows.filter(|row| !is_heavy(row)).map(place).filter(|(_, y)| *y > 1.0 - 2.0 * spacing);
        let right = heavy.map(|(x, _)| x).fold(f64::NEG_INFINITY, f64::max);
        let left = light.map(|(x, _)| x).fold(f64::INFINITY, f64::min);
        fronts.push((solver.time(), [right - 4.0, 4.0 - left]));
    });
    let speed = |which: usize| {
        let at = |way: f64| fronts.iter().find(|(_, ways)| ways[which] > way).map_or(f64::INFINITY, |(time, _)| *time);
        1.6 / (at(2.6) - at(1.0))
    };
    let scale = (9.81 * 0.1 * 1.0_f64).sqrt();
    bars("lock exchange, depth 20 dx, densities 1000 and 900", |bars| {
        bars.within("speed of the heavy front over sqrt(g' H)", speed(0) / scale, 0.44, 0.52);
        bars.within("speed of the light front over sqrt(g' H)", speed(1) / scale, 0.44, 0.52);
    });
}
