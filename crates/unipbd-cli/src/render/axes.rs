//! Axes at the left and below a picture.

use unipbd_core::math::Vector64;

use super::error::RenderError;
use super::image::Image;
use super::labels::{number, round_length};
use super::paper::Paper;
use super::text::{self, Align, Lettering};
use super::theme::Theme;
use super::view::Camera;

/// Margins for axes [pixels].
#[derive(Clone, Copy)]
pub(super) struct Margins {
    /// Columns left of the picture.
    pub left: u32,
    /// Rows between the region and what is below it.
    pub below: u32,
    /// Columns right of the picture.
    pub beside: u32,
}

impl Margins {
    pub fn new(scale: f32) -> Margins {
        let even = |pixels: f32| (pixels / 2.0).round() as u32 * 2;
        Margins { left: even(64.0 * scale), below: even(52.0 * scale), beside: even(16.0 * scale) }
    }
}

/// A picture with a margin that holds its axes.
pub(super) struct Framed {
    outer: Image,
    margins: Margins,
    /// Rows above the horizontal axis.
    rows: u32,
}

/// Draws the axes of the region of a camera.
pub(super) fn draw(paper: &mut dyn Paper, camera: &Camera, margins: Margins, theme: &Theme, scale: f32) {
    let (left, base) = (margins.left as f32, camera.size[1] as f32);
    Axes { camera, theme, height: 9.5 * scale, tick: 5.0 * scale, left, base }.draw(paper);
}

impl Framed {
    /// Draws the axes of a picture, whose first rows show the region of the camera.
    pub fn new(camera: &Camera, inner: &Image, theme: &Theme, scale: f32) -> Result<Framed, RenderError> {
        let margins = Margins::new(scale);
        let size = [inner.width() + margins.left + margins.beside, inner.height() + margins.below];
        let mut outer = Image::new(size[0], size[1], theme.background)?;
        draw(&mut outer, camera, margins, theme, scale);
        Ok(Framed { outer, margins, rows: camera.size[1] })
    }

    /// Puts a picture between the axes; what is below its region goes below the axis.
    pub fn show(&mut self, inner: &Image) -> &Image {
        let (Margins { left, below, .. }, rows) = (self.margins, self.rows);
        self.outer.put(inner, 0..rows, [left, 0]);
        self.outer.put(inner, rows..inner.height(), [left, rows + below]);
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
    fn draw(&self, paper: &mut dyn Paper) {
        let Axes { camera, theme, height, tick, left, base } = *self;
        let view = camera.view;
        let [width, rows] = [camera.size[0] as f32, camera.size[1] as f32];
        paper.line(&[[left, 0.0], [left, base], [left + width, base]], theme.text, 1.4);
        let lettering = |align| Lettering { height, align, color: theme.text, halo: theme.background };
        let most = f64::from(width / (6.5 * height));
        let step = tick_step(view.max[0] - view.min[0], most);
        for x in ticks(view.min[0], view.max[0], step) {
            let at = camera.pixel(Vector64::new(x, view.min[1]))[0] + left;
            paper.line(&[[at, base], [at, base + tick]], theme.text, 1.4);
            text::draw(paper, &number(x, step), [at, base + 1.8 * tick + height], lettering(Align::Center));
        }
        text::draw(paper, "x [m]", [left + 0.5 * width, base + 2.8 * tick + 2.6 * height], lettering(Align::Center));
        let step = tick_step(view.max[1] - view.min[1], f64::from(rows / (4.0 * height)));
        for y in ticks(view.min[1], view.max[1], step) {
            let at = camera.pixel(Vector64::new(view.min[0], y))[1];
            paper.line(&[[left - tick, at], [left, at]], theme.text, 1.4);
            let line = (at + 0.5 * height).max(1.2 * height);
            text::draw(paper, &number(y, step), [left - 1.8 * tick, line], lettering(Align::Right));
        }
        // Half-way between two ticks, where no number stands.
        let middle = ((0.5 * (view.min[1] + view.max[1]) / step).floor() + 0.5) * step;
        let line = camera.pixel(Vector64::new(view.min[0], middle))[1] + 0.5 * height;
        text::draw(paper, "y [m]", [0.4 * tick, line], lettering(Align::Left));
    }
}

/// A round step that gives at most so many ticks.
pub(super) fn tick_step(span: f64, most: f64) -> f64 {
    let least = span / most.max(1.0);
    let length = round_length(least);
    [1.0, 2.0, 2.5, 5.0]
        .into_iter()
        .map(|factor| round_length(factor * length * 1.000_001))
        .find(|step| *step >= least)
        .unwrap_or(5.0 * length)
}

pub(super) fn ticks(min: f64, max: f64, step: f64) -> impl Iterator<Item = f64> {
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
