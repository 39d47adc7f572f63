//! Stresses with a name.

use unipbd_core::scene::{Block, Liquid, Scene, SolverSettings, Substeps, Tank};
use unipbd_core::{BuildOptions, Edit, Vector64};

use super::{Ending, endure};
use crate::scenes::{body, nozzle};

/// A stress with a name.
pub struct Stress {
    /// Short description of the test.
    pub name: &'static str,
    /// Runs it.
    pub run: fn() -> Ending,
}

/// All of them; each takes well below a second on a free core.
pub const NAMED: &[Stress] = &[
    Stress { name: "frames of 1/240 s", run: || frame_time(240.0) },
    Stress { name: "frames of 1/30 s", run: || frame_time(30.0) },
    Stress { name: "frames of 1/10 s", run: || frame_time(10.0) },
    Stress { name: "one substep per frame", run: || forced(1) },
    Stress { name: "two substeps per frame", run: || forced(2) },
    Stress { name: "density ratio 10, heavy on top", run: || ratio(10.0) },
    Stress { name: "density ratio 100, heavy on top", run: || ratio(100.0) },
    Stress { name: "density ratio 1000, heavy on top", run: || ratio(1000.0) },
    Stress { name: "speed of 1000 dx per frame", run: fast },
    Stress { name: "one particle", run: single },
    Stress { name: "coincident particles", run: coincident },
    Stress { name: "jitter of half a spacing", run: jitter },
    Stress { name: "emitter into a full box", run: emitter },
    Stress { name: "offset of 1e5 dx", run: || offset(1e5) },
    Stress { name: "offset of 1e6 dx", run: || offset(1e6) },
    Stress { name: "mass ratio 1e4 between bodies", run: mass_ratio },
    Stress { name: "body crushed between kinematic walls", run: crushed },
    Stress { name: "not-a-number through the edits", run: not_a_number },
];

const SPACING: f64 = 0.1;

/// A closed tank of 16 x 16 spacings at `corner`.
fn tank(corner: f64) -> Tank {
    Tank { open: Vec::new(), ..Tank::new([corner, 0.0], [corner + 1.6, 1.6]) }
}

/// Water in half of that tank.
fn half_full(substeps: Substeps) -> Scene {
    Scene {
        spacing: SPACING,
        solver: SolverSettings { substeps, ..SolverSettings::default() },
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [0.8, 1.6])],
        tank: vec![tank(0.0)],
        ..Scene::default()
    }
}

/// Three times the speed of a fall through the tank.
const FALL: f64 = 3.0 * 5.6;

fn frame_time(fps: f64) -> Ending {
    endure(&Scene { fps, ..half_full(Substeps::Auto) }, (1.5 * fps) as u32, FALL)
}

fn forced(substeps: u32) -> Ending {
    endure(&half_full(Substeps::Fixed(substeps)), 90, 4.0 * FALL)
}

fn ratio(ratio: f64) -> Ending {
    let scene = Scene {
        liquid: vec![Liquid::new("light", 1.0), Liquid::new("heavy", ratio)],
        block: vec![Block::new("light", [0.0, 0.0], [1.6, 0.5]), Block::new("heavy", [0.0, 0.5], [1.6, 1.0])],
        ..half_full(Substeps::Auto)
    };
    endure(&scene, 30, 4.0 * FALL)
}

fn fast() -> Ending {
    let mut scene = half_full(Substeps::Auto);
    let speed = 1000.0 * SPACING * 60.0;
    scene.block[0].velocity = [speed, 0.0];
    scene.solver.max_substeps = 64;
    endure(&scene, 10, 2.0 * speed)
}

fn single() -> Ending {
    let mut scene = half_full(Substeps::Auto);
    scene.block[0] = Block::new("water", [0.3, 1.0], [0.4, 1.1]);
    endure(&scene, 90, FALL)
}

fn jitter() -> Ending {
    let mut scene = half_full(Substeps::Auto);
    scene.block[0].jitter = 0.5;
    endure(&scene, 90, 2.0 * FALL)
}

fn emitter() -> Ending {
    let mut scene = half_full(Substeps::Auto);
    scene.block[0] = Block::new("water", [0.0, 0.0], [1.6, 1.2]);
    scene.emitter.push(nozzle("water", [0.8, 0.6], 0.4, 1.0));
    scene.solver.max_substeps = 32;
    endure(&scene, 120, 6.0 * FALL)
}

fn offset(spacings: f64) -> Ending {
    let mut scene = half_full(Substeps::Fixed(4));
    let shift = spacings * SPACING;
    scene.tank = vec![tank(shift)];
    scene.block[0] = Block::new("water", [shift, 0.0], [shift + 0.8, 1.6]);
    endure(&scene, 60, 2.0 * FALL)
}

fn mass_ratio() -> Ending {
    let mut scene = Scene { spacing: SPACING, ..Scene::default() };
    scene.tank = vec![tank(0.0)];
    for (index, mass) in [1e-2, 1e2].into_iter().enumerate() {
        let mut one = body(&format!("box {index}"), [0.8, 0.2 + 0.4 * index as f64]);
        (one.size, one.mass) = (Some([0.4, 0.3]), Some(mass));
        scene.body.push(one);
    }
    endure(&scene, 120, FALL)
}

fn crushed() -> Ending {
    use unipbd_core::rigid::BodyKind;
    use unipbd_core::scene::MotionDescription;
    let mut scene = half_full(Substeps::Fixed(8));
    scene.block[0] = Block::new("water", [0.0, 0.0], [1.6, 0.3]);
    let mut victim = body("victim", [0.8, 0.6]);
    victim.size = Some([0.4, 0.4]);
    scene.body.push(victim);
    for (name, x, speed) in [("left", 0.2, 0.2), ("right", 1.4, -0.2)] {
        let mut press = body(name, [x, 0.8]);
        press.kind = BodyKind::Kinematic;
        press.size = Some([0.2, 1.4]);
        press.motion = Some(MotionDescription { velocity: [speed, 0.0], ..MotionDescription::default() });
        scene.body.push(press);
    }
    endure(&scene, 150, 6.0 * FALL)
}

fn coincident() -> Ending {
    let scene = half_full(Substeps::Auto);
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    let Ok(mut solver) = scene.build(options) else { return Ending::Refused };
    let ids: Vec<u32> = solver.ids()[..8].to_vec();
    let edit = Edit::new().set_positions(ids, vec![Vector64::new(0.4, 0.4); 8]);
    if solver.apply(&edit).is_err() {
        return Ending::Refused;
    }
    for _ in 0..60 {
        if let Err(error) = solver.step_frame() {
            return Ending::Stopped(error.to_string());
        }
        if let Some(broken) = super::unsound(&solver, &scene) {
            return Ending::Broken(broken);
        }
    }
    let speed = solver.diagnostics().speed_max;
    if speed > FALL { Ending::Broken(format!("ends at {speed} m/s")) } else { Ending::Sound { speed } }
}

fn not_a_number() -> Ending {
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    let Ok(mut solver) = half_full(Substeps::Auto).build(options) else { return Ending::Refused };
    let id = solver.ids()[3];
    for value in [f64::NAN, f64::INFINITY] {
        let bad = Vector64::new(value, 0.0);
        let edits = [Edit::new().set_positions([id], [bad]), Edit::new().set_velocities([id], [bad])];
        if edits.iter().any(|edit| solver.apply(edit).is_ok()) {
            return Ending::Broken(format!("an edit with {value} was taken"));
        }
    }
    match solver.step_frame() {
        Ok(_) => super::unsound(&solver, &half_full(Substeps::Auto)).map_or(Ending::Refused, Ending::Broken),
        Err(error) => Ending::Broken(error.to_string()),
    }
}
