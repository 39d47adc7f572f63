use unipbd_core::phase::Phase;

use super::color::ColorMap;
use super::color_by::ColorBy;
use super::error::RenderError;
use super::options::Range;
use crate::snapshot::Snapshot;

/// The numbers that colours show, and the colour map they run through.
pub(super) struct Scalar {
    pub by: ColorBy,
    pub map: ColorMap,
    range: Range,
    /// Ends of the colour map, in the unit of the colour bar.
    ends: Option<[f64; 2]>,
    /// One number per particle of the frame drawn last.
    values: Vec<f32>,
}

impl Scalar {
    /// Nothing for the colour of the material.
    pub fn new(by: ColorBy, range: Range) -> Option<Scalar> {
        let map = match by {
            ColorBy::Material => return None,
            ColorBy::Speed => ColorMap::sequential(),
            ColorBy::Density => ColorMap::diverging(),
            ColorBy::Temperature => ColorMap::heat(),
        };
        Some(Scalar { by, map, range, ends: None, values: Vec::new() })
    }

    /// Whether particles of this phase have the quantity.
    pub fn applies_to(&self, phase: Phase) -> bool {
        match self.by {
            ColorBy::Material => false,
            ColorBy::Speed => phase != Phase::Rigid,
            ColorBy::Density => phase.is_fluid(),
            ColorBy::Temperature => phase.is_fluid(),
        }
    }

    /// Reads the column of a frame and fits the ends of the colour map to it.
    pub fn read(&mut self, frame: &Snapshot) -> Result<(), RenderError> {
        self.values.clear();
        let missing = || RenderError::MissingColumn(self.by);
        match self.by {
            ColorBy::Material => {}
            ColorBy::Speed => {
                let column = frame.velocities.as_ref().ok_or_else(missing)?;
                self.values.extend(column.iter().map(|[x, y]| x.hypot(*y)));
            }
            ColorBy::Density => {
                let column = frame.density_errors.as_ref().ok_or_else(missing)?;
                self.values.extend(column.iter().map(|error| error * 100.0));
            }
            ColorBy::Temperature => {
                self.values.extend_from_slice(frame.temperatures.as_ref().ok_or_else(missing)?);
            }
        }
        if self.values.len() != frame.positions.len() {
            return Err(RenderError::MissingColumn(self.by));
        }
        self.fit(frame)
    }

    fn fit(&mut self, frame: &Snapshot) -> Result<(), RenderError> {
        self.ends = match self.range {
            Range::Fixed { min, max } if min < max && min.is_finite() && max.is_finite() => Some([min, max]),
            Range::Fixed { .. } => return Err(RenderError::Range),
            Range::Automatic => {
                let of_phase = |(phase, value): (&Phase, &f32)| self.applies_to(*phase).then_some(*value);
                let shown = frame.phases.iter().zip(&self.values).filter_map(of_phase).collect();
                match (self.ends, suited_range(self.by, shown)) {
                    (Some(old), Some(new)) => Some([old[0].min(new[0]), old[1].max(new[1])]),
                    (old, new) => old.or(new),
                }
            }
        };
        Ok(())
    }

    /// Ends of the colour map; 0 to 1 before any particle was seen.
    pub fn ends(&self) -> [f64; 2] {
        self.ends.unwrap_or([0.0, 1.0])
    }

    /// Where the number of a particle lies between the ends, 0 to 1.
    pub fn fraction(&self, row: usize) -> f32 {
        let [min, max] = self.ends();
        ((f64::from(self.values[row]) - min) / (max - min)).clamp(0.0, 1.0) as f32
    }
}

/// The range that suits these numbers, or nothing where there are none. It ignores the outermost
/// half percent at either end, so that a few wild particles do not dim all others.
fn suited_range(by: ColorBy, mut values: Vec<f32>) -> Option<[f64; 2]> {
    values.retain(|value| value.is_finite());
    if values.is_empty() {
        return None;
    }
    let low = percentile(&mut values, 0.005);
    let high = percentile(&mut values, 0.995);
    Some(match by {
        // Compression sets the ends: spray, which has few neighbours, would set them tenfold.
        ColorBy::Density => {
            let end = round_up(high.max(0.1));
            [-end, end]
        }
        ColorBy::Temperature => [-round_up(-low.min(0.0)), round_up(high.max(1e-3))],
        ColorBy::Speed | ColorBy::Material => [0.0, round_up(high.max(1e-3))],
    })
}

fn percentile(values: &mut [f32], fraction: f64) -> f64 {
    let index = ((values.len() - 1) as f64 * fraction).round() as usize;
    let (_, value, _) = values.select_nth_unstable_by(index, f32::total_cmp);
    f64::from(*value)
}

/// The next number of the series 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten; 0 stays 0.
fn round_up(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let mut decade = 10f64.powf(value.log10().floor());
    if decade > value {
        decade /= 10.0;
    }
    let steps = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    steps.iter().map(|step| step * decade).find(|end| *end >= value * (1.0 - 1e-6)).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn automatic_range_ignores_a_few_wild_values() {
        let mut values: Vec<f32> = (0..1000).map(|k| k as f32 * 0.00271).collect();
        values[3] = 1e9;
        values[4] = f32::NAN;
        assert_eq!(suited_range(ColorBy::Speed, values), Some([0.0, 3.0]));
    }

    #[test]
    fn automatic_density_range_is_symmetric_about_zero_and_follows_compression() {
        assert_eq!(suited_range(ColorBy::Density, vec![-0.4, 0.1, 3.7]), Some([-4.0, 4.0]));
        assert_eq!(suited_range(ColorBy::Density, vec![-80.0, -60.0, 0.1, 0.7]), Some([-0.8, 0.8]));
        assert_eq!(suited_range(ColorBy::Density, vec![]), None);
    }
}
