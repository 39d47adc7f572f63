use tiny_skia::{Path, PathBuilder};
use unipbd_core::math::Vector64;
use unipbd_core::observe::WallOutline;

use super::color::Rgb;
use super::paper::Paper;
use super::theme::Theme;
use super::view::Camera;

/// Depth of the band on the solid side of a wall in a picture 960 pixels wide.
const BAND: f32 = 9.0;

/// A wall made ready to draw.
pub(super) struct Wall {
    points: Vec<Vector64>,
    pieces: Vec<Piece>,
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
            center(&mut points, camera);
        }
        Some(Wall { pieces: pieces(&points, outline.closed), points, closed: outline.closed, endless: outline.endless })
    }

    /// Draws a line with a lighter band on its solid side, which lies to the right of the way from
    /// point to point. The inside of a solid box and the far side of an endless wall are filled.
    pub fn draw(&self, paper: &mut dyn Paper, camera: &Camera, theme: &Theme, scale: f32) {
        let points = &self.points;
        let solid_inside = self.closed && area(points) < 0.0;
        let band_depth = f64::from(BAND * scale) / camera.scale;
        let depth = if self.endless { 2.0 * camera.diagonal() } else { band_depth };
        let filled = if solid_inside { polygon(points, camera) } else { band(points, self.closed, depth, camera) };
        fill(paper, filled, theme.wall_fill);
        stroke(paper, line(points, self.closed, camera), theme.wall_line, 1.8 * scale);
    }

    /// The corners of what a closed wall surrounds; nothing for a block of wall, and for a line.
    pub fn inside(&self) -> Option<&[Vector64]> {
        (self.closed && area(&self.points) > 0.0).then_some(&self.points)
    }

    /// The mirror images of a point in those straight pieces that have it before them, no farther
    /// away than `reach` \[m], each with the direction out of its wall.
    pub fn mirror(&self, point: Vector64, reach: f64, mut image: impl FnMut(Vector64, Vector64)) {
        for piece in &self.pieces {
            let offset = point - piece.from;
            let height = piece.way.perp_dot(offset);
            let along = piece.way.dot(offset);
            if height > 0.0 && height < reach && along > 0.0 && along < piece.length {
                let normal = piece.way.perp();
                image(point - normal * 2.0 * height, normal);
            }
        }
    }
}

/// The region that closed walls surround: gas and smoke are cut to it, as their soft edges reach farther than they do.
/// Nothing where no wall is closed.
pub(super) fn region(walls: &[Wall], camera: &Camera) -> Option<Path> {
    let mut path = PathBuilder::new();
    for corners in walls.iter().filter_map(Wall::inside) {
        add_points(&mut path, corners.iter(), true, camera);
    }
    path.finish()
}

/// A straight piece of a wall.
struct Piece {
    from: Vector64,
    /// Direction of the way, of length 1.
    way: Vector64,
    length: f64,
}

fn pieces(points: &[Vector64], closed: bool) -> Vec<Piece> {
    let count = if closed { points.len() } else { points.len() - 1 };
    let piece = |k: usize| {
        let way = points[(k + 1) % points.len()] - points[k];
        Piece { from: points[k], way: way.normalize(), length: way.length() }
    };
    (0..count).map(piece).collect()
}

/// Twice the signed area: positive where the points run counter-clockwise.
fn area(points: &[Vector64]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// Cuts a line without end to the stretch that passes the picture, with some to spare.
fn center(points: &mut Vec<Vector64>, camera: &Camera) {
    let from = points[0];
    let along = (points[points.len() - 1] - from).normalize();
    let foot = from + along * (camera.center() - from).dot(along);
    *points = vec![foot - along * 2.0 * camera.diagonal(), foot + along * 2.0 * camera.diagonal()];
}

/// The strip of the given depth \[m] to the right of a line, with mitred corners.
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

pub(super) fn fill(paper: &mut dyn Paper, path: Option<Path>, color: Rgb) {
    if let Some(path) = path {
        paper.fill(&path, color, 1.0);
    }
}

pub(super) fn stroke(paper: &mut dyn Paper, path: Option<Path>, color: Rgb, width: f32) {
    if let Some(path) = path {
        paper.stroke(&path, color, width);
    }
}
