//! Static walls: solids that bodies and particles cannot enter.

use super::Surface;
use crate::math::Vector64;
use crate::shapes::{Nearest, Shape, nearest_on_polygon};

/// The geometry of a wall.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Boundary {
    /// A half-plane: the side of a straight line behind its normal is solid.
    HalfPlane {
        /// A point on the line \[m].
        point: Vector64,
        /// Unit normal, out of the solid.
        normal: Vector64,
    },
    /// A solid disc.
    Disc {
        /// Centre \[m].
        center: Vector64,
        /// Radius \[m].
        radius: f64,
    },
    /// A solid polygon, convex or not, in world coordinates \[m].
    Polygon(Vec<Vector64>),
}

/// A static wall.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Wall {
    /// Its geometry.
    pub boundary: Boundary,
    /// Friction and restitution.
    pub surface: Surface,
    /// Name under which its force is reported; empty without one.
    pub name: String,
}

impl Wall {
    /// A half-plane; the normal need not have length 1.
    pub fn half_plane(point: Vector64, normal: Vector64, surface: Surface) -> Wall {
        Wall { boundary: Boundary::HalfPlane { point, normal: normal.normalize() }, surface, name: String::new() }
    }

    /// A solid polygon in world coordinates.
    pub fn polygon(corners: Vec<Vector64>, surface: Surface) -> Wall {
        Wall { boundary: Boundary::Polygon(corners), surface, name: String::new() }
    }

    /// The same under a name.
    #[must_use]
    pub fn named(self, name: String) -> Wall {
        Wall { name, ..self }
    }

    /// A solid axis-aligned box.
    pub fn rectangle(low: Vector64, high: Vector64, surface: Surface) -> Wall {
        let corners = vec![low, Vector64::new(high.x, low.y), high, Vector64::new(low.x, high.y)];
        Wall::polygon(corners, surface)
    }

    /// The four walls of a container: left, right, bottom, top.
    pub fn tank(low: Vector64, high: Vector64, surface: Surface) -> [Wall; 4] {
        let side = |point, normal| Wall::half_plane(point, normal, surface);
        [side(low, Vector64::X), side(high, -Vector64::X), side(low, Vector64::Y), side(high, -Vector64::Y)]
    }

    /// Signed distance to the surface and its outward normal.
    pub fn nearest(&self, point: Vector64) -> Nearest {
        match &self.boundary {
            Boundary::HalfPlane { point: on, normal } => {
                Nearest { distance: (point - *on).dot(*normal), normal: *normal }
            }
            Boundary::Disc { center, radius } => Shape::Disc { radius: *radius }.nearest(point - *center),
            Boundary::Polygon(corners) => nearest_on_polygon(corners, point),
        }
    }
}
