//! The tables of liquids.

use super::unipbd::{Setting, unipbd};
use super::{Case, Outcome, python, salva};
use crate::chart;
use crate::options::option;

/// Target compressions that unipbd tries, the loosest first.
const TARGETS: [f64; 8] = [0.1, 0.03, 0.02, 0.01, 0.006, 0.005, 0.003, 0.001];
/// Largest density errors of SPlisHSPlasH's DFSPH, the first its default [%].
const DFSPH: [&str; 3] = ["0.01", "0.1", "1"];
/// Largest density errors of salva2d's DFSPH, the last its default.
const SALVA: [f64; 4] = [0.001, 0.003, 0.01, 0.05];

const HEAD: &str = "\
| solver | processor time per simulated second [s] | steps | compression | dilation | mean of abs. C | centre of mass [m] | unipbd at no larger C | times faster |
|---|---|---|---|---|---|---|---|---|
";

/// Both cases at each number of particles: headings and bodies, and a picture of how much faster unipbd is.
pub fn sections(mut write: impl FnMut(&str, &str)) -> Result<(), String> {
    let seconds: f64 = option("--seconds", "2").parse().expect("--seconds takes a number");
    let mut bars = Vec::new();
    for size in option("--particles", "5000").split(',') {
        let size: usize = size.parse().expect("--particles takes numbers");
        for case in [Case::dam_break(size, seconds), Case::still_tank(size, seconds)] {
            let particles = case.lattice().len();
            let beside = option("--peers", "");
            let beside = if beside.is_empty() { beside } else { format!(", beside {beside}") };
            let body = section(&case, &mut bars)?;
            write(&format!("{} of {particles} particles, {seconds} s{beside}", capital(case.name)), &body);
        }
    }
    let path = option("--chart", "");
    if path.is_empty() || bars.is_empty() {
        return Ok(());
    }
    let title = "Processor time over that of unipbd at no larger density error";
    std::fs::write(path, chart::bars(title, &bars)).map_err(|error| error.to_string())
}

fn capital(name: &str) -> String {
    let (first, rest) = name.split_at(1);
    first.to_uppercase() + rest
}

/// Every peer on a case, and the quickest unipbd whose density error is no larger.
fn section(case: &Case, bars: &mut Vec<(String, f64)>) -> Result<String, String> {
    let (ours, (peers, notes)) = (ours(case)?, peers(case)?);
    let mut text = HEAD.to_owned();
    let best = ours.iter().filter(|of| !ours.iter().any(|other| of.is_beaten_by(other)));
    best.for_each(|of| text += &row(case, of, " | "));
    for peer in &peers {
        let good = ours.iter().filter(|of| of.errors.mean() <= peer.errors.mean());
        let end = match good.min_by(|a, b| a.time.total_cmp(&b.time)) {
            Some(of) => {
                let ratio = peer.time / of.time;
                bars.push((format!("{}, {} {}", peer.solver, case.name, case.lattice().len()), ratio));
                format!("{} | {ratio:.1}", of.solver.trim_start_matches("unipbd, "))
            }
            None => "none | -".to_owned(),
        };
        text += &row(case, peer, &end);
    }
    draw(case, &ours, &peers)?;
    notes.iter().for_each(|note| text += &format!("\n- {note}"));
    Ok(text)
}

fn row(case: &Case, of: &Outcome, end: &str) -> String {
    let percent = |value: f64| format!("{:.2} %", 100.0 * value);
    let errors = [of.errors.mean_compression(), of.errors.mean_dilation(), of.errors.mean()].map(percent).join(" | ");
    let Outcome { solver, steps, height, .. } = of;
    format!("| {solver} | {:.3} | {steps} | {errors} | {height:.4} | {end} |\n", of.time / case.seconds)
}

/// unipbd by all settings.
fn ours(case: &Case) -> Result<Vec<Outcome>, String> {
    let radii = option("--radius", "3,2");
    let radii = radii.split(',').map(|radius| radius.parse::<f64>().expect("--radius takes numbers"));
    let coarse = option("--coarse", "no,yes");
    let coarse: Vec<bool> = coarse.split(',').map(|word| word == "yes").collect();
    let with = |radius: f64, target: f64| coarse.iter().map(move |&coarse| Setting { radius, target, coarse });
    let settings = radii.flat_map(|radius| TARGETS.into_iter().flat_map(move |target| with(radius, target)));
    settings.map(|setting| unipbd(case, setting)).collect()
}

/// The peers that were asked for, and a note on each of the others. One that breaks is an error.
fn peers(case: &Case) -> Result<(Vec<Outcome>, Vec<String>), String> {
    let asked = option("--peers", "dfsph,salva,taichi");
    let asked = |name: &str| asked.split(',').any(|peer| peer == name);
    let (mut peers, mut notes) = (Vec::new(), Vec::new());
    let mut add = |name: &str, what: &str, runs: &mut dyn FnMut() -> Result<Vec<Outcome>, String>| {
        if asked(name) {
            peers.extend(runs()?);
        } else {
            notes.push(format!("{what}: not asked for (`--peers {name}`)."));
        }
        Ok::<(), String>(())
    };
    let splish = |setting: String| python::peer(case, "splishsplash.py", &setting);
    add("dfsph", "SPlisHSPlasH's DFSPH", &mut || DFSPH.iter().map(|error| splish(format!("dfsph:{error}"))).collect())?;
    add("salva", "salva2d", &mut || SALVA.iter().map(|&error| salva::salva(case, error)).collect())?;
    add("taichi", "taichi's pbf2d", &mut || Ok(vec![python::peer(case, "taichi_pbf.py", "1")?]))?;
    add("pbf", "SPlisHSPlasH's PBF", &mut || Ok(vec![splish("pbf".to_owned())?]))?;
    Ok((peers, notes))
}

/// All solvers on one picture.
fn draw(case: &Case, ours: &[Outcome], peers: &[Outcome]) -> Result<(), String> {
    let folder = option("--pictures", "");
    if folder.is_empty() {
        return Ok(());
    }
    let particles = case.lattice().len();
    let mut curves = chart::curves(ours, case.seconds);
    curves.extend(chart::curves(peers, case.seconds));
    let path = format!("{folder}/peers_{}_{particles}.svg", case.name.replace(' ', "_"));
    std::fs::write(path, chart::errors(case, particles, &mut curves)).map_err(|error| error.to_string())
}
