use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, Stroke, Transform};

use super::color::{self, Rgb};
use super::error::RenderError;
use super::paper::Paper;

/// Most pixels a picture may have: enough for 8K, little enough to allocate without worry.
const MOST_PIXELS: u64 = 64_000_000;

/// An opaque picture: rows from the top, four bytes (red, green, blue, 255) a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Image {
    /// A picture filled with one colour.
    pub fn new(width: u32, height: u32, fill: Rgb) -> Result<Image, RenderError> {
        if width == 0 || height == 0 || u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(RenderError::PictureSize { width, height });
        }
        let mut image = Image { width, height, pixels: vec![255; width as usize * height as usize * 4] };
        image.fill(fill);
        Ok(image)
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The bytes, row by row from the top.
    pub fn rgba(&self) -> &[u8] {
        &self.pixels
    }

    /// The colour of one pixel, counted from the upper left corner; nothing outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Rgb> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = (y as usize * self.width as usize + x as usize) * 4;
        Some([self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]])
    }

    /// The bytes without the opacity: three a pixel.
    pub fn to_rgb(&self) -> Vec<u8> {
        self.pixels.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }

    pub(super) fn fill(&mut self, color: Rgb) {
        for pixel in self.pixels.chunks_exact_mut(4) {
            pixel[..3].copy_from_slice(&color);
        }
    }

    /// Puts these rows of a picture where the first of them shall be, columns and rows from the upper left corner.
    pub(super) fn put(&mut self, inner: &Image, rows: std::ops::Range<u32>, [left, top]: [u32; 2]) {
        let row_bytes = inner.width as usize * 4;
        for (row, to) in rows.zip(top as usize..) {
            let from = row as usize * row_bytes;
            let at = (to * self.width as usize + left as usize) * 4;
            self.pixels[at..at + row_bytes].copy_from_slice(&inner.pixels[from..from + row_bytes]);
        }
    }

    /// Lays a colour over the pixel number `index`; `opacity` from 0 to 1.
    #[inline]
    pub(super) fn blend(&mut self, index: usize, over: [f32; 3], opacity: f32) {
        let pixel = &mut self.pixels[index * 4..index * 4 + 3];
        for (channel, over) in pixel.iter_mut().zip(over) {
            let under = f32::from(*channel);
            *channel = (under + (over - under) * opacity + 0.5) as u8;
        }
    }

    /// Lays an anti-aliased disc over the picture; `center` and `radius` in pixels.
    pub(super) fn disc(&mut self, center: [f32; 2], radius: f32, fill: Rgb, opacity: f32) {
        // A disc smaller than a pixel keeps its area as a paler disc of one pixel.
        let drawn = radius.max(0.6);
        let opacity = opacity * (radius / drawn) * (radius / drawn);
        let over = color::to_float(fill);
        let Some([columns, rows]) = self.window(center, drawn + 0.5) else { return };
        for y in rows {
            for x in columns.clone() {
                let [dx, dy] = [x as f32 + 0.5 - center[0], y as f32 + 0.5 - center[1]];
                let covered = (drawn - (dx * dx + dy * dy).sqrt() + 0.5).clamp(0.0, 1.0);
                if covered > 0.0 {
                    self.blend(y * self.width as usize + x, over, covered * opacity);
                }
            }
        }
    }

    fn window(&self, center: [f32; 2], reach: f32) -> Option<[std::ops::Range<usize>; 2]> {
        window(center, reach, [self.width as usize, self.height as usize])
    }

    /// The picture as a canvas for lines and polygons.
    fn canvas(&mut self) -> tiny_skia::PixmapMut<'_> {
        tiny_skia::PixmapMut::from_bytes(&mut self.pixels, self.width, self.height)
            .expect("the buffer has four bytes a pixel")
    }
}

impl Paper for Image {
    fn size(&self) -> [f32; 2] {
        [self.width as f32, self.height as f32]
    }

    fn fill(&mut self, path: &Path, color: Rgb, opacity: f32) {
        self.canvas().fill_path(path, &paint(color, opacity), FillRule::EvenOdd, Transform::identity(), None);
    }

    fn stroke(&mut self, path: &Path, color: Rgb, width: f32) {
        let stroke = Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
        self.canvas().stroke_path(path, &paint(color, 1.0), &stroke, Transform::identity(), None);
    }

    fn disc(&mut self, center: [f32; 2], radius: f32, color: Rgb, opacity: f32) {
        Image::disc(self, center, radius, color, opacity);
    }
}

fn paint(color: Rgb, opacity: f32) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(color[0], color[1], color[2], (255.0 * opacity).round() as u8);
    paint
}

/// Columns and rows of the pixels within `reach` of a point, where there are any.
pub(super) fn window(center: [f32; 2], reach: f32, size: [usize; 2]) -> Option<[std::ops::Range<usize>; 2]> {
    if !center.iter().all(|value| value.is_finite()) {
        return None;
    }
    let span = |axis: usize| {
        let from = (center[axis] - reach).floor().max(0.0) as usize;
        let to = (center[axis] + reach).ceil().max(0.0) as usize;
        from..to.min(size[axis])
    };
    let [columns, rows] = [span(0), span(1)];
    (!columns.is_empty() && !rows.is_empty()).then_some([columns, rows])
}
