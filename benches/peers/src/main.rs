//! unipbd beside other solvers, in one run: `benches/peers.sh` prepares all of them and starts this.
//!
//! `unipbd-peers [--particles 5000,20000] [--seconds 2] [--bodies 5000] [--rows 100] [--only liquids|bodies] [--pbf yes]
//! [--radius 3,2] [--coarse no,yes] [--peers dfsph,salva,taichi] [--substeps 4x1,3x2]
//! [--chart FILE.svg] [--pictures FOLDER]`

mod case;
mod chart;
mod liquids;
mod python;
mod rigid;

use std::io::Write;

use case::{Case, Outcome};
use liquids::Setting;
use rigid::{Kind, Settled};

/// Target compressions that unipbd tries, the loosest first.
const TARGETS: [f64; 8] = [0.1, 0.03, 0.02, 0.01, 0.006, 0.005, 0.003, 0.001];

fn option(name: &str, default: &str) -> String {
    let arguments: Vec<String> = std::env::args().collect();
    let place = arguments.iter().position(|argument| argument == name);
    place.and_then(|place| arguments.get(place + 1)).cloned().unwrap_or_else(|| default.to_owned())
}

fn main() {
    // One thread for everybody; taichi and SPlisHSPlasH are told so by their scripts.
    let one = std::env::var("RAYON_NUM_THREADS").is_ok_and(|count| count == "1");
    assert!(one, "RAYON_NUM_THREADS=1 must be set: start by peers.sh");
    println!("# unipbd and its peers\n");
    println!(
        "Written by `benches/peers.sh`; do not edit by hand. One thread each, all in one run on one machine: trust\nthe ratios, not the times. Mean compression is that of a cubic spline over interior particles, averaged over time.\n"
    );
    let (only, mut bars) = (option("--only", "all"), Vec::new());
    let seconds: f64 = option("--seconds", "2").parse().expect("--seconds takes a number");
    if only != "bodies" {
        for size in option("--particles", "5000").split(',') {
            let size: usize = size.parse().expect("--particles takes numbers");
            for case in [Case::dam_break(size, seconds), Case::still_tank(size, seconds)] {
                liquids_table(&case, &mut bars);
            }
        }
        if let Some(path) = Some(option("--chart", "")).filter(|path| !path.is_empty()) {
            std::fs::write(path, chart::bars("Time per simulated second, over unipbd at the same compression", &bars))
                .expect("the chart can be written");
        }
    }
    if only != "liquids" {
        bodies_tables();
    }
}

/// Every peer on a case, and unipbd at the loosest target that compresses no more than it.
fn liquids_table(case: &Case, bars: &mut Vec<(String, f64)>) {
    let particles = case.lattice().len();
    println!("## {} of {particles} particles, {} s\n", case.name, case.seconds);
    let radii = option("--radius", "3,2");
    let radii = radii.split(',').map(|radius| radius.parse::<f64>().expect("--radius takes numbers"));
    let coarse = option("--coarse", "no,yes");
    let coarse: Vec<bool> = coarse.split(',').map(|word| word == "yes").collect();
    let settings = radii.flat_map(|radius| TARGETS.map(|target| (radius, target)));
    let settings =
        settings.flat_map(|(radius, target)| coarse.iter().map(move |&coarse| Setting { radius, target, coarse }));
    let ours: Vec<Outcome> = settings.map(|setting| liquids::unipbd(case, setting)).collect();
    let dt = (0.1 * case.dx).min(0.002);
    let asked = option("--peers", "dfsph,salva,taichi");
    let asked = |name: &str| asked.split(',').any(|peer| peer == name);
    let python = |name: &str, short: &str, script: &str, setting: &str| {
        let outcome = if asked(short) { python::peer(case, script, setting) } else { Err("not asked for".to_owned()) };
        outcome.map_err(|why| format!("{name}: skipped, {why}"))
    };
    let mut peers = vec![python("SPlisHSPlasH DFSPH", "dfsph", "splishsplash.py", "dfsph:0.1")];
    if asked("salva") {
        peers.extend([0.001, 0.003, 0.01, 0.05].map(|error| Ok(liquids::salva(case, error, dt))));
    } else {
        peers.push(Err("salva2d: skipped, not asked for".to_owned()));
    }
    peers.push(python("taichi", "taichi", "taichi_pbf.py", "1"));
    peers.push(if option("--pbf", "no") == "yes" {
        python::peer(case, "splishsplash.py", "pbf").map_err(|why| format!("SPlisHSPlasH PBF: skipped, {why}"))
    } else {
        Err("SPlisHSPlasH PBF: skipped, it takes minutes; ask for it by --pbf yes".to_owned())
    });
    println!(
        "| solver | processor time per simulated second [s] | steps | mean compression | centre of mass [m] | unipbd no more compressed | times faster |\n|---|---|---|---|---|---|---|"
    );
    let row = |of: &Outcome, end: String| {
        let per_second = of.time / case.seconds;
        println!(
            "| {} | {per_second:.3} | {} | {:.2} % | {:.4} | {end} |",
            of.solver,
            of.steps,
            100.0 * of.mean_compression(),
            of.height
        );
    };
    ours.iter().for_each(|of| row(of, " | ".into()));
    let (mut notes, mut curves) = (Vec::new(), chart::curves(&ours, case.seconds));
    for peer in peers {
        let peer = match peer {
            Ok(peer) => peer,
            Err(note) => {
                notes.push(note);
                continue;
            }
        };
        curves.extend(chart::curves(std::slice::from_ref(&peer), case.seconds));
        let error = peer.mean_compression();
        match ours.iter().filter(|of| of.mean_compression() <= error).min_by(|a, b| a.time.total_cmp(&b.time)) {
            Some(of) => {
                let ratio = peer.time / of.time;
                row(&peer, format!("{} | {ratio:.1}", of.solver.trim_start_matches("unipbd, ")));
                bars.push((format!("{}, {} {particles}", peer.solver, case.name), ratio));
            }
            None => row(&peer, "none | -".into()),
        }
    }
    let folder = option("--pictures", "");
    if !folder.is_empty() {
        let path = format!("{folder}/peers_{}_{particles}.svg", case.name.replace(' ', "_"));
        std::fs::write(&path, chart::errors(case, particles, &mut curves)).expect("the picture can be written");
    }
    std::io::stdout().flush().expect("the table can be written");
    println!();
    notes.iter().for_each(|note| println!("- {note}"));
    println!();
}

fn bodies_tables() {
    let count: usize = option("--bodies", "5000").parse().expect("--bodies takes a number");
    let rows: usize = option("--rows", "100").parse().expect("--rows takes a number");
    let seconds: f64 = option("--settle", "5").parse().expect("--settle takes a number");
    let substeps = option("--substeps", "2x1,3x1,4x1,3x2,4x2");
    let number = |text: &str| text.parse::<u32>().expect("--substeps takes substeps x iterations, such as 4x1,3x2");
    let setting = |text: &str| text.split_once('x').map_or_else(|| (number(text), 1), |(n, k)| (number(n), number(k)));
    let substeps: Vec<(u32, u32)> = substeps.split(',').map(setting).collect();
    println!("## {count} bodies of 0.5 m settle, {seconds} s\n");
    println!(
        "| bodies | solver | substeps x iterations | processor time per frame [ms] | penetration [m] |\n|---|---|---|---|---|"
    );
    for (name, kind) in [("discs", Kind::Discs), ("boxes", Kind::Boxes)] {
        for (substeps, of) in rigid::settle(kind, count, seconds, &substeps) {
            let Settled { solver, milliseconds, penetration, .. } = of;
            println!("| {name} | {solver} | {substeps} | {milliseconds:.2} | {penetration:.4} |");
        }
    }
    let stand: f64 = option("--stand", "10").parse().expect("--stand takes a number");
    println!("\n## A pyramid of {} boxes for {stand} s\n", rows * (rows + 1) / 2);
    println!("| solver | substeps | stands | processor time per frame [ms] | penetration [m] |\n|---|---|---|---|---|");
    for solver in [rigid::stand, rigid::stand_peer] {
        for substeps in [2, 4, 8, 16, 32, 64] {
            let Settled { solver, milliseconds, penetration, stands } = solver(rows, stand, substeps);
            println!(
                "| {solver} | {substeps} | {} | {milliseconds:.1} | {penetration:.4} |",
                if stands { "yes" } else { "no" }
            );
            if stands {
                break;
            }
        }
    }
}
