//! Exact solution of the smallest contact problem: one body pair with one or two contact points.

/// Inverse effective mass of two points: a symmetric matrix with the off-diagonal entry `off`.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Coupling {
    pub first: f64,
    pub second: f64,
    pub off: f64,
}

/// Finds impulses of at least `lower` such that no point has a negative velocity, and points above their
/// bound have velocity zero: a linear complementarity problem, solved by enumeration of the active points.
/// `motion` is the motion with the impulses `old`; with one point, pass zero response for the second.
#[inline]
pub(super) fn solve(coupling: &Coupling, motion: [f64; 2], old: [f64; 2], lower: [f64; 2]) -> [f64; 2] {
    let Coupling { first, second, off } = *coupling;
    let raise = |gain: f64, motion: f64, old: f64, lower: f64| {
        if gain > 0.0 { (old - motion / gain).max(lower) } else { old }
    };
    if second <= 0.0 || first <= 0.0 {
        return [raise(first, motion[0], old[0], lower[0]), raise(second, motion[1], old[1], lower[1])];
    }
    let determinant = first * second - off * off;
    if determinant < 1e-6 * first * second {
        // Both points have the same motion, as on a body without rotation: half of the impulse each.
        return [raise(2.0 * first, motion[0], old[0], lower[0]), raise(2.0 * second, motion[1], old[1], lower[1])];
    }
    let both = [
        old[0] - (second * motion[0] - off * motion[1]) / determinant,
        old[1] - (first * motion[1] - off * motion[0]) / determinant,
    ];
    if both[0] >= lower[0] && both[1] >= lower[1] {
        return both;
    }
    // One point is active; the other is at its bound and must not approach.
    let one = old[0] - (motion[0] + off * (lower[1] - old[1])) / first;
    if one >= lower[0] && motion[1] + off * (one - old[0]) + second * (lower[1] - old[1]) >= 0.0 {
        return [one, lower[1]];
    }
    let other = old[1] - (motion[1] + off * (lower[0] - old[0])) / second;
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
        let coupling = Coupling { first: 2.0, second: 3.0, off: -1.2 };
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
