//! A small scene of every kind that has a state of its own.

use super::scenes;
use unipbd_core::scene::{
    Block, BodyDescription, BodyKind, BodySolver, Copies, Domain, Heap, Held, JointDescription, JointRule, Link,
    Liquid, Rope, Scene, Side, Solid, SolverSettings, Tank, Tethers,
};

fn scene(text: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene { spacing: 0.1, tank: vec![Tank::new([0.0, 0.0], [3.0, 3.0])], ..Scene::default() };
    text(&mut scene);
    scene
}

/// Boxes, discs and a hinge; they come to rest.
fn heap() -> Scene {
    scene(|scene| {
        let step = [0.35, 0.35];
        let copies = Copies { columns: 3, rows: 3, step, heap: Heap::Brick };
        let boxes = BodyDescription::rectangle([0.3, 0.3], [0.5, 0.15]);
        scene.body.push(BodyDescription { name: "box".into(), copies: Some(copies), ..boxes });
        scene.body.push(BodyDescription { name: "wheel".into(), ..BodyDescription::disc(0.2, [2.0, 1.0]) });
        let wedge = BodyDescription::polygon(vec![[0.0, 0.0], [0.5, 0.0], [0.0, 0.3]], [2.3, 0.2]);
        scene.body.push(BodyDescription { name: "wedge".into(), kind: BodyKind::Static, ..wedge });
        let hinge = JointDescription::new(JointRule::Hinge, "wheel", [2.0, 1.0]);
        scene.joint.push(JointDescription { motor_speed_deg: Some(90.0), ..hinge });
    })
}

/// A rope with a body at its end, and a soft body.
fn tied() -> Scene {
    scene(|scene| {
        scene.solid.push(Solid { name: "hemp".into(), ..Solid::default() });
        scene.body.push(BodyDescription { name: "ball".into(), ..BodyDescription::disc(0.2, [1.5, 1.5]) });
        let soft = BodyDescription {
            solver: BodySolver::ShapeMatching,
            compliance: 1e-6,
            ..BodyDescription::disc(0.3, [0.6, 1.0])
        };
        scene.body.push(soft);
        scene.rope.push(Rope {
            material: "hemp".into(),
            from: [1.5, 2.8],
            to: [1.5, 1.7],
            length: None,
            compliance: 0.0,
            held: Held::default(),
            link: Link::default(),
            tethers: Tethers::default(),
            body: Some("ball".into()),
            from_body: None,
        });
    })
}

/// A pool that falls asleep.
fn pool() -> Scene {
    scene(|scene| {
        scene.solver = SolverSettings { sleep: true, ..SolverSettings::default() };
        scene.liquid.push(Liquid::new("water", 1000.0));
        scene.block.push(scenes::block("water", [0.0, 0.0], [3.0, 0.6]));
    })
}

/// A band of liquid that meets itself.
fn band() -> Scene {
    let domain = Domain { periodic_x: Some([0.0, 2.0]), ..Domain::default() };
    let tank = Tank { open: vec![Side::Left, Side::Right], ..Tank::new([0.0, 0.0], [2.0, 1.0]) };
    scene(|scene| {
        scene.domain = domain;
        scene.tank = vec![tank];
        scene.liquid.push(Liquid::new("water", 1000.0));
        scene.block.push(Block { velocity: [1.0, 0.0], ..scenes::block("water", [0.0, 0.0], [2.0, 0.5]) });
    })
}

pub fn all() -> Vec<Scene> {
    let known = scenes::all().map(|(_, scene)| scene);
    known.into_iter().chain([heap(), tied(), pool(), band()]).collect()
}
