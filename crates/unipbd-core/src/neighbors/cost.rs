//! The cost of a skin, and the cheapest width.

use crate::math::{Real, real};
use std::f64::consts::PI;

/// Cost of sorting a row and searching around it, in visits of one pair by one pass (measured:
/// about 47 ns over 0.46 ns, `cargo run --release -p unipbd-benches --bin roofline`).
const ROW_COST: f64 = 100.0;
/// Cost of listing a pair, in the same unit.
const PAIR_COST: f64 = 0.8;
/// Widest skin, as a part of the radius: beyond it lists take too much memory.
const LONGEST_SKIN: f64 = 0.3;
/// Steps vary, and the projection moves particles too: this many times the steps that were counted.
const MARGIN: f64 = 1.05;
/// A list is not meant to last for more substeps than this.
const LONGEST_LIFE: u32 = 64;

/// Cost of lists and passes in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListCost {
    /// Radius of the kernel over the spacing of the particles.
    pub radius: f64,
    /// Passes over all pairs in a substep.
    pub passes: f64,
}

impl ListCost {
    /// The cheapest skin, as a part of the radius, where particles come nearer to each other by up to
    /// `step` radii per substep: a list that lasts for k more substeps costs a build/(k + 1) and passes over
    /// all pairs within the radius and k steps.
    pub fn skin(&self, step: Real) -> Real {
        let step = f64::from(step);
        if step.is_nan() || step > LONGEST_SKIN {
            return 0.0;
        }
        let cost = |life: u32| {
            let reach = self.radius * (1.0 + f64::from(life) * step);
            let pairs = PI * reach * reach;
            (ROW_COST + PAIR_COST * pairs) / f64::from(life + 1) + self.passes * pairs
        };
        let longest = LONGEST_LIFE.min((LONGEST_SKIN / step.max(1e-6)) as u32);
        let life = (0..=longest).min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap_or(0);
        real(f64::from(life) * step * MARGIN)
    }

    /// Widest skin that [`skin`](Self::skin) returns, as a part of the radius.
    pub const LONGEST: Real = LONGEST_SKIN as Real;
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIQUID: ListCost = ListCost { radius: 3.0, passes: 3.0 };

    #[test]
    fn fast_flows_get_no_skin_and_slow_ones_a_list_for_many_substeps() {
        assert_eq!(LIQUID.skin(0.5), 0.0);
        assert_eq!(LIQUID.skin(Real::NAN), 0.0);
        assert_eq!(LIQUID.skin(Real::INFINITY), 0.0);
        let lives: Vec<_> = [0.1, 0.03, 0.01, 0.003].map(|step| LIQUID.skin(step) / step).to_vec();
        assert!(lives.is_sorted() && lives[0] >= 1.0 && lives[3] > 10.0, "{lives:?}");
        assert!(LIQUID.skin(0.0) <= ListCost::LONGEST);
    }

    #[test]
    fn more_passes_make_the_skin_thinner() {
        let gas = ListCost { passes: 8.0, ..LIQUID };
        assert!(gas.skin(0.01) < LIQUID.skin(0.01));
    }
}
