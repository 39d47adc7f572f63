//! A scene runs the stages it needs and no other.

use unipbd_core::Stage::{
    self, AddGridPressure, AdvectSmoke, BeginGroups, Contacts, ContactsAgain, Effects, Emit, FindNeighbors,
    FinishBodies, FinishGroups, KeepOutOfWalls, MoveBodies, PlaceSamples, Predict, PressureGrid, Project,
    RefreshNeighbors, SettleSamples, StoreDensity, UpdateVelocities,
};
use unipbd_core::constraints::{Needs, Substep};
use unipbd_core::effects::{Changes, Effect};
use unipbd_core::math::{Vector, Vector64};
use unipbd_tests::{Prescribed, build, run, scene, shipped};

#[track_caller]
fn assert_stages(text: &str, stages: &[Stage]) {
    let mut solver = build(&scene(text), 1);
    assert_eq!(solver.stages(), stages);
    run(&mut solver, 1, |_| ());
    let timed: Vec<&str> = solver.timings().iter().map(|(name, _)| *name).collect();
    let ends = if stages.contains(&Contacts) { &[FinishBodies][..] } else { &[] };
    let expected: Vec<&str> = stages.iter().chain(ends).map(|stage| stage.name()).collect();
    assert_eq!(timed, expected, "every stage is timed under its own name");
}

const WATER: &str = r#"
[solver]
pressure_grid = "off"
[[liquid]]
name = "water"
[[block]]
material = "water"
min = [0.0, 0.0]
max = [1.0, 1.0]
"#;

const GRAINS: &str = r#"
[[solid]]
name = "grain"
[[points]]
material = "grain"
positions = [[0.0, 1.0], [0.5, 1.0], [1.0, 1.5]]
"#;

const BALL: &str = r#"
[[body]]
radius = 0.3
position = [0.5, 2.0]
"#;

#[test]
fn free_flight_has_two_stages() {
    assert_stages(GRAINS, &[Predict, UpdateVelocities]);
}

#[test]
fn grains_between_walls_are_projected_without_neighbours() {
    let walled = format!("{GRAINS}[[half_plane]]\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n");
    assert_stages(&walled, &[Predict, KeepOutOfWalls, UpdateVelocities]);
}

#[test]
fn the_pressure_grid_goes_before_the_particles() {
    let water = WATER.replace("off", "on");
    let before = [Predict, PressureGrid, FindNeighbors, BeginGroups, Project, StoreDensity, AddGridPressure];
    assert_stages(&water, &[&before[..], &[UpdateVelocities]].concat());
}

#[test]
fn water_has_neighbours_and_one_projection() {
    assert_stages(WATER, &[Predict, FindNeighbors, BeginGroups, Project, StoreDensity, UpdateVelocities]);
}

#[test]
fn viscous_water_adds_the_effects() {
    let viscous = WATER.replace("name = \"water\"\n[[block", "name = \"water\"\nxsph = 0.1\n[[block");
    assert_stages(
        &viscous,
        &[Predict, FindNeighbors, BeginGroups, Project, StoreDensity, UpdateVelocities, RefreshNeighbors, Effects],
    );
}

#[test]
fn bodies_alone_need_no_neighbours_and_no_density() {
    assert_stages(BALL, &[Predict, Contacts, ContactsAgain, UpdateVelocities, MoveBodies]);
}

#[test]
fn bodies_in_water_are_solved_before_and_after_the_fluid() {
    let all = [
        Predict,
        Contacts,
        PlaceSamples,
        FindNeighbors,
        BeginGroups,
        Project,
        StoreDensity,
        ContactsAgain,
        UpdateVelocities,
        MoveBodies,
        SettleSamples,
    ];
    assert_stages(&format!("{WATER}{BALL}"), &all);
}

#[test]
fn the_shipped_plume_emits_and_advects() {
    let stages = [
        Emit,
        Predict,
        FindNeighbors,
        BeginGroups,
        Project,
        StoreDensity,
        UpdateVelocities,
        RefreshNeighbors,
        Effects,
        AdvectSmoke,
    ];
    assert_eq!(build(&shipped("open_gas.toml").scene, 1).stages(), stages);
}

#[test]
fn still_gas_in_a_box_has_no_effects() {
    let gas = WATER.replace("liquid", "gas");
    assert_stages(&gas, &[Predict, FindNeighbors, BeginGroups, Project, StoreDensity, UpdateVelocities]);
}

#[test]
fn a_group_that_asks_for_a_velocity_pass_gets_its_stage() {
    let mut solver = build(&scene(WATER), 1);
    solver.add_group(Box::new(Prescribed(|_: Vector64| Vector64::ZERO)));
    let stages = [Predict, FindNeighbors, BeginGroups, Project, StoreDensity, UpdateVelocities, FinishGroups];
    assert_eq!(solver.stages(), stages);
}

/// Adds the same velocity to every listed row in each substep.
struct Push(Vector);

impl Effect for Push {
    fn name(&self) -> &'static str {
        "push"
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn apply(&mut self, _now: Substep<'_>, out: &mut Changes) {
        out.velocity.iter_mut().for_each(|change| *change += self.0);
    }
}

#[test]
fn an_effect_from_outside_gets_its_stage_and_acts() {
    let free = WATER.replacen("[solver]", "gravity = [0.0, 0.0]\n[solver]\nsubsteps = 4", 1);
    let mut solver = build(&scene(&free), 1);
    let id = solver.ids()[0];
    solver.add_effect(Box::new(Push(Vector::new(0.25, 0.0))));
    assert!(solver.stages().contains(&Effects) && solver.stages().contains(&RefreshNeighbors));
    run(&mut solver, 1, |_| ());
    let row = solver.row_of(id).expect("the particle is still there");
    assert_eq!(solver.ids()[row], id);
    assert!(solver.row_of(u32::MAX).is_none());
    let speed = solver.velocities()[row].x;
    assert!((speed - 1.0).abs() < 1e-3, "four substeps of a quarter, but {speed}");
}
