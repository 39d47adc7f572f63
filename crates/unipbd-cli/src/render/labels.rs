//! The time stamp and the colour bar.

use super::image::Image;
use super::scalar::Scalar;
use super::text::{self, Align, Lettering};
use super::theme::Theme;

/// Writes the simulated time into the upper left corner.
pub(super) fn time_stamp(image: &mut Image, time: f64, theme: &Theme, scale: f32) {
    let height = 11.0 * scale;
    let lettering = Lettering { height, align: Align::Left, color: theme.text, halo: theme.background };
    text::draw(image, &format!("{time:.2} s"), [16.0 * scale, 16.0 * scale + height], lettering);
}

/// Height of the strip that holds the colour bar, an even number of pixels.
pub(super) fn strip_height(scale: f32) -> u32 {
    (32.0 * scale).round() as u32 * 2
}

/// Draws the colour bar into the strip that begins at the row `top`.
pub(super) fn color_bar(image: &mut Image, scalar: &Scalar, top: u32, theme: &Theme, scale: f32) {
    let width = image.width() as usize;
    for index in top as usize * width..image.height() as usize * width {
        image.blend(index, super::color::to_float(theme.background), 1.0);
    }
    let height = 9.0 * scale.max(0.75);
    // The bar stands in the middle unless its title needs the room.
    let title_width = text::width(scalar.by.label(), height) + 24.0 * scale;
    let left = (0.30 * width as f32).max(title_width);
    let right = (0.70 * width as f32).max(left + 0.5 * (width as f32 - left));
    let [bar, thickness] = [top as f32 + 14.0 * scale, (12.0 * scale).max(4.0)];
    for x in left as usize..right as usize {
        let color = scalar.map.color((x as f32 + 0.5 - left) / (right - left));
        for y in bar as usize..(bar + thickness) as usize {
            image.blend(y * width + x, super::color::to_float(color), 1.0);
        }
    }
    let title = Lettering { height, align: Align::Right, color: theme.text, halo: theme.background };
    text::draw(image, scalar.by.label(), [left - 14.0 * scale, bar + thickness - 1.0], title);
    let tick = Lettering { align: Align::Center, color: theme.faint_text, ..title };
    let ends = scalar.ends();
    for k in 0..5 {
        let t = f64::from(k) / 4.0;
        let label = number(ends[0] + t * (ends[1] - ends[0]), ends[1] - ends[0]);
        let x = left + t as f32 * (right - left);
        let base = bar + thickness + 8.0 * scale + height;
        text::draw(image, &label, [x, base], tick);
    }
}

/// A number with the digits that quarters of the span need.
fn number(value: f64, span: f64) -> String {
    if !(1e-3..1e5).contains(&span) {
        return format!("{value:.1e}");
    }
    let decimals = (3.0 - span.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_the_digits_they_need() {
        assert_eq!(number(0.0, 3.0), "0");
        assert_eq!(number(0.75, 3.0), "0.75");
        assert_eq!(number(-0.0, 2.0), "0");
        assert_eq!(number(100.0, 100.0), "100");
        assert_eq!(number(0.0375, 0.15), "0.0375");
    }
}
