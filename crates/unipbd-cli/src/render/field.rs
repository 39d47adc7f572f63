use tiny_skia::Mask;

use super::image::{Image, window};

/// Four sums per pixel: three weighted values and the weight itself.
pub(super) type Sums = [f32; 4];

/// A buffer in which particles accumulate as soft blobs before they become pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct Field {
    size: [usize; 2],
    sums: Vec<Sums>,
    /// Columns and rows touched since the last clearing.
    touched: Option<[[usize; 2]; 2]>,
    /// Factors along one row of a Gaussian.
    row: Vec<f32>,
}

impl Field {
    /// Empties the buffer and gives it a size.
    pub fn start(&mut self, [width, height]: [u32; 2]) {
        let size = [width as usize, height as usize];
        if size != self.size {
            self.size = size;
            self.sums = vec![[0.0; 4]; size[0] * size[1]];
        } else if let Some([[left, right], [top, bottom]]) = self.touched {
            for y in top..bottom {
                self.sums[y * size[0] + left..y * size[0] + right].fill([0.0; 4]);
            }
        }
        self.touched = None;
    }

    fn touch(&mut self, columns: &std::ops::Range<usize>, rows: &std::ops::Range<usize>) {
        let [[left, right], [top, bottom]] =
            self.touched.unwrap_or([[columns.start, columns.end], [rows.start, rows.end]]);
        self.touched =
            Some([[left.min(columns.start), right.max(columns.end)], [top.min(rows.start), bottom.max(rows.end)]]);
    }

    /// Adds values with the weight (1 - r^2/R^2)^2 within `reach` R [pixels] of a point.
    pub fn add_compact(&mut self, center: [f32; 2], reach: f32, values: [f32; 3]) {
        let Some([columns, rows]) = window(center, reach, self.size) else { return };
        self.touch(&columns, &rows);
        let inverse = 1.0 / (reach * reach);
        let values = [values[0], values[1], values[2], 1.0];
        for y in rows {
            let dy = y as f32 + 0.5 - center[1];
            let left_over = 1.0 - dy * dy * inverse;
            let line = &mut self.sums[y * self.size[0]..][columns.clone()];
            for (x, sums) in columns.clone().zip(line) {
                let dx = x as f32 + 0.5 - center[0];
                let inside = (left_over - dx * dx * inverse).max(0.0);
                let weight = inside * inside;
                for k in 0..4 {
                    sums[k] += weight * values[k];
                }
            }
        }
    }

    /// The same, but only where the way from the centre along `normal` is longer than `from` [pixels].
    pub fn add_cut(&mut self, center: [f32; 2], reach: f32, values: [f32; 3], normal: [f32; 2], from: f32) {
        let Some([columns, rows]) = window(center, reach, self.size) else { return };
        self.touch(&columns, &rows);
        for y in rows {
            for x in columns.clone() {
                let [dx, dy] = [x as f32 + 0.5 - center[0], y as f32 + 0.5 - center[1]];
                let inside = 1.0 - (dx * dx + dy * dy) / (reach * reach);
                if inside > 0.0 && dx * normal[0] + dy * normal[1] > from {
                    let sums = &mut self.sums[y * self.size[0] + x];
                    let weight = inside * inside;
                    (0..3).for_each(|k| sums[k] += weight * values[k]);
                    sums[3] += weight;
                }
            }
        }
    }

    /// Adds values with the weight `peak` exp(-r^2 / 2 sigma^2); `sigma` in pixels.
    pub fn add_gaussian(&mut self, center: [f32; 2], sigma: f32, peak: f32, values: [f32; 3]) {
        let Some([columns, rows]) = window(center, 3.0 * sigma, self.size) else { return };
        self.touch(&columns, &rows);
        let factor = |offset: f32| (-0.5 * (offset / sigma) * (offset / sigma)).exp();
        self.row.clear();
        self.row.extend(columns.clone().map(|x| factor(x as f32 + 0.5 - center[0])));
        let values = [values[0], values[1], values[2], 1.0];
        for y in rows {
            let weight = peak * factor(y as f32 + 0.5 - center[1]);
            let values = values.map(|value| value * weight);
            let line = &mut self.sums[y * self.size[0]..][columns.clone()];
            for (sums, factor) in line.iter_mut().zip(&self.row) {
                for k in 0..4 {
                    sums[k] += factor * values[k];
                }
            }
        }
    }

    /// Lays the field over a picture of the same width: `paint` makes colour and opacity of the
    /// mean values and the weight of a pixel. Where there is a mask, it shows through that alone.
    pub fn lay_over(&self, image: &mut Image, mask: Option<&Mask>, paint: impl Fn([f32; 3], f32) -> ([f32; 3], f32)) {
        let Some([[left, right], [top, bottom]]) = self.touched else { return };
        for y in top..bottom {
            for x in left..right {
                let [a, b, c, weight] = self.sums[y * self.size[0] + x];
                if weight > 1e-4 {
                    let (color, opacity) = paint([a / weight, b / weight, c / weight], weight);
                    let share = mask.map_or(1.0, |mask| f32::from(mask.data()[y * self.size[0] + x]) / 255.0);
                    let opacity = opacity * share;
                    if opacity > 0.0 {
                        image.blend(y * image.width() as usize + x, color, opacity);
                    }
                }
            }
        }
    }

    #[cfg(test)]
    pub fn weight(&self, x: usize, y: usize) -> f32 {
        self.sums[y * self.size[0] + x][3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smoke_blob_falls_off_as_a_gaussian() {
        let mut field = Field::default();
        field.start([101, 101]);
        field.add_gaussian([50.5, 50.5], 10.0, 2.0, [0.0; 3]);
        for offset in [0, 5, 10, 20, 28] {
            let r = offset as f32 / 10.0;
            let exact = 2.0 * (-0.5 * r * r).exp();
            assert!((field.weight(50 + offset, 50) - exact).abs() < 1e-5);
            assert!((field.weight(50, 50 - offset) - exact).abs() < 1e-5);
        }
        assert_eq!(field.weight(85, 50), 0.0);
    }

    #[test]
    fn starting_again_empties_the_buffer() {
        let mut field = Field::default();
        field.start([40, 30]);
        field.add_compact([20.0, 10.0], 6.0, [1.0; 3]);
        assert!(field.weight(20, 10) > 0.9);
        field.start([40, 30]);
        assert!((0..30).all(|y| (0..40).all(|x| field.weight(x, y) == 0.0)));
    }
}
