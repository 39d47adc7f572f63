use super::super::color::Rgb;

/// Bits kept of each channel in the histogram.
const BITS: u32 = 6;
const BINS: usize = 1 << (3 * BITS);

fn bin([red, green, blue]: Rgb) -> usize {
    let cut = |channel: u8| usize::from(channel >> (8 - BITS));
    (cut(red) << (2 * BITS)) | (cut(green) << BITS) | cut(blue)
}

/// Counts the colours of many pictures.
pub(super) struct Histogram {
    counts: Vec<u64>,
    sums: Vec<[u64; 3]>,
}

impl Histogram {
    pub fn new() -> Histogram {
        Histogram { counts: vec![0; BINS], sums: vec![[0; 3]; BINS] }
    }

    pub fn add(&mut self, color: Rgb) {
        let bin = bin(color);
        self.counts[bin] += 1;
        for (sum, channel) in self.sums[bin].iter_mut().zip(color) {
            *sum += u64::from(channel);
        }
    }

    /// At most `most` colours that stand for all: the box of colours with the largest total squared
    /// error is split at its mean along its widest axis until there are enough boxes.
    pub fn palette(&self, most: usize) -> Vec<Rgb> {
        let all = (0..BINS).filter(|bin| self.counts[*bin] > 0).map(|bin| self.weighted(bin)).collect();
        let mut boxes = vec![ColorBox::of(all)];
        while boxes.len() < most {
            let errors = boxes.iter().map(ColorBox::error);
            let Some((worst, error)) = errors.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            if error <= 0.0 {
                break;
            }
            let (low, high) = boxes.swap_remove(worst).split();
            boxes.extend([low, high]);
        }
        boxes.iter().filter(|colors| !colors.members.is_empty()).map(ColorBox::color).collect()
    }

    /// The mean of the fullest bin.
    pub fn most_frequent(&self) -> Rgb {
        let fullest = (0..BINS).max_by_key(|bin| self.counts[*bin]).unwrap_or(0);
        self.weighted(fullest).color.map(|channel| channel.round() as u8)
    }

    fn weighted(&self, bin: usize) -> Weighted {
        let count = self.counts[bin] as f64;
        Weighted { color: self.sums[bin].map(|sum| sum as f64 / count), count }
    }
}

#[derive(Clone, Copy)]
struct Weighted {
    color: [f64; 3],
    count: f64,
}

struct ColorBox {
    members: Vec<Weighted>,
    mean: [f64; 3],
    /// Squared error of the members along each axis.
    errors: [f64; 3],
}

impl ColorBox {
    fn of(members: Vec<Weighted>) -> ColorBox {
        let count: f64 = members.iter().map(|member| member.count).sum();
        let sum = |axis: usize| members.iter().map(|member| member.count * member.color[axis]).sum::<f64>();
        let mean = [0, 1, 2].map(|axis| sum(axis) / count.max(1.0));
        let square = |axis: usize, member: &Weighted| {
            let offset = member.color[axis] - mean[axis];
            member.count * offset * offset
        };
        let errors = [0, 1, 2].map(|axis| members.iter().map(|member| square(axis, member)).sum());
        ColorBox { members, mean, errors }
    }

    fn error(&self) -> f64 {
        if self.members.len() > 1 { self.errors.iter().sum() } else { 0.0 }
    }

    fn split(self) -> (ColorBox, ColorBox) {
        let axis = (0..3).max_by(|a, b| self.errors[*a].total_cmp(&self.errors[*b])).unwrap_or(0);
        let (low, high) = self.members.into_iter().partition(|member| member.color[axis] <= self.mean[axis]);
        (ColorBox::of(low), ColorBox::of(high))
    }

    fn color(&self) -> Rgb {
        self.mean.map(|channel| channel.round() as u8)
    }
}

/// Finds the nearest colour of a palette, and remembers it.
pub(super) struct Matcher {
    palette: Vec<Rgb>,
    known: Vec<u16>,
}

impl Matcher {
    pub fn new(palette: Vec<Rgb>) -> Matcher {
        Matcher { palette, known: vec![u16::MAX; BINS] }
    }

    pub fn palette(&self) -> &[Rgb] {
        &self.palette
    }

    pub fn index(&mut self, color: Rgb) -> u8 {
        let known = &mut self.known[bin(color)];
        if *known == u16::MAX {
            let distances = self.palette.iter().map(|entry| distance(*entry, color)).enumerate();
            *known = distances.min_by_key(|(_, distance)| *distance).map_or(0, |(index, _)| index as u16);
        }
        *known as u8
    }
}

/// Squared distance of two colours.
pub(super) fn distance(a: Rgb, b: Rgb) -> u32 {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_exactly() {
        let mut histogram = Histogram::new();
        let colors = [[14, 19, 27], [200, 30, 40], [0, 0, 255], [255, 255, 255]];
        for (k, color) in colors.iter().enumerate() {
            (0..=k * k).for_each(|_| histogram.add(*color));
        }
        let mut palette = histogram.palette(255);
        palette.sort();
        let mut expected = colors.to_vec();
        expected.sort();
        assert_eq!(palette, expected);
    }

    #[test]
    fn a_grey_ramp_in_sixteen_colours_is_off_by_at_most_half_a_step() {
        let mut histogram = Histogram::new();
        (0..=255).for_each(|grey| histogram.add([grey; 3]));
        let mut matcher = Matcher::new(histogram.palette(16));
        assert_eq!(matcher.palette().len(), 16);
        for grey in 0..=255u8 {
            let index = usize::from(matcher.index([grey; 3]));
            let entry = matcher.palette()[index];
            assert!(entry[0].abs_diff(grey) <= 13, "{grey} became {}", entry[0]);
        }
    }
}
