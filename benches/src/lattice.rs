use unipbd_core::neighbors::{Grid, NeighborList};
use unipbd_core::parallel::Parallelism;
use unipbd_core::periodic::Periodic;
use unipbd_core::{Real, Vector};

/// A square block of particles on a lattice of spacing 1, shifted at random by up to a quarter of it,
/// sorted by cell, with its neighbour list.
pub struct Lattice {
    /// Kernel radius over spacing.
    pub radius: Real,
    /// Positions, sorted.
    pub x: Vec<Vector>,
    /// Random velocities.
    pub v: Vec<Vector>,
    /// Random numbers.
    pub field: Vec<Real>,
    /// The grid the rows are sorted by.
    pub grid: Grid,
    /// All pairs within the radius.
    pub list: NeighborList,
}

impl Lattice {
    /// A block of this many particles.
    pub fn new(rows: usize, radius: Real) -> Lattice {
        let mut random = random();
        let side = (rows as f64).sqrt() as usize;
        let lattice: Vec<_> = (0..rows)
            .map(|k| Vector::new((k % side) as Real + 0.5 * random(), (k / side) as Real + 0.5 * random()))
            .collect();
        let mut grid = Grid::new(Periodic::NONE);
        let order = grid.order(&lattice, rows, radius, Parallelism::Serial);
        let x: Vec<_> = order.iter().map(|&row| lattice[row as usize]).collect();
        let v = (0..rows).map(|_| Vector::new(random(), random())).collect();
        let field = (0..rows).map(|_| random()).collect();
        let mut list = NeighborList::default();
        list.build(&grid, &x, radius, Parallelism::Serial);
        Lattice { radius, x, v, field, grid, list }
    }
}

/// Numbers from -0.5 to 0.5.
fn random() -> impl FnMut() -> Real {
    let mut state = 1u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as Real / (1u64 << 24) as Real - 0.5
    }
}
