use std::borrow::Cow;
use std::path::{Path, PathBuf};

use gif::{AnyExtension, DisposalMethod, Encoder, Extension, Frame, Repeat};

use super::super::color::Rgb;
use super::super::error::RenderError;
use super::super::image::Image;
use super::palette::{Histogram, Matcher, distance};
use super::{partial_path, write_error};

/// Most bytes of frames a GIF may hold in memory before it is written.
const GIF_MEMORY: usize = 800_000_000;

/// How a GIF is compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GifOptions {
    /// Most colours, 2 to 255.
    pub colors: u16,
    /// Largest change of a channel's level that is not worth a new pixel.
    pub tolerance: u8,
    /// Largest size \[bytes]: quality, then the number of frames, is reduced until the file fits.
    pub size_limit: Option<u64>,
}

impl Default for GifOptions {
    fn default() -> Self {
        GifOptions { colors: 160, tolerance: 3, size_limit: None }
    }
}

/// How hard a GIF is compressed.
#[derive(Clone, Copy, Debug)]
struct Effort {
    colors: usize,
    tolerance: u8,
    /// Keep one frame of so many.
    thinning: usize,
}

/// Collects frames and writes them as one GIF with one palette for all, so that nothing flickers.
/// Frames are held in memory because the last ones decide about the palette as much as the first.
pub struct GifWriter {
    path: PathBuf,
    options: GifOptions,
    fps: f64,
    mark: String,
    size: Option<(u32, u32)>,
    frames: Vec<Vec<u8>>,
}

impl GifWriter {
    /// Starts a GIF that plays `fps` frames a second.
    pub fn new(path: &Path, fps: f64, options: GifOptions) -> GifWriter {
        GifWriter { path: path.to_owned(), options, fps, mark: String::new(), size: None, frames: Vec::new() }
    }

    /// Adds a comment of at most 255 bytes.
    #[must_use]
    pub fn marked(self, mark: &str) -> GifWriter {
        GifWriter { mark: mark.to_owned(), ..self }
    }

    /// Adds a frame; all must have the same size.
    pub fn push(&mut self, image: &Image) -> Result<(), RenderError> {
        let size = (image.width(), image.height());
        if *self.size.get_or_insert(size) != size || size.0.max(size.1) > u32::from(u16::MAX) {
            return Err(RenderError::PictureSize { width: size.0, height: size.1 });
        }
        let frame = image.to_rgb();
        if (self.frames.len() + 1) * frame.len() > GIF_MEMORY {
            return Err(RenderError::GifMemory { limit: GIF_MEMORY });
        }
        self.frames.push(frame);
        Ok(())
    }

    /// Compresses all frames and writes the file.
    pub fn finish(self) -> Result<(), RenderError> {
        let bytes = self.compress()?;
        let partial = partial_path(&self.path);
        std::fs::write(&partial, bytes).map_err(write_error(&partial))?;
        std::fs::rename(&partial, &self.path).map_err(write_error(&self.path))
    }

    fn compress(&self) -> Result<Vec<u8>, RenderError> {
        let colors = usize::from(self.options.colors.clamp(2, 255));
        let best = Effort { colors, tolerance: self.options.tolerance, thinning: 1 };
        let Some(limit) = self.options.size_limit else { return self.encode(best) };
        let steps =
            [(1, 255, 0), (1, 96, 5), (1, 64, 8), (2, 96, 5), (2, 48, 10), (3, 48, 10), (4, 32, 12), (6, 24, 16)];
        for (thinning, most_colors, least_tolerance) in steps {
            let tolerance = best.tolerance.max(least_tolerance);
            let bytes = self.encode(Effort { colors: colors.min(most_colors), tolerance, thinning })?;
            if bytes.len() as u64 <= limit {
                return Ok(bytes);
            }
        }
        Err(RenderError::GifSize { limit })
    }

    fn encode(&self, effort: Effort) -> Result<Vec<u8>, RenderError> {
        let Some((width, height)) = self.size else { return Err(RenderError::NoFrames) };
        let histogram = self.histogram();
        let mut matcher = Matcher::new(histogram.palette(effort.colors));
        let size = [width as u16, height as u16];
        let mut encoded = || -> Result<Vec<u8>, gif::EncodingError> {
            // The last entry is never seen: it marks pixels that stay.
            let table = [&matcher.palette().concat()[..], &[0; 3]].concat();
            let mut encoder = Encoder::new(Vec::new(), size[0], size[1], &table)?;
            encoder.set_repeat(Repeat::Infinite)?;
            if !self.mark.is_empty() {
                encoder.write_raw_extension(AnyExtension::from(Extension::Comment), &[self.mark.as_bytes()])?;
            }
            let mut shown = Shown { ground: histogram.most_frequent(), ..Shown::default() };
            let mut clock = Clock { fps: self.fps / effort.thinning as f64, frames: 0 };
            for frame in self.frames.iter().step_by(effort.thinning) {
                let delay = clock.next_delay();
                encoder.write_frame(&shown.next(frame, size, &mut matcher, effort.tolerance, delay))?;
            }
            encoder.into_inner()
        };
        encoded().map_err(|error| RenderError::Write { path: self.path.clone(), source: std::io::Error::other(error) })
    }

    /// Colours of up to 48 frames spread over the film.
    fn histogram(&self) -> Histogram {
        let mut histogram = Histogram::new();
        for frame in self.frames.iter().step_by(self.frames.len().div_ceil(48)) {
            colors(frame).for_each(|color| histogram.add(color));
        }
        histogram
    }
}

fn colors(rgb: &[u8]) -> impl Iterator<Item = Rgb> {
    rgb.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]])
}

/// Turns frame times into delays of whole hundredths of a second whose sum does not drift.
struct Clock {
    fps: f64,
    frames: u64,
}

impl Clock {
    fn next_delay(&mut self) -> u16 {
        let at = |frames: u64| (frames as f64 * 100.0 / self.fps).round();
        let delay = at(self.frames + 1) - at(self.frames);
        self.frames += 1;
        delay.clamp(2.0, f64::from(u16::MAX)) as u16
    }
}

/// The picture that a viewer shows after the frames so far.
#[derive(Default)]
struct Shown {
    /// The colour between things: returning to it is always worth a pixel, or moving things would
    /// leave trails.
    ground: Rgb,
    /// Palette index and the true colour it stood for; empty before the first frame.
    indices: Vec<u8>,
    colors: Vec<Rgb>,
}

impl Shown {
    /// The next frame as the rectangle that changed, with unchanged pixels left transparent.
    fn next(
        &mut self,
        frame: &[u8],
        [width, height]: [u16; 2],
        matcher: &mut Matcher,
        tolerance: u8,
        delay: u16,
    ) -> Frame<'static> {
        let first = self.indices.is_empty();
        if first {
            self.indices = colors(frame).map(|color| matcher.index(color)).collect();
            self.colors = colors(frame).collect();
            return whole(self.indices.clone(), [width, height], delay);
        }
        let transparent = matcher.palette().len() as u8;
        let limit = 3 * u32::from(tolerance) * u32::from(tolerance);
        let mut pixels = vec![transparent; self.indices.len()];
        let mut rectangle = Rectangle::default();
        for (at, color) in colors(frame).enumerate() {
            let changed = distance(color, self.colors[at]) > limit || color == self.ground;
            let index = if changed { matcher.index(color) } else { self.indices[at] };
            if index != self.indices[at] {
                (self.indices[at], self.colors[at], pixels[at]) = (index, color, index);
                rectangle.include(at % usize::from(width), at / usize::from(width));
            }
        }
        rectangle.cut(&pixels, usize::from(width), transparent, delay)
    }
}

fn whole(indices: Vec<u8>, [width, height]: [u16; 2], delay: u16) -> Frame<'static> {
    Frame { width, height, delay, buffer: Cow::Owned(indices), dispose: DisposalMethod::Keep, ..Frame::default() }
}

/// Columns and rows from the first to the last that changed.
struct Rectangle {
    min: [usize; 2],
    max: [usize; 2],
}

impl Default for Rectangle {
    fn default() -> Self {
        Rectangle { min: [usize::MAX; 2], max: [0; 2] }
    }
}

impl Rectangle {
    fn include(&mut self, x: usize, y: usize) {
        self.min = [self.min[0].min(x), self.min[1].min(y)];
        self.max = [self.max[0].max(x), self.max[1].max(y)];
    }

    fn cut(mut self, pixels: &[u8], width: usize, transparent: u8, delay: u16) -> Frame<'static> {
        if self.min[0] == usize::MAX {
            // Nothing changed: a frame cannot be empty, so one transparent pixel carries the delay.
            self.min = [0; 2];
        }
        let [columns, rows] = [self.min[0]..self.max[0] + 1, self.min[1]..self.max[1] + 1];
        let buffer: Vec<u8> = rows.clone().flat_map(|y| pixels[y * width..][columns.clone()].iter().copied()).collect();
        Frame {
            left: columns.start as u16,
            top: rows.start as u16,
            transparent: Some(transparent),
            ..whole(buffer, [columns.len() as u16, rows.len() as u16], delay)
        }
    }
}
