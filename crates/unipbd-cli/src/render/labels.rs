//! The time stamp, the colour bar, the scale bar and the legend.

use super::color::Rgb;
use super::paper::Paper;
use super::scalar::Scalar;
use super::text::{self, Align, Lettering};
use super::theme::Theme;

/// Opacity of the plates behind text.
const PLATE: f32 = 0.8;

/// Writes the simulated time onto a plate in the upper left corner.
pub(super) fn time_stamp(paper: &mut dyn Paper, time: f64, theme: &Theme, scale: f32) {
    let height = 11.0 * scale;
    let label = format!("{time:.2} s");
    let [left, top, pad] = [16.0 * scale, 16.0 * scale, 7.0 * scale];
    plate(paper, [left - pad, top - pad, left + text::width(&label, height) + pad, top + height + pad], theme);
    text::draw(paper, &label, [left, top + height], lettering(height, Align::Left, theme));
}

/// Draws a bar of a round length into the lower right corner of the first `rows` rows; `metre` in pixels.
pub(super) fn scale_bar(paper: &mut dyn Paper, rows: u32, metre: f64, theme: &Theme, scale: f32) {
    let [width, bottom] = [paper.size()[0], rows as f32];
    let metres = round_length(0.22 * f64::from(width) / metre);
    let [length, height, pad] = [(metres * metre) as f32, 10.0 * scale, 8.0 * scale];
    let label = if metres < 0.01 {
        format!("{} mm", number(1e3 * metres, 1e3 * metres))
    } else if metres < 1.0 {
        format!("{} cm", number(100.0 * metres, 100.0 * metres))
    } else {
        format!("{} m", number(metres, metres))
    };
    let wide = length.max(text::width(&label, height));
    let [right, base] = [width - 20.0 * scale, bottom - 20.0 * scale];
    plate(paper, [right - wide - pad, base - height - 16.0 * scale, right + pad, base + pad], theme);
    let middle = right - 0.5 * wide;
    paper.rectangle([middle - 0.5 * length, base - 4.0 * scale, middle + 0.5 * length, base], theme.text, 1.0);
    text::draw(paper, &label, [middle, base - 10.0 * scale], lettering(height, Align::Center, theme));
}

/// Lists names with their colours on a plate in the upper right corner.
pub(super) fn legend(paper: &mut dyn Paper, entries: &[(Rgb, String)], theme: &Theme, scale: f32) {
    let [height, line, pad] = [10.0 * scale, 19.0 * scale, 9.0 * scale];
    let widest = entries.iter().map(|(_, name)| text::width(name, height)).fold(0.0, f32::max);
    let right = paper.size()[0] - 12.0 * scale;
    let [left, top] = [right - widest - 2.2 * height - pad, 14.0 * scale];
    plate(paper, [left - pad, top - pad, right, top + line * entries.len() as f32 - (line - height) + pad], theme);
    for (row, (color, name)) in entries.iter().enumerate() {
        let y = top + line * row as f32;
        paper.rectangle([left, y, left + 1.3 * height, y + height], *color, 1.0);
        text::draw(paper, name, [left + 2.2 * height, y + height], lettering(height, Align::Left, theme));
    }
}

fn lettering(height: f32, align: Align, theme: &Theme) -> Lettering {
    Lettering { height, align, color: theme.text, halo: theme.background }
}

pub(super) fn plate(paper: &mut dyn Paper, area: [f32; 4], theme: &Theme) {
    paper.rectangle(area, theme.background, PLATE);
}

/// The largest of 1, 2 and 5 times a power of ten up to a length.
pub(super) fn round_length(most: f64) -> f64 {
    let decade = 10f64.powf(most.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|step| step * decade).find(|length| *length <= most).unwrap_or(decade)
}

/// Height of the strip that holds the colour bar, an even number of pixels.
pub(super) fn strip_height(scale: f32) -> u32 {
    (32.0 * scale).round() as u32 * 2
}

/// Draws the colour bar into the strip that begins at the row `top`.
pub(super) fn color_bar(paper: &mut dyn Paper, scalar: &Scalar, top: u32, theme: &Theme, scale: f32) {
    let [width, bottom] = paper.size();
    paper.rectangle([0.0, top as f32, width, bottom], theme.background, 1.0);
    let height = 9.0 * scale.max(0.75);
    // The bar stands in the middle unless its title needs the room.
    let title_width = text::width(scalar.by.label(), height) + 24.0 * scale;
    let left = (0.30 * width).max(title_width);
    let right = (0.70 * width).max(left + 0.5 * (width - left));
    let [bar, thickness] = [top as f32 + 14.0 * scale, (12.0 * scale).max(4.0)];
    for x in left as usize..right as usize {
        let color = scalar.map.color((x as f32 + 0.5 - left) / (right - left));
        paper.rectangle([x as f32, bar, x as f32 + 1.0, bar + thickness], color, 1.0);
    }
    let title = Lettering { height, align: Align::Right, color: theme.text, halo: theme.background };
    text::draw(paper, scalar.by.label(), [left - 14.0 * scale, bar + thickness - 1.0], title);
    let tick = Lettering { align: Align::Center, color: theme.faint_text, ..title };
    let ends = scalar.ends();
    for k in 0..5 {
        let t = f64::from(k) / 4.0;
        let label = number(ends[0] + t * (ends[1] - ends[0]), ends[1] - ends[0]);
        let x = left + t as f32 * (right - left);
        let base = bar + thickness + 8.0 * scale + height;
        text::draw(paper, &label, [x, base], tick);
    }
}

/// A number with the digits that quarters of the span need.
pub(super) fn number(value: f64, span: f64) -> String {
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
    use super::{number, round_length};

    #[test]
    fn scale_bars_have_round_lengths() {
        assert_eq!([0.7, 4.9, 5.0, 0.021].map(round_length), [0.5, 2.0, 5.0, 0.02]);
    }

    #[test]
    fn numbers_have_the_digits_they_need() {
        assert_eq!(number(0.0, 3.0), "0");
        assert_eq!(number(0.75, 3.0), "0.75");
        assert_eq!(number(-0.0, 2.0), "0");
        assert_eq!(number(100.0, 100.0), "100");
        assert_eq!(number(0.0375, 0.15), "0.0375");
    }
}
