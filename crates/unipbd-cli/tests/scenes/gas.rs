//! Gas in a closed box, and the smoke in it.

use unipbd_core::{Phase, Solver, Vector64};

use crate::support::solver;

const SPACING: f64 = 0.04;
/// Smoke markers per second, and how long one lasts [s].
const RATE: f64 = 240.0;
const LIFETIME: f64 = 1.0;

fn closed_box() -> Solver {
    solver(&format!(
        r#"
        spacing = {SPACING}
        seed = 3
        [solver]
        substeps = 6
        kernel_radius = 2.5
        [[gas]]
        name = "air"
        gravity_factor = -0.3
        vorticity = 2.0
        conductivity = 0.0064
        [[smoke]]
        name = "smoke"
        lifetime = {LIFETIME}
        [[block]]
        material = "air"
        min = [0.0, 0.0]
        max = [1.2, 1.6]
        jitter = 0.1
        [[tank]]
        min = [0.0, 0.0]
        max = [1.2, 1.6]
        open = []
        [[heater]]
        region = {{ center = [0.6, 0.3], radius = 0.15 }}
        [[injector]]
        material = "smoke"
        region = {{ center = [0.6, 0.3], radius = 0.15 }}
        rate = {RATE}
        "#
    ))
}

fn rows(solver: &Solver, phase: Phase) -> Vec<usize> {
    (0..solver.positions().len()).filter(|&row| solver.phases()[row] == phase).collect()
}

/// sum v W / sum W over the carrier at a point, by the formula (Wendland C2).
fn carried(solver: &Solver, carrier: &[usize], x: Vector64) -> Vector64 {
    let weight = |distance: f64| {
        let q = distance / (2.5 * SPACING);
        if q < 1.0 { (1.0 - q).powi(4) * (1.0 + 4.0 * q) } else { 0.0 }
    };
    let (mut sum, mut whole) = (Vector64::ZERO, 0.0);
    for &row in carrier {
        let w = weight((solver.positions()[row].as_dvec2() - x).length());
        sum += solver.velocities()[row].as_dvec2() * w;
        whole += w;
    }
    sum / whole
}

#[test]
fn smoke_in_a_closed_box_rises_stays_inside_and_is_what_was_let_in_less_what_expired() {
    let mut room = closed_box();
    let air = rows(&room, Phase::Gas).len();
    let (mut emitted, mut removed) = (0, 0);
    for frame in 1..=150 {
        let report = room.step_frame().unwrap();
        emitted += report.emitted;
        removed += report.removed;
        let smoke = rows(&room, Phase::Smoke);
        assert_eq!(smoke.len() as u64, emitted - removed, "frame {frame}");
        assert_eq!(rows(&room, Phase::Gas).len(), air, "the carrier stays as many");
        for x in room.positions() {
            assert!(x.x >= -1e-4 && x.y >= -1e-4 && x.x <= 1.2001 && x.y <= 1.6001, "{x} has left the box");
        }
    }
    let seconds = 150.0 / 60.0;
    assert_eq!(emitted as f64, RATE * seconds);
    assert!((removed as f64 - RATE * (seconds - LIFETIME)).abs() <= RATE / 30.0, "{removed} have expired");
    let smoke = rows(&room, Phase::Smoke);
    let height = smoke.iter().map(|&row| f64::from(room.positions()[row].y)).sum::<f64>() / smoke.len() as f64;
    println!("{} markers of {emitted}, mean height {height:.2} m", smoke.len());
    assert!(height > 0.45, "smoke let in at 0.3 m rises with warm gas: {height} m");
}

#[test]
fn smoke_in_a_closed_box_has_the_velocity_of_the_gas_around_it_to_round_off() {
    let mut room = closed_box();
    for _ in 0..60 {
        room.step_frame().unwrap();
    }
    let (air, smoke) = (rows(&room, Phase::Gas), rows(&room, Phase::Smoke));
    let fastest = room.diagnostics().speed_max;
    let error = |&row: &usize| {
        let expected = carried(&room, &air, room.positions()[row].as_dvec2());
        (room.velocities()[row].as_dvec2() - expected).length() / fastest
    };
    let worst = smoke.iter().map(error).fold(0.0, f64::max);
    println!("velocities of {} markers are off by {worst:.1e} of the fastest", smoke.len());
    assert!(smoke.len() > 200 && worst < 1e-5, "{worst}");
}
