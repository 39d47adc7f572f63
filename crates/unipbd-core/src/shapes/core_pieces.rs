//! A solid as convex polygons, for contacts: the pieces cover the outline exactly.

use super::{Shape, decompose::convex_decomposition, polygon};
use crate::math::Vector64;

/// The convex pieces of a solid.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Core {
    /// Radius of a disc; 0 for a polygon \[m].
    pub radius: f64,
    /// Convex pieces; a disc is one piece with one vertex.
    pub pieces: Vec<ConvexPiece>,
}

/// A convex polygon, counter-clockwise.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ConvexPiece {
    /// Vertices \[m].
    pub vertices: Vec<Vector64>,
    /// Outward normal of the edge that starts at each vertex; zero for a single vertex.
    pub normals: Vec<Vector64>,
    /// Whether that edge is part of the outline, and not a cut through the solid.
    pub outer: Vec<bool>,
    /// Whether the vertex is a convex corner of the outline, and not listed by another piece.
    pub corners: Vec<bool>,
}

pub(super) fn core(shape: &Shape) -> Core {
    match shape {
        Shape::Disc { radius } => Core { radius: *radius, pieces: vec![ConvexPiece::point()] },
        Shape::Polygon(corners) => {
            let outline = polygon::tidied(corners);
            let mut owned = vec![false; outline.len()];
            let pieces = convex_decomposition(&outline);
            let pieces = pieces.iter().map(|piece| ConvexPiece::cut(&outline, piece, &mut owned)).collect();
            Core { radius: 0.0, pieces }
        }
    }
}

impl ConvexPiece {
    fn point() -> ConvexPiece {
        ConvexPiece {
            vertices: vec![Vector64::ZERO],
            normals: vec![Vector64::ZERO],
            outer: vec![true],
            corners: vec![true],
        }
    }

    fn cut(outline: &[Vector64], piece: &[usize], owned: &mut [bool]) -> ConvexPiece {
        let (n, m) = (outline.len(), piece.len());
        let corner = |k: usize| outline[k % n];
        let vertices: Vec<Vector64> = piece.iter().map(|&k| corner(k)).collect();
        let normals = polygon::edges(&vertices).map(|(p, q)| -(q - p).perp().normalize_or_zero()).collect();
        let outer = (0..m).map(|k| piece[(k + 1) % m] == (piece[k] + 1) % n).collect();
        let convex = |k: usize| (corner(k) - corner(k + n - 1)).perp_dot(corner(k + 1) - corner(k)) > 0.0;
        let corners = piece.iter().map(|&k| convex(k) && !std::mem::replace(&mut owned[k], true)).collect();
        ConvexPiece { vertices, normals, outer, corners }
    }
}
