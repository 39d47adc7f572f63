//! The tables of liquids.

use super::python::python;
use super::salva::salva;
use super::unipbd::{Setting, unipbd};
use super::{Case, Outcome, Solver, race};
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
    let settings = settings();
    let ours = race(case, &mut build(case, &settings)?)?;
    let is_best = |of: &Outcome| !ours.iter().any(|other| of.is_beaten_by(other));
    let shown = |(setting, of): &(Setting, &Outcome)| setting.is_default() || is_best(of);
    let shown: Vec<(Setting, &Outcome)> = settings.into_iter().zip(&ours).filter(shown).collect();
    let best: Vec<Setting> = shown.iter().map(|(setting, _)| *setting).collect();
    let mut text = HEAD.to_owned();
    shown.iter().for_each(|(_, of)| text += &row(case, of, " | "));
    let mut peers = Vec::new();
    for start in asked_for() {
        // Once more with each peer: so that both are timed in the same moments.
        let mut solvers = build(case, &best)?;
        solvers.push(start(case)?);
        let mut outcomes = race(case, &mut solvers)?;
        let peer = outcomes.pop().expect("the peer was raced");
        let good = outcomes.iter().filter(|of| of.errors.mean() <= peer.errors.mean());
        let end = match good.min_by(|a, b| a.time.total_cmp(&b.time)) {
            Some(of) => {
                let ratio = peer.time / of.time;
                bars.push((format!("{}, {} {}", peer.solver, case.name, case.lattice().len()), ratio));
                format!("{} | {ratio:.1}", of.solver.trim_start_matches("unipbd, "))
            }
            None => "none | -".to_owned(),
        };
        text += &row(case, &peer, &end);
        peers.push(peer);
    }
    draw(case, &ours, &peers)?;
    Ok(text)
}

fn row(case: &Case, of: &Outcome, end: &str) -> String {
    let percent = |value: f64| format!("{:.2} %", 100.0 * value);
    let errors = [of.errors.mean_compression(), of.errors.mean_dilation(), of.errors.mean()].map(percent).join(" | ");
    let Outcome { solver, steps, height, .. } = of;
    format!("| {solver} | {:.3} | {steps} | {errors} | {height:.4} | {end} |\n", of.time / case.seconds)
}

/// unipbd's settings.
fn settings() -> Vec<Setting> {
    let radii = option("--radius", "3,2");
    let radii = radii.split(',').map(|radius| radius.parse::<f64>().expect("--radius takes numbers"));
    let grid = option("--grid", "no,yes");
    let grid: Vec<bool> = grid.split(',').map(|word| word == "yes").collect();
    let with = |radius: f64, target: f64| grid.iter().map(move |&grid| Setting { radius, target, grid });
    radii.flat_map(|radius| TARGETS.into_iter().flat_map(move |target| with(radius, target))).collect()
}

fn build(case: &Case, settings: &[Setting]) -> Result<Vec<Box<dyn Solver>>, String> {
    settings.iter().map(|&setting| unipbd(case, setting)).collect()
}

type Start = Box<dyn Fn(&Case) -> Result<Box<dyn Solver>, String>>;

/// The peers of `--peers`, each to be started when it is its turn.
fn asked_for() -> Vec<Start> {
    let splish = |setting: String| -> Start { Box::new(move |case| python(case, "splishsplash.py", &setting)) };
    let peers = |name: &str| -> Vec<Start> {
        match name {
            "dfsph" => DFSPH.iter().map(|error| splish(format!("dfsph:{error}"))).collect(),
            "salva" => SALVA.iter().map(|&error| -> Start { Box::new(move |case| salva(case, error)) }).collect(),
            "taichi" => vec![Box::new(|case| python(case, "taichi_pbf.py", "1"))],
            "pbf" => vec![splish("pbf".to_owned())],
            _ => panic!("there is no peer {name}: --peers takes dfsph, salva, taichi and pbf"),
        }
    };
    option("--peers", "dfsph,salva,taichi").split(',').flat_map(peers).collect()
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
