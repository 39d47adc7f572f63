//! Writes `docs/performance.md` anew from measurements on this machine.
//!
//! `cargo run --release -p unipbd-benches --bin report [sizes ...] > docs/performance.md`

use unipbd_benches::steps::{self, Measured};
use unipbd_benches::{on_two_threads, roofline, sleep};
use unipbd_core::simd::Level;
use unipbd_validation::stamp::{machine, stamp};

fn main() {
    let given: Vec<usize> = std::env::args().skip(1).filter_map(|size| size.parse().ok()).collect();
    let sizes = if given.is_empty() { vec![1_000, 10_000, 100_000, 1_000_000] } else { given };
    println!("{INTRODUCTION}");
    println!("Measured {}, on {}.\n", stamp(), machine());
    println!("## Passes\n\n{PASSES}\n");
    // Most machines have AVX2 but not AVX-512.
    let mut levels = vec![Level::best()];
    levels.extend((Level::best() == Level::Avx512).then_some(Level::Avx2));
    on_two_threads(|| {
        for rows in [10_000, 100_000] {
            println!("{}", roofline::report(rows, &levels));
        }
        println!("{}", roofline::report(1_000_000, &[Level::best()]));
    });
    let measured: Vec<Measured> = sizes.iter().map(|&size| steps::measure(size, frames(size))).collect();
    println!("## Steps\n\n{STEPS}\n\n{}", step_table(&measured));
    if let [.., small, _, large] = &measured[..] {
        println!("{}\n", growth_line(small, large));
    }
    println!("{}", stage_table(&measured));
    println!("## Sleep\n\n{}", sleep_line());
    println!("\nLoad of the machine while this was written, 1 and 5 minutes: {}.", load());
    println!("\n## Elsewhere\n\n{ELSEWHERE}");
}

fn load() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').take(2).collect::<Vec<_>>().join(", ")
}

fn sleep_line() -> String {
    match sleep::measure(1500) {
        Some([awake, asleep]) => format!(
            "A pool of 10,000 particles at rest, 8 substeps a frame: {awake:.2} ms per frame awake, {asleep:.3} ms \
             asleep, {:.2} % (bar 2 %).",
            100.0 * asleep / awake
        ),
        None => "The pool did not come to rest.".to_owned(),
    }
}

const INTRODUCTION: &str = "\
# Performance

Written by `cargo run --release -p unipbd-benches --bin report > docs/performance.md`; do not edit by
hand. Everything in a table is measured in turn in one run, so that a slow moment of the machine hits
all of it: trust the ratios, not the nanoseconds. Speed-ups by threads mean nothing while others use the
machine. The bars are what the project asks of itself; figures below them are not met.
";

const ELSEWHERE: &str = "\
- Other solvers in one run: [peers.md](peers.md), by `benches/peers.sh`.
- Instructions of a frame by part of the library, those that a scene does not use among them:
  `python benches/python/instructions.py` (needs valgrind).
- What a log of 60 frames per second costs: `python benches/python/recording.py`.";

const PASSES: &str = "\
A lattice with random shifts, h = 2 dx. \"Scalar\" is a plain loop over vectors and a compressed list of
the same pairs; the roofline is a loop of nothing but one exact square root per slot of the list, eight
at a time, as the kernel needs no quotient. A whole step is the sort, the list, four iterations of density and correction,
and viscosity. Results have the same bits on every instruction set and number of threads.";

const STEPS: &str = "\
A dam break with viscosity, h = 3 dx, one iteration a substep, list builds included; nanoseconds per
particle and substep, the least over the frames.";

fn frames(size: usize) -> u32 {
    (2_000_000 / size.max(1)).clamp(3, 100) as u32
}

fn step_table(measured: &[Measured]) -> String {
    let mut text =
        "| particles | 1 thread [ns] | 2 threads [ns] | speed-up (bar 1.7 at 100k, 1.5 at 10k) | bytes per particle (aim 200) |\n|---|---|---|---|---|\n"
            .to_owned();
    for Measured { particles, least: [one, two], bytes, .. } in measured {
        text += &format!("| {particles} | {one:.1} | {two:.1} | {:.2} | {bytes:.0} |\n", one / two);
    }
    text
}

fn growth_line(small: &Measured, large: &Measured) -> String {
    let exponent = steps::growth(small, large);
    format!(
        "From {} to {} particles the time of a substep grows with the power {exponent:.3} (bar 1.05).",
        small.particles, large.particles
    )
}

fn stage_table(measured: &[Measured]) -> String {
    let sizes = measured.iter().map(|of| format!(" {} |", of.particles)).collect::<String>();
    let mut text = format!("| stage, 1 thread, mean [ns] |{sizes}\n|---|{}\n", "---|".repeat(measured.len()));
    for (index, (name, _)) in measured[0].stages.iter().enumerate() {
        let cells =
            measured.iter().map(|of| of.stages.get(index).map_or_else(String::new, |(_, time)| format!("{time:.1}")));
        text += &format!("| {name} |{}\n", cells.map(|cell| format!(" {cell} |")).collect::<String>());
    }
    text
}
