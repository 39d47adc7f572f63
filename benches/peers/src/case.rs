//! The two cases, the same for every solver, and how their compression is measured.

use cpu_time::ProcessTime;

/// A block of liquid on a lattice of spacing `dx` in a tank from the origin.
#[derive(Clone, Copy)]
pub struct Case {
    pub name: &'static str,
    pub block: [f64; 2],
    pub tank: [f64; 2],
    pub dx: f64,
    /// Simulated time [s].
    pub seconds: f64,
}

/// Seconds between two looks at the positions.
pub const LOOK: f64 = 0.1;
/// Neighbours counted by the estimate, in spacings.
const REACH: f64 = 2.5;

impl Case {
    /// A column twice as high as wide collapses.
    pub fn dam_break(particles: usize, seconds: f64) -> Case {
        let dx = 1.0 / (particles as f64 / 2.0).sqrt().round();
        Case { name: "dam break", block: [1.0, 2.0], tank: [3.2, 4.0], dx, seconds }
    }

    /// A square pool at rest.
    pub fn still_tank(particles: usize, seconds: f64) -> Case {
        let dx = 1.0 / (particles as f64).sqrt().round();
        Case { name: "still tank", block: [1.0, 1.0], tank: [1.0, 2.0], dx, seconds }
    }

    pub fn lattice(&self) -> Vec<[f64; 2]> {
        let count = |length: f64| (length / self.dx).round() as usize;
        let (columns, rows) = (count(self.block[0]), count(self.block[1]));
        let at = |k: usize| [(k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5].map(|x| x * self.dx);
        (0..columns * rows).map(at).collect()
    }

    /// Mean compression, max(rho/rho0 - 1, 0), over the interior: particles farther than the kernel's reach from walls and
    /// from the surface, which is the highest particle of their column. The density is that of a cubic
    /// spline (Monaghan 1992), 1 on the lattice.
    pub fn compression(&self, positions: &[[f64; 2]]) -> f64 {
        let reach = REACH * self.dx;
        let scaled = |x: f64| (x / reach).floor().max(0.0) as usize;
        let (columns, rows) = (scaled(self.tank[0]) + 2, scaled(self.tank[1]) + 2);
        let cell = |x: &[f64; 2]| (scaled(x[0]).min(columns - 1), scaled(x[1]).min(rows - 1));
        let mut cells = vec![Vec::new(); columns * rows];
        let mut tops = vec![0.0_f64; columns];
        for (k, x) in positions.iter().enumerate() {
            let (column, row) = cell(x);
            cells[row * columns + column].push(k);
            tops[column] = tops[column].max(x[1]);
        }
        let rest: f64 = (-3..=3)
            .flat_map(|i| (-3..=3).map(move |j| (f64::from(i), f64::from(j))))
            .map(|(i, j)| spline(i.hypot(j) / REACH))
            .sum();
        let (mut sum, mut count) = (0.0, 0);
        for x in positions {
            let (column, row) = cell(x);
            let lowest_top =
                (column.max(1) - 1..=(column + 1).min(columns - 2)).map(|k| tops[k]).fold(f64::INFINITY, f64::min);
            let inside = x[0] > reach && x[0] < self.tank[0] - reach && x[1] > reach;
            if !inside || x[1] > lowest_top - 1.5 * reach {
                continue;
            }
            let mut density = 0.0;
            for row in row.max(1) - 1..=(row + 1).min(rows - 1) {
                for column in column.max(1) - 1..=(column + 1).min(columns - 1) {
                    for &j in &cells[row * columns + column] {
                        density += spline((x[0] - positions[j][0]).hypot(x[1] - positions[j][1]) / reach);
                    }
                }
            }
            sum += (density / rest - 1.0).max(0.0);
            count += 1;
        }
        if count > 0 { sum / f64::from(count) } else { 0.0 }
    }
}

/// The cubic spline over q = r/h, without its constant.
fn spline(q: f64) -> f64 {
    if q < 0.5 {
        6.0 * (q * q * q - q * q) + 1.0
    } else if q < 1.0 {
        2.0 * (1.0 - q).powi(3)
    } else {
        0.0
    }
}

/// What a run of one solver gave.
pub struct Outcome {
    pub solver: String,
    /// Processor time of the steps alone [s]: on one thread the wall-clock time of a machine that does nothing else.
    pub time: f64,
    pub steps: u64,
    /// Compression at each look.
    pub compression: Vec<f64>,
    /// Height of the centre of mass at the end [m].
    pub height: f64,
}

impl Outcome {
    pub fn mean_compression(&self) -> f64 {
        self.compression.iter().sum::<f64>() / self.compression.len().max(1) as f64
    }
}

/// A solver that holds a case.
pub trait Runs {
    /// Advances by its step, whose length it returns [s].
    fn step(&mut self) -> f64;
    fn positions(&self) -> Vec<[f64; 2]>;
}

/// Runs a case to its end. Only the steps are timed.
pub fn run(case: &Case, solver: String, runs: &mut impl Runs) -> Outcome {
    let mut outcome = Outcome { solver, time: 0.0, steps: 0, compression: Vec::new(), height: 0.0 };
    let (mut time, mut next) = (0.0, LOOK);
    while time < case.seconds - 1e-9 {
        let begin = ProcessTime::now();
        let dt = runs.step();
        outcome.time += begin.elapsed().as_secs_f64();
        outcome.steps += 1;
        time += dt;
        if time >= next - 1e-9 {
            next += LOOK;
            outcome.compression.push(case.compression(&runs.positions()));
        }
    }
    let positions = runs.positions();
    outcome.height = positions.iter().map(|x| x[1]).sum::<f64>() / positions.len() as f64;
    outcome
}
