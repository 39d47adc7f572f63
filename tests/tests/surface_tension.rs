//! Surface tension: water, sigma = 0.07 N, dx = 1 mm, drops of R = 20 dx without gravity.

use std::f64::consts::PI;
use unipbd_core::Solver;
use unipbd_core::math::{Vector64, wide};
use unipbd_core::scene::{Points, Scene};
use unipbd_tests::{bars, build, full_size, kinetic_energy, mean_of, run, scene};

const DX: f64 = 1e-3;
const SIGMA: f64 = 0.07;
const RHO: f64 = 1000.0;

/// Water of these points, with more keys for the liquid and more tables.
fn water(points: &[Vector64], velocities: &[Vector64], keys: &str, tables: &str) -> Scene {
    let mut scene = scene(&format!(
        "spacing = {DX}\ngravity = [0.0, 0.0]\n[[liquid]]\nname = \"water\"\nsurface_tension = {SIGMA}\n{keys}\n\
         [[points]]\nmaterial = \"water\"\npositions = [[0.0, 0.0]]\n{tables}"
    ));
    scene.points = vec![Points {
        positions: points.iter().map(|x| x.to_array()).collect(),
        velocities: velocities.iter().map(|v| v.to_array()).collect(),
        ..scene.points[0].clone()
    }];
    scene
}

/// The points of a square lattice in a disc \[m].
fn disc(radius: f64, center: Vector64) -> Vec<Vector64> {
    let reach = radius.ceil() as i32;
    let all = (-reach..reach).flat_map(|i| (-reach..reach).map(move |j| Vector64::new(f64::from(i), f64::from(j))));
    let points = all.map(|x| x + Vector64::splat(0.5)).filter(|x| x.length() < radius);
    points.map(|x| (x + center.round()) * DX).collect()
}

fn places(solver: &Solver) -> Vec<Vector64> {
    solver.positions().iter().map(|x| wide(*x)).collect()
}

fn radius_of(count: usize) -> f64 {
    (count as f64 / PI).sqrt() * DX
}

/// Pressure in the middle of a drop over sigma/R.
fn laplace(solver: &Solver) -> f64 {
    let (places, radius) = (places(solver), radius_of(solver.positions().len()));
    let middle = places.iter().sum::<Vector64>() / places.len() as f64;
    let inner = places.iter().zip(solver.pressures()).filter(|(x, _)| (**x - middle).length() < 0.6 * radius);
    mean_of(inner.map(|(_, pressure)| f64::from(*pressure) * RHO)) * radius / SIGMA
}

/// A round drop of this radius \[dx] that has come to rest, and the mean of its Laplace pressure.
fn drop_at_rest(radius: f64) -> (Vec<Vector64>, f64) {
    let mut solver = build(&water(&disc(radius, Vector64::ZERO), &[], "xsph = 0.1", ""), 2);
    let mut pressures = Vec::new();
    run(&mut solver, 150, |_| ());
    run(&mut solver, 50, |solver| pressures.push(laplace(solver)));
    (places(&solver), mean_of(pressures))
}

/// The frequency of a mode over that of Rayleigh in two dimensions, omega^2 = n (n^2 - 1) sigma/(rho R^3): the drop is
/// struck with the velocity of the mode, and its moment passes its mean value every half period.
fn frequency(drop: &[Vector64], n: i32) -> f64 {
    let (radius, order) = (radius_of(drop.len()), f64::from(n));
    let omega = (order * (order * order - 1.0) * SIGMA / (RHO * radius * radius * radius)).sqrt();
    let middle = drop.iter().sum::<Vector64>() / drop.len() as f64;
    let polar = |x: &Vector64| ((*x - middle).length() / radius, (x.y - middle.y).atan2(x.x - middle.x));
    let strike = |x: &Vector64| {
        let (r, angle) = polar(x);
        let turn = (order - 1.0) * angle;
        Vector64::new(turn.cos(), -turn.sin()) * (r.powi(n - 1) * 0.04 * radius * omega)
    };
    let velocities: Vec<Vector64> = drop.iter().map(strike).collect();
    let mut scene = water(drop, &velocities, "", "");
    (scene.solver.settle_substeps, scene.fps) = (Some(0), 120.0);
    let moment = |x: &Vector64| {
        let (r, angle) = polar(x);
        r.powi(n) * (order * angle).cos()
    };
    let period = 2.0 * PI / omega;
    let mut solver = build(&scene, 2);
    let mut series = vec![(0.0, mean_of(drop.iter().map(moment)))];
    run(&mut solver, (1.6 * period * scene.fps) as u64, |solver| {
        series.push((solver.time(), mean_of(places(solver).iter().map(moment))));
    });
    let errors =
        (0..200).map(|k| 0.8 + 0.002 * f64::from(k)).map(|part| (misfit(&series, part * omega, 0.15 / period), part));
    errors.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are frequencies").1
}

/// Square error of the best damped sine about a mean.
fn misfit(series: &[(f64, f64)], omega: f64, decay: f64) -> f64 {
    let basis = |t: f64| [1.0, (-decay * t).exp() * (omega * t).sin(), (-decay * t).exp() * (omega * t).cos()];
    let (mut a, mut b) = ([[0.0; 3]; 3], [0.0; 3]);
    for &(t, y) in series {
        let f = basis(t);
        for i in 0..3 {
            b[i] += f[i] * y;
            (0..3).for_each(|j| a[i][j] += f[i] * f[j]);
        }
    }
    for i in 0..3 {
        for k in i + 1..3 {
            let factor = a[k][i] / a[i][i];
            (i..3).for_each(|j| a[k][j] -= factor * a[i][j]);
            b[k] -= factor * b[i];
        }
    }
    let mut x = [0.0; 3];
    for i in (0..3).rev() {
        x[i] = (b[i] - (i + 1..3).map(|j| a[i][j] * x[j]).sum::<f64>()) / a[i][i];
    }
    let error = |&(t, y): &(f64, f64)| y - basis(t).iter().zip(x).map(|(f, x)| f * x).sum::<f64>();
    series.iter().map(|sample| error(sample) * error(sample)).sum()
}

#[test]
fn a_drop_has_the_pressure_of_laplace_and_the_modes_of_rayleigh() {
    let (drop, pressure) = drop_at_rest(20.0);
    bars("drop, R = 20 dx", |bars| {
        bars.within("Laplace pressure over sigma/R", pressure, 0.97, 1.03);
        bars.within("frequency of n = 2 over Rayleigh", frequency(&drop, 2), 0.97, 1.03);
        if full_size("modes n = 3 and 4 of a drop") {
            bars.within("frequency of n = 3 over Rayleigh", frequency(&drop, 3), 0.88, 1.05);
            bars.within("frequency of n = 4 over Rayleigh", frequency(&drop, 4), 0.83, 1.05);
        }
    });
}

/// The tension of a drop depends on how its surface came to be: drops cut from one lattice at other radii have another.
#[test]
fn the_tension_of_other_drops_is_known_roughly() {
    if !full_size("drops of other radii") {
        return;
    }
    bars("Laplace pressure over sigma/R", |bars| {
        for radius in [14.3, 19.6, 20.4] {
            bars.within(&format!("R = {radius} dx"), drop_at_rest(radius).1, 0.7, 1.25);
        }
    });
}

/// The contact angle of a drop on a wall, from its mean height.
fn contact_angle(angle: f64) -> (f64, f64) {
    let theta = angle.to_radians();
    let radius = 20.0 * (PI / (theta - theta.sin() * theta.cos())).sqrt();
    let mut points = disc(radius, Vector64::new(0.0, -theta.cos() * radius));
    points.retain(|x| x.y > 0.0);
    let wall = "[[half_plane]]\nname = \"wall\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]";
    let mut solver = build(&water(&points, &[], &format!("xsph = 0.1\ncontact_angle = {angle}"), wall), 2);
    let (mut heights, mut forces) = (Vec::new(), Vec::new());
    run(&mut solver, 150, |_| ());
    run(&mut solver, 50, |solver| {
        heights.push(mean_of(places(solver).iter().map(|x| x.y)));
        forces.push(solver.wall_forces()[0].force.y / SIGMA);
    });
    let area = points.len() as f64 * DX * DX;
    // Mean height of a segment of a circle of this area.
    let height = |t: f64| {
        let part = t - t.sin() * t.cos();
        (2.0 / 3.0 * t.sin().powi(3) / part - t.cos()) * (area / part).sqrt()
    };
    let (mut low, mut high) = (0.01, 3.13);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if height(middle) < mean_of(heights.iter().copied()) { low = middle } else { high = middle }
    }
    (low.to_degrees(), mean_of(forces))
}

#[test]
fn drops_on_walls_have_the_contact_angle_of_the_scene() {
    let angles: &[f64] = if full_size("drops on walls at 90 and 135 degrees") { &[45.0, 90.0, 135.0] } else { &[45.0] };
    bars("drop on a wall, R = 20 dx", |bars| {
        for &angle in angles {
            let (found, force) = contact_angle(angle);
            bars.within(&format!("angle where {angle} is given [deg]"), found, angle - 5.0, angle + 5.0);
            bars.within("force on the wall over sigma", force, -0.3, 0.3);
        }
    });
}

#[test]
fn a_pool_with_tension_rests_as_one_without() {
    let pool = |sigma: f64| {
        let mut solver = build(
            &scene(&format!(
                "spacing = {DX}\n[[liquid]]\nname = \"water\"\nxsph = 0.1\nsurface_tension = {sigma}\n\
                 [[tank]]\nmin = [0.0, 0.0]\nmax = [0.04, 0.06]\nopen = [\"top\"]\n\
                 [[block]]\nmaterial = \"water\"\nmin = [0.0, 0.0]\nmax = [0.04, 0.02]\n\
                 [solver]\npressure_grid = \"off\""
            )),
            2,
        );
        let height = |solver: &Solver| mean_of(places(solver).iter().map(|x| x.y)) / DX;
        let start = height(&solver);
        run(&mut solver, 120, |_| ());
        (start, height(&solver), (2.0 * kinetic_energy(&solver)).sqrt() / DX)
    };
    let ([with, without], rest) = ([SIGMA, 0.0].map(pool), 10.0);
    bars("pool, 40 x 20 dx", |bars| {
        bars.within("mean height at the start [dx]", with.0, rest - 0.1, rest + 0.1);
        bars.within("mean height after two seconds [dx]", with.1, rest - 0.15, rest + 0.1);
        bars.at_most("mean speed with tension [dx/s]", with.2, 1.0f64.max(1.2 * without.2));
    });
}
