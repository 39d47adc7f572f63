//! Scalar equations of joints, J u = b, and blocks of them solved together.

use crate::math::Vector64;
use crate::rigid::{InverseMass, Twist};

/// Equations in a block at most.
const MOST: usize = 3;

/// One equation for the displacements of two bodies; a unit impulse pushes the first along it and the second back.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Row {
    /// Directions of the linear parts, of the first body and of the second.
    pub along: (Vector64, Vector64),
    /// Moments of a unit impulse about the centres of mass.
    pub apply: (f64, f64),
    /// Moments by which rotations of the bodies are measured; they differ from `apply` where they are taken at the
    /// middle of a substep.
    pub measure: (f64, f64),
}

impl Row {
    /// Separation of the points at these arms along a direction; the second arms are for measuring.
    pub fn point(along: Vector64, apply: (Vector64, Vector64), measure: (Vector64, Vector64)) -> Row {
        let moments = |arms: (Vector64, Vector64)| (arms.0.perp_dot(along), arms.1.perp_dot(along));
        Row { along: (along, along), apply: moments(apply), measure: moments(measure) }
    }

    /// Rotation of the first body against the second.
    pub fn turn() -> Row {
        Row { along: (Vector64::ZERO, Vector64::ZERO), apply: (1.0, 1.0), measure: (1.0, 1.0) }
    }

    /// J u.
    pub fn moved(&self, a: &Twist, b: &Twist) -> f64 {
        a.linear.dot(self.along.0) - b.linear.dot(self.along.1) + self.measure.0 * a.angular
            - self.measure.1 * b.angular
    }

    /// The pushes of an impulse: to add to the first body and to subtract from the second.
    pub fn push(&self, impulse: f64) -> (Twist, Twist) {
        let on = |along: Vector64, moment: f64| Twist { linear: along * impulse, angular: moment * impulse };
        (on(self.along.0, self.apply.0), on(self.along.1, self.apply.1))
    }

    /// How far a unit impulse of another equation moves this one.
    pub fn response(&self, other: &Row, (a, b): &(InverseMass, InverseMass)) -> f64 {
        self.along.0.dot(other.along.0) * a.linear
            + self.along.1.dot(other.along.1) * b.linear
            + self.measure.0 * other.apply.0 * a.angular
            + self.measure.1 * other.apply.1 * b.angular
    }
}

/// The impulses that change the left sides by `wanted`: Gauss elimination of at most three equations. Equations that
/// nothing can move get none.
pub(super) fn solve(rows: &[Row], wanted: &[f64], masses: &(InverseMass, InverseMass)) -> [f64; MOST] {
    let count = rows.len().min(MOST);
    let mut matrix = [[0.0; MOST + 1]; MOST];
    for (i, line) in matrix.iter_mut().enumerate().take(count) {
        for (j, entry) in line.iter_mut().enumerate().take(count) {
            *entry = rows[i].response(&rows[j], masses);
        }
        line[MOST] = wanted[i];
    }
    let mut fixed = [false; MOST];
    for pivot in 0..count {
        let size = matrix[pivot][pivot];
        if size <= 1e-12 * rows[pivot].response(&rows[pivot], masses).max(f64::MIN_POSITIVE) {
            fixed[pivot] = true;
            continue;
        }
        let line = matrix[pivot];
        for (i, other) in matrix.iter_mut().enumerate().take(count).filter(|(i, _)| *i != pivot) {
            let factor = other[pivot] / size;
            if factor != 0.0 && !fixed[i] {
                other.iter_mut().zip(&line).for_each(|(entry, of_pivot)| *entry -= factor * of_pivot);
            }
        }
    }
    let mut impulses = [0.0; MOST];
    for k in (0..count).filter(|&k| !fixed[k]) {
        impulses[k] = matrix[k][MOST] / matrix[k][k];
    }
    impulses
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impulses_bring_about_what_is_wanted() {
        let arms = (Vector64::new(0.3, -0.2), Vector64::new(-0.1, 0.5));
        let rows = [Row::point(Vector64::X, arms, arms), Row::point(Vector64::Y, arms, arms), Row::turn()];
        let mass = |linear, angular| InverseMass { linear, angular };
        let (masses, wanted) = ((mass(1.0, 2.0), mass(0.5, 0.0)), [0.1, -0.2, 0.3]);
        let impulses = solve(&rows, &wanted, &masses);
        let (mut a, mut b) = (Twist::ZERO, Twist::ZERO);
        for (row, impulse) in rows.iter().zip(impulses) {
            let (on_a, on_b) = row.push(impulse);
            a += Twist { linear: on_a.linear * masses.0.linear, angular: on_a.angular * masses.0.angular };
            b -= Twist { linear: on_b.linear * masses.1.linear, angular: on_b.angular * masses.1.angular };
        }
        for (row, wanted) in rows.iter().zip(wanted) {
            assert!((row.moved(&a, &b) - wanted).abs() < 1e-12);
        }
    }

    #[test]
    fn immovable_bodies_get_no_impulse() {
        let none = (InverseMass::default(), InverseMass::default());
        assert_eq!(solve(&[Row::turn()], &[1.0], &none), [0.0; 3]);
    }
}
