//! Watches a run and says which expectations of its scene do not hold.

use unipbd_core::Solver;
use unipbd_core::math::{Real, Vector64, vector, wide};
use unipbd_core::observe::Diagnostics;
use unipbd_core::rigid::{Body, BodyKind};
use unipbd_core::scene::{BodyExpectation, Expect, MaterialExpectation, Scene};

/// Depth inside a wall that counts as outside still, in spacings: rounding, and the slop of contacts.
const TOUCHING: f64 = 0.25;

/// Extremes of a run so far, to be compared with the [`Expect`] table of its scene.
#[derive(Clone, Debug)]
pub struct Watch {
    expect: Expect,
    gravity: Vector64,
    density_error_mean: f64,
    density_error_max: f64,
    substeps: u32,
    speed: f64,
    /// Energy at the start \[J], and what of it can be given away.
    start: Option<(f64, f64)>,
    energy: f64,
    /// Deepest point inside a wall \[m], and when.
    deepest: (f64, f64),
}

impl Watch {
    /// A watch over a run of this scene.
    pub fn new(scene: &Scene) -> Self {
        Watch {
            expect: scene.expect.clone(),
            gravity: scene.gravity.into(),
            density_error_mean: 0.0,
            density_error_max: 0.0,
            substeps: 0,
            speed: 0.0,
            start: None,
            energy: f64::NEG_INFINITY,
            deepest: (0.0, 0.0),
        }
    }

    /// Takes note of the state at the start or after a frame.
    pub fn observe(&mut self, solver: &Solver) {
        let diagnostics = solver.diagnostics();
        if diagnostics.time >= self.expect.settled {
            self.density_error_mean = self.density_error_mean.max(diagnostics.density_error_mean);
            self.density_error_max = self.density_error_max.max(diagnostics.density_error_max);
        }
        self.substeps = self.substeps.max(diagnostics.substeps);
        let bodies = solver.bodies().iter().map(|body| body.velocity.length());
        self.speed = bodies.fold(self.speed.max(diagnostics.speed_max), f64::max);
        let energy = self.energy(&diagnostics, solver);
        if self.start.is_none() {
            self.start = Some((energy, energy - self.lowest_energy(solver)));
        }
        self.energy = self.energy.max(energy);
        if self.expect.contained == Some(true) {
            let depth = depth_in_walls(solver);
            if depth > self.deepest.0 {
                self.deepest = (depth, diagnostics.time);
            }
        }
    }

    /// Kinetic and potential energy of particles and dynamic bodies \[J].
    fn energy(&self, diagnostics: &Diagnostics, solver: &Solver) -> f64 {
        let of = |body: &Body| {
            let kinetic = body.mass * body.velocity.length_squared()
                + body.inertia * body.angular_velocity * body.angular_velocity;
            0.5 * kinetic - body.mass * self.gravity.dot(body.position)
        };
        let bodies: f64 = dynamic(solver).map(of).sum();
        diagnostics.kinetic_energy + diagnostics.potential_energy + bodies
    }

    /// Potential energy if everything lay at the lowest point \[J].
    fn lowest_energy(&self, solver: &Solver) -> f64 {
        let particles = solver.particles();
        let heavy = || (0..particles.len()).filter(|&row| particles.inverse_masses()[row] > 0.0);
        let places = heavy().map(|row| wide(particles.positions()[row]));
        let places = places.chain(dynamic(solver).map(|body| body.position));
        let lowest = places.map(|x| -self.gravity.dot(x)).fold(f64::INFINITY, f64::min);
        let mass: f64 = heavy().map(|row| 1.0 / f64::from(particles.inverse_masses()[row])).sum();
        let mass = mass + dynamic(solver).map(|body| body.mass).sum::<f64>();
        if lowest.is_finite() { mass * lowest } else { 0.0 }
    }

    /// Largest growth of the energy so far, over what the start could give away; 0 for an empty start.
    fn energy_growth(&self) -> f64 {
        self.start
            .filter(|(_, available)| *available > 0.0)
            .map_or(0.0, |(start, available)| (self.energy - start) / available)
    }

    /// Everything that does not hold, one line each. Called at the end of the run.
    pub fn violations(&self, solver: &Solver) -> Vec<String> {
        let mut lines = Vec::new();
        let mut at_most = |what: &str, value: f64, limit: Option<f64>| {
            if let Some(limit) = limit.filter(|limit| value.is_nan() || value > *limit) {
                lines.push(format!("{what}: {value:.6} exceeds {limit}"));
            }
        };
        at_most("density_error_mean", self.density_error_mean, self.expect.density_error_mean);
        at_most("density_error_max", self.density_error_max, self.expect.density_error_max);
        at_most("substeps_max", f64::from(self.substeps), self.expect.substeps_max.map(f64::from));
        at_most("speed_max", self.speed, self.expect.speed_max);
        at_most("energy_growth", self.energy_growth(), self.expect.energy_growth);
        if self.deepest.0 > TOUCHING * solver.spacing() {
            lines.push(format!(
                "contained: something is {:.4} m inside a wall at {:.3} s",
                self.deepest.0, self.deepest.1
            ));
        }
        self.expect.material.iter().for_each(|expected| check_material(expected, solver, &mut lines));
        self.expect.body.iter().for_each(|expected| check_body(expected, solver, &mut lines));
        lines
    }

    /// The extremes so far, for people to read.
    pub fn summary(&self) -> String {
        format!(
            "density error {:.3} % mean, {:.2} % worst; energy {:+.2} %; fastest {:.2} m/s; {} substeps",
            100.0 * self.density_error_mean,
            100.0 * self.density_error_max,
            100.0 * self.energy_growth(),
            self.speed,
            self.substeps
        )
    }
}

fn dynamic(solver: &Solver) -> impl Iterator<Item = &Body> {
    solver.bodies().iter().filter(|body| body.kind == BodyKind::Dynamic)
}

/// How far a free particle or the centre of a dynamic body is inside a wall \[m].
fn depth_in_walls(solver: &Solver) -> f64 {
    let walls = solver.walls();
    let particles = solver.particles();
    let free = |row: &usize| particles.inverse_masses()[*row] > 0.0 || particles.phases()[*row].is_passive();
    let depth = |x| f64::from((walls.clamp(x, x) - x).length());
    let loose = (0..particles.len()).filter(free).map(|row| depth(particles.positions()[row]));
    loose.chain(dynamic(solver).map(|body| depth(vector(body.position)))).fold(0.0, f64::max)
}

fn within(lines: &mut Vec<String>, what: String, value: f64, range: Option<[f64; 2]>) {
    if let Some([from, to]) = range.filter(|[from, to]| !(value >= *from && value <= *to)) {
        lines.push(format!("{what}: {value:.4} is not within [{from}, {to}]"));
    }
}

fn check_material(expected: &MaterialExpectation, solver: &Solver, lines: &mut Vec<String>) {
    let name = &expected.name;
    let Some(index) = solver.materials().iter().position(|material| material.name == *name) else {
        lines.push(format!("{name}: there is no such material"));
        return;
    };
    let particles = solver.particles();
    let rows = (0..particles.len()).filter(|&row| usize::from(particles.materials()[row]) == index);
    let places: Vec<Vector64> = rows.map(|row| wide(particles.positions()[row])).collect();
    let count = places.len() as f64;
    let mean = places.iter().sum::<Vector64>() / count;
    let mut heights: Vec<f64> = places.iter().map(|x| x.y).collect();
    heights.sort_by(f64::total_cmp);
    let high = heights.get((heights.len() * 19 / 20).min(heights.len().saturating_sub(1)));
    within(lines, format!("{name} count"), count, expected.count);
    within(lines, format!("{name} mean_x"), mean.x, expected.mean_x);
    within(lines, format!("{name} mean_y"), mean.y, expected.mean_y);
    within(lines, format!("{name} high_y"), high.copied().unwrap_or(Real::NAN.into()), expected.high_y);
}

fn check_body(expected: &BodyExpectation, solver: &Solver, lines: &mut Vec<String>) {
    let name = &expected.name;
    let copy = |body: &Body| {
        let number = body.name.strip_prefix(name.as_str()).and_then(|rest| rest.strip_prefix(' '));
        body.name == *name || number.is_some_and(|digits| digits.parse::<u32>().is_ok())
    };
    let mut found = false;
    for body in solver.bodies().iter().filter(|body| copy(body)) {
        found = true;
        let name = &body.name;
        within(lines, format!("{name} x"), body.position.x, expected.x);
        within(lines, format!("{name} y"), body.position.y, expected.y);
        within(lines, format!("{name} angle_deg"), body.angle.to_degrees(), expected.angle_deg);
        within(lines, format!("{name} speed"), body.velocity.length(), expected.speed);
        within(lines, format!("{name} spin_deg"), body.angular_velocity.to_degrees(), expected.spin_deg);
    }
    if !found {
        lines.push(format!("{name}: there is no such body"));
    }
}
