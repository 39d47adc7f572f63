//! The surface that shapes are drawn on: the pixels of a picture, or a sheet of vectors.

use tiny_skia::{Path, PathBuilder, Rect};

use super::color::Rgb;

/// Takes shapes in pixels: x to the right, y down, from the upper left corner.
pub(super) trait Paper {
    /// Width and height.
    fn size(&self) -> [f32; 2];

    /// Fills a path, by the even-odd rule.
    fn fill(&mut self, path: &Path, color: Rgb, opacity: f32);

    /// Draws a line with round ends and corners along a path.
    fn stroke(&mut self, path: &Path, color: Rgb, width: f32);

    /// Fills a disc.
    fn disc(&mut self, center: [f32; 2], radius: f32, color: Rgb, opacity: f32);

    /// Fills a rectangle: left, top, right, bottom.
    fn rectangle(&mut self, [left, top, right, bottom]: [f32; 4], color: Rgb, opacity: f32) {
        if let Some(area) = Rect::from_ltrb(left, top, right, bottom) {
            self.fill(&PathBuilder::from_rect(area), color, opacity);
        }
    }

    /// Draws a line through points.
    fn line(&mut self, points: &[[f32; 2]], color: Rgb, width: f32) {
        let mut path = PathBuilder::new();
        for (k, [x, y]) in points.iter().enumerate() {
            if k == 0 { path.move_to(*x, *y) } else { path.line_to(*x, *y) }
        }
        if let Some(path) = path.finish() {
            self.stroke(&path, color, width);
        }
    }
}
