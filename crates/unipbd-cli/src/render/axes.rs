//! Axes at the left and below a picture.

use unipbd_core::math::Vector64;

use super::error::RenderError;
use super::image::Image;
use super::labels::{number, round_length};
use super::text::{self, Align, Lettering};
use super::theme::Theme;
use super::view::Camera;

/// A picture with a margin that holds its axes.
pub(super) struct Framed {
    outer: Image,
    /// Where the picture begins: columns from the left.
    left: u32,
    /// Rows above the horizontal axis, and rows that the axis takes.
    rows: [u32; 2],
}

impl Framed {
    /// Draws the axes of a picture, whose first rows show the region of the camera.
    pub fn new(camera: &Camera, inner: &Image, theme: &Theme, scale: f32) -> Result<Framed, RenderError> {
        let even = |pixels: f32| (pixels / 2.0).round() as u32 * 2;
        let [left, below, beside] = [even(64.0 * scale), even(52.0 * scale), even(16.0 * scale)];
        let size = [inner.width() + left + beside, inner.height() + below];
        let mut outer = Image::new(size[0], size[1], theme.background)?;
        let base = camera.size[1] as f32;
        let axes = Axes { camera, theme, height: 9.5 * scale, tick: 5.0 * scale, left: left as f32, base };
        axes.draw(&mut outer);
        Ok(Framed { outer, left, rows: [camera.size[1], below] })
    }

    /// Puts a picture between the axes; what is below its region goes below the axis.
    pub fn show(&mut self, inner: &Image) -> &Image {
        let [region, axis] = self.rows;
        self.outer.put(inner, 0..region, [self.left, 0]);
        self.outer.put(inner, region..inner.height(), [self.left, region + axis]);
        &self.outer
    }
}

struct Axes<'a> {
    camera: &'a Camera,
    theme: &'a Theme,
    height: f32,
    tick: f32,
    /// Column of the vertical axis, row of the horizontal one.
    left: f32,
    base: f32,
}

impl Axes<'_> {
    fn draw(&self, image: &mut Image) {
        let Axes { camera, theme, height, tick, left, base } = *self;
        let view = camera.view;
        let [width, rows] = [camera.size[0] as f32, camera.size[1] as f32];
        super::walls::stroke_pixels(image, &[[left, 0.0], [left, base], [left + width, base]], theme.text, 1.4);
        let lettering = |align| Lettering { height, align, color: theme.text, halo: theme.background };
        let most = f64::from(width / (6.5 * height));
        let step = tick_step(view.max[0] - view.min[0], most);
        for x in ticks(view.min[0], view.max[0], step) {
            let at = camera.pixel(Vector64::new(x, view.min[1]))[0] + left;
            super::walls::stroke_pixels(image, &[[at, base], [at, base + tick]], theme.text, 1.4);
            text::draw(image, &number(x, step), [at, base + 1.8 * tick + height], lettering(Align::Center));
        }
        text::draw(image, "x [m]", [left + 0.5 * width, base + 2.8 * tick + 2.6 * height], lettering(Align::Center));
        let step = tick_step(view.max[1] - view.min[1], f64::from(rows / (4.0 * height)));
        for y in ticks(view.min[1], view.max[1], step) {
            let at = camera.pixel(Vector64::new(view.min[0], y))[1];
            super::walls::stroke_pixels(image, &[[left - tick, at], [left, at]], theme.text, 1.4);
            let line = (at + 0.5 * height).max(1.2 * height);
            text::draw(image, &number(y, step), [left - 1.8 * tick, line], lettering(Align::Right));
        }
        text::draw(image, "y [m]", [0.2 * tick, base + 2.8 * tick + 2.6 * height], lettering(Align::Left));
    }
}

/// A round step that gives at most so many ticks.
fn tick_step(span: f64, most: f64) -> f64 {
    let least = span / most.max(1.0);
    let length = round_length(least);
    [1.0, 2.0, 2.5, 5.0]
        .into_iter()
        .map(|factor| round_length(factor * length * 1.000_001))
        .find(|step| *step >= least)
        .unwrap_or(5.0 * length)
}

fn ticks(min: f64, max: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (min / step - 1e-9).ceil() as i64;
    let last = (max / step + 1e-9).floor() as i64;
    (first..=last).map(move |k| k as f64 * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        let step = tick_step(5.1, 10.0);
        assert!((step - 1.0).abs() < 1e-12, "{step}");
        assert!((tick_step(5.1, 30.0) - 0.2).abs() < 1e-12, "{}", tick_step(5.1, 30.0));
        let found: Vec<f64> = ticks(-0.05, 5.05, step).collect();
        assert_eq!(found, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }
}
