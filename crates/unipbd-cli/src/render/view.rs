use unipbd_core::math::Vector64;
use unipbd_core::observe::WallOutline;

use super::error::RenderError;
use crate::snapshot::{Setting, Snapshot};

/// The region a picture shows \[m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Lower left corner.
    pub min: [f64; 2],
    /// Upper right corner.
    pub max: [f64; 2],
}

impl View {
    /// The region that holds the walls, the bodies, and all but a few stray particles of all given
    /// frames, with a margin of two spacings.
    pub fn fit<'a>(setting: &Setting, frames: impl IntoIterator<Item = &'a Snapshot>) -> View {
        let mut extent = Extent::default();
        for frame in frames {
            extent.include_frame(frame, setting.spacing);
        }
        extent.view(setting)
    }

    pub(super) fn checked(self) -> Result<View, RenderError> {
        let spans = [0, 1].map(|axis| self.max[axis] - self.min[axis]);
        if spans.iter().all(|span| span.is_finite() && *span > 0.0) { Ok(self) } else { Err(RenderError::View) }
    }

    /// The same region, widened about its centre so that the picture is neither a thread nor a ribbon.
    fn bounded_aspect(self) -> View {
        let mut spans = [0, 1].map(|axis| self.max[axis] - self.min[axis]);
        spans = [spans[0].max(spans[1] / 2.0), spans[1].max(spans[0] / 6.0)];
        let center = [0, 1].map(|axis| (self.max[axis] + self.min[axis]) / 2.0);
        View {
            min: [0, 1].map(|axis| center[axis] - spans[axis] / 2.0),
            max: [0, 1].map(|axis| center[axis] + spans[axis] / 2.0),
        }
    }
}

/// The box around what was seen so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    min: Vector64,
    max: Vector64,
}

impl Default for Extent {
    fn default() -> Self {
        Extent { min: Vector64::INFINITY, max: Vector64::NEG_INFINITY }
    }
}

impl Extent {
    fn include(&mut self, point: Vector64) {
        if point.is_finite() {
            self.min = self.min.min(point);
            self.max = self.max.max(point);
        }
    }

    pub fn include_frame(&mut self, frame: &Snapshot, spacing: f64) {
        let spans = [0, 1].map(|axis| span_of_most(frame.positions.iter().map(|position| position[axis])));
        if let [Some([left, right]), Some([bottom, top])] = spans {
            self.include(Vector64::new(left, bottom));
            self.include(Vector64::new(right, top));
        }
        for body in &frame.bodies {
            let far = body.outline.iter().chain(&body.samples).map(|point| point.length());
            let reach = far.fold(body.radius.max(spacing / 2.0), f64::max);
            self.include(body.position - reach);
            self.include(body.position + reach);
        }
    }

    pub fn view(mut self, setting: &Setting) -> View {
        for wall in setting.walls.iter().filter(|wall| !wall.endless) {
            wall.points.iter().for_each(|point| self.include(*point));
        }
        for wall in setting.walls.iter().filter(|wall| wall.endless) {
            self.include_endless(wall);
        }
        if !(self.min.is_finite() && self.max.is_finite()) {
            (self.min, self.max) = (Vector64::ZERO, Vector64::ONE);
        }
        let margin = if setting.spacing > 0.0 { 2.0 * setting.spacing } else { 0.02 * (self.max - self.min).length() };
        let margin = margin.max(1e-6);
        View { min: (self.min - margin).into(), max: (self.max + margin).into() }
    }

    /// A wall without end is shown where it is near: by the point closest to the centre.
    fn include_endless(&mut self, wall: &WallOutline) {
        let [from, .., to] = wall.points[..] else { return };
        if !self.min.is_finite() {
            self.include(from);
            self.include(to);
            return;
        }
        let [center, span] = [(self.min + self.max) / 2.0, self.max - self.min];
        let along = (to - from).normalize_or_zero();
        let foot = from + along * (center - from).dot(along);
        if (foot - center).length() < span.length().max(1e-9) {
            self.include(foot);
        }
    }
}

/// The span of finite coordinates without the outermost 0.2 % at either end: a few drops that fly
/// high must not shrink all the rest.
fn span_of_most(coordinates: impl Iterator<Item = f32>) -> Option<[f64; 2]> {
    let mut coordinates: Vec<f32> = coordinates.filter(|value| value.is_finite()).collect();
    let strays = coordinates.len() / 500;
    let last = coordinates.len().checked_sub(1)?;
    let [low, high] =
        [strays, last - strays].map(|index| f64::from(*coordinates.select_nth_unstable_by(index, f32::total_cmp).1));
    Some([low, high])
}

/// From metres to pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    /// Region shown, of the picture's aspect ratio.
    pub view: View,
    /// Pixels per metre.
    pub scale: f64,
    /// Size of the region in pixels.
    pub size: [u32; 2],
}

impl Camera {
    pub fn new(view: View, width: u32) -> Result<Camera, RenderError> {
        let view = view.checked()?.bounded_aspect();
        let width = width.max(2).next_multiple_of(2);
        let scale = f64::from(width) / (view.max[0] - view.min[0]);
        let height = ((view.max[1] - view.min[1]) * scale / 2.0).round() as u32 * 2;
        Ok(Camera { view, scale, size: [width, height.max(2)] })
    }

    /// Pixel coordinates of a point: x to the right, y down, from the upper left corner.
    pub fn pixel(&self, point: Vector64) -> [f32; 2] {
        let x = (point.x - self.view.min[0]) * self.scale;
        let y = f64::from(self.size[1]) - (point.y - self.view.min[1]) * self.scale;
        [x as f32, y as f32]
    }

    /// Pixel coordinates of a particle.
    pub fn particle(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        self.pixel(Vector64::new(f64::from(x), f64::from(y)))
    }

    /// Length of a distance \[m] in pixels.
    pub fn length(&self, distance: f64) -> f32 {
        (distance * self.scale) as f32
    }

    /// Centre of the region \[m].
    pub fn center(&self) -> Vector64 {
        (Vector64::from(self.view.min) + Vector64::from(self.view.max)) / 2.0
    }

    /// Diagonal of the region \[m].
    pub fn diagonal(&self) -> f64 {
        (Vector64::from(self.view.max) - Vector64::from(self.view.min)).length()
    }
}
