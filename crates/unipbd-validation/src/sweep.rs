//! Run time against error: kernels, substeps, iterations and solver options on one picture per case.

use std::fmt::Write;

use unipbd_core::scene::{GradientPoint, KernelKind, SolverSettings, Substeps};

use crate::case::Case;
use crate::cases;
use crate::chart::{Curve, Point, log_log, mark_front};

/// The cases of the sweep, with the resolutions of the quick and the full one.
pub const CASES: [(&str, u32, u32); 4] =
    [("column", 12, 30), ("dam_break", 10, 20), ("standing_wave", 24, 64), ("floating_box", 8, 16)];

/// A way of solving: one curve over the numbers of substeps or iterations.
pub struct Variant {
    /// Name of the curve.
    pub name: &'static str,
    change: fn(&mut SolverSettings),
    scan: Scan,
}

/// What changes along a curve.
#[derive(Clone, Copy)]
enum Scan {
    /// Substeps at this many iterations each.
    Substeps(u32),
    /// Iterations of a single substep.
    Iterations,
}

/// All curves.
pub const VARIANTS: &[Variant] = &[
    Variant { name: "Wendland, h = 3 dx (default)", change: |_| (), scan: Scan::Substeps(1) },
    Variant { name: "Wendland, h = 2 dx", change: |s| s.kernel_radius = 2.0, scan: Scan::Substeps(1) },
    Variant { name: "Wendland, h = 2.5 dx", change: |s| s.kernel_radius = 2.5, scan: Scan::Substeps(1) },
    Variant { name: "Wendland, h = 4 dx", change: |s| s.kernel_radius = 4.0, scan: Scan::Substeps(1) },
    Variant { name: "taken half way", change: |s| s.gradients = Some(GradientPoint::Middle), scan: Scan::Substeps(1) },
    Variant {
        name: "gradients at the start",
        change: |s| s.gradients = Some(GradientPoint::Start),
        scan: Scan::Substeps(1),
    },
    Variant { name: "cubic spline", change: |s| s.kernel = KernelKind::CubicSpline, scan: Scan::Substeps(1) },
    Variant { name: "2 iterations", change: |_| (), scan: Scan::Substeps(2) },
    Variant { name: "1 substep, K iterations", change: |_| (), scan: Scan::Iterations },
    Variant {
        name: "Macklin & Müller 2013",
        change: |s| {
            s.kernel = KernelKind::Poly6Spiky;
            s.relaxation = Some(1.0);
            (s.constraint_mixing, s.artificial_pressure) = (1.0, 0.1);
        },
        scan: Scan::Iterations,
    },
];

impl Variant {
    /// The settings along the curve.
    fn settings(&self) -> Vec<SolverSettings> {
        let with = |substeps: u32, iterations: u32| {
            let mut settings =
                SolverSettings { substeps: Substeps::Fixed(substeps), iterations, ..SolverSettings::default() };
            (self.change)(&mut settings);
            settings
        };
        match self.scan {
            Scan::Substeps(iterations) => {
                [4, 8, 16, 32].into_iter().map(|n| with((n / iterations).max(1), iterations)).collect()
            }
            Scan::Iterations => [4, 8, 16, 32].into_iter().map(|iterations| with(1, iterations)).collect(),
        }
    }
}

/// Runs all variants of a case; gives the curves over wall time [s] and a table.
pub fn sweep(case: &'static Case, resolution: u32, mut look: impl FnMut(&str)) -> (Vec<Curve>, String) {
    let mut curves = Vec::new();
    let mut rows = Vec::new();
    // Warms the processor: else the first curve pays for it.
    VARIANTS[0].settings().iter().for_each(|settings| drop(case.run(resolution, settings)));
    for variant in VARIANTS {
        let mut points = Vec::new();
        for settings in variant.settings() {
            let Ok(outcome) = case.run(resolution, &settings) else {
                look(&format!("{}: {} fails", case.name, variant.name));
                continue;
            };
            let seconds = outcome.cost.wall.as_secs_f64();
            let Substeps::Fixed(substeps) = settings.substeps else { continue };
            look(&format!(
                "{}: {}, n = {substeps}, K = {}: error {:.3e}, {seconds:.2} s",
                case.name,
                variant.name,
                settings.iterations,
                outcome.error()
            ));
            rows.push((variant.name, substeps, settings.iterations, outcome.cost.pair_visits));
            points.push(Point { x: seconds, y: outcome.error(), best: false });
        }
        curves.push(Curve { name: variant.name.to_owned(), points });
    }
    mark_front(&mut curves);
    let mut csv = String::new();
    let points = curves.iter().flat_map(|curve| &curve.points);
    for ((name, substeps, iterations, visits), point) in rows.into_iter().zip(points) {
        let _ = writeln!(
            csv,
            "{},{resolution},\"{name}\",{substeps},{iterations},{:.6e},{:.4},{visits:.4e},{}",
            case.name, point.y, point.x, point.best
        );
    }
    (curves, csv)
}

/// The first line of the table.
pub const HEADER: &str = "case,resolution,curve,substeps,iterations,error,wall_s,pair_visits,on_front\n";

/// The picture of a sweep.
pub fn picture(case: &Case, curves: &[Curve]) -> String {
    let norm = match case.name {
        "standing_wave" => "decay per period",
        "floating_box" => "largest draft error [dx]",
        _ => "mean of max(C, 0), by the kernel of each curve",
    };
    log_log(&case.name.replace('_', " "), "wall time [s], one thread", norm, curves)
}

/// The cases of the sweep at these sizes.
pub fn cases(full: bool) -> impl Iterator<Item = (&'static Case, u32)> {
    CASES.into_iter().filter_map(move |(name, quick, size)| Some((cases::find(name)?, if full { size } else { quick })))
}
