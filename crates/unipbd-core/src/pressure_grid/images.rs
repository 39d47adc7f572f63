//! Periodic axes: the rim of a grid holds images of the cells on the opposite side.

use super::transfer::Add;

/// Along which axes a grid repeats: after this many cells, or not at all (zero). The rim and the cell beyond the last one
/// are images.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Images {
    pub periods: [usize; 2],
}

impl Images {
    pub fn any(self) -> bool {
        self.periods != [0; 2]
    }

    /// The images on the next coarser grid; none along an axis that it cannot halve.
    pub fn coarser(self) -> Images {
        Images { periods: self.periods.map(|period| if period.is_multiple_of(2) { period / 2 } else { 0 }) }
    }

    /// Calls `pair` with each cell and the image of another one that lies beside it: the image before the first cell,
    /// then that beyond the last one.
    #[inline(always)]
    fn each(self, cells: usize, stride: usize, mut pair: impl FnMut(usize, [usize; 2])) {
        let [width, height] = self.periods;
        let rows = cells / stride;
        if width > 0 {
            for row in (0..rows).map(|row| row * stride) {
                pair(0, [row, row + width]);
                pair(1, [row + width + 1, row + 1]);
            }
        }
        if height > 0 {
            for column in 0..stride {
                pair(2, [column, height * stride + column]);
                pair(3, [(height + 1) * stride + column, stride + column]);
            }
        }
    }

    /// Gives the images the values of their cells.
    pub fn copy<T: Copy>(self, column: &mut [T], stride: usize) {
        if self.any() {
            self.each(column.len(), stride, |_, [image, cell]| column[image] = column[cell]);
        }
    }

    /// Adds what was summed in images to their cells, and gives the images the whole.
    pub fn fold<T: Copy + Add>(self, column: &mut [T], stride: usize) {
        if !self.any() {
            return;
        }
        self.each(column.len(), stride, |_, [image, cell]| column[cell] = column[cell].plus(column[image]));
        self.copy(column, stride);
    }

    /// Sets images to zero.
    pub fn clear<T: Copy + Default>(self, column: &mut [T], stride: usize) {
        if self.any() {
            self.each(column.len(), stride, |_, [image, _]| column[image] = T::default());
        }
    }

    /// Calls `pair` with the axis, the last cell and the first one of each row and column that repeats.
    pub fn borders(self, cells: usize, stride: usize, mut pair: impl FnMut(usize, usize, usize)) {
        self.each(cells, stride, |side, [image, cell]| match side {
            0 => pair(0, cell, image + 1),
            2 => pair(1, cell, image + stride),
            _ => (),
        });
    }

    /// Couples cells with the images before the first ones, and images with nothing else.
    pub fn couple<T: Copy + Default>(self, [right, upper, air]: [&mut [T]; 3], stride: usize) {
        if !self.any() {
            return;
        }
        let cells = right.len();
        [&mut *right, &mut *upper, &mut *air].into_iter().for_each(|column| {
            // The couplings of the last cells with the images beyond them are theirs; those of images are none.
            self.clear(column, stride);
        });
        self.each(cells, stride, |side, [image, cell]| match side {
            0 => right[image] = right[cell],
            2 => upper[image] = upper[cell],
            _ => (),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Real;

    const STRIDE: usize = 8;
    const IMAGES: Images = Images { periods: [4, 2] };

    #[test]
    fn images_have_the_values_of_the_opposite_side() {
        let mut column: Vec<usize> = (0..STRIDE * 4).collect();
        IMAGES.copy(&mut column, STRIDE);
        let at = |i: usize, j: usize| column[j * STRIDE + i];
        assert_eq!((at(0, 1), at(5, 1)), (STRIDE + 4, STRIDE + 1));
        assert_eq!((at(2, 0), at(2, 3)), (2 * STRIDE + 2, STRIDE + 2));
        assert_eq!((at(0, 0), at(5, 3)), (2 * STRIDE + 4, STRIDE + 1), "corners");
    }

    #[test]
    fn folding_keeps_the_sum_of_the_cells() {
        let mut column = vec![0.0; STRIDE * 4];
        for j in 0..4 {
            column[j * STRIDE..][..6].fill(1.0);
        }
        IMAGES.fold(&mut column, STRIDE);
        let cells = (1..=2).flat_map(|j| (1..=4).map(move |i| j * STRIDE + i));
        assert_eq!(cells.map(|cell| column[cell]).sum::<Real>(), 24.0);
    }

    #[test]
    fn odd_periods_are_not_halved() {
        assert_eq!(Images { periods: [6, 5] }.coarser(), Images { periods: [3, 0] });
    }
}
