//! Run time against error: kernels, substeps, iterations and solver options on one picture per case.

use std::fmt::Write;

use unipbd_core::scene::{GradientPoint, LegacyKernel, Liquid, PressureGridUse, Scene, SolverSettings, Substeps};

use crate::case::{Case, Outcome, Trial};
use crate::cases::{self, DENSITY_ERROR, LEVEL, WORST};
use crate::chart::{Curve, Point, log_log, mark_front};
use crate::plan;

/// The cases of the sweep, with the resolutions of the quick and the full one.
pub const CASES: [(&str, u32, u32); 4] =
    [("column", 12, 30), (DAM_BREAK, 10, 40), ("standing_wave", 24, 64), ("floating_box", 8, 16)];

const DAM_BREAK: &str = "dam_break";

/// The figure of a case that is drawn over time.
pub struct Norm {
    /// Name of the case.
    pub case: &'static str,
    /// Its figure.
    pub figure: &'static str,
    /// Name of the picture.
    pub picture: &'static str,
    /// Label of its axis.
    axis: &'static str,
    /// Whether the figure says nothing about compression: then only settings count that hold water in the dam break.
    blind: bool,
}

/// Worst C in the dam break at which a setting still counts where the figure itself does not see compression. A wave
/// hardly decays in a liquid that gives way like a sponge.
const HOLDS_WATER: f64 = 0.06;

/// All pictures.
pub const NORMS: &[Norm] = &[
    Norm {
        case: "column",
        figure: DENSITY_ERROR,
        picture: "column",
        axis: "mean |C| of the interior at rest, by a cubic spline of radius 4 dx for all",
        blind: false,
    },
    Norm {
        case: "column",
        figure: LEVEL,
        picture: "column_level",
        axis: "error of the level, over the depth",
        blind: false,
    },
    Norm {
        case: "dam_break",
        figure: DENSITY_ERROR,
        picture: "dam_break",
        axis: "mean |C| of the interior, by a cubic spline of radius 4 dx for all",
        blind: false,
    },
    Norm {
        case: "standing_wave",
        figure: "decay per period",
        picture: "standing_wave",
        axis: "decay per period",
        blind: true,
    },
    Norm {
        case: "floating_box",
        figure: "largest draft error [dx]",
        picture: "floating_box",
        axis: "largest draft error [dx]",
        blind: true,
    },
];

/// Rounds go over all curves, so that what else the machine does hits all alike; the least time of a point counts. Its
/// errors are averaged: how a wave decays and where a box comes to rest hang on the arrangement by chance (8 % of the
/// decay from run to run), and that is another one in each round.
const ROUNDS: u32 = 3;
/// Rounds where the figure hangs on chance.
const MANY_ROUNDS: u32 = 9;
/// Part by which the relaxation of a round differs from that of the next.
const APART: f64 = 0.005;

/// A point is off the front only where another one is cheaper or more exact by this part, and no worse in the other:
/// times scatter by it, and errors that hang on the arrangement do too.
pub const SCATTER: f64 = 0.1;

/// A way of solving: one curve over the numbers of substeps or iterations.
pub struct Variant {
    /// Name of the curve.
    pub name: &'static str,
    change: fn(&mut Trial),
    scan: Scan,
}

/// The quantity that changes along a curve.
#[derive(Clone, Copy)]
enum Scan {
    /// Substeps at this many iterations each.
    Substeps(u32),
    /// Iterations of a single substep.
    Iterations,
    /// Target compressions of automatic substeps.
    Targets,
}

/// All curves.
pub const VARIANTS: &[Variant] = &[
    Variant { name: "default, n by target", change: |_| (), scan: Scan::Targets },
    Variant::over_substeps("h = 3 dx, taken early", |s| at(s, 3.0, GradientPoint::Early)),
    Variant::over_substeps("h = 2 dx, taken early", |s| at(s, 2.0, GradientPoint::Early)),
    Variant::over_substeps("h = 2.5 dx, taken early", |s| at(s, 2.5, GradientPoint::Early)),
    Variant::over_substeps("h = 4 dx, taken early", |s| at(s, 4.0, GradientPoint::Early)),
    Variant::over_substeps("h = 3 dx, gradients at the prediction", |s| at(s, 3.0, GradientPoint::Predicted)),
    Variant::over_substeps("h = 3 dx, gradients at the start", |s| at(s, 3.0, GradientPoint::Start)),
    Variant::over_substeps("h = 2 dx, gradients at the prediction", |s| at(s, 2.0, GradientPoint::Predicted)),
    Variant::over_substeps("h = 2 dx, gradients at the start", |s| at(s, 2.0, GradientPoint::Start)),
    Variant::over_substeps("cubic spline, h = 3 dx", |t| {
        (t.legacy.kernel, t.solver.kernel_radius) = (LegacyKernel::CubicSpline, 3.0);
    }),
    Variant { name: "h = 3 dx, 2 iterations", change: |t| t.solver.kernel_radius = 3.0, scan: Scan::Substeps(2) },
    Variant {
        name: "h = 3 dx, 1 substep, K iterations",
        change: |t| t.solver.kernel_radius = 3.0,
        scan: Scan::Iterations,
    },
    Variant {
        name: "Macklin & Müller 2013",
        change: |t| {
            at(t, 3.0, GradientPoint::Predicted);
            t.solver.relaxation = Some(1.0);
            t.legacy.kernel = LegacyKernel::Poly6Spiky;
            (t.legacy.constraint_mixing, t.legacy.artificial_pressure) = (1.0, 0.1);
        },
        scan: Scan::Iterations,
    },
    Variant { name: WITH_GRID, change: |t| t.solver.pressure_grid = PressureGridUse::On, scan: Scan::Targets },
];

/// Drawn, but does not count: its target bounds the way of a substep, not the compression.
const WITH_GRID: &str = "pressure grid, n by target";

/// Sets kernel radius and where the constraint is taken.
fn at(trial: &mut Trial, radius: f64, gradients: GradientPoint) {
    (trial.solver.kernel_radius, trial.solver.gradients) = (radius, Some(gradients));
}

impl Variant {
    /// A curve over substeps of one iteration each.
    const fn over_substeps(name: &'static str, change: fn(&mut Trial)) -> Variant {
        Variant { name, change, scan: Scan::Substeps(1) }
    }

    /// The trials along the curve.
    fn trials(&self, resolution: u32) -> Vec<Trial> {
        let fixed = |substeps: u32, iterations: u32| SolverSettings {
            substeps: Substeps::Fixed(substeps),
            iterations,
            ..SolverSettings::default()
        };
        let all: Vec<SolverSettings> = match self.scan {
            Scan::Substeps(iterations) => [4, 8, 16, 32].map(|n| fixed((n / iterations).max(1), iterations)).to_vec(),
            Scan::Iterations => [4, 8, 16, 32].map(|iterations| fixed(1, iterations)).to_vec(),
            Scan::Targets => [0.04, 0.02, 0.01, 0.005, 0.0025].map(plan::settings).to_vec(),
        };
        let trial = |solver| {
            let mut trial = Trial::new(resolution, solver);
            (self.change)(&mut trial);
            trial
        };
        all.into_iter().map(trial).collect()
    }
}

/// A point of a curve before it is drawn.
struct Timed {
    variant: &'static Variant,
    trial: Trial,
    /// Its worst C in the dam break.
    worst: f64,
    /// Outcome of each round; nothing once one has failed.
    outcomes: Vec<Outcome>,
}

impl Timed {
    /// Runs it once more, with a relaxation that differs by this part.
    fn run(&mut self, case: &'static Case, part: f64) {
        let mut trial = self.trial.clone();
        let solver = &mut trial.solver;
        // The water of all four cases.
        let water = Scene { solver: solver.clone(), liquid: vec![Liquid::new("water", 1000.0)], ..Scene::default() };
        let gradients = water.gradients();
        solver.relaxation = Some(solver.relaxation_of_liquids(gradients) * (1.0 + part));
        self.outcomes.extend(case.run_trial(&trial).ok());
    }

    /// Whether a figure of it is judged.
    fn counts(&self, norm: &Norm) -> bool {
        self.variant.name != WITH_GRID && (!norm.blind || self.worst <= HOLDS_WATER)
    }

    fn is_done(&self, rounds: u32) -> bool {
        self.outcomes.len() == rounds as usize
    }

    /// Least processor time \[s].
    fn time(&self) -> f64 {
        self.outcomes.iter().map(|outcome| outcome.cost.processor.as_secs_f64()).fold(f64::INFINITY, f64::min)
    }

    /// Size of the mean of a figure.
    fn error(&self, figure: &str) -> f64 {
        let values = self.outcomes.iter().map(|outcome| outcome.figure(figure).unwrap_or(f64::NAN));
        (values.sum::<f64>() / self.outcomes.len() as f64).abs()
    }
}

/// The points of a case.
pub struct Swept {
    case: &'static Case,
    resolution: u32,
    points: Vec<Timed>,
}

/// Runs all variants of a case.
pub fn sweep(case: &'static Case, resolution: u32, mut look: impl FnMut(&str)) -> Swept {
    let dam = dam_resolution(case, resolution);
    let timed = |variant: &'static Variant| {
        variant.trials(resolution).into_iter().map(move |trial| {
            let worst = worst_of_dam_break(dam, &trial);
            Timed { variant, trial, worst, outcomes: Vec::new() }
        })
    };
    let mut points: Vec<Timed> = VARIANTS.iter().flat_map(timed).collect();
    let rounds = rounds(case);
    for round in 0..rounds {
        let part = APART * (f64::from(round) - 0.5 * f64::from(rounds - 1));
        points.iter_mut().for_each(|point| point.run(case, part));
        look(&format!("{}: relaxation {:+} % done", case.name, 100.0 * part));
    }
    Swept { case, resolution, points }
}

/// Rounds of a case.
fn rounds(case: &Case) -> u32 {
    let by_chance = NORMS.iter().any(|norm| norm.case == case.name && norm.blind);
    if by_chance { MANY_ROUNDS } else { ROUNDS }
}

/// The resolution of the dam break that goes with this one of another case.
fn dam_resolution(case: &Case, resolution: u32) -> u32 {
    let full = CASES.iter().any(|&(name, _, full)| name == case.name && resolution >= full);
    let dam = CASES.iter().find(|(name, ..)| *name == DAM_BREAK);
    dam.map_or(resolution, |&(_, quick, size)| if full { size } else { quick })
}

fn worst_of_dam_break(resolution: u32, trial: &Trial) -> f64 {
    let trial = Trial { resolution, ..trial.clone() };
    let outcome = cases::find(DAM_BREAK).and_then(|case| case.run_trial(&trial).ok());
    outcome.and_then(|outcome| outcome.figure(WORST)).unwrap_or(f64::NAN)
}

impl Swept {
    /// The curves of one figure over processor time \[s], with the front marked, and their rows of the table.
    pub fn curves(&self, norm: &Norm) -> (Vec<Curve>, String) {
        let rounds = rounds(self.case);
        let done = || self.points.iter().filter(|point| point.is_done(rounds));
        let curve = |variant: &Variant| Curve {
            name: variant.name.to_owned(),
            points: done()
                .filter(|point| point.variant.name == variant.name)
                .map(|point| Point {
                    x: point.time(),
                    y: point.error(norm.figure),
                    counts: point.counts(norm),
                    best: false,
                })
                .collect(),
        };
        let mut curves: Vec<Curve> = VARIANTS.iter().map(curve).collect();
        mark_front(&mut curves, SCATTER);
        let mut csv = String::new();
        for (timed, point) in done().zip(curves.iter().flat_map(|curve| &curve.points)) {
            let substeps = match timed.trial.solver.substeps {
                Substeps::Fixed(substeps) => substeps.to_string(),
                Substeps::Auto => format!("auto {}", timed.trial.solver.target_compression),
            };
            let _ = writeln!(
                csv,
                "{},{},\"{}\",\"{}\",{substeps},{},{:.6e},{:.4},{:.4e},{:.4},{}",
                self.case.name,
                self.resolution,
                norm.figure,
                timed.variant.name,
                timed.trial.solver.iterations,
                point.y,
                point.x,
                timed.outcomes[0].cost.pair_visits,
                timed.worst,
                point.best
            );
        }
        (curves, csv)
    }
}

/// The first line of the table.
pub const HEADER: &str =
    "case,resolution,figure,curve,substeps,iterations,error,processor_s,pair_visits,worst_c_of_dam_break,on_front\n";

/// The picture of a sweep.
pub fn picture(norm: &Norm, curves: &[Curve]) -> String {
    log_log(&norm.picture.replace('_', " "), "processor time [s], one thread, least of all rounds", norm.axis, curves)
}

/// The cases of the sweep at these sizes.
pub fn cases(full: bool) -> impl Iterator<Item = (&'static Case, u32)> {
    CASES.into_iter().filter_map(move |(name, quick, size)| Some((cases::find(name)?, if full { size } else { quick })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_shows_a_figure_of_its_case() {
        for norm in NORMS {
            let case = cases::find(norm.case).expect("the case exists");
            let outcome = case.run(8, &SolverSettings::default()).expect("the case runs");
            assert!(outcome.figure(norm.figure).is_some(), "{}: {}", norm.case, norm.figure);
        }
    }
}
