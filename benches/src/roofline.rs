//! Times the passes over pairs against two yardsticks in the same run: a plain scalar loop over a
//! compressed list, and a loop of nothing but square roots: the one operation of a pair that cannot be made cheaper.
#![allow(unsafe_code)]

use crate::Lattice;
use crate::whole::{ScalarStep, Step};
use std::hint::black_box;
use std::ops::Deref;
use std::time::Instant;
use unipbd_core::kernel::WendlandC2;
use unipbd_core::neighbors::{Grid, NeighborList};
use unipbd_core::parallel::Parallelism::{self, Pool, Serial};
use unipbd_core::passes::{
    DensityInput, DensityOutput, Pairs, Reach, Records, Weights, correction, density, difference_gradient, laplacian,
    repulsion, vorticity, xsph, xsph_mixed,
};
use unipbd_core::periodic::Periodic;
use unipbd_core::simd::Level;
use unipbd_core::{Real, Vector};

/// Kernel radius over spacing.
const RADIUS: Real = 2.0;
const ROUNDS: usize = 21;

/// Particles, and their pairs once more as a compressed list.
struct Case {
    set: Lattice,
    starts: Vec<u32>,
    entries: Vec<u32>,
}

fn case(rows: usize) -> Case {
    let set = Lattice::new(rows, RADIUS);
    let (mut starts, mut entries) = (vec![0], Vec::new());
    for row in 0..rows {
        set.list.for_each(row, |j| entries.push(j as u32));
        starts.push(entries.len() as u32);
    }
    Case { set, starts, entries }
}

impl Deref for Case {
    type Target = Lattice;
    fn deref(&self) -> &Lattice {
        &self.set
    }
}

impl Case {
    fn neighbors(&self, row: usize) -> &[u32] {
        &self.entries[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

/// (1 - q) of a pair, its q and difference.
#[inline(always)]
fn pair(case: &Case, i: usize, j: u32) -> (Real, Real, Vector) {
    let apart = case.x[i] - case.x[j as usize];
    let q = apart.length() * (1.0 / RADIUS);
    ((1.0 - q).max(0.0), q, apart)
}

fn scalar_density(case: &Case, value: &mut [Real], gradient: &mut [Vector], response: &mut [Real]) {
    for i in 0..case.x.len() {
        let (mut s, mut g, mut q2) = (0.0, Vector::ZERO, 0.0);
        for &j in case.neighbors(i) {
            let (t, q, apart) = pair(case, i, j);
            let t3 = t * t * t;
            s += t3 * t * (1.0 + 4.0 * q);
            g += apart * t3;
            q2 += t3 * t3 * apart.length_squared();
        }
        (value[i], gradient[i], response[i]) = (s, g, q2);
    }
}

fn scalar_correction(case: &Case, out: &mut [Vector]) {
    for (i, out) in out.iter_mut().enumerate() {
        *out = Vector::ZERO;
        for &j in case.neighbors(i) {
            let (t, _, apart) = pair(case, i, j);
            *out += apart * (t * t * t * (case.field[i] + case.field[j as usize]));
        }
    }
}

fn scalar_xsph(case: &Case, out: &mut [Vector]) {
    for (i, out) in out.iter_mut().enumerate() {
        *out = Vector::ZERO;
        for &j in case.neighbors(i) {
            let (t, q, _) = pair(case, i, j);
            *out += (case.v[j as usize] - case.v[i]) * ((t * t) * (t * t) * (1.0 + 4.0 * q));
        }
    }
}

/// `slots` square roots, eight at a time: what a pair of the kernel needs at least. It needs no quotient.
fn roofline(slots: u64) -> f32 {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        #[target_feature(enable = "avx2")]
        fn wide(slots: u64) -> f32 {
            roots(slots)
        }
        // SAFETY: the machine has AVX2.
        return unsafe { wide(slots) };
    }
    roots(slots)
}

#[inline(always)]
fn roots(slots: u64) -> f32 {
    let data: [[f32; 8]; 4] = black_box([[1.5; 8], [2.5; 8], [3.5; 8], [4.5; 8]]);
    let mut sums = [[0.0f32; 8]; 4];
    for _ in 0..slots / 32 {
        for (sum, data) in sums.iter_mut().zip(&black_box(data)) {
            for lane in 0..8 {
                sum[lane] += data[lane].sqrt();
            }
        }
    }
    sums.as_flattened().iter().sum()
}

struct Timed<'a> {
    name: String,
    work: Box<dyn FnMut() + Send + 'a>,
    times: Vec<f64>,
}

/// Runs all in turn, many times over, so that a slow moment of the machine hits them alike.
fn measure(entries: &mut [Timed<'_>], rows: usize) {
    for _ in 0..ROUNDS {
        for entry in entries.iter_mut() {
            // Once for the caches: what ran before has other columns.
            (entry.work)();
            let start = Instant::now();
            (entry.work)();
            entry.times.push(start.elapsed().as_secs_f64() * 1e9 / rows as f64);
        }
    }
    entries.iter_mut().for_each(|entry| entry.times.sort_by(f64::total_cmp));
}

fn timed<'a>(name: impl Into<String>, work: impl FnMut() + Send + 'a) -> Timed<'a> {
    Timed { name: name.into(), work: Box::new(work), times: Vec::new() }
}

fn pass_entries<'a>(case: &'a Case, level: Level, parallelism: Parallelism, tag: &str) -> Vec<Timed<'a>> {
    let rows = case.x.len();
    let kernel = WendlandC2::new(f64::from(RADIUS));
    let pairs = Pairs::new(&case.list, Periodic::NONE, parallelism).at_level(level);
    let (mut a, mut b, mut g) = (vec![0.0; rows], vec![0.0; rows], vec![Vector::ZERO; rows]);
    let (mut g1, mut g2, mut g3, mut g4) = (g.clone(), g.clone(), g.clone(), g.clone());
    let (mut c, mut d, mut e, mut f) = (a.clone(), a.clone(), a.clone(), a.clone());
    let (mut h, mut m) = (g.clone(), g.clone());
    let traits: Vec<_> = case.field.iter().map(|&value| Vector::new(0.1, 1.0 + value)).collect();
    let one = Weights::Uniform(1.0);
    let [mut r1, mut r2, mut r3, mut r4] = std::array::from_fn(|_| Records::default());
    let input = DensityInput { positions: &case.x, gradient_positions: None, weights: one, unit: 1.0 };
    let split = DensityInput {
        gradient_positions: Some(&case.v),
        weights: Weights::Column(&case.field),
        positions: &case.x,
        unit: 1.0,
    };
    vec![
        timed(format!("density      {tag}"), move || {
            density(pairs, kernel, input, DensityOutput { value: &mut a, gradient: &mut g, response: &mut b });
        }),
        timed(format!("density s+w  {tag}"), move || {
            density(pairs, kernel, split, DensityOutput { value: &mut e, gradient: &mut h, response: &mut f });
        }),
        timed(format!("correction   {tag}"), move || correction(pairs, kernel, &case.x, &case.field, &mut r1, &mut g1)),
        timed(format!("xsph         {tag}"), move || xsph(pairs, kernel, &case.x, &case.v, one, &mut r2, &mut g2)),
        timed(format!("xsph mixed   {tag}"), move || {
            xsph_mixed(pairs, kernel, &case.x, &case.v, &traits, &mut r3, &mut m)
        }),
        timed(format!("vorticity    {tag}"), move || vorticity(pairs, kernel, &case.x, &case.v, &mut r4, &mut c)),
        timed(format!("gradient     {tag}"), move || {
            difference_gradient(pairs, kernel, &case.x, &case.field, &mut g3);
        }),
        timed(format!("laplacian    {tag}"), move || laplacian(pairs, kernel, &case.x, &case.field, one, &mut d)),
        timed(format!("repulsion    {tag}"), move || {
            repulsion(pairs, Reach { full: 0.5, none: 0.8 }, &case.x, one, &mut g4)
        }),
    ]
}

/// Times everything at this size; a table in Markdown.
pub fn report(rows: usize, levels: &[Level]) -> String {
    let case = case(rows);
    let (pairs, slots) = (case.list.pairs(), case.list.slots());
    let mut text = format!(
        "{rows} particles: {:.1} neighbours, {:.1} slots each, {:.0} bytes of list each.\n\n",
        pairs as f64 / rows as f64,
        slots as f64 / rows as f64,
        case.list.memory_bytes() as f64 / rows as f64
    );
    let (mut a, mut b, mut g) = (vec![0.0; rows], vec![0.0; rows], vec![Vector::ZERO; rows]);
    let (mut g1, mut g2) = (g.clone(), g.clone());
    let mut order_grid = Grid::new(Periodic::NONE);
    let (mut build, mut build_pool) = (NeighborList::default(), NeighborList::default());
    let mut pool_grid = Grid::new(Periodic::NONE);
    let (mut whole, mut whole_pool) = (Step::new(rows, RADIUS), Step::new(rows, RADIUS));
    let mut whole_scalar = ScalarStep::new(rows, RADIUS);
    let mut entries = vec![
        timed("whole step   scalar CSR", || whole_scalar.run(&case.x, &case.v)),
        timed("whole step", || whole.ours(&case.x, &case.v, Serial)),
        timed("whole step   2 threads", || whole_pool.ours(&case.x, &case.v, Pool)),
        timed("roofline sqrt", || {
            black_box(roofline(slots));
        }),
        timed("density      scalar CSR", || scalar_density(&case, &mut a, &mut g, &mut b)),
        timed("correction   scalar CSR", || scalar_correction(&case, &mut g1)),
        timed("xsph         scalar CSR", || scalar_xsph(&case, &mut g2)),
        timed("order", || {
            order_grid.order(&case.x, rows, RADIUS, Serial);
        }),
        timed("order        2 threads", || {
            pool_grid.order(&case.x, rows, RADIUS, Pool);
        }),
        timed("list build", || build.build(&case.grid, &case.x, RADIUS, Serial)),
        timed("list build   2 threads", || build_pool.build(&case.grid, &case.x, RADIUS, Pool)),
    ];
    for &level in levels {
        entries.extend(pass_entries(&case, level, Serial, &format!("{level:?}")));
    }
    entries.extend(pass_entries(&case, Level::best(), Pool, "2 threads"));
    measure(&mut entries, rows);
    let least = |name: &str| entries.iter().find(|e| e.name.starts_with(name)).map_or(f64::NAN, |e| e.times[0]);
    let roof = least("roofline");
    text += "| ns per particle | least | median | faster than scalar (bar 3.5; whole step 3.4) | of the roofline (bar 0.50) |\n|---|---|---|---|---|\n";
    let ratio = |ratio: f64| if ratio.is_finite() { format!("{ratio:.2}") } else { String::new() };
    for entry in &entries {
        let scalar = least(&format!("{:12} scalar CSR", entry.name.split("  ").next().unwrap_or("")));
        let (time, median) = (entry.times[0], entry.times[ROUNDS / 2]);
        let (name, faster, part) = (&entry.name, ratio(scalar / time), ratio(roof / time));
        text += &format!("| {name} | {time:.2} | {median:.2} | {faster} | {part} |\n");
    }
    text
}
