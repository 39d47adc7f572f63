//! The forces of fluids on walls and on bodies that do not move.

use unipbd_core::{Solver, Vector64};

use crate::support::{run_until, solver};

/// Mean forces on walls over a second, by name.
fn mean_forces(solver: &mut Solver) -> Vec<(String, Vector64)> {
    let mut sums: Vec<(String, Vector64)> =
        solver.wall_forces().into_iter().map(|wall| (wall.name, Vector64::ZERO)).collect();
    for _ in 0..60 {
        solver.step_frame().unwrap();
        for ((_, sum), wall) in sums.iter_mut().zip(solver.wall_forces()) {
            *sum += wall.force / 60.0;
        }
    }
    sums
}

#[test]
fn the_floor_of_a_still_tank_carries_the_water_and_the_sides_its_pressure() {
    let mut tank = solver(
        r#"
        spacing = 0.05
        [solver]
        substeps = 16
        [[liquid]]
        name = "water"
        xsph = 0.05
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [2.0, 1.5]
        [[tank]]
        name = "tank"
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        open = ["top"]
        "#,
    );
    run_until(&mut tank, 3.0);
    let forces = mean_forces(&mut tank);
    let force = |name: &str| forces.iter().find(|(wall, _)| wall == name).unwrap().1;
    let (weight, side) = (1000.0 * 9.81 * 2.0 * 1.5, 1000.0 * 9.81 * 1.5 * 1.5 / 2.0);
    println!("floor {:.4} of the weight", -force("tank bottom").y / weight);
    println!("sides {:.4} {:.4}", -force("tank left").x / side, force("tank right").x / side);
    assert!((-force("tank bottom").y / weight - 1.0).abs() < 0.02, "{}", force("tank bottom"));
    assert!((-force("tank left").x / side - 1.0).abs() < 0.02, "{}", force("tank left"));
    assert!((force("tank right").x / side - 1.0).abs() < 0.02, "{}", force("tank right"));
    assert_eq!(tank.diagnostics().walls, tank.wall_forces());
}

#[test]
fn water_over_a_static_body_and_an_obstacle_weighs_on_each_what_it_displaces_and_carries() {
    let mut tank = solver(
        r#"
        spacing = 0.05
        [solver]
        substeps = 16
        [[liquid]]
        name = "water"
        xsph = 0.05
        [[block]]
        material = "water"
        min = [0.0, 0.4]
        max = [1.0, 1.4]
        [[block]]
        material = "water"
        min = [1.0, 0.0]
        max = [3.0, 1.4]
        [[obstacle]]
        name = "step"
        min = [-1.0, -1.0]
        max = [1.0, 0.4]
        [[half_plane]]
        name = "left"
        point = [0.0, 0.0]
        normal = [1.0, 0.0]
        [[half_plane]]
        point = [3.0, 0.0]
        normal = [-1.0, 0.0]
        [[half_plane]]
        name = "floor"
        point = [0.0, 0.0]
        normal = [0.0, 1.0]
        [[body]]
        name = "box"
        kind = "static"
        size = [0.4, 0.4]
        position = [2.0, 0.8]
        "#,
    );
    run_until(&mut tank, 3.0);
    let mut lift = 0.0;
    for _ in 0..60 {
        tank.step_frame().unwrap();
        lift += tank.bodies()[0].fluid_force.y / 60.0;
    }
    let forces = mean_forces(&mut tank);
    assert_eq!(forces.len(), 3, "the wall without a name is not measured");
    let buoyancy = 1000.0 * 9.81 * 0.4 * 0.4;
    println!("lift of the box {:.4} of its displacement", lift / buoyancy);
    assert!((lift / buoyancy - 1.0).abs() < 0.06, "{lift} N instead of {buoyancy} N");
    let step = forces[2].1;
    // What the body displaces raises the level; the step carries the water above it, on its top alone.
    let level = 1.4 - 0.4 * 0.4 * 0.0;
    let over = 1000.0 * 9.81 * (level - 0.4);
    println!("force on the step {step}, water over it {over:.0} N");
    assert!((-step.y / over - 1.0).abs() < 0.06, "{step} instead of {over} N");
    assert!(step.x < 0.0, "water on its right pushes it to the left");
}

#[test]
fn a_scene_without_named_walls_measures_nothing_and_does_not_change() {
    let scene = |name: &str| {
        solver(&format!(
            r#"
            spacing = 0.1
            [[liquid]]
            name = "water"
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [1.0, 1.5]
            [[tank]]
            {name}
            min = [0.0, 0.0]
            max = [2.0, 2.0]
            "#
        ))
    };
    let (mut plain, mut measured) = (scene(""), scene("name = \"tank\""));
    run_until(&mut plain, 0.5);
    run_until(&mut measured, 0.5);
    assert!(plain.wall_forces().is_empty());
    assert_eq!(plain.positions(), measured.positions());
}
