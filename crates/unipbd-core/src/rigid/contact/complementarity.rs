//! Exact solution of the smallest contact problem: one body pair with one or two contact points.

/// Inverse effective mass of two points, a symmetric matrix with the off-diagonal entry `off`, and what its solution
/// needs.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Coupling {
    first: f64,
    second: f64,
    off: f64,
    /// Effective mass of each point on its own; with one point, and where both have the same motion, that is all.
    alone: [f64; 2],
    /// 1 over the determinant; 0 where the matrix is not inverted.
    inverse_determinant: f64,
}

impl Coupling {
    /// A point alone.
    pub fn of_one(first: f64) -> Coupling {
        Coupling { first, alone: [inverse(first), 0.0], ..Coupling::default() }
    }

    /// Two points; one with a response of 0 keeps its impulse.
    pub fn of_two(first: f64, second: f64, off: f64) -> Coupling {
        let alone = [inverse(first), inverse(second)];
        let (determinant, product) = (first * second - off * off, first * second);
        if product <= 0.0 {
            return Coupling { first, second, off, alone, inverse_determinant: 0.0 };
        }
        if determinant < 1e-6 * product {
            // Both points have the same motion, as on a body without rotation: half of the impulse each.
            return Coupling { first, second, off, alone: alone.map(|mass| 0.5 * mass), inverse_determinant: 0.0 };
        }
        Coupling { first, second, off, alone, inverse_determinant: 1.0 / determinant }
    }

    /// The matrix of responses, one for which [`solve`] needs no other case, and the effective masses alone: both
    /// points, and across.
    pub fn matrices(&self) -> ([f64; 3], [f64; 3], [f64; 2]) {
        let (Coupling { first, second, off, alone, .. }, by) = (*self, self.inverse_determinant);
        if by == 0.0 {
            // Each point on its own.
            return ([inverse(alone[0]), inverse(alone[1]), 0.0], [alone[0], alone[1], 0.0], alone);
        }
        ([first, second, off], [second * by, first * by, off * by], alone)
    }

    /// The same two points, where only those that act have a response.
    pub fn restricted_to(&self, acts: [bool; 2]) -> Coupling {
        let keep = |acts: bool, response: f64| if acts { response } else { 0.0 };
        Coupling::of_two(keep(acts[0], self.first), keep(acts[1], self.second), self.off)
    }
}

/// The mass of a response; 0 for a body that nothing moves.
pub(super) fn inverse(response: f64) -> f64 {
    if response > 0.0 { 1.0 / response } else { 0.0 }
}

/// Finds impulses of at least `lower` such that no point has a negative velocity, and points above their
/// bound have velocity zero: a linear complementarity problem, solved by enumeration of the active points.
/// `motion` is the motion with the impulses `old`.
#[inline]
pub(super) fn solve(coupling: &Coupling, motion: [f64; 2], old: [f64; 2], lower: [f64; 2]) -> [f64; 2] {
    let Coupling { first, second, off, alone, inverse_determinant } = *coupling;
    if inverse_determinant == 0.0 {
        let raise = |k: usize| if alone[k] > 0.0 { (old[k] - motion[k] * alone[k]).max(lower[k]) } else { old[k] };
        return [raise(0), raise(1)];
    }
    let both = [
        old[0] - (second * motion[0] - off * motion[1]) * inverse_determinant,
        old[1] - (first * motion[1] - off * motion[0]) * inverse_determinant,
    ];
    if both[0] >= lower[0] && both[1] >= lower[1] {
        return both;
    }
    // One point is active; the other is at its bound and must not approach.
    let one = old[0] - (motion[0] + off * (lower[1] - old[1])) * alone[0];
    if one >= lower[0] && motion[1] + off * (one - old[0]) + second * (lower[1] - old[1]) >= 0.0 {
        return [one, lower[1]];
    }
    let other = old[1] - (motion[1] + off * (lower[0] - old[0])) * alone[1];
    if other >= lower[1] && motion[0] + off * (other - old[1]) + first * (lower[0] - old[0]) >= 0.0 {
        return [lower[0], other];
    }
    lower
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_are_complementary() {
        let coupling = Coupling::of_two(2.0, 3.0, -1.2);
        for k in 0..1000 {
            let value = |j: i32| (f64::from(k * 7 + j) * 12.9898).sin();
            let (motion, old, lower) = ([value(0), value(1)], [value(2).abs(), value(3).abs()], [0.0, -0.1]);
            let found = solve(&coupling, motion, old, lower);
            let (d0, d1) = (found[0] - old[0], found[1] - old[1]);
            let after = [motion[0] + 2.0 * d0 - 1.2 * d1, motion[1] - 1.2 * d0 + 3.0 * d1];
            for i in 0..2 {
                assert!(found[i] >= lower[i] && after[i] >= -1e-12);
                assert!((found[i] - lower[i]) * after[i] <= 1e-12, "an acting point does not move away");
            }
        }
    }
}
