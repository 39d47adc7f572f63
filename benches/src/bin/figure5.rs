//! Figure 5 of the original, drawn anew: mean time of a loop against the number of particles.
//!
//! `cargo run --release -p unipbd-benches --bin figure5 [sizes ...]` measures on this machine and writes
//! `docs/figure5.md` and `docs/images/figure5.svg`.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use unipbd_benches::growth::{self, Method, ORIGINAL, Point, SIZES};
use unipbd_validation::stamp::{machine, stamp};

/// Exponents are fitted from this size on: below, the cost of starting threads and stages counts.
const FITTED_FROM: usize = 1_600;
/// Particles times frames that are measured at least.
const WORK: usize = 400_000;

struct Curve {
    name: &'static str,
    what: &'static str,
    points: Vec<Point>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<usize> = std::env::args().skip(1).map(|size| size.parse()).collect::<Result<_, _>>()?;
    let sizes = if given.is_empty() { SIZES.to_vec() } else { given };
    let curves = [
        Curve {
            name: "original program",
            what: "one step, three iterations, all pairs searched",
            points: ORIGINAL.into(),
        },
        measured("seed settings", "the same method here: one step, three iterations", &sizes, Method::Original),
        measured("default", "substeps for at most 1 % compression", &sizes, Method::Default),
    ];
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    draw(&docs.join("images/figure5.svg"), &curves)?;
    std::fs::write(docs.join("figure5.md"), page(&curves))?;
    Ok(())
}

fn measured(name: &'static str, what: &'static str, sizes: &[usize], method: Method) -> Curve {
    let point = |&size: &usize| {
        let frames = (WORK / size.max(1)).clamp(2, 100) as u32;
        let point = growth::measure(&growth::two_liquids(size, method), frames);
        eprintln!("{name}: {} particles, {:.3} ms a frame", point.particles, point.milliseconds);
        point
    };
    Curve { name, what, points: sizes.iter().map(point).collect() }
}

fn draw(path: &Path, curves: &[Curve]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (760, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let range = |value: fn(&Point) -> f64| {
        let (low, high) = all().map(value).fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        low / 1.5..high * 1.5
    };
    let (x, y) = (range(|point| point.particles as f64), range(|point| point.milliseconds));
    let mut chart = ChartBuilder::on(&root)
        .caption("Time of a frame of 1/60 s", ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    let label = |value: &f64| format!("{value}");
    chart
        .configure_mesh()
        .x_desc("particles")
        .y_desc("milliseconds")
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .light_line_style(WHITE)
        .draw()?;
    for (curve, color) in curves.iter().zip([RGBColor(214, 39, 40), RGBColor(127, 127, 127), RGBColor(31, 119, 180)]) {
        let places = || curve.points.iter().map(|point| (point.particles as f64, point.milliseconds));
        let name = format!("{}, N^{:.2}", curve.name, growth::exponent(&curve.points, FITTED_FROM));
        chart
            .draw_series(LineSeries::new(places(), color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color.stroke_width(2)));
        chart.draw_series(places().map(|place| Circle::new(place, 3, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.9))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    Ok(())
}

fn page(curves: &[Curve]) -> String {
    let mut text = format!("{INTRODUCTION}Measured {}, on {}.\n\n", stamp(), machine());
    for curve in curves {
        let exponent = growth::exponent(&curve.points, FITTED_FROM);
        text += &format!("- **{}**: {}; grows as N^{exponent:.2} from {FITTED_FROM} on.\n", curve.name, curve.what);
    }
    text += "\n| particles | original program [ms] | seed settings [ms] | default [ms] |\n|---|---|---|---|\n";
    let mut sizes: Vec<usize> = curves.iter().flat_map(|curve| curve.points.iter().map(|p| p.particles)).collect();
    sizes.sort_unstable();
    sizes.dedup();
    for size in sizes {
        let cell = |curve: &Curve| {
            let point = curve.points.iter().find(|point| point.particles == size);
            point.map_or(String::new(), |point| format!("{:.3}", point.milliseconds))
        };
        let cells: Vec<String> = curves.iter().map(cell).collect();
        text += &format!("| {size} | {} |\n", cells.join(" | "));
    }
    text
}

const INTRODUCTION: &str = "\
# Figure 5: time of a loop against the number of particles

Written by `cargo run --release -p unipbd-benches --bin figure5`; do not edit by hand.

![Time of a frame against the number of particles](images/figure5.svg)

Two liquids side by side in a box, at the original's spacing, falling into place: mean time of a frame of
1/60 s on one thread, neighbour search included. The original's times were measured once, also on one
thread, of a machine with two cores; the others in this run.

";
