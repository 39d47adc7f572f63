//! Gauges: readings with a known answer.

use unipbd_core::scene::{
    Block, BodyDescription, Domain, Emitter, ForcePart, Gauge, GaugeKind, HalfPlane, Liquid, PressureGridUse, Scene,
    Smoke, Tank,
};
use unipbd_core::{BuildOptions, Solver};

const GRAVITY: f64 = 9.81;
const SPACING: f64 = 0.05;

fn level(name: &str, x: f64) -> Gauge {
    Gauge { at: Some([x, 0.0]), ..Gauge::new(name, GaugeKind::Level) }
}

fn pressure(name: &str, at: [f64; 2]) -> Gauge {
    Gauge { at: Some(at), ..Gauge::new(name, GaugeKind::Pressure) }
}

/// Water 1 m deep, 1.6 m wide, between walls that are measured.
fn pool(gauge: Vec<Gauge>) -> Scene {
    Scene {
        spacing: SPACING,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [1.6, 1.0])],
        tank: vec![Tank { name: "tank".into(), ..Tank::new([0.0, 0.0], [1.6, 2.0]) }],
        gauge,
        ..Scene::default()
    }
}

fn build(scene: &Scene) -> Solver {
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Runs `frames` frames and returns the mean of each gauge over the last `last` of them.
fn means(solver: &mut Solver, frames: u32, last: u32) -> Vec<f64> {
    let mut sums = vec![0.0; solver.gauges().len()];
    for frame in 0..frames {
        solver.step_frame().expect("the scene is calm");
        if frame + last >= frames {
            sums.iter_mut().zip(solver.gauges()).for_each(|(sum, gauge)| *sum += gauge.value / f64::from(last));
        }
    }
    sums
}

#[test]
fn a_still_tank_reads_its_level_its_pressure_and_its_weight() {
    let force = |name: &str, of| Gauge {
        on: Some("tank bottom".into()),
        direction: Some([0.0, -2.0]),
        of,
        ..Gauge::new(name, GaugeKind::Force)
    };
    let aside = Gauge { direction: Some([-3.0, 0.0]), ..level("aside", 0.9) };
    let gauge = vec![
        level("middle", 0.83),
        level("at_the_wall", 0.0),
        Gauge { at: Some([0.9, 0.5]), ..aside },
        pressure("deep", [0.8, 0.3]),
        pressure("at_a_wall", [0.0, 0.5]),
        Gauge { radius: Some(0.3), ..pressure("wide", [0.8, 0.4]) },
        force("floor", ForcePart::All),
        force("floor_of_fluids", ForcePart::Fluids),
        force("floor_of_contacts", ForcePart::Contacts),
        Gauge { line: Some([[0.0, 0.5], [1.6, 0.5]]), ..Gauge::new("flow", GaugeKind::FlowRate) },
    ];
    // Without the grid the row at a wall reads 2 to 7 % high, by its arrangement.
    for (grid, beside) in [(PressureGridUse::On, 0.04), (PressureGridUse::Off, 0.1)] {
        let mut scene = pool(gauge.clone());
        scene.solver.pressure_grid = grid;
        let [middle, at_wall, aside, deep, wall, wide, floor, fluids, contacts, flow] =
            means(&mut build(&scene), 240, 60)[..]
        else {
            panic!("a reading for each gauge")
        };
        eprintln!("{grid:?}: levels {middle:.4} {at_wall:.4} {aside:.4}, flow {flow:.1e}");
        let over = |pressure: f64, depth: f64| pressure / (1000.0 * GRAVITY * depth) - 1.0;
        eprintln!("pressures {:.4} {:.4} {:.4}", over(deep, 0.7), over(wall, 0.5), over(wide, 0.6));
        eprintln!("floor {:.4}", floor / (1600.0 * GRAVITY) - 1.0);
        for (level, expected) in [(middle, 1.0), (at_wall, 1.0), (aside, 0.9)] {
            assert!((level - expected).abs() < 0.5 * SPACING, "{level} is not {expected}");
        }
        assert!(over(deep, 0.7).abs() < 0.02 && over(wide, 0.6).abs() < 0.02);
        assert!(over(wall, 0.5).abs() < beside);
        assert!((floor / (1600.0 * GRAVITY) - 1.0).abs() < 0.01);
        assert!((floor - fluids).abs() < 1e-9 * floor && contacts == 0.0);
        assert!(flow.abs() < 0.01, "{flow}");
    }
}

/// A jet 20 spacings wide that falls on a plate without gravity: all its momentum goes into the plate.
#[test]
fn with_the_grid_a_jet_presses_on_a_plate_with_its_momentum_and_its_dynamic_pressure() {
    let (width, speed) = (0.4, 3.0);
    let mut scene = Scene {
        spacing: 0.02,
        gravity: [0.0; 2],
        liquid: vec![Liquid::new("water", 1000.0)],
        emitter: vec![Emitter { direction: [0.0, -1.0], ..Emitter::new("water", [0.0, 1.2], width, speed) }],
        half_plane: vec![HalfPlane { name: "plate".into(), ..HalfPlane::new([0.0; 2], [0.0, 1.0]) }],
        domain: Domain { remove_below: Some([-2.0, -1.0]), remove_above: Some([2.0, 2.0]), ..Domain::default() },
        gauge: vec![
            pressure("middle", [0.0, 0.06]),
            Gauge { on: Some("plate".into()), ..Gauge::new("plate", GaugeKind::Force) },
        ],
        ..Scene::default()
    };
    scene.solver.pressure_grid = PressureGridUse::On;
    let [middle, force] = means(&mut build(&scene), 300, 120)[..] else { panic!("two gauges") };
    let (stagnation, momentum) = (middle / (500.0 * speed * speed), force / (1000.0 * width * speed * speed));
    eprintln!("stagnation pressure {stagnation:.4}, force {momentum:.4}");
    assert!((stagnation - 1.0).abs() < 0.05, "{stagnation}");
    assert!((momentum - 1.0).abs() < 0.03, "{momentum}");
}

/// The impulse on the wall is known from its force, which keeps the momentum.
#[test]
fn with_the_grid_the_pressures_beside_a_wall_that_a_broken_dam_hits_add_up_to_its_force() {
    let (spacing, wall) = (0.04, 3.2);
    let mut scene = Scene {
        spacing,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0; 2], [1.0, 2.0])],
        half_plane: vec![
            HalfPlane::new([0.0; 2], [0.0, 1.0]),
            HalfPlane::new([0.0; 2], [1.0, 0.0]),
            HalfPlane { name: "wall".into(), ..HalfPlane::new([wall, 0.0], [-1.0, 0.0]) },
        ],
        gauge: vec![Gauge { on: Some("wall".into()), ..Gauge::new("force", GaugeKind::Force) }],
        ..Scene::default()
    };
    scene.solver.pressure_grid = PressureGridUse::On;
    let mut solver = build(&scene);
    let (mut pressures, mut forces) = (0.0, 0.0);
    for _ in 0..150 {
        solver.step_frame().expect("it runs");
        let beside = solver.positions().iter().zip(solver.pressures());
        let beside = beside.filter(|(x, _)| f64::from(x.x) > wall - 2.0 * spacing);
        pressures += beside.map(|(_, pressure)| 1000.0 * f64::from(*pressure)).sum::<f64>() * 0.5 * spacing;
        forces += solver.gauges()[0].value;
    }
    let over = pressures / forces;
    eprintln!("pressures over the force {over:.4}");
    assert!((over - 1.0).abs() < 0.1, "{over}");
}

#[test]
fn a_stream_carries_its_width_times_its_speed_across_a_line() {
    let line = |name: &str, line| Gauge { line: Some(line), ..Gauge::new(name, GaugeKind::FlowRate) };
    let up = Emitter { direction: [1.0, 0.0], ..Emitter::new("water", [0.0, 0.5], 0.4, 2.0) };
    let scene = Scene {
        spacing: SPACING,
        gravity: [0.0; 2],
        liquid: vec![Liquid::new("water", 1000.0), Liquid::new("oil", 800.0)],
        emitter: vec![up],
        gauge: vec![
            line("ahead", [[0.7, 0.0], [0.7, 1.0]]),
            line("back", [[0.7, 1.0], [0.7, 0.0]]),
            line("slanted", [[0.5, 0.0], [1.0, 1.0]]),
            line("beside", [[0.7, 1.0], [0.7, 2.0]]),
            Gauge { material: Some("oil".into()), ..line("oil", [[0.7, 0.0], [0.7, 1.0]]) },
        ],
        ..Scene::default()
    };
    // The head of the stream breaks up; behind it the flow is steady.
    let [ahead, back, slanted, beside, oil] = means(&mut build(&scene), 120, 30)[..] else { panic!("five gauges") };
    eprintln!("{ahead:.4} {back:.4} {slanted:.4}");
    assert!((ahead / 0.8 - 1.0).abs() < 0.005, "{ahead}");
    assert!((ahead + back).abs() < 1e-9 * ahead);
    assert!((slanted / 0.8 - 1.0).abs() < 0.01, "{slanted}");
    assert_eq!([beside, oil].map(f64::to_bits), [0; 2], "nothing flows there");
}

#[test]
fn the_front_of_a_broken_dam_runs_and_its_level_falls() {
    let front = Gauge { direction: Some([1.0, 0.0]), ..Gauge::new("front", GaugeKind::Front) };
    let from_wall = Gauge { at: Some([4.0, 0.0]), direction: Some([-1.0, 0.0]), ..front.clone() };
    let mut scene =
        pool(vec![front, Gauge { name: "to_wall".into(), ..from_wall }, level("behind", 0.1), level("dry", 3.0)]);
    scene.block[0].max = [0.8, 1.0];
    scene.tank[0].max = [4.0, 2.0];
    let mut solver = build(&scene);
    let read = |solver: &Solver| solver.gauges().iter().map(|gauge| gauge.value).collect::<Vec<f64>>();
    let start = read(&solver);
    assert!((start[0] - 0.8).abs() < 0.5 * SPACING && start[3].is_nan(), "{start:?}");
    // Seen from the other wall, the farthest water is that at the left end.
    assert!((start[1] - 4.0).abs() < 0.5 * SPACING, "{start:?}");
    let mut last = start[0];
    for _ in 0..5 {
        means(&mut solver, 6, 1);
        let now = read(&solver);
        assert!(now[0] > last + 0.01, "{now:?}");
        last = now[0];
    }
    // The front of a collapsing column runs at about 2 sqrt(g h) when it is free: 6 m/s at most.
    assert!(last > 1.3 && last < 0.8 + 0.5 * 6.3, "{last}");
    assert!(read(&solver)[2] < start[2] - SPACING);
}

#[test]
fn what_has_nothing_to_read_says_so() {
    let bottom = Gauge { on: Some("tank bottom".into()), ..Gauge::new("floor", GaugeKind::Force) };
    let gauge = vec![bottom, pressure("above", [0.8, 1.5]), pressure("in_water", [0.8, 0.5]), level("outside", 2.5)];
    let scene = pool(gauge);
    let mut solver = build(&scene);
    assert!(solver.gauges().iter().all(|gauge| gauge.value.is_nan()), "no frame was run: {:?}", solver.gauges());
    solver.step_frame().expect("it runs");
    let known = |solver: &Solver| solver.gauges().iter().map(|gauge| !gauge.value.is_nan()).collect::<Vec<bool>>();
    assert_eq!(known(&solver), [true, false, true, false]);
    let state = solver.save();
    solver.restore(&state).expect("it is a state of this run");
    assert_eq!(known(&solver), [false, false, true, false], "a state holds no forces on walls");
}

#[test]
fn a_lone_drop_is_no_surface_and_no_front() {
    let front = Gauge { direction: Some([1.0, 0.0]), ..Gauge::new("front", GaugeKind::Front) };
    let mut scene = pool(vec![level("level", 0.8), front]);
    scene.gravity = [0.0; 2];
    scene.tank[0].max = [4.0, 4.0];
    let drop = |min: [f64; 2]| Block::new("water", min, min.map(|corner| corner + SPACING));
    scene.block.extend([drop([0.8, 3.0]), drop([3.0, 0.5])]);
    let read = build(&scene).gauges();
    assert!((read[0].value - 1.0).abs() < 0.5 * SPACING && (read[1].value - 1.6).abs() < 0.5 * SPACING, "{read:?}");
}

#[test]
fn gauges_change_no_bit_of_a_run() {
    let gauge = vec![
        level("level", 0.3),
        pressure("pressure", [0.5, 0.4]),
        Gauge { direction: Some([1.0, 0.0]), ..Gauge::new("front", GaugeKind::Front) },
        Gauge { line: Some([[0.0, 0.5], [1.0, 0.5]]), ..Gauge::new("flow", GaugeKind::FlowRate) },
        Gauge { on: Some("float".into()), ..Gauge::new("force", GaugeKind::Force) },
    ];
    let mut scene = pool(gauge);
    scene.block[0].max = [0.8, 1.0];
    scene.body.push(BodyDescription { name: "float".into(), ..BodyDescription::rectangle([0.2, 0.2], [1.2, 0.2]) });
    let without = Scene { gauge: Vec::new(), ..scene.clone() };
    let (mut with, mut plain) = (build(&scene), build(&without));
    for _ in 0..20 {
        with.step_frame().expect("it runs");
        with.gauges();
        plain.step_frame().expect("it runs");
    }
    assert_eq!(with.state_hash(), plain.state_hash());
    assert!(plain.gauges().is_empty() && plain.diagnostics().gauges.is_empty());
    let mut other = build(&scene);
    other.set_threads(3);
    other.restore(&with.save()).expect("it is a state of the scene");
    other.step_frame().and_then(|_| with.step_frame()).expect("both run");
    assert_eq!(other.gauges(), with.gauges());
}

#[test]
fn the_force_on_a_body_at_rest_is_its_weight() {
    let weight = |name: &str, of| Gauge {
        on: Some("box".into()),
        direction: Some([0.0, 1.0]),
        of,
        ..Gauge::new(name, GaugeKind::Force)
    };
    let scene = Scene {
        spacing: SPACING,
        half_plane: vec![HalfPlane { name: "ground".into(), ..HalfPlane::new([0.0, 0.0], [0.0, 1.0]) }],
        body: vec![BodyDescription { name: "box".into(), ..BodyDescription::rectangle([0.4, 0.4], [0.0, 0.2]) }],
        gauge: vec![
            weight("held", ForcePart::All),
            weight("by_contacts", ForcePart::Contacts),
            weight("by_fluids", ForcePart::Fluids),
            Gauge { on: Some("ground".into()), ..Gauge::new("ground", GaugeKind::Force) },
        ],
        ..Scene::default()
    };
    let expected = 1000.0 * 0.16 * GRAVITY;
    let [held, contacts, fluids, ground] = means(&mut build(&scene), 30, 10)[..] else { panic!("four gauges") };
    for force in [held, contacts, ground] {
        assert!((force / expected - 1.0).abs() < 1e-3, "{force} of {expected}");
    }
    assert_eq!(fluids, 0.0);
}

#[test]
fn faulty_gauges_are_named_with_what_to_do() {
    let mut scene = pool(vec![
        level("a", 0.0),
        level("a", 0.1),
        level("two words", 0.1),
        Gauge::new("no_place", GaugeKind::Pressure),
        Gauge { radius: Some(0.1), ..level("wrong_key", 0.0) },
        Gauge { on: Some("tank botom".into()), ..Gauge::new("nobody", GaugeKind::Force) },
        Gauge { line: Some([[1.0, 1.0]; 2]), ..Gauge::new("short", GaugeKind::FlowRate) },
        Gauge { direction: Some([0.0; 2]), ..Gauge::new("nowhere", GaugeKind::Front) },
        Gauge { material: Some("soot".into()), ..level("smoky", 0.0) },
        Gauge { radius: Some(-1.0), ..pressure("inside_out", [0.0; 2]) },
    ]);
    scene.smoke.push(Smoke { name: "soot".into(), ..Smoke::default() });
    let problems = scene.validate().to_string();
    for expected in [
        "gauge[1].name: the name \"a\" is taken by gauge[0]",
        "gauge[2].name: \"two words\" is no name of a gauge (letters, digits and _",
        "gauge[3]: a gauge of kind \"pressure\" needs `at` (such as at = [0.5, 0.0])",
        "gauge[4].radius: a gauge of kind \"level\" has no `radius` (leave it out: it is of pressure)",
        "gauge[5].on: there is no wall or body \"tank botom\" (did you mean \"tank bottom\"?)",
        "gauge[6].line: the line has no length",
        "gauge[7].direction: must not be the zero vector",
        "gauge[8].material: \"soot\" is a smoke, not",
        "gauge[9].radius: must be greater than 0, found -1",
    ] {
        assert!(problems.contains(expected), "{expected}\nis not in\n{problems}");
    }
    assert_eq!(problems.lines().count(), 9, "{problems}");
}
