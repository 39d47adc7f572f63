//! unipbd beside other solvers, in one run: `benches/peers.sh` prepares all of them and starts this.
//!
//! `unipbd-peers --document FILE.md [--only liquids|bodies] [--chart FILE.svg] [--pictures FOLDER]`;
//! liquids: `[--particles 5000,20000] [--seconds 2] [--radius 3,2] [--grid no,yes] [--peers dfsph,salva,taichi,pbf]`;
//! bodies: `[--bodies 5000] [--settle 3] [--substeps 2x2,2x4,1x3] [--rows 100] [--stand 10]`.
//!
//! Each section of the document is written when it is measured. A solver that breaks, or does not use the settings that
//! it was given, ends the run with an error, and its section stays as it was.

mod bodies;
mod chart;
mod liquids;
mod options;
mod readback;

use std::process::ExitCode;

use options::option;
use unipbd_validation::document::{with_introduction, with_section};
use unipbd_validation::stamp::{machine, stamp};

const INTRODUCTION: &str = "\
# unipbd and its peers

Written by `benches/peers.sh`; do not edit by hand. A section is that of one run, all solvers in turn on one thread:
trust the ratios, not the times, and none below 1.2. Before it runs, each solver is asked for the settings that it uses,
and a run whose settings differ from those asked for fails.

Density errors C = rho/rho0 - 1 are those of a cubic spline over interior particles, the same for all, averaged over
time: the mean of max(C, 0) is called compression, that of max(-C, 0) dilation, and their sum, the mean of |C|, decides
which settings are compared. Interior means 2.5 spacings from walls and 3.75 below the surface. Of unipbd's settings only the
default is shown and those that no other one beats in both time and |C|. With the pressure grid the target bounds the way of
a substep, not the compression.

unipbd's steps are substeps, whose number it chooses. The others take fixed steps of 2 ms, or of a tenth of the spacing in
metres where that is less; their adaptive steps were not tried. SPlisHSPlasH is a 3D code in its 2D mode. The water of the
dam break still moves at the end, and the solvers damp it differently: hence the different centres of mass (0.3125 m at
rest at the rest density). The tables rank by the density error alone.

![processor time over that of unipbd at no larger density error](images/peers.svg)

![error against time, dam break](images/peers_dam_break_5000.svg)

![error against time, still tank](images/peers_still_tank_5041.svg)
";

fn main() -> ExitCode {
    // One thread for everybody; taichi and SPlisHSPlasH are told so by their scripts.
    let one = std::env::var("RAYON_NUM_THREADS").is_ok_and(|count| count == "1");
    assert!(one, "RAYON_NUM_THREADS=1 must be set: start by peers.sh");
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("broken: {why}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let only = option("--only", "all");
    if only != "bodies" {
        liquids::sections(write)?;
    }
    if only != "liquids" {
        for section in [bodies::heap_section, bodies::pyramid_section] {
            let (heading, body) = section()?;
            write(&heading, &body);
        }
    }
    Ok(())
}

/// Puts a section into the document, with where it comes from.
fn write(heading: &str, body: &str) {
    let command = option("--command", "unipbd-peers");
    let body = format!("By `{command}`, {}, on {}.\n\n{body}", stamp(), machine());
    println!("## {heading}\n\n{body}");
    let path = option("--document", "");
    if path.is_empty() {
        return;
    }
    let document = with_introduction(&std::fs::read_to_string(&path).unwrap_or_default(), INTRODUCTION);
    std::fs::write(&path, with_section(&document, heading, &body)).expect("the document can be written");
}
