//! Rounded cores: a solid as convex polygons grown by a contact radius.
//!
//! The outline is moved inwards by the radius; growing it again gives back every face and rounds
//! the corners. Two rounded solids have a well-defined normal even when they slightly overlap.

use super::{Shape, decompose::convex_decomposition, polygon};
use crate::math::Vector64;

/// The rounded convex pieces of a solid.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Core {
    /// Distance of the surface outside the pieces [m].
    pub radius: f64,
    /// Convex pieces; a disc is one piece with one vertex.
    pub pieces: Vec<ConvexPiece>,
}

/// A convex polygon, counter-clockwise.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ConvexPiece {
    /// Vertices [m].
    pub vertices: Vec<Vector64>,
    /// Outward normal of the edge that starts at each vertex; zero for a single vertex.
    pub normals: Vec<Vector64>,
    /// Whether that edge is part of the outline, and not a cut through the solid.
    pub outer: Vec<bool>,
    /// Whether the vertex can be in contact: convex in the outline, and not listed by another piece.
    pub sampled: Vec<bool>,
}

pub(super) fn core(shape: &Shape, radius: f64) -> Core {
    match shape {
        Shape::Disc { radius } => Core { radius: *radius, pieces: vec![ConvexPiece::point()] },
        Shape::Polygon(corners) => polygon_core(&polygon::tidied(corners), radius),
    }
}

/// Halves the radius until the inset outline is the same polygon, only smaller.
fn polygon_core(corners: &[Vector64], radius: f64) -> Core {
    let radii = (0..6u32).map(|halvings| radius / f64::from(1 << halvings));
    let fitting = radii.filter(|&r| r > 0.0).find_map(|r| Some((r, inset(corners, r)?)));
    let (radius, outline) = fitting.unwrap_or((0.0, corners.to_vec()));
    let mut owned = vec![false; outline.len()];
    let pieces = convex_decomposition(&outline);
    Core { radius, pieces: pieces.iter().map(|piece| ConvexPiece::cut(&outline, piece, &mut owned)).collect() }
}

impl ConvexPiece {
    fn point() -> ConvexPiece {
        ConvexPiece {
            vertices: vec![Vector64::ZERO],
            normals: vec![Vector64::ZERO],
            outer: vec![true],
            sampled: vec![true],
        }
    }

    fn cut(outline: &[Vector64], piece: &[usize], owned: &mut [bool]) -> ConvexPiece {
        let (n, m) = (outline.len(), piece.len());
        let corner = |k: usize| outline[k % n];
        let vertices: Vec<Vector64> = piece.iter().map(|&k| corner(k)).collect();
        let normals = polygon::edges(&vertices).map(|(p, q)| -(q - p).perp().normalize_or_zero()).collect();
        let outer = (0..m).map(|k| piece[(k + 1) % m] == (piece[k] + 1) % n).collect();
        let convex = |k: usize| (corner(k) - corner(k + n - 1)).perp_dot(corner(k + 1) - corner(k)) > 0.0;
        let sampled = piece.iter().map(|&k| convex(k) && !std::mem::replace(&mut owned[k], true)).collect();
        ConvexPiece { vertices, normals, outer, sampled }
    }
}

/// The outline moved inwards by `radius`, or `None` if an edge would shrink below a quarter.
fn inset(corners: &[Vector64], radius: f64) -> Option<Vec<Vector64>> {
    let n = corners.len();
    let normal = |k: usize| -(corners[(k + 1) % n] - corners[k % n]).perp().normalize();
    let moved: Vec<Vector64> = (0..n)
        .map(|k| {
            let (before, after) = (normal(k + n - 1), normal(k));
            corners[k] - (before + after) * (radius / (1.0 + before.dot(after)).max(1e-9))
        })
        .collect();
    let kept = (0..n).all(|k| {
        let (edge, short) = (corners[(k + 1) % n] - corners[k], moved[(k + 1) % n] - moved[k]);
        short.dot(edge) >= 0.25 * edge.length_squared()
    });
    (kept && polygon::is_simple(&moved)).then_some(moved)
}
