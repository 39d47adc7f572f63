//! Every pass over pairs, the sort and the list build: particles per second.
//!
//! `cargo bench -p unipbd-benches --features criterion --bench passes`
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use unipbd_benches::Lattice;
use unipbd_core::kernel::WendlandC2;
use unipbd_core::neighbors::{Grid, NeighborList};
use unipbd_core::parallel::Parallelism;
use unipbd_core::passes::{
    DensityInput, DensityOutput, Pairs, Reach, Records, Weights, correction, density, difference_gradient, laplacian,
    repulsion, vorticity, xsph, xsph_mixed,
};
use unipbd_core::periodic::Periodic;
use unipbd_core::{Real, Vector};

const SIZES: [usize; 2] = [10_000, 100_000];

/// Kernel radius over spacing.
const RADIUS: Real = 2.0;

fn passes(criterion: &mut Criterion) {
    for rows in SIZES {
        let set = Lattice::new(rows, RADIUS);
        let pairs = Pairs::new(&set.list, Periodic::NONE, Parallelism::Serial);
        let kernel = WendlandC2::new(f64::from(RADIUS));
        let (mut vectors, mut a, mut b) = (vec![Vector::ZERO; rows], vec![0.0; rows], vec![0.0; rows]);
        let traits: Vec<_> = set.field.iter().map(|&value| Vector::new(0.1, 1.0 + value)).collect();
        let one = Weights::Uniform(1.0);
        let [mut r1, mut r2, mut r3, mut r4] = std::array::from_fn(|_| Records::default());
        let mut group = criterion.benchmark_group("passes");
        group.throughput(Throughput::Elements(rows as u64));
        let mut bench = |name: &str, work: &mut dyn FnMut(&mut [Vector], &mut [Real])| {
            group.bench_function(BenchmarkId::new(name, rows), |bencher| bencher.iter(|| work(&mut vectors, &mut a)));
        };
        bench("density", &mut |gradient, value| {
            let input = DensityInput { positions: &set.x, gradient_positions: None, weights: one, unit: 1.0 };
            density(pairs, kernel, input, DensityOutput { value, gradient, response: &mut b });
        });
        bench("correction", &mut |out, _| correction(pairs, kernel, &set.x, &set.field, &mut r1, out));
        bench("xsph", &mut |out, _| xsph(pairs, kernel, &set.x, &set.v, one, &mut r2, out));
        bench("xsph_mixed", &mut |out, _| xsph_mixed(pairs, kernel, &set.x, &set.v, &traits, &mut r3, out));
        bench("vorticity", &mut |_, out| vorticity(pairs, kernel, &set.x, &set.v, &mut r4, out));
        bench("gradient", &mut |out, _| difference_gradient(pairs, kernel, &set.x, &set.field, out));
        bench("laplacian", &mut |_, out| laplacian(pairs, kernel, &set.x, &set.field, one, out));
        bench("repulsion", &mut |out, _| repulsion(pairs, Reach { full: 0.5, none: 0.8 }, &set.x, one, out));
    }
}

fn neighbors(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("neighbors");
    for rows in SIZES {
        let set = Lattice::new(rows, RADIUS);
        let (mut grid, mut list) = (Grid::new(Periodic::NONE), NeighborList::default());
        group.throughput(Throughput::Elements(rows as u64));
        group.bench_function(BenchmarkId::new("sort", rows), |bencher| {
            bencher.iter(|| black_box(grid.order(&set.x, rows, RADIUS, Parallelism::Serial).len()));
        });
        group.bench_function(BenchmarkId::new("list", rows), |bencher| {
            bencher.iter(|| list.build(&set.grid, &set.x, RADIUS, Parallelism::Serial));
        });
    }
}

criterion_group!(benches, passes, neighbors);
criterion_main!(benches);
