//! Nothing passes through a wall.

use unipbd_core::math::wide;
use unipbd_core::scene::Scene;
use unipbd_core::{Phase, Solver};
use unipbd_tests::{build, run, scene, shipped};

/// Rounding of a position in single precision, in spacings.
const ROUNDING: f64 = 1e-4;

/// Fails where a particle is outside all tanks' walls or inside an obstacle.
#[track_caller]
fn assert_all_outside_walls(scene: &Scene, solver: &Solver) {
    let slack = ROUNDING * scene.spacing;
    for (row, position) in solver.positions().iter().enumerate() {
        let x = wide(*position);
        for tank in &scene.tank {
            let open = |side| tank.open.contains(&side);
            use unipbd_core::scene::Side::{Bottom, Left, Right, Top};
            let inside = (open(Left) || x.x >= tank.min[0] - slack)
                && (open(Right) || x.x <= tank.max[0] + slack)
                && (open(Bottom) || x.y >= tank.min[1] - slack)
                && (open(Top) || x.y <= tank.max[1] + slack);
            assert!(inside, "{:?} at {x} left the tank at {} s", solver.phases()[row], solver.time());
        }
        for obstacle in &scene.obstacle {
            let deep = (x.x - obstacle.min[0]).min(obstacle.max[0] - x.x);
            let deep = deep.min(x.y - obstacle.min[1]).min(obstacle.max[1] - x.y);
            assert!(deep <= slack, "{:?} at {x} is in an obstacle at {} s", solver.phases()[row], solver.time());
        }
        for plane in &scene.half_plane {
            let normal = unipbd_core::Vector64::from(plane.normal).normalize();
            let distance = (x - unipbd_core::Vector64::from(plane.point)).dot(normal);
            assert!(distance >= -slack, "{:?} at {x} is behind a wall at {} s", solver.phases()[row], solver.time());
        }
    }
}

#[track_caller]
fn assert_walls_hold(scene: &Scene, frames: u64) -> Solver {
    let mut solver = build(scene, 2);
    assert_all_outside_walls(scene, &solver);
    run(&mut solver, frames, |solver| assert_all_outside_walls(scene, solver));
    solver
}

#[test]
fn the_water_of_the_dam_break_stays_in_its_tank() {
    assert_walls_hold(&shipped("dam_break.toml").scene, 300);
}

/// Water thrown at 12 m/s at a slope, a thin box and a corner.
const THROWN: &str = r#"
spacing = 0.1
[[liquid]]
name = "water"
[[block]]
material = "water"
min = [-1.0, 1.0]
max = [1.0, 3.0]
velocity = [8.0, -9.0]
[[tank]]
min = [-4.0, -2.0]
max = [4.0, 6.0]
friction = 0.3
[[obstacle]]
min = [1.5, -1.0]
max = [2.5, -0.8]
[[half_plane]]
point = [-4.0, 0.0]
normal = [1.0, 2.0]
"#;

#[test]
fn thrown_water_passes_neither_slope_nor_corner_nor_thin_box() {
    assert_walls_hold(&scene(THROWN), 240);
}

/// A fast jet of gas with smoke against a plate in a box with an open top.
const JET_ON_PLATE: &str = r#"
spacing = 0.02
[[gas]]
name = "air"
drag = 20.0
lifetime = 2.0
[[smoke]]
name = "smoke"
lifetime = 2.0
[[emitter]]
material = "air"
position = [0.0, 0.1]
width = 0.2
speed = 3.0
temperature = 1.0
smoke = { material = "smoke", per_particle = 3 }
[[obstacle]]
min = [-0.3, 0.6]
max = [0.35, 0.65]
[[tank]]
min = [-0.5, 0.0]
max = [0.5, 1.5]
open = ["top"]
"#;

#[test]
fn neither_gas_nor_smoke_passes_a_plate() {
    let solver = assert_walls_hold(&scene(JET_ON_PLATE), 150);
    let smoke = solver.diagnostics().count(Phase::Smoke);
    let above = solver.positions().iter().filter(|x| x.y > 0.65).count();
    assert!(smoke > 500 && above > 100, "{smoke} markers, {above} particles have gone round the plate");
}
