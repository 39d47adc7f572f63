//! Outlines of bodies and walls asked: rays, points, boxes, other outlines.

use super::{Body, Boundary, Pose, Wall};
use crate::math::Vector64;
use crate::shapes::{Nearest, Shape, edges, nearest_on_polygon};

/// Where a ray enters an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    /// Part of the way from the start of the ray to its end, 0 to 1.
    pub fraction: f64,
    /// Outward normal, of length 1.
    pub normal: Vector64,
}

/// An outline in the world.
pub(crate) enum Outline {
    /// A disc: centre and radius \[m].
    Disc(Vector64, f64),
    /// A polygon, counter-clockwise \[m].
    Polygon(Vec<Vector64>),
    /// Everything behind a line: a point on it \[m] and its outward normal.
    HalfPlane(Vector64, Vector64),
}

impl Body {
    /// Place and orientation.
    pub fn pose(&self) -> Pose {
        Pose { position: self.position, angle: self.angle }
    }

    /// The outline where the body is; `None` of one that was taken away.
    pub(crate) fn placed(&self) -> Option<Outline> {
        if self.removed {
            return None;
        }
        if self.radius > 0.0 {
            return Some(Outline::Disc(self.position, self.radius));
        }
        let pose = self.pose();
        Some(Outline::Polygon(self.outline.iter().map(|corner| pose.apply(*corner)).collect()))
    }
}

impl Wall {
    /// The outline of the solid.
    pub(crate) fn placed(&self) -> Outline {
        match &self.boundary {
            Boundary::HalfPlane { point, normal } => Outline::HalfPlane(*point, *normal),
            Boundary::Disc { center, radius } => Outline::Disc(*center, *radius),
            Boundary::Polygon(corners) => Outline::Polygon(corners.clone()),
        }
    }
}

impl Outline {
    /// Signed distance to the outline, negative inside, and its outward normal.
    pub fn nearest(&self, point: Vector64) -> Nearest {
        match self {
            Outline::Disc(center, radius) => Shape::Disc { radius: *radius }.nearest(point - *center),
            Outline::Polygon(corners) => nearest_on_polygon(corners, point),
            Outline::HalfPlane(on, normal) => Nearest { distance: (point - *on).dot(*normal), normal: *normal },
        }
    }

    /// Where a ray that starts outside enters; `None` if it misses.
    pub fn entered(&self, from: Vector64, to: Vector64) -> Option<Entry> {
        let way = to - from;
        match self {
            Outline::Disc(center, radius) => {
                let (arm, length) = (from - *center, way.length());
                let along = arm.dot(way) / length;
                let off = along * along - (arm.length_squared() - radius * radius);
                let fraction = (-along - off.max(0.0).sqrt()) / length;
                let hits = length > 0.0 && off >= 0.0 && along < 0.0 && (0.0..=1.0).contains(&fraction);
                hits.then(|| Entry { fraction, normal: (arm + way * fraction).normalize_or_zero() })
            }
            Outline::Polygon(corners) => {
                let entries = edges(corners).filter_map(|(p, q)| cross((from, way), (p, q)));
                entries.min_by(|a, b| a.fraction.total_cmp(&b.fraction))
            }
            Outline::HalfPlane(on, normal) => {
                let (height, fall) = ((from - *on).dot(*normal), -way.dot(*normal));
                let hits = height >= 0.0 && fall > 0.0 && height <= fall;
                hits.then(|| Entry { fraction: height / fall, normal: *normal })
            }
        }
    }

    /// Whether two solids have a point in common.
    pub fn overlaps(&self, other: &Outline) -> bool {
        match (self, other) {
            (Outline::Disc(a, r), Outline::Disc(b, s)) => (*a - *b).length_squared() <= (r + s) * (r + s),
            (Outline::Disc(center, radius), solid) | (solid, Outline::Disc(center, radius)) => {
                solid.nearest(*center).distance <= *radius
            }
            (Outline::Polygon(a), Outline::Polygon(b)) => polygons_overlap(a, b),
            (Outline::Polygon(corners), plane @ Outline::HalfPlane(..))
            | (plane @ Outline::HalfPlane(..), Outline::Polygon(corners)) => {
                corners.iter().any(|corner| plane.nearest(*corner).distance <= 0.0)
            }
            (Outline::HalfPlane(a, n), Outline::HalfPlane(b, m)) => n.dot(*m) > -1.0 || (*b - *a).dot(*n) <= 0.0,
        }
    }
}

/// Where a ray crosses an edge from outside: the outside lies to the right of the way from `p` to `q`.
fn cross((from, way): (Vector64, Vector64), (p, q): (Vector64, Vector64)) -> Option<Entry> {
    let side = q - p;
    let normal = -side.perp();
    let closing = -way.dot(normal);
    if closing <= 0.0 {
        return None;
    }
    let fraction = (from - p).dot(normal) / closing;
    let along = (from + way * fraction - p).dot(side) / side.length_squared();
    let hits = (0.0..=1.0).contains(&fraction) && (0.0..=1.0).contains(&along);
    hits.then(|| Entry { fraction, normal: normal.normalize_or_zero() })
}

fn polygons_overlap(a: &[Vector64], b: &[Vector64]) -> bool {
    let inside = |point: Option<&Vector64>, of: &[Vector64]| {
        point.is_some_and(|point| nearest_on_polygon(of, *point).distance <= 0.0)
    };
    let crossing = edges(a).any(|(p, q)| edges(b).any(|(r, s)| segments_cross(p, q, r, s)));
    crossing || inside(a.first(), b) || inside(b.first(), a)
}

fn segments_cross(p: Vector64, q: Vector64, r: Vector64, s: Vector64) -> bool {
    let side = |a: Vector64, b: Vector64, c: Vector64| (b - a).perp_dot(c - a);
    // Of two segments on one line only the boxes tell.
    let near = p.min(q).cmple(r.max(s)).all() && r.min(s).cmple(p.max(q)).all();
    near && side(p, q, r) * side(p, q, s) <= 0.0 && side(r, s, p) * side(r, s, q) <= 0.0
}

/// A box \[m].
pub(crate) fn rectangle(low: Vector64, high: Vector64) -> Outline {
    Outline::Polygon(vec![low, Vector64::new(high.x, low.y), high, Vector64::new(low.x, high.y)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Vector64 {
        Vector64::new(x, y)
    }

    #[test]
    fn rays_enter_from_outside_alone() {
        let square = rectangle(at(0.0, 0.0), at(2.0, 1.0));
        let entry = square.entered(at(-1.0, 0.5), at(3.0, 0.5)).expect("it hits");
        assert_eq!((entry.fraction, entry.normal), (0.25, at(-1.0, 0.0)));
        assert!(square.entered(at(1.0, 0.5), at(3.0, 0.5)).is_none(), "from within");
        assert!(square.entered(at(-1.0, 1.5), at(3.0, 1.5)).is_none(), "above");
        assert!(square.entered(at(-1.0, 0.5), at(-0.5, 0.5)).is_none(), "too short");
        let disc = Outline::Disc(at(0.0, 0.0), 1.0);
        let entry = disc.entered(at(0.0, 3.0), at(0.0, -1.0)).expect("it hits");
        assert!((entry.fraction - 0.5).abs() < 1e-12 && (entry.normal - at(0.0, 1.0)).length() < 1e-12);
        let plane = Outline::HalfPlane(at(0.0, -1.0), at(0.0, 1.0));
        assert_eq!(plane.entered(at(0.0, 1.0), at(0.0, -3.0)).map(|entry| entry.fraction), Some(0.5));
    }

    #[test]
    fn solids_overlap_when_they_share_a_point() {
        let square = rectangle(at(0.0, 0.0), at(2.0, 1.0));
        assert!(square.overlaps(&rectangle(at(0.5, 0.2), at(0.6, 0.3))), "one within the other");
        assert!(square.overlaps(&rectangle(at(0.5, -1.0), at(0.6, 3.0))), "a cross");
        assert!(!square.overlaps(&rectangle(at(2.1, 0.0), at(3.0, 1.0))), "edges on one line, apart");
        assert!(
            square.overlaps(&Outline::Disc(at(2.5, 0.5), 0.6)) && !square.overlaps(&Outline::Disc(at(2.5, 0.5), 0.4))
        );
    }
}
