//! Whole frames of the solver by scene, size and threads: particles times substeps per second.
//!
//! `cargo bench -p unipbd-benches --features criterion --bench steps`
#![allow(missing_docs)]

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use unipbd_benches::{dam_break, pool, solver};
use unipbd_core::scene::{Scene, SolverSettings, Substeps};

const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
const SUBSTEPS: u32 = 2;

fn steps(criterion: &mut Criterion) {
    let scenes: [(&str, fn(usize) -> Scene); 2] = [("dam_break", dam_break), ("pool", pool)];
    for (name, scene) in scenes {
        let mut group = criterion.benchmark_group(name);
        group.sampling_mode(SamplingMode::Flat).sample_size(10);
        for size in SIZES {
            // As fast frames as a run of this size has substeps, so that the motion of one is realistic.
            let scene = Scene {
                fps: 60.0 * (size as f64).sqrt() / 4.0,
                solver: SolverSettings { substeps: Substeps::Fixed(SUBSTEPS), ..SolverSettings::default() },
                ..scene(size)
            };
            for threads in [1, 2] {
                let mut solver = solver(&scene, threads);
                let particles = solver.positions().len() as u64;
                group.throughput(Throughput::Elements(particles * u64::from(SUBSTEPS)));
                group.bench_function(BenchmarkId::new(format!("threads_{threads}"), size), |bencher| {
                    bencher.iter(|| solver.step_frame().expect("the scene stays calm"));
                });
            }
        }
        group.finish();
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
