//! Places that hold far more particles than fit: every two of them are a pair, and a list of pairs has to be held.

use std::collections::HashMap;

use crate::math::Vector64;

/// Particles in a square of one kernel radius that are let pass anywhere: at rest there are nine.
const USUAL: u64 = 200;
/// Pairs that are let pass in any case: the list of them takes about 100 MB.
const LIGHT: u64 = 5_000_000;

/// A place with too many particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crowd {
    /// Middle of the fullest square \[m].
    pub place: Vector64,
    /// Particles in it.
    pub count: u64,
    /// Side of the square \[m].
    pub side: f64,
}

/// The fullest square of side `reach` \[m], if lists of pairs would grow out of hand where the new points are. Points
/// that are there already count where new ones join them.
pub(crate) fn crowd(
    new: impl IntoIterator<Item = Vector64>,
    there: impl IntoIterator<Item = Vector64>,
    reach: f64,
) -> Option<Crowd> {
    let key = |point: Vector64| ((point.x / reach).floor() as i64, (point.y / reach).floor() as i64);
    let mut squares: HashMap<(i64, i64), u64> = HashMap::new();
    for point in new {
        *squares.entry(key(point)).or_insert(0) += 1;
    }
    for point in there {
        if let Some(count) = squares.get_mut(&key(point)) {
            *count += 1;
        }
    }
    let points: u64 = squares.values().sum();
    let pairs = squares.values().fold(0_u64, |pairs, count| pairs.saturating_add(count * count));
    if pairs <= LIGHT.saturating_add(USUAL.saturating_mul(points)) {
        return None;
    }
    let (&(x, y), &count) = squares.iter().max_by_key(|&(key, count)| (*count, *key))?;
    let place = (Vector64::new(x as f64, y as f64) + 0.5) * reach;
    Some(Crowd { place, count, side: reach })
}

impl std::fmt::Display for Crowd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [x, y] = self.place.to_array();
        write!(f, "{} particles within a square of {:.3} m around ({x:.3}, {y:.3})", self.count, self.side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(side: usize, step: f64) -> impl Iterator<Item = Vector64> {
        (0..side * side).map(move |k| Vector64::new((k % side) as f64, (k / side) as f64) * step)
    }

    #[test]
    fn a_lattice_is_no_crowd_however_large() {
        assert_eq!(crowd(lattice(700, 0.1), [], 0.3), None);
        assert_eq!(crowd(lattice(300, 0.02), [], 0.3), None, "a hundred times too dense, but not many");
    }

    #[test]
    fn many_points_in_one_place_are_a_crowd() {
        let found = crowd(std::iter::repeat_n(Vector64::new(1.0, -1.0), 5_000), [], 0.3).unwrap();
        assert_eq!(found.count, 5_000);
        assert!((found.place - Vector64::new(1.0, -1.0)).length() < 0.3);
        let joined = crowd(lattice(2, 0.01), std::iter::repeat_n(Vector64::splat(0.1), 5_000), 0.3).unwrap();
        assert_eq!(joined.count, 5_004);
        assert_eq!(crowd(lattice(2, 0.01), std::iter::repeat_n(Vector64::splat(9.0), 5_000), 0.3), None);
    }
}
