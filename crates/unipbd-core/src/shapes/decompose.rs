//! Convex decomposition: ear clipping, then removal of the diagonals that are not needed for convexity
//! (Hertel & Mehlhorn 1983: at most four times the least number of pieces).

use crate::math::Vector64;

/// Splits a simple counter-clockwise polygon into convex pieces, given as indices of its corners.
pub fn convex_decomposition(corners: &[Vector64]) -> Vec<Vec<usize>> {
    let mut pieces = triangulate(corners);
    let mut k = 0;
    while k < pieces.len() {
        let found = (k + 1..pieces.len()).find_map(|j| Some((j, merged(corners, &pieces[k], &pieces[j])?)));
        match found {
            Some((j, merged)) => {
                pieces[k] = merged;
                pieces.remove(j);
                k = 0;
            }
            None => k += 1,
        }
    }
    pieces
}

/// Cuts off the ears one by one, the widest first, so that slivers are rare.
fn triangulate(corners: &[Vector64]) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let triple = |k: usize| [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
        let quality = |k: usize| ear_quality(corners, &left, triple(k)).unwrap_or(f64::NEG_INFINITY);
        let best = (0..n).fold(0, |best, k| if quality(k) > quality(best) { k } else { best });
        triangles.push(triple(best).to_vec());
        left.remove(best);
    }
    triangles.push(left);
    triangles
}

/// Smallest height over longest side of an ear; `None` if the corner is reflex or the ear not empty.
fn ear_quality(corners: &[Vector64], left: &[usize], triple: [usize; 3]) -> Option<f64> {
    let [a, b, c] = triple.map(|k| corners[k]);
    let doubled = (b - a).perp_dot(c - b);
    let inside = |p: Vector64| {
        (b - a).perp_dot(p - a) >= 0.0 && (c - b).perp_dot(p - b) >= 0.0 && (a - c).perp_dot(p - c) >= 0.0
    };
    let blocked = left.iter().any(|&k| !triple.contains(&k) && inside(corners[k]));
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (doubled > 0.0 && !blocked).then_some(doubled / longest)
}

/// The union of two pieces with a common edge, if there is one and the union is convex.
fn merged(corners: &[Vector64], first: &[usize], second: &[usize]) -> Option<Vec<usize>> {
    let (n, m) = (first.len(), second.len());
    let (i, j) = (0..n).find_map(|i| {
        let (from, to) = (first[i], first[(i + 1) % n]);
        let j = (0..m).find(|&j| second[j] == to && second[(j + 1) % m] == from)?;
        Some((i, j))
    })?;
    let from_first = (0..n).map(|k| first[(i + 1 + k) % n]);
    let from_second = (0..m - 2).map(|k| second[(j + 2 + k) % m]);
    let union: Vec<usize> = from_first.chain(from_second).collect();
    is_convex(corners, &union).then_some(union)
}

fn is_convex(corners: &[Vector64], piece: &[usize]) -> bool {
    let n = piece.len();
    (0..n).all(|k| {
        let [a, b, c] = [piece[k], piece[(k + 1) % n], piece[(k + 2) % n]].map(|k| corners[k]);
        (b - a).perp_dot(c - b) >= -1e-9 * (b - a).length() * (c - b).length()
    })
}
