//! Order and over-relaxation of Gauss-Seidel sweeps.
//!
//! With warm starts, a mode of the approach of which the sweeps of a substep leave the part s is multiplied from substep
//! to substep by the roots of z^2 - 2 s z + s = 0. It grows for s < -1/3, and fades slowly, by sqrt(s), where s is near
//! 1: plain sweeps in one direction leave high heaps swaying for good. Sweeps go there and back, since symmetric ones leave
//! parts of 0 to 1 (Young 1971, "Iterative Solution of Large Linear Systems"), and they are over-relaxed: loads pass
//! through high stacks in fewer sweeps, and slow modes fade sooner. The last sweep solves each contact as it is, as do those
//! before particles push the bodies: over-relaxed ones move bodies about under deep water, and of 8,000 random scenes of
//! the stress test 8 broke with them instead of 4.

use super::contact_block::Block;
use crate::simd::wide::Wide;

/// Over-relaxation beyond 1. With it, a pyramid of 5,050 boxes comes to rest at 3 substeps of 2 iterations; without, it
/// sways for good at 6 and falls at 3. From 0.9 on a stack of 20 boxes jitters.
const MOST: f64 = 0.8;
/// Fall in a substep, relative to the smaller body, up to which that holds, and from which on nothing is over-relaxed. A
/// heap of 5,000 boxes stays sound with 0.8 at 0.0014; at 0.0054 it boils with 0.7, but not with 0.5.
const FALL: [f64; 2] = [0.002, 0.01];

/// Kind of a sweep.
#[derive(Clone, Copy)]
pub(super) struct Way {
    /// Against the direction of the substep.
    pub back: bool,
    pub over_relaxed: bool,
}

impl Way {
    /// Of the sweep of this number in a substep, where so many come before particles push the bodies and as many after.
    pub fn of(sweep: u32, half: u32, among_particles: bool) -> Way {
        let plain = (sweep + 1).is_multiple_of(half) || (among_particles && sweep < half);
        Way { back: sweep % 2 == 1, over_relaxed: !plain }
    }
}

/// The over-relaxation beyond 1 of a contact between bodies of at least this size that fall so far in a substep \[m]. One
/// that bore nothing in the last substep has none: its impulse is no correction of one that is nearly right.
pub(super) fn over(pressed: bool, fall: f64, size: f64) -> f64 {
    let calm = (FALL[1] - fall / size) / (FALL[1] - FALL[0]);
    if pressed { MOST * calm.clamp(0.0, 1.0) } else { 0.0 }
}

/// The same in lanes, with the impulses kept from the last substep.
#[inline(always)]
pub(super) fn over_in_lanes<W: Wide>(lanes: W, block: &Block, fall: f64) -> W {
    let (zero, [first, second]) = (lanes.like(0.0), &block.normal_impulse);
    let calm = (lanes.like(FALL[1]) - lanes.like(fall) / lanes.reals(&block.size)) / lanes.like(FALL[1] - FALL[0]);
    let over = lanes.like(MOST) * calm.smaller(lanes.like(1.0)).larger(zero);
    zero.where_below(lanes.row(first) + lanes.row(second), over, zero)
}

/// Normal impulses whose changes are taken this many times.
pub(super) fn relaxed(now: [f64; 2], old: [f64; 2], relaxation: f64) -> [f64; 2] {
    std::array::from_fn(|k| (old[k] + relaxation * (now[k] - old[k])).max(0.0))
}
