//! Bodies whose shape is matched: particles drawn back to a shape, stiff or soft.

use unipbd_core::math::wide;
use unipbd_core::{Solver, Vector64};
use unipbd_tests::{bars, build, run, scene};

const SPACING: f64 = 0.05;

fn boxed(text: &str) -> Solver {
    build(&scene(&format!("spacing = {SPACING}\n[solver]\nsubsteps = 8\n{text}")), 2)
}

fn weightless(text: &str) -> Solver {
    build(&scene(&format!("spacing = {SPACING}\ngravity = [0, 0]\n[solver]\nsubsteps = 8\n{text}")), 2)
}

/// Largest distance of a sample from where the body's pose puts it, over the body's half width.
fn deformation(solver: &Solver, id: usize, half: f64) -> f64 {
    let body = &solver.bodies()[id];
    let first: usize = solver.bodies()[..id].iter().map(|body| body.samples.len()).sum();
    let ids = solver.ids();
    let least = ids.iter().zip(solver.phases()).filter(|(_, phase)| phase.name() == "rigid").map(|(id, _)| *id).min();
    let worst = body.samples.iter().enumerate().map(|(k, sample)| {
        let row = ids.iter().position(|&id| id == least.unwrap() + (first + k) as u32).unwrap();
        let place = body.position + Vector64::from_angle(body.angle).rotate(*sample);
        (wide(solver.positions()[row]) - place).length()
    });
    worst.fold(0.0, f64::max) / half
}

const BOX: &str = "[[body]]\nname = 'box'\nsolver = 'shape_matching'\nsize = [0.6, 0.6]\n";

#[test]
fn a_free_shape_keeps_its_momenta_and_its_form() {
    let text = format!("{BOX}position = [0, 0]\nvelocity = [1, 2]\nspin_deg = 300");
    let mut solver = weightless(&text);
    let start = solver.diagnostics();
    let mut worst = 0.0f64;
    run(&mut solver, 120, |solver| worst = worst.max(deformation(solver, 0, 0.3)));
    let (end, body) = (solver.diagnostics(), &solver.bodies()[0]);
    let turned = 2.0 * 300f64.to_radians();
    bars("free flight", |bars| {
        // Single precision: 960 substeps.
        bars.at_most("momentum error", (end.momentum - start.momentum).length() / start.momentum.length(), 5e-5);
        let spin = |d: &unipbd_core::observe::Diagnostics| d.angular_momentum;
        bars.at_most("angular momentum error", (spin(&end) / spin(&start) - 1.0).abs(), 1e-4);
        bars.at_most("kinetic energy error", (end.kinetic_energy / start.kinetic_energy - 1.0).abs(), 1e-3);
        bars.at_most("deformation", worst, 0.01);
        bars.at_most("place error [m]", (body.position - Vector64::new(2.0, 4.0)).length(), 1e-3);
        bars.within("turned over expected", body.angle / turned, 0.999, 1.001);
    });
}

#[test]
fn a_dropped_shape_rests_on_the_floor_in_its_form() {
    let mut solver =
        boxed(&format!("{BOX}position = [0, 1]\nangle_deg = 20\n[[half_plane]]\npoint = [0, 0]\nnormal = [0, 1]"));
    let (mut worst, mut fastest) = (0.0f64, 0.0f64);
    run(&mut solver, 300, |solver| worst = worst.max(deformation(solver, 0, 0.3)));
    run(&mut solver, 60, |solver| fastest = fastest.max(solver.bodies()[0].velocity.length()));
    let body = &solver.bodies()[0];
    let off = (body.angle.to_degrees() / 90.0 - (body.angle.to_degrees() / 90.0).round()) * 90.0;
    bars("dropped shape", |bars| {
        bars.at_most("deformation", worst, 0.01);
        bars.within("height over half its width", body.position.y / 0.3, 0.98, 1.01);
        bars.at_most("angle to a side [degrees]", off.abs(), 1.0);
        bars.at_most("speed at rest [m/s]", fastest, 0.02);
    });
}

#[test]
fn shapes_that_collide_keep_their_momenta() {
    let text = format!(
        "{BOX}position = [-0.6, 0]\nvelocity = [2, 0]\n{}\n[[body]]\nradius = 0.25\nposition = [1.1, -0.3]\nvelocity = [-1, 0]",
        BOX.replace("'box'", "'other'") + "position = [0.3, 0.25]\nvelocity = [-1, 0]\ndensity = 500"
    );
    let mut solver = weightless(&text);
    let start = solver.diagnostics();
    let mut worst = 0.0f64;
    run(&mut solver, 90, |solver| worst = worst.max(deformation(solver, 0, 0.3)).max(deformation(solver, 1, 0.3)));
    let end = solver.diagnostics();
    let scale: f64 = solver.bodies().iter().map(|body| body.mass).sum::<f64>();
    bars("two shapes and a disc", |bars| {
        bars.at_most("momentum error [m/s]", (end.momentum - start.momentum).length() / scale, 1e-5);
        bars.at_most(
            "angular momentum error [m^2/s]",
            (end.angular_momentum - start.angular_momentum).abs() / scale,
            2e-2,
        );
        bars.at_most("kinetic energy over the start's", end.kinetic_energy / start.kinetic_energy, 1.0);
        bars.at_most("speed of the first box [m/s]", solver.bodies()[0].velocity.x, 1.5);
        bars.at_least("change of the disc's speed [m/s]", solver.bodies()[2].velocity.x + 1.0, 0.1);
        bars.at_most("deformation", worst, 0.02);
    });
}

#[test]
fn a_shape_floats_at_its_draft() {
    let mut solver = boxed(
        "[[liquid]]\nname = 'water'\nxsph = 0.05\n[[block]]\nmaterial = 'water'\nmin = [0, 0]\nmax = [4, 1.2]\n\
         [[tank]]\nmin = [0, 0]\nmax = [4, 3]\nopen = ['top']\n\
         [[body]]\nsolver = 'shape_matching'\nsize = [1.2, 0.4]\nposition = [2, 1.3]\ndensity = 500",
    );
    run(&mut solver, 480, |_| {});
    let (mut bottom, mut tilt) = (0.0, 0.0f64);
    run(&mut solver, 60, |solver| {
        bottom += (solver.bodies()[0].position.y - 0.2) / 60.0;
        tilt = tilt.max(solver.bodies()[0].angle.abs());
    });
    let water = solver.phases().iter().filter(|phase| phase.name() == "liquid").count() as f64;
    let area = water * SPACING * SPACING / (1.0 + solver.diagnostics().density_error_mean);
    let draft = (area / 4.0 - bottom) / (1.0 - 1.2 / 4.0);
    let lift = solver.bodies()[0].fluid_force.y / (solver.bodies()[0].mass * 9.81);
    bars("floating shape", |bars| {
        bars.at_most("draft error [spacings]", ((draft - 0.2) / SPACING).abs(), 0.5);
        bars.at_most("tilt [rad]", tilt, 0.1);
        bars.within("lift over weight", lift, 0.9, 1.1);
        bars.at_most("deformation", deformation(&solver, 0, 0.6), 0.01);
    });
}

#[test]
fn a_soft_shape_deforms_and_comes_back() {
    let text = "[[half_plane]]\npoint = [0, 0]\nnormal = [0, 1]\n[[body]]\nsolver = 'shape_matching'\ncompliance = 4e-7\nsize = [0.6, 0.6]\nposition = [0, 1.5]\n";
    let mut solver = boxed(text);
    let mut worst = 0.0f64;
    run(&mut solver, 120, |solver| worst = worst.max(deformation(solver, 0, 0.3)));
    run(&mut solver, 480, |_| {});
    let left = deformation(&solver, 0, 0.3);
    let corners = solver.bodies()[0].outline.len();
    bars("soft shape", |bars| {
        bars.at_least("deformation on impact", worst, 0.2);
        bars.at_most("deformation at rest", left, 0.08);
        bars.at_least("corners of its outline", corners as f64, 8.0);
        bars.within("height over half its width", solver.bodies()[0].position.y / 0.3, 0.9, 1.02);
    });
}

#[test]
fn boxes_of_particles_pile_on_a_rigid_one() {
    let mut solver = boxed(&format!(
        "[[tank]]\nmin = [-2, 0]\nmax = [2, 4]\n[[body]]\nsize = [0.8, 0.4]\nposition = [0, 0.2]\n{BOX}position = [0, 0.75]\ncopies = {{ columns = 1, rows = 2, step = [0, 0.65] }}"
    ));
    run(&mut solver, 300, |_| {});
    let heights: Vec<f64> = solver.bodies().iter().map(|body| body.position.y).collect();
    bars("pile of shapes", |bars| {
        bars.within("height of the first", heights[1], 0.66, 0.72);
        bars.within("height of the second", heights[2], 1.23, 1.33);
        bars.at_most("speed [m/s]", solver.bodies()[2].velocity.length(), 0.05);
    });
}
