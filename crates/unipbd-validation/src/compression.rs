//! Density errors by one measure for all solvers and kernels: the density of a cubic spline over interior particles.
//!
//! A solver corrects the density of its own kernel, and reads less error from it the wider that kernel is. To compare
//! kernels, density is estimated anew from the positions alone. Compression alone would favour a kernel whose liquid
//! swells: where particles lie in disorder, a narrow kernel takes them for denser than they are.

/// Estimates the density errors of a liquid in a tank whose lower left corner is the origin.
#[derive(Clone, Copy, Debug)]
pub struct Estimator {
    /// Spacing of the lattice at rest \[m].
    pub spacing: f64,
    /// Radius of the spline, in spacings.
    pub radius: f64,
    /// Size of the tank \[m].
    pub tank: [f64; 2],
}

/// Density errors C = rho/rho0 - 1 summed over interior particles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Sum of max(C, 0).
    pub compression: f64,
    /// Sum of max(-C, 0).
    pub dilation: f64,
    /// How many particles they go over.
    pub count: usize,
}

impl Errors {
    /// Mean of max(C, 0); 0 where nothing is interior.
    pub fn mean_compression(self) -> f64 {
        self.compression / self.count.max(1) as f64
    }

    /// Mean of max(-C, 0); 0 where nothing is interior.
    pub fn mean_dilation(self) -> f64 {
        self.dilation / self.count.max(1) as f64
    }

    /// Mean of |C|; 0 where nothing is interior.
    pub fn mean(self) -> f64 {
        (self.compression + self.dilation) / self.count.max(1) as f64
    }

    /// Both together.
    #[must_use]
    pub fn and(self, other: Errors) -> Errors {
        Errors {
            compression: self.compression + other.compression,
            dilation: self.dilation + other.dilation,
            count: self.count + other.count,
        }
    }
}

impl Estimator {
    /// Errors over the particles farther than the radius from walls, and than 1.5 times it from the surface, which
    /// is the highest particle near. The density is that of a cubic spline (Monaghan 1992), 1 on the lattice.
    pub fn errors(&self, positions: &[[f64; 2]]) -> Errors {
        let cells = Cells::new(self, positions);
        let (reach, rest) = (self.reach(), self.rest());
        let inside = |x: &[f64; 2]| {
            let off_walls = x[0] > reach && x[0] < self.tank[0] - reach && x[1] > reach;
            off_walls && x[1] <= cells.lowest_top(x) - 1.5 * reach
        };
        let one = |x: &[f64; 2]| {
            let near = cells.near(x).map(|j| (x[0] - positions[j][0]).hypot(x[1] - positions[j][1]));
            let error = near.map(|distance| spline(distance / reach)).sum::<f64>() / rest - 1.0;
            Errors { compression: error.max(0.0), dilation: (-error).max(0.0), count: 1 }
        };
        positions.iter().filter(|x| inside(x)).map(one).fold(Errors::default(), Errors::and)
    }

    fn reach(&self) -> f64 {
        self.radius * self.spacing
    }

    /// The sum of the spline over the lattice at rest.
    fn rest(&self) -> f64 {
        let ring = self.radius.ceil() as i32;
        let offsets = (-ring..=ring).flat_map(|i| (-ring..=ring).map(move |j| (f64::from(i), f64::from(j))));
        offsets.map(|(i, j)| spline(i.hypot(j) / self.radius)).sum()
    }
}

/// Particles by cells as wide as the spline reaches.
struct Cells {
    reach: f64,
    counts: [usize; 2],
    rows: Vec<Vec<usize>>,
    /// Highest particle of each column of cells \[m].
    tops: Vec<f64>,
}

impl Cells {
    fn new(estimator: &Estimator, positions: &[[f64; 2]]) -> Cells {
        let reach = estimator.reach();
        let counts = estimator.tank.map(|size| (size / reach) as usize + 2);
        let (rows, tops) = (vec![Vec::new(); counts[0] * counts[1]], vec![0.0_f64; counts[0]]);
        let mut cells = Cells { reach, counts, rows, tops };
        for (index, x) in positions.iter().enumerate() {
            let [column, row] = cells.of(x);
            cells.rows[row * counts[0] + column].push(index);
            cells.tops[column] = cells.tops[column].max(x[1]);
        }
        cells
    }

    fn of(&self, x: &[f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| ((x[axis] / self.reach).max(0.0) as usize).min(self.counts[axis] - 1))
    }

    /// The lowest surface of this column and those beside it that lie in the tank \[m].
    fn lowest_top(&self, x: &[f64; 2]) -> f64 {
        let column = self.of(x)[0];
        let columns = column.saturating_sub(1)..=(column + 1).min(self.counts[0] - 2);
        columns.map(|column| self.tops[column]).fold(f64::INFINITY, f64::min)
    }

    fn near(&self, x: &[f64; 2]) -> impl Iterator<Item = usize> + '_ {
        let [column, row] = self.of(x);
        let beside = |at: usize, axis: usize| at.saturating_sub(1)..=(at + 1).min(self.counts[axis] - 1);
        beside(row, 1)
            .flat_map(move |row| beside(column, 0).map(move |column| row * self.counts[0] + column))
            .flat_map(|cell| self.rows[cell].iter().copied())
    }
}

/// The cubic spline over q = r/h, without its constant.
fn spline(q: f64) -> f64 {
    if q < 0.5 {
        6.0 * (q * q * q - q * q) + 1.0
    } else if q < 1.0 {
        2.0 * (1.0 - q).powi(3)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(columns: usize, rows: usize, spacing: f64) -> Vec<[f64; 2]> {
        let at = |k: usize| [(k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5].map(|x| x * spacing);
        (0..columns * rows).map(at).collect()
    }

    #[test]
    fn a_lattice_at_rest_has_no_error_and_another_one_that_of_its_area() {
        let estimator = Estimator { spacing: 0.1, radius: 4.0, tank: [4.0, 8.0] };
        let rest = estimator.errors(&lattice(40, 40, 0.1));
        assert!(rest.count == 32 * 30 && rest.mean() < 1e-6, "{rest:?}");
        let tight = estimator.errors(&lattice(40, 40, 0.099));
        assert!((tight.mean_compression() - (1.0 / 0.9801 - 1.0)).abs() < 2e-3, "{tight:?}");
        let loose = estimator.errors(&lattice(39, 40, 0.101));
        assert!(loose.mean_compression() < 1e-6 && (loose.mean() - (1.0 - 1.0 / 1.0201)).abs() < 2e-3, "{loose:?}");
    }

    #[test]
    fn a_layer_thinner_than_its_margins_has_no_interior() {
        let estimator = Estimator { spacing: 0.1, radius: 4.0, tank: [4.0, 8.0] };
        assert_eq!(estimator.errors(&lattice(40, 9, 0.05)), Errors::default());
        assert_eq!(Errors::default().mean(), 0.0);
    }
}
