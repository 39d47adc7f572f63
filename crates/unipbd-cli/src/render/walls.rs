use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Stroke, Transform};
use unipbd_core::math::Vector64;
use unipbd_core::observe::WallOutline;

use super::color::Rgb;
use super::image::Image;
use super::theme::Theme;
use super::view::Camera;

/// A wall made ready to draw.
pub(super) struct Wall {
    points: Vec<Vector64>,
    closed: bool,
    endless: bool,
}

impl Wall {
    /// Nothing for an outline that is no line.
    pub fn new(outline: &WallOutline, camera: &Camera) -> Option<Wall> {
        let mut points = outline.points.clone();
        points.dedup();
        if outline.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 2 || !points.iter().all(|point| point.is_finite()) {
            return None;
        }
        if outline.endless {
            extend(&mut points, camera.diagonal());
        }
        Some(Wall { points, closed: outline.closed, endless: outline.endless })
    }

    /// Draws a line with a lighter band on its solid side, which lies to the right of the way from
    /// point to point. The inside of a solid box and the far side of an endless wall are filled.
    pub fn draw(&self, image: &mut Image, camera: &Camera, theme: &Theme, spacing: f32, scale: f32) {
        let points = &self.points;
        let solid_inside = self.closed && area(points) < 0.0;
        // The band must hide what a surface draws beyond the wall.
        let band_depth = f64::from((9.0 * scale).max(0.8 * spacing)) / camera.scale;
        let depth = if self.endless { 4.0 * camera.diagonal() } else { band_depth };
        let filled = if solid_inside { polygon(points, camera) } else { band(points, self.closed, depth, camera) };
        fill(image, filled, theme.wall_fill);
        stroke(image, line(points, self.closed, camera), theme.wall_line, 1.8 * scale);
    }

    /// The mirror images of a point in those straight pieces that have it before them, no farther
    /// away than `reach` [m].
    pub fn mirror(&self, point: Vector64, reach: f64, mut image: impl FnMut(Vector64)) {
        let count = self.points.len();
        let pieces = if self.closed { count } else { count - 1 };
        for k in 0..pieces {
            let [from, to] = [self.points[k], self.points[(k + 1) % count]];
            let way = to - from;
            let length = way.length();
            let height = way.perp_dot(point - from) / length;
            let along = way.dot(point - from) / length;
            if height > 0.0 && height < reach && along > -reach && along < length + reach {
                image(point + way.perp() * (-2.0 * height / length));
            }
        }
    }
}

/// Twice the signed area: positive where the points run counter-clockwise.
fn area(points: &[Vector64]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// Moves the ends of a line outwards, out of the picture.
fn extend(points: &mut [Vector64], diagonal: f64) {
    let last = points.len() - 1;
    let [start, end] = [(points[0] - points[1]).normalize(), (points[last] - points[last - 1]).normalize()];
    points[0] += start * 4.0 * diagonal;
    points[last] += end * 4.0 * diagonal;
}

/// The strip of the given depth [m] to the right of a line, with mitred corners.
fn band(points: &[Vector64], closed: bool, depth: f64, camera: &Camera) -> Option<Path> {
    let count = points.len();
    let right = |from: usize, to: usize| -(points[to] - points[from]).normalize().perp();
    let outer: Vec<Vector64> = (0..count)
        .map(|k| {
            let before = (closed || k > 0).then(|| right((k + count - 1) % count, k));
            let after = (closed || k + 1 < count).then(|| right(k, (k + 1) % count));
            points[k] + depth * miter(before.or(after).unwrap_or_default(), after.or(before).unwrap_or_default())
        })
        .collect();
    let mut path = PathBuilder::new();
    if closed {
        add_points(&mut path, points.iter(), true, camera);
        add_points(&mut path, outer.iter(), true, camera);
    } else {
        add_points(&mut path, points.iter().chain(outer.iter().rev()), true, camera);
    }
    path.finish()
}

/// From a corner to the crossing of two lines at distance 1 along the normals `a` and `b`.
fn miter(a: Vector64, b: Vector64) -> Vector64 {
    (a + b) / (1.0 + a.dot(b)).max(0.25)
}

pub(super) fn polygon(points: &[Vector64], camera: &Camera) -> Option<Path> {
    line(points, true, camera)
}

pub(super) fn line(points: &[Vector64], closed: bool, camera: &Camera) -> Option<Path> {
    let mut path = PathBuilder::new();
    add_points(&mut path, points.iter(), closed, camera);
    path.finish()
}

fn add_points<'a>(path: &mut PathBuilder, points: impl Iterator<Item = &'a Vector64>, closed: bool, camera: &Camera) {
    for (k, point) in points.enumerate() {
        let [x, y] = camera.pixel(*point);
        if k == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
}

pub(super) fn fill(image: &mut Image, path: Option<Path>, color: Rgb) {
    let Some(path) = path else { return };
    image.canvas().fill_path(&path, &solid(color), FillRule::EvenOdd, Transform::identity(), None);
}

pub(super) fn stroke(image: &mut Image, path: Option<Path>, color: Rgb, width: f32) {
    let Some(path) = path else { return };
    let stroke = Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
    image.canvas().stroke_path(&path, &solid(color), &stroke, Transform::identity(), None);
}

fn solid(color: Rgb) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(color[0], color[1], color[2], 255);
    paint
}
