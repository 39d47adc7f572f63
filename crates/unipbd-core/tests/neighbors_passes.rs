//! The passes over pairs: every instruction set gives the bits of the scalar form, and the scalar
//! form is the formula.

use unipbd_core::kernel::{Shape, WendlandC2};
use unipbd_core::legacy::Formula;
use unipbd_core::neighbors::{Grid, NeighborList};
use unipbd_core::parallel::Parallelism;
use unipbd_core::passes::{
    DensityInput, DensityOutput, Pairs, Reach, Records, Weights, correction, density, difference_gradient, laplacian,
    repulsion, vorticity, xsph, xsph_mixed,
};
use unipbd_core::periodic::{Periodic, PeriodicAxis};
use unipbd_core::scene::LegacyKernel;
use unipbd_core::simd::Level;
use unipbd_core::{Real, Vector};

const RADIUS: Real = 2.5;
const SIDE: Real = 24.0;

/// A small generator, so that data differ from row to row in all their bits.
struct Random(u64);

impl Random {
    fn next(&mut self) -> Real {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 40) as f64 / (1u64 << 24) as f64) as Real
    }
    fn column(&mut self, rows: usize) -> Vec<Real> {
        (0..rows).map(|_| self.next() * 2.0 - 1.0).collect()
    }
    fn vectors(&mut self, rows: usize, scale: Real) -> Vec<Vector> {
        (0..rows).map(|_| Vector::new(self.next(), self.next()) * scale).collect()
    }
}

/// Columns of one particle set, sorted, and its list.
struct Set {
    periodic: Periodic,
    list: NeighborList,
    x: Vec<Vector>,
    start: Vec<Vector>,
    v: Vec<Vector>,
    weights: Vec<Real>,
    field: Vec<Real>,
}

impl Set {
    fn new(x: Vec<Vector>, periodic: Periodic) -> Set {
        let mut random = Random(7);
        let rows = x.len();
        let mut grid = Grid::new(periodic);
        // A list wider than the kernel, as one with a skin is.
        let radius = RADIUS * 1.15;
        let order = grid.order(&x, rows, radius, Parallelism::Serial);
        let x: Vec<_> = order.iter().map(|&row| x[row as usize]).collect();
        let mut list = NeighborList::default();
        list.build(&grid, &x, radius, Parallelism::Serial);
        let start = x.iter().map(|&x| x + Vector::new(random.next(), random.next()) * 0.1).collect();
        let (v, weights, field) = (random.vectors(rows, 3.0), random.column(rows), random.column(rows));
        Set { periodic, list, x, start, v, weights, field }
    }

    fn random(rows: usize, periodic: Periodic) -> Set {
        let mut x = Random(rows as u64).vectors(rows, SIDE);
        for row in (3..rows).step_by(11) {
            x[row] = x[row - 1];
        }
        Set::new(x, periodic)
    }

    fn pairs(&self, level: Level, parallelism: Parallelism) -> Pairs<'_> {
        Pairs::new(&self.list, self.periodic, parallelism).at_level(level)
    }
}

fn kernel() -> WendlandC2 {
    WendlandC2::new(f64::from(RADIUS))
}

/// Strengths, and inverse masses of which every third is zero.
fn traits(set: &Set) -> Vec<Vector> {
    (0..set.x.len()).map(|row| Vector::new(set.weights[row].abs(), (row % 3) as Real)).collect()
}

/// The results of every pass, one row of numbers each.
fn all_passes(set: &Set, kernel: WendlandC2, level: Level, parallelism: Parallelism) -> Vec<(&'static str, Vec<Real>)> {
    let rows = set.x.len();
    let pairs = set.pairs(level, parallelism);
    let (mut a, mut b, mut g) = (vec![0.0; rows], vec![0.0; rows], vec![Vector::ZERO; rows]);
    let flat = |vectors: &[Vector]| vectors.iter().flat_map(|v| [v.x, v.y]).collect::<Vec<_>>();
    let mut results = Vec::new();
    for weights in [Weights::Uniform(0.7), Weights::Column(&set.weights)] {
        for gradient_positions in [None, Some(&set.start[..])] {
            let input = DensityInput { positions: &set.x, gradient_positions, weights, unit: 1.0 };
            density(pairs, kernel, input, DensityOutput { value: &mut a, gradient: &mut g, response: &mut b });
            results.push(("density", [a.clone(), flat(&g), b.clone()].concat()));
        }
        repulsion(pairs, Reach { full: 0.3, none: 0.8 }, &set.x, weights, &mut g);
        results.push(("repulsion", flat(&g)));
        xsph(pairs, kernel, &set.x, &set.v, weights, &mut Records::default(), &mut g);
        results.push(("xsph", flat(&g)));
        laplacian(pairs, kernel, &set.x, &set.field, weights, &mut a);
        results.push(("laplacian", a.clone()));
    }
    correction(pairs, kernel, &set.x, &set.field, &mut Records::default(), &mut g);
    results.push(("correction", flat(&g)));
    vorticity(pairs, kernel, &set.x, &set.v, &mut Records::default(), &mut a);
    results.push(("vorticity", a.clone()));
    difference_gradient(pairs, kernel, &set.x, &set.field, &mut g);
    results.push(("difference gradient", flat(&g)));
    let traits = traits(set);
    xsph_mixed(pairs, kernel, &set.x, &set.v, &traits, &mut Records::default(), &mut g);
    results.push(("xsph mixed", flat(&g)));
    results
}

fn assert_levels_agree(results: impl Fn(Level) -> Vec<(&'static str, Vec<Real>)>) {
    let oracle = results(Level::Scalar);
    for level in Level::available() {
        for ((name, wanted), (_, found)) in oracle.iter().zip(results(level)) {
            for (k, (wanted, found)) in wanted.iter().zip(&found).enumerate() {
                assert!(wanted.is_finite(), "{name}: {wanted}");
                assert_eq!(wanted.to_bits(), found.to_bits(), "{name}, {level:?}, number {k}: {wanted} {found}");
            }
        }
    }
}

fn periods() -> [Periodic; 3] {
    let axis = Some(PeriodicAxis { from: 0.0, length: SIDE });
    [Periodic::NONE, Periodic { x: axis, y: None }, Periodic { x: axis, y: axis }]
}

#[test]
fn every_level_gives_the_bits_of_the_scalar_form() {
    assert!(Level::available().contains(&Level::best()));
    // Miri looks at every access, so that few rows must do.
    let sizes: &[usize] =
        if cfg!(miri) { &[0, 1, 2, 7, 8, 9, 40] } else { &[0, 1, 2, 7, 8, 9, 40, 511, 512, 513, 700] };
    for periodic in periods() {
        for &rows in sizes {
            let set = Set::random(rows, periodic);
            assert_levels_agree(|level| all_passes(&set, kernel(), level, Parallelism::Serial));
        }
    }
}

#[test]
fn every_kernel_gives_the_bits_of_the_scalar_form() {
    fn check(set: &Set, kernel: impl Shape) {
        assert_levels_agree(|level| {
            let pairs = set.pairs(level, Parallelism::Serial);
            let mut out = vec![0.0; 300];
            laplacian(pairs, kernel, &set.x, &set.field, Weights::Uniform(1.0), &mut out);
            let mut mean = vec![Vector::ZERO; 300];
            xsph(pairs, kernel, &set.x, &set.v, Weights::Uniform(1.0), &mut Records::default(), &mut mean);
            vec![("laplacian", out), ("xsph", mean.iter().flat_map(|v| [v.x, v.y]).collect())]
        });
    }
    let radius = f64::from(RADIUS);
    let set = Set::random(300, periods()[1]);
    check(&set, Formula::new(LegacyKernel::CubicSpline, radius));
    check(&set, Formula::new(LegacyKernel::Poly6Spiky, radius));
}

#[test]
fn wide_entries_give_the_bits_of_the_scalar_form() {
    // Two rows of cells with 34,000 particles each: offsets between them exceed 16 bits.
    let mut random = Random(3);
    let x = (0..68_000).map(|k| Vector::new((k / 2) as Real + random.next() * 0.5, (k % 2) as Real * 2.0 + 2.0));
    let set = Set::new(x.collect(), Periodic::NONE);
    assert_levels_agree(|level| all_passes(&set, kernel(), level, Parallelism::Serial));
}

#[test]
fn thread_counts_do_not_change_bits() {
    let mut x = Random(5).vectors(6000, SIDE);
    x.iter_mut().for_each(|x| *x *= 3.0);
    let set = Set::new(x, Periodic::NONE);
    let serial = all_passes(&set, kernel(), Level::best(), Parallelism::Serial);
    for threads in [1, 2, 3, 8] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let parallel = pool.install(|| all_passes(&set, kernel(), Level::best(), Parallelism::Pool));
        assert!(parallel == serial, "{threads} threads");
    }
}

fn relative(found: f64, wanted: f64, scale: f64) -> f64 {
    (found - wanted).abs() / scale
}

/// The formulas of the passes in double precision over all pairs, without any list.
#[test]
fn passes_compute_their_formulas() {
    for periodic in periods() {
        let set = Set::random(400, periodic);
        let results = all_passes(&set, kernel(), Level::best(), Parallelism::Serial);
        let traits: Vec<_> = traits(&set).iter().map(|t| (f64::from(t.x), f64::from(t.y))).collect();
        let traits = |row: usize| traits[row];
        let h = f64::from(RADIUS);
        let pi = std::f64::consts::PI;
        for i in 0..400 {
            let mut wanted = [0.0; 15];
            let mut scale = [1e-3; 15];
            for j in (0..400).filter(|&j| j != i) {
                let apart = |p: &[Vector]| {
                    let d = periodic.min_image(p[i] - p[j]);
                    (f64::from(d.x), f64::from(d.y))
                };
                let slope = |(x, y): (f64, f64)| -140.0 / (pi * h.powi(4)) * (1.0 - x.hypot(y) / h).max(0.0).powi(3);
                let ((x, y), start) = (apart(&set.x), apart(&set.start));
                let (r, t) = (x.hypot(y), (1.0 - x.hypot(y) / h).max(0.0));
                let w = 7.0 / (pi * h * h) * t.powi(4) * (1.0 + 4.0 * r / h);
                let (g, g0) = (slope((x, y)), slope(start));
                let of = |column: &[Real], k: usize| f64::from(column[k]);
                let (u, v) = (f64::from(set.v[j].x - set.v[i].x), f64::from(set.v[j].y - set.v[i].y));
                let (weight, sum) = (of(&set.weights, j), of(&set.field, i) + of(&set.field, j));
                let difference = of(&set.field, j) - of(&set.field, i);
                let (mine, other) = (traits(i), traits(j));
                let masses = mine.1 + other.1;
                let exchange = if masses > 0.0 { (mine.0 + other.0) * mine.1 / masses } else { 0.0 };
                let push =
                    if r == 0.0 { 0.0 } else { (f64::from(0.8 as Real) - r.max(f64::from(0.3 as Real))).max(0.0) / r };
                let flip = if r > 0.0 {
                    0.0
                } else if i < j {
                    -0.5
                } else {
                    0.5
                };
                let terms = [
                    w,
                    g * x,
                    g * y,
                    0.7 * g * g * r * r,
                    g0 * start.0,
                    weight * g0 * g0 * (start.0 * start.0 + start.1 * start.1),
                    weight * (push * x + flip),
                    weight * push * y,
                    weight * w * u,
                    weight * w * v,
                    -weight * g * difference,
                    sum * g * x,
                    g * (x * v - y * u),
                    difference * g * y,
                    exchange * w * v,
                ];
                for k in 0..15 {
                    wanted[k] += terms[k];
                    scale[k] += terms[k].abs();
                }
            }
            let at = |pass: usize, number: usize| f64::from(results[pass].1[number]);
            let rows = 400;
            let found = [
                at(0, i),
                at(0, rows + 2 * i),
                at(0, rows + 2 * i + 1),
                at(0, 3 * rows + i),
                at(1, rows + 2 * i),
                at(6, 3 * rows + i),
                at(7, 2 * i),
                at(7, 2 * i + 1),
                at(8, 2 * i),
                at(8, 2 * i + 1),
                at(9, i),
                at(10, 2 * i),
                at(11, i),
                at(12, 2 * i + 1),
                at(13, 2 * i + 1),
            ];
            for k in 0..15 {
                let error = relative(found[k], wanted[k], scale[k]);
                assert!(error < 2e-5, "row {i}, quantity {k}: {} instead of {}", found[k], wanted[k]);
            }
        }
    }
}

#[test]
fn mixed_viscosity_keeps_momentum_and_drags_nothing_moved_by_a_script() {
    let set = Set::random(300, Periodic::NONE);
    let traits: Vec<_> =
        (0..300).map(|row| Vector::new(0.5 + set.weights[row].abs(), 0.5 + set.field[row].abs())).collect();
    let mut change = vec![Vector::ZERO; 300];
    let pairs = set.pairs(Level::best(), Parallelism::Serial);
    xsph_mixed(pairs, kernel(), &set.x, &set.v, &traits, &mut Records::default(), &mut change);
    let momentum: Vector = (0..300).map(|row| change[row] / traits[row].y).sum();
    let size: Real = (0..300).map(|row| change[row].length() / traits[row].y).sum();
    assert!(momentum.length() < 1e-5 * size, "{momentum} of {size}");

    let kinematic: Vec<_> =
        traits.iter().enumerate().map(|(row, t)| Vector::new(t.x, if row % 5 == 0 { 0.0 } else { t.y })).collect();
    xsph_mixed(pairs, kernel(), &set.x, &set.v, &kinematic, &mut Records::default(), &mut change);
    assert!(change.iter().step_by(5).all(|change| *change == Vector::ZERO));
    assert!(change.iter().all(|change| change.is_finite()) && change[1] != Vector::ZERO);
}

#[test]
fn corrections_and_repulsion_push_both_of_a_pair_alike() {
    let set = Set::random(600, periods()[2]);
    let pairs = set.pairs(Level::best(), Parallelism::Serial);
    let mut out = vec![Vector::ZERO; 600];
    let total = |out: &[Vector]| out.iter().fold(Vector::ZERO, |sum, &v| sum + v).length();
    let size = |out: &[Vector]| out.iter().map(|v| v.length()).sum::<Real>();
    correction(pairs, kernel(), &set.x, &set.field, &mut Records::default(), &mut out);
    assert!(total(&out) < 1e-5 * size(&out));
    repulsion(pairs, Reach { full: 0.3, none: 0.8 }, &set.x, Weights::Column(&set.weights), &mut out);
    out.iter_mut().zip(&set.weights).for_each(|(v, &s)| *v *= s);
    assert!(size(&out) > 1.0 && total(&out) < 1e-5 * size(&out));
}

#[cfg(not(feature = "f64"))]
#[test]
#[should_panic(expected = "as many rows as the list")]
fn short_columns_are_refused() {
    let set = Set::random(100, Periodic::NONE);
    let mut out = vec![Vector::ZERO; 100];
    correction(
        set.pairs(Level::best(), Parallelism::Serial),
        WendlandC2::new(2.5),
        &set.x[..99],
        &set.field,
        &mut Records::default(),
        &mut out,
    );
}
