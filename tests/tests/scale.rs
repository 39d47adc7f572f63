//! A scene is right at any scale: with lengths times s and times times the root of s, and with other densities, the
//! same happens. Where the factors are powers of two that f32 carries exactly, the bits are the same.

use unipbd_core::constraints::{ConstraintGroup, Corrections, Needs, Substep};
use unipbd_core::math::{Vector64, wide};
use unipbd_core::scene::Scene;
use unipbd_core::{Solver, SolverError, Vector};
use unipbd_tests::{bars, build, mean_of, run, say, scene};

/// Factors on lengths and densities; times go with the root of lengths, so that gravity stays.
#[derive(Clone, Copy, Debug)]
struct Scale {
    length: f64,
    density: f64,
}

impl Scale {
    const ONE: Scale = Scale { length: 1.0, density: 1.0 };

    fn time(self) -> f64 {
        self.length.sqrt()
    }

    fn speed(self) -> f64 {
        self.length / self.time()
    }

    /// Factor on a number by the letter of its unit.
    fn of(self, unit: &str) -> f64 {
        let (length, time) = (self.length, self.time());
        let mass = self.density * length * length;
        match unit {
            "m" => length,
            "s" => time,
            "m/s" => length / time,
            "1/s" => 1.0 / time,
            "1/m" => 1.0 / length,
            "m2/s" => length * length / time,
            "kg/m2" => self.density,
            "m/N" => time * time / mass,
            "N" => mass * length / (time * time),
            "Nm" => mass * length * length / (time * time),
            "Ns/m" => mass / time,
            _ => panic!("no unit {unit}"),
        }
    }

    /// A scene, written with numbers and their units as `<0.5 m>`.
    fn scene(self, text: &str) -> Scene {
        let mut parts = text.split('<');
        let mut scaled = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (number, rest) = part.split_once('>').expect("a number is closed");
            let (value, unit) = number.split_once(' ').expect("a number has a unit");
            let value: f64 = value.parse().expect("a number is one");
            scaled += &format!("{:e}{rest}", value * self.of(unit));
        }
        scene(&scaled)
    }
}

/// What happens, in the units of scale one: places and velocities of particles and bodies, and density errors.
fn seen(solver: &Solver, scale: Scale) -> Vec<f64> {
    let mut all = Vec::new();
    let vector = |all: &mut Vec<f64>, vector: Vector64, unit: f64| all.extend((vector / unit).to_array());
    for (x, v) in solver.positions().iter().zip(solver.velocities()) {
        vector(&mut all, wide(*x), scale.length);
        vector(&mut all, wide(*v), scale.speed());
    }
    for body in solver.bodies() {
        vector(&mut all, body.position, scale.length);
        vector(&mut all, body.velocity, scale.speed());
        all.extend([body.angle, body.angular_velocity * scale.time(), f64::from(u8::from(body.asleep))]);
    }
    let diagnostics = solver.diagnostics();
    all.extend([f64::from(diagnostics.substeps), diagnostics.density_error_mean, diagnostics.density_error_max]);
    all.push(solver.particles().asleep() as f64);
    all
}

/// A run in the units of scale one, looked at in every tenth frame.
fn story(text: &str, frames: u64, scale: Scale) -> Vec<Vec<f64>> {
    let mut solver = build(&scale.scene(text), 1);
    let (mut seen_so_far, mut frame) = (vec![seen(&solver, scale)], 0);
    run(&mut solver, frames, |solver| {
        frame += 1;
        if frame % 10 == 0 {
            seen_so_far.push(seen(solver, scale));
        }
    });
    seen_so_far
}

/// Powers of 4, or of 16 where a scene takes the root of a viscosity, and of two, from dx = 1e-6 m to 1e3 m and densities of 1e-3 to 1e5 kg/m^2 for a spacing of a few
/// hundredths of a metre.
const EXACT: [Scale; 4] = [
    Scale { length: 1.0 / 4096.0, density: 1.0 },
    Scale { length: 65536.0, density: 64.0 },
    Scale { length: 1.0 / 4096.0, density: 1.0 / 1_048_576.0 },
    Scale { length: 256.0, density: 1.0 / 1024.0 },
];

/// The root of a viscosity or a conductivity is not exact here.
const EXACT_WITHOUT_DIFFUSION: [Scale; 2] =
    [Scale { length: 1.0 / 16384.0, density: 1.0 }, Scale { length: 16384.0, density: 4.0 }];

/// Runs a scene at all scales and counts the looks that differ.
#[track_caller]
pub(crate) fn same_at_any_scale(case: &'static str, frames: u64, text: &str) {
    let expected = story(text, frames, Scale::ONE);
    assert!(expected.iter().flatten().all(|value| value.is_finite()));
    bars(case, |bars| {
        let diffuses = text.contains("viscosity") || text.contains("conductivity");
        let more = if diffuses { &[][..] } else { &EXACT_WITHOUT_DIFFUSION };
        for &scale in EXACT.iter().chain(more) {
            let found = story(text, frames, scale);
            let differs = |(a, b): (&Vec<f64>, &Vec<f64>)| a != b;
            let first = expected.iter().zip(&found).position(differs);
            if let Some(look) = first {
                say(first_difference(&expected[look], &found[look]));
            }
            let what =
                format!("looks with the same bits at lengths x {:e}, densities x {:e}", scale.length, scale.density);
            bars.at_least(&what, first.unwrap_or(expected.len()) as f64, expected.len() as f64);
        }
    });
}

/// Where two looks differ first, for the reader of a failure.
fn first_difference(expected: &[f64], found: &[f64]) -> String {
    let both = || expected.iter().zip(found).enumerate();
    let count = both().filter(|(_, (a, b))| a != b).count();
    match both().find(|(_, (a, b))| a != b) {
        Some((place, (a, b))) => {
            format!("{count} of {} numbers differ, number {place} first: {a:e} {b:e}", found.len())
        }
        None => format!("{} numbers in place of {}", found.len(), expected.len()),
    }
}

/// A tank over the whole of a scene of this size.
pub(crate) const TANK: &str = "
[[tank]]
min = [0.0, 0.0]
max = [<1.0 m>, <1.0 m>]
open = [\"top\"]
";

pub(crate) const HEAD: &str = "
spacing = <0.03125 m>
fps = <60 1/s>
duration = <4 s>
";

#[test]
fn a_dam_break_that_may_sleep_is_the_same_at_any_scale() {
    for solver in ["sleep = true", "pressure_grid = \"on\""] {
        let text = format!(
            r#"{HEAD}
            [solver]
            {solver}
            [[liquid]]
            name = "water"
            density = <1000 kg/m2>
            xsph = 0.05
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [<0.5 m>, <0.6 m>]
            {TANK}"#
        );
        same_at_any_scale("dam break", 60, &text);
    }
}

#[test]
fn a_shallow_pool_falls_asleep_at_any_scale() {
    let text = format!(
        r#"{HEAD}
        [solver]
        sleep = true
        [[liquid]]
        name = "water"
        density = <1000 kg/m2>
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [<1.0 m>, <0.2 m>]
        {TANK}"#
    );
    same_at_any_scale("pool", 60, &text);
}

#[test]
fn viscous_liquids_with_surface_tension_are_the_same_at_any_scale() {
    let text = format!(
        r#"{HEAD}
        [[liquid]]
        name = "oil"
        density = <900 kg/m2>
        kinematic_viscosity = <0.01 m2/s>
        surface_tension = <20 N>
        contact_angle = 60.0
        quadratic_drag = <0.1 1/m>
        [[liquid]]
        name = "water"
        density = <1000 kg/m2>
        [[disc]]
        material = "oil"
        center = [<0.5 m>, <0.6 m>]
        radius = <0.2 m>
        velocity = [<0.5 m/s>, 0.0]
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [<1.0 m>, <0.2 m>]
        {TANK}"#
    );
    same_at_any_scale("liquids", 40, &text);
}

#[test]
fn a_plume_of_gas_with_smoke_is_the_same_at_any_scale() {
    let text = format!(
        r#"{HEAD}
        [[gas]]
        name = "air"
        density = <1024 kg/m2>
        drag = <2 1/s>
        vorticity = <1 1/s>
        baroclinic = 0.5
        conductivity = <0.001 m2/s>
        lifetime = <1.0 s>
        keep_radius = <0.3 m>
        keep_age = <0.3 s>
        [[smoke]]
        name = "smoke"
        lifetime = <0.9 s>
        [[emitter]]
        material = "air"
        position = [<0.5 m>, <0.1 m>]
        width = <0.2 m>
        speed = <1.5 m/s>
        temperature = 1.0
        start = <0.05 s>
        smoke = {{ material = "smoke", per_particle = 2 }}
        sheath = {{ thickness = <0.06 m>, speed = <0.7 m/s> }}
        [[heater]]
        region = {{ center = [<0.5 m>, <0.6 m>], radius = <0.2 m> }}
        rate = <10 1/s>
        [environment]
        velocity = [<0.1 m/s>, 0.0]
        gusts = <0.2 m/s>
        gust_length = <0.3 m>
        gust_time = <0.4 s>
        [[sink]]
        region = {{ min = [<0.0 m>, <0.9 m>], max = [<1.0 m>, <1.0 m>] }}
        rate = <500 1/s>
        {TANK}"#
    );
    same_at_any_scale("plume", 60, &text);
}

#[test]
fn a_closed_box_of_gas_over_liquid_is_the_same_at_any_scale() {
    let text = format!(
        r#"{HEAD}
        [[gas]]
        name = "air"
        density = <1024 kg/m2>
        kinematic_viscosity = <0.001 m2/s>
        [[liquid]]
        name = "water"
        density = <1000 kg/m2>
        [[smoke]]
        name = "smoke"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [<1.0 m>, <0.3 m>]
        [[block]]
        material = "air"
        min = [0.0, <0.3125 m>]
        max = [<1.0 m>, <1.0 m>]
        jitter = 0.05
        [[injector]]
        material = "smoke"
        region = {{ center = [<0.5 m>, <0.6 m>], radius = <0.2 m> }}
        rate = <300 1/s>
        [[heater]]
        region = {{ center = [<0.5 m>, <0.6 m>], radius = <0.2 m> }}
        rate = <10 1/s>
        [[tank]]
        min = [0.0, 0.0]
        max = [<1.0 m>, <1.0 m>]"#
    );
    same_at_any_scale("closed box", 40, &text);
}

/// Distance that a dam break has run and its energy, at times of its own, over those of scale one.
#[test]
fn a_dam_break_runs_as_far_at_scales_that_are_no_powers_of_two() {
    let text = format!(
        r#"{HEAD}
        [[liquid]]
        name = "water"
        density = <1000 kg/m2>
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [<0.5 m>, <1.0 m>]
        [[tank]]
        min = [0.0, 0.0]
        max = [<3.0 m>, <2.0 m>]"#
    );
    let measure = |scale: Scale| {
        let mut solver = build(&scale.scene(&text), 1);
        let mut front = Vec::new();
        run(&mut solver, 30, |solver| {
            let farthest = solver.positions().iter().map(|x| f64::from(x.x)).fold(0.0, f64::max);
            front.push(farthest / scale.length);
        });
        let speeds = solver.velocities().iter().map(|v| (wide(*v) / scale.speed()).length_squared());
        (mean_of(front), mean_of(speeds))
    };
    let (front, energy) = measure(Scale::ONE);
    bars("dam break at other scales", |bars| {
        for (length, density) in [(3.3e-5, 1e-6), (3.0e-3, 100.0), (777.0, 3e-3), (3.2e4, 1.0)] {
            let (other_front, other_energy) = measure(Scale { length, density });
            let at = format!("at lengths x {length:e}, densities x {density:e}");
            bars.within(&format!("front over that of scale one {at}"), other_front / front, 0.99, 1.01);
            bars.within(&format!("kinetic energy over that of scale one {at}"), other_energy / energy, 0.98, 1.02);
        }
    });
}

/// Moves the first particle nowhere that can be said, without a velocity.
struct Nowhere;

impl ConstraintGroup for Nowhere {
    fn name(&self) -> &str {
        "nowhere"
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn project(&mut self, _: Substep<'_>, out: &mut Corrections) {
        out.shifts_mut()[0] = Vector::NAN;
    }
}

#[test]
fn a_place_that_is_no_number_stops_the_run_and_is_named() {
    let text = format!(
        r#"{HEAD}
        [[solid]]
        name = "dust"
        density = <1000 kg/m2>
        [[points]]
        material = "dust"
        positions = [[0.1, 0.1], [0.5, 0.5]]"#
    );
    let mut solver = build(&Scale::ONE.scene(&text), 1);
    solver.add_group(Box::new(Nowhere));
    let error = solver.step_frame().expect_err("the run stops");
    assert!(matches!(&error, SolverError::Diverged { material, .. } if material == "dust"), "{error}");
    say(error);
}
