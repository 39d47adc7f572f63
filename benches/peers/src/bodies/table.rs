//! The tables of bodies.

use super::box2d::Tuning;
use super::penetration::Penetration;
use super::{Engine, Kind, Run, Setup, alone, box2d, rapier, together, unipbd};
use crate::options::option;

/// Heaps that settle: heading and body of the section.
pub fn heap_section() -> Result<(String, String), String> {
    let count: usize = option("--bodies", "5000").parse().expect("--bodies takes a number");
    let seconds: f64 = option("--settle", "3").parse().expect("--settle takes a number");
    let mut text = String::from(
        "Overlap is that of two bodies, or of one and a wall, at the end: by separating axes from the poses of each engine; \
         the mean is that of each body's deepest. unipbd's substeps are those of a frame x iterations of each. Box2D's \
         slop is set by its unit of length, with which its speculative margin shrinks too.\n\n\
         | bodies | engine | processor time per frame [ms] | over the first row | deepest overlap [mm] | mean [mm] |\n\
         |---|---|---|---|---|---|\n",
    );
    for kind in [Kind::Discs, Kind::Boxes] {
        let setup = Setup::heap(kind, count);
        let mut engines: Vec<Box<dyn Engine>> = Vec::new();
        for setting in settings() {
            engines.push(unipbd::engine(&setup, setting)?);
        }
        engines.push(rapier::engine(&setup, 4)?);
        engines.push(box2d::engine(&setup, Tuning::DEFAULT)?);
        engines.push(box2d::engine(&setup, Tuning::STIFF)?);
        let runs = together(&setup, engines, seconds)?;
        let first = runs[0].milliseconds;
        for Run { name, milliseconds, penetration, .. } in runs {
            text += &format!(
                "| {} | {name} | {milliseconds:.2} | {:.2} | {} |\n",
                kind.name(),
                milliseconds / first,
                depths(penetration)
            );
        }
    }
    Ok((format!("{count} bodies of 0.5 m settle, {seconds} s"), text))
}

/// Two cells of a row [mm].
fn depths(of: Penetration) -> String {
    format!("{:.1} | {:.2}", 1e3 * of.deepest, 1e3 * of.mean)
}

/// unipbd's substeps and iterations, such as `4x1,3x2`.
fn settings() -> Vec<(u32, u32)> {
    let number = |text: &str| text.parse::<u32>().expect("--substeps takes substeps x iterations, such as 4x1,3x2");
    let setting = |text: &str| text.split_once('x').map_or_else(|| (number(text), 1), |(n, k)| (number(n), number(k)));
    option("--substeps", "2x2,2x4,1x3").split(',').map(setting).collect()
}

/// A pyramid that should stand: more substeps until it does.
pub fn pyramid_section() -> Result<(String, String), String> {
    const SUBSTEPS: [u32; 8] = [2, 3, 4, 6, 8, 16, 32, 64];
    let rows: usize = option("--rows", "100").parse().expect("--rows takes a number");
    let seconds: f64 = option("--stand", "10").parse().expect("--stand takes a number");
    let setup = Setup::pyramid(rows);
    let mut text = String::from(
        "It stands where its top stays within half a box of its place; a run ends where it does not. Overlap as above.\n\n\
         | engine | stands | processor time per frame [ms] | deepest overlap [mm] | mean [mm] |\n|---|---|---|---|---|\n",
    );
    let mut row = |run: &Run| {
        let stands = if run.stands { "yes" } else { "no" };
        text += &format!("| {} | {stands} | {:.1} | {} |\n", run.name, run.milliseconds, depths(run.penetration));
    };
    // As many iterations as by default.
    let mine = |substeps: u32| unipbd::engine(&setup, (substeps, 2));
    let rapier = |substeps: u32| rapier::engine(&setup, substeps);
    let more: [&dyn Fn(u32) -> Result<Box<dyn Engine>, String>; 2] = [&mine, &rapier];
    for engine in more {
        for substeps in SUBSTEPS {
            let run = alone(&setup, engine(substeps)?, seconds)?;
            row(&run);
            if run.stands {
                break;
            }
        }
    }
    for tuning in [Tuning::DEFAULT, Tuning::STIFF] {
        row(&alone(&setup, box2d::engine(&setup, tuning)?, seconds)?);
    }
    Ok((format!("A pyramid of {} boxes for {seconds} s", setup.places.len()), text))
}
