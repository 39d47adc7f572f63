//! Colours: mixing, the Oklab space, and the colour maps made in it.

/// A colour as red, green, blue (sRGB).
pub type Rgb = [u8; 3];

/// The colour `t` of the way from one to another.
pub fn mix(from: Rgb, to: Rgb, t: f32) -> Rgb {
    std::array::from_fn(|k| {
        let [from, to] = [f32::from(from[k]), f32::from(to[k])];
        (from + (to - from) * t).round().clamp(0.0, 255.0) as u8
    })
}

/// The colour as SVG and style sheets write it.
pub(super) fn css([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Relative luminance, 0 black to 1 white (Rec. 709 weights on linear light).
pub fn luminance(color: Rgb) -> f32 {
    let [red, green, blue] = color.map(|channel| linear(f32::from(channel) / 255.0));
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

pub(super) fn to_float(color: Rgb) -> [f32; 3] {
    color.map(f32::from)
}

fn linear(channel: f32) -> f32 {
    if channel <= 0.04045 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}

fn encoded(channel: f32) -> f32 {
    if channel <= 0.003_130_8 { 12.92 * channel } else { 1.055 * channel.powf(1.0 / 2.4) - 0.055 }
}

/// A colour from lightness (0 to 1), chroma and hue \[deg] in Oklab (B. Ottosson, 2020), where equal
/// steps look equally large. Chroma that sRGB cannot show is reduced until it can.
fn from_oklch(lightness: f32, chroma: f32, hue_deg: f32) -> Rgb {
    let shown = |chroma: f32| {
        oklab_to_linear(lightness, chroma, hue_deg).iter().all(|channel| (-1e-3..=1.001).contains(channel))
    };
    let [mut low, mut high] = [0.0, chroma];
    if shown(high) {
        low = high;
    }
    for _ in 0..16 {
        let middle = (low + high) / 2.0;
        if shown(middle) { low = middle } else { high = middle }
    }
    oklab_to_linear(lightness, low, hue_deg).map(|channel| (encoded(channel.clamp(0.0, 1.0)) * 255.0).round() as u8)
}

fn oklab_to_linear(lightness: f32, chroma: f32, hue_deg: f32) -> [f32; 3] {
    let (sin, cos) = hue_deg.to_radians().sin_cos();
    let [a, b] = [chroma * cos, chroma * sin];
    let long = lightness + 0.396_337_78 * a + 0.215_803_76 * b;
    let medium = lightness - 0.105_561_346 * a - 0.063_854_17 * b;
    let short = lightness - 0.089_484_18 * a - 1.291_485_5 * b;
    let [l, m, s] = [long, medium, short].map(|root| root * root * root);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

/// A table of colours for numbers from 0 to 1.
#[derive(Clone, Debug)]
pub struct ColorMap([Rgb; 256]);

impl ColorMap {
    /// Dark indigo over teal to bright yellow: lightness rises evenly.
    pub fn sequential() -> ColorMap {
        ColorMap::sample(|t| from_oklch(0.36 + 0.55 * t, 0.13 + 0.03 * t, 285.0 - 180.0 * t))
    }

    /// Dim violet over red and orange to pale yellow: lightness rises evenly.
    pub fn heat() -> ColorMap {
        ColorMap::sample(|t| from_oklch(0.34 + 0.60 * t, 0.11 + 0.28 * t * (1.0 - t), 305.0 + 155.0 * t))
    }

    /// Blue below the middle, neutral in it, red above: both arms lose lightness evenly.
    pub fn diverging() -> ColorMap {
        ColorMap::sample(|t| {
            let arm = 2.0 * t - 1.0;
            let hue = if arm < 0.0 { 255.0 } else { 28.0 };
            from_oklch(0.93 - 0.45 * arm.abs(), 0.20 * arm.abs(), hue)
        })
    }

    fn sample(color: impl Fn(f32) -> Rgb) -> ColorMap {
        ColorMap(std::array::from_fn(|step| color(step as f32 / 255.0)))
    }

    /// The colour of a number from 0 to 1; numbers beyond get the colour of the nearer end.
    pub fn color(&self, t: f32) -> Rgb {
        self.0[(t.clamp(0.0, 1.0) * 255.0).round() as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_of_the_sequential_map_never_falls() {
        for map in [ColorMap::sequential(), ColorMap::heat()] {
            let steps: Vec<f32> = (0..=32).map(|step| luminance(map.color(step as f32 / 32.0))).collect();
            assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
        }
    }

    #[test]
    fn the_diverging_map_is_neutral_in_the_middle_blue_below_red_above() {
        let map = ColorMap::diverging();
        let [red, green, blue] = map.color(0.5);
        assert!(red.abs_diff(green) < 6 && green.abs_diff(blue) < 6, "{:?}", map.color(0.5));
        assert!(map.color(0.0)[2] > map.color(0.0)[0] + 60);
        assert!(map.color(1.0)[0] > map.color(1.0)[2] + 60);
    }

    #[test]
    fn white_and_black_come_back_from_oklab() {
        assert_eq!(from_oklch(1.0, 0.0, 0.0), [255; 3]);
        assert_eq!(from_oklch(0.0, 0.0, 0.0), [0; 3]);
    }
}
