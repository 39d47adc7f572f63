//! Bodies and scenes that move by samples.

use unipbd_core::scene::{
    AccelerationTable, Block, BodyDescription, BodyKind, Gauge, GaugeKind, Liquid, MotionDescription, MotionTable,
    Scene, Tank,
};
use unipbd_core::{BuildOptions, Solver};

fn build(scene: &Scene) -> Solver {
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A plate that moves by these samples.
fn plate(table: MotionTable) -> Scene {
    let body = BodyDescription {
        name: "plate".into(),
        kind: BodyKind::Kinematic,
        motion: Some(MotionDescription { table: Some(table), ..MotionDescription::default() }),
        ..BodyDescription::rectangle([0.5, 0.1], [1.0, 2.0])
    };
    Scene { body: vec![body], fps: 60.0, ..Scene::default() }
}

/// Samples at the times of frames, of a motion that starts and ends at rest.
fn table(count: u32) -> MotionTable {
    let time: Vec<f64> = (0..=count).map(|k| f64::from(6 * k) / 60.0).collect();
    let bump = |t: &f64| 0.3 * t * t * (3.0 - t) * (3.0 - t);
    MotionTable {
        x: time.iter().map(bump).collect(),
        y: time.iter().map(|t| -0.5 * bump(t)).collect(),
        angle_deg: time.iter().map(|t| 40.0 * bump(t)).collect(),
        time,
    }
}

#[test]
fn a_body_is_where_its_table_says_at_each_sample_with_the_velocity_of_the_motion() {
    let samples = table(30);
    let mut solver = build(&plate(samples.clone()));
    for frame in 0..190 {
        let body = &solver.bodies()[0];
        let time = solver.time();
        if frame % 6 == 0 && frame / 6 < 31 {
            let k = frame / 6;
            let off = [
                body.position.x - (1.0 + samples.x[k]),
                body.position.y - (2.0 + samples.y[k]),
                body.angle - samples.angle_deg[k].to_radians(),
            ];
            assert!(off.iter().all(|off| off.abs() < 1e-12), "{off:?} at {time}");
        }
        // d/dt of the bump; the curve through samples 0.1 s apart has it to their square.
        let rate = if time < 3.0 { 0.3 * 2.0 * time * (3.0 - time) * (3.0 - 2.0 * time) } else { 0.0 };
        let off = body.velocity.x - rate;
        assert!(off.abs() < 0.06 && (body.velocity.y + 0.5 * body.velocity.x).abs() < 1e-9, "{off} at {time}");
        solver.step_frame().expect("it runs");
    }
    assert_eq!(solver.bodies()[0].velocity.length(), 0.0, "it rests behind the last sample");
}

/// Water 0.5 m deep in a tank 2 m wide whose walls move, or whose world does.
fn tank(moving: bool) -> Scene {
    let spacing = 0.05;
    // Twice the first sloshing period is 3.7 s: a push over one second excites it.
    let time: Vec<f64> = (0..=40).map(|k| 0.05 * f64::from(k)).collect();
    let (reach, span) = (0.15, 1.0);
    // x = reach (10 s^3 - 15 s^4 + 6 s^5), s = t/span: smooth to its acceleration.
    let part = |t: &f64| (t / span).min(1.0);
    let x: Vec<f64> = time.iter().map(part).map(|s| reach * s * s * s * (10.0 + s * (6.0 * s - 15.0))).collect();
    let ax: Vec<f64> =
        time.iter().map(part).map(|s| -reach / (span * span) * s * (60.0 + s * (120.0 * s - 180.0))).collect();
    let level = |name: &str, x: f64| Gauge { at: Some([x, 0.0]), ..Gauge::new(name, GaugeKind::Level) };
    let mut scene = Scene {
        spacing,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [2.0, 0.5])],
        gauge: vec![level("left", 0.05), level("right", 1.95), level("moved_left", 0.2), level("moved_right", 2.1)],
        ..Scene::default()
    };
    if !moving {
        scene.shaking.table = Some(AccelerationTable { time, ax, ay: Vec::new() });
        scene.tank = vec![Tank::new([0.0, 0.0], [2.0, 1.5])];
        return scene;
    }
    scene.tank = vec![Tank::new([-1.0, 0.0], [3.5, 1.5])];
    let moved = MotionTable { time, x, ..MotionTable::default() };
    let wall = |name: &str, x: f64| BodyDescription {
        name: name.into(),
        kind: BodyKind::Kinematic,
        motion: Some(MotionDescription { table: Some(moved.clone()), ..MotionDescription::default() }),
        ..BodyDescription::rectangle([0.4, 1.4], [x, 0.7])
    };
    scene.body = vec![wall("left wall", -0.2), wall("right wall", 2.2)];
    scene
}

#[test]
fn a_tank_that_is_shaken_sloshes_as_one_whose_walls_move() {
    let (mut shaken, mut moved) = (build(&tank(false)), build(&tank(true)));
    let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
    for frame in 0..150 {
        shaken.step_frame().and_then(|_| moved.step_frame()).expect("both run");
        if frame < 66 {
            continue;
        }
        // The walls stand 0.15 m to the right now.
        let (here, there) = (shaken.gauges(), moved.gauges());
        for (a, b) in [(here[0].value, there[2].value), (here[1].value, there[3].value)] {
            largest = largest.max((a - 0.5).abs());
            worst = worst.max((a - b).abs());
        }
    }
    eprintln!("largest {largest:.4}, apart {worst:.4}");
    assert!(largest > 0.04, "the water sloshes: {largest}");
    assert!(worst < 0.5 * largest, "{worst} of {largest}");
}

#[test]
fn a_shaken_run_goes_on_bit_for_bit_after_a_restore_and_keeps_its_gravity() {
    let scene = tank(false);
    let (mut whole, mut half) = (build(&scene), build(&scene));
    for _ in 0..10 {
        whole.step_frame().and_then(|_| half.step_frame()).expect("both run");
    }
    let state = half.save();
    let mut other = build(&scene);
    other.restore(&state).expect("it is a state of the scene");
    assert_eq!(other.diagnostics().potential_energy, half.diagnostics().potential_energy);
    for _ in 0..10 {
        whole.step_frame().and_then(|_| other.step_frame()).expect("both run");
    }
    assert_eq!(whole.state_hash(), other.state_hash());
    assert_eq!((whole.gravity().x, whole.gravity().y), (0.0, -9.81));
}

#[test]
fn a_body_goes_on_bit_for_bit_after_a_restore() {
    let scene = plate(table(30));
    let (mut whole, mut other) = (build(&scene), build(&scene));
    for _ in 0..50 {
        whole.step_frame().expect("it runs");
    }
    other.restore(&whole.save()).expect("it is a state of the scene");
    for _ in 0..20 {
        whole.step_frame().and_then(|_| other.step_frame()).expect("both run");
    }
    assert_eq!(whole.state_hash(), other.state_hash());
}

#[test]
fn a_box_that_sleeps_wakes_when_the_ground_shakes() {
    let mut scene = Scene {
        spacing: 0.05,
        tank: vec![Tank { friction: Some(0.2), ..Tank::new([-5.0, 0.0], [5.0, 3.0]) }],
        body: vec![BodyDescription { friction: 0.2, ..BodyDescription::rectangle([0.4, 0.4], [0.0, 0.2]) }],
        ..Scene::default()
    };
    // Still for two seconds; then ten times what friction holds.
    let (time, ax) = (vec![0.0, 2.0, 2.5, 4.0], vec![0.0, 0.0, 20.0, 20.0]);
    scene.shaking.table = Some(AccelerationTable { time, ax, ay: Vec::new() });
    let mut solver = build(&scene);
    for _ in 0..115 {
        solver.step_frame().expect("it runs");
    }
    assert!(solver.bodies()[0].asleep && solver.bodies()[0].position.x.abs() < 1e-3);
    for _ in 0..25 {
        solver.step_frame().expect("it runs");
    }
    assert!(!solver.bodies()[0].asleep && solver.bodies()[0].position.x > 0.1, "{:?}", solver.bodies()[0].position);
}

#[test]
fn faulty_tables_are_named_with_what_to_do() {
    let mut scene = plate(MotionTable { time: vec![0.0, 1.0, 1.0], x: vec![0.0, 1.0], ..MotionTable::default() });
    let motion = scene.body[0].motion.as_mut().expect("it has one");
    motion.velocity = [1.0, 0.0];
    scene.shaking.table = Some(AccelerationTable { time: vec![0.0, 1.0], ..AccelerationTable::default() });
    scene.shaking.file = "shake.csv".into();
    scene.body.push(plate(MotionTable { time: vec![0.0], x: vec![0.0], ..MotionTable::default() }).body.remove(0));
    scene.body[1].name = "other".into();
    scene.body[1].position = [5.0, 5.0];
    let problems = scene.validate().to_string();
    for expected in [
        "shaking.file: there are no files here, \"shake.csv\" cannot be read (give the samples themselves as `table`)",
        "shaking.table: has nothing besides times (add one or more of ax, ay)",
        "body[0].motion: a script is one kind of motion, found velocity or spin_deg and a table",
        "body[0].motion.table.time[2]: must increase, found 1 after 1 (sort the samples by time)",
        "body[0].motion.table.x: has 2 values for 3 times",
        "body[1].motion.table.time: needs 2 to 100000 samples, found 1",
    ] {
        assert!(problems.contains(expected), "{expected}\nis not in\n{problems}");
    }
    assert_eq!(problems.lines().count(), 6, "{problems}");
}
