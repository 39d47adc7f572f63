//! The rules of [`Contact`](super::Contact) for four contacts at once.

use super::Depenetration;
use super::blocks::Blocks;
use super::contact_block::{Block, Exact, Lane};
use super::manifold::ROUNDS;
use crate::simd::wide::{Kernel, WIDE, Wide, run};
use std::ops::Range;

/// The operation of a pass on each block.
#[derive(Clone, Copy)]
pub(super) enum Rule {
    /// One iteration of normal impulses, friction and rolling resistance.
    Solve {
        /// From the last block to the first.
        backward: bool,
        /// Whether contacts are over-relaxed.
        over_relaxed: bool,
    },
    /// Moves bodies out of each other, without a trace in the impulses; with twice the gravity times the square of the
    /// substep \[m].
    Separate(Depenetration, f64),
}

impl Blocks {
    /// Applies a rule to all blocks, one after the other.
    pub fn pass(&mut self, rule: Rule) {
        self.pass_over(0..self.all.len(), rule);
    }

    /// Applies a rule to these blocks, one after the other.
    pub fn pass_over(&mut self, range: Range<usize>, rule: Rule) {
        run(Pass { blocks: &mut self.all[range], motion: &mut self.motion, rule });
    }
}

/// A rule for blocks, one after the other.
struct Pass<'a> {
    blocks: &'a mut [Block],
    motion: &'a mut [Exact],
    rule: Rule,
}

impl Kernel for Pass<'_> {
    #[inline(always)]
    fn run<W: Wide>(self, lanes: W) {
        match self.rule {
            Rule::Solve { backward: false, over_relaxed } => {
                for block in self.blocks {
                    solve(lanes, block, self.motion, f64::from(over_relaxed));
                }
            }
            Rule::Solve { backward: true, over_relaxed } => {
                for block in self.blocks.iter_mut().rev() {
                    solve(lanes, block, self.motion, f64::from(over_relaxed));
                }
            }
            Rule::Separate(how, fall) => {
                for block in self.blocks {
                    separate(lanes, block, self.motion, &how, fall);
                }
            }
        }
    }
}

/// Motion of a body: along x and y, and its rotation.
type Motion<W> = [W; 3];

/// The constants of a block.
struct Lines<W> {
    normal: [W; 2],
    normal_a: [W; 2],
    normal_b: [W; 2],
    linear: [W; 2],
    angular: [W; 2],
    response: [W; 3],
    inverse: [W; 3],
    alone: [W; 2],
}

impl<W: Wide> Lines<W> {
    #[inline(always)]
    fn of(lanes: W, block: &Block) -> Self {
        let [first, second, off] = &block.response;
        let [into_first, into_second, across] = &block.inverse;
        Lines {
            normal: reals(lanes, &block.normal),
            normal_a: reals(lanes, &block.normal_a),
            normal_b: reals(lanes, &block.normal_b),
            linear: exacts(lanes, &block.linear),
            angular: exacts(lanes, &block.angular),
            response: [lanes.reals(first), lanes.reals(second), lanes.reals(off)],
            inverse: [lanes.reals(into_first), lanes.reals(into_second), lanes.reals(across)],
            alone: reals(lanes, &block.alone),
        }
    }

    /// How far each point opens.
    #[inline(always)]
    fn openings(&self, a: &Motion<W>, b: &Motion<W>) -> [W; 2] {
        let along = (a[0] - b[0]) * self.normal[0] + (a[1] - b[1]) * self.normal[1];
        [
            along + self.normal_a[0] * a[2] - self.normal_b[0] * b[2],
            along + self.normal_a[1] * a[2] - self.normal_b[1] * b[2],
        ]
    }

    /// Normal impulses that leave no approach, in place of `old`: see [`complementarity`](super::complementarity).
    #[inline(always)]
    fn press(&self, excess: [W; 2], old: [W; 2]) -> [W; 2] {
        let zero = old[0].like(0.0);
        let ([first, second, off], [into_first, into_second, across]) = (self.response, self.inverse);
        let both = [
            old[0] - (into_first * excess[0] - across * excess[1]),
            old[1] - (into_second * excess[1] - across * excess[0]),
        ];
        let one = old[0] - (excess[0] - off * old[1]) * self.alone[0];
        let left = excess[1] + off * (one - old[0]) - second * old[1];
        let other = old[1] - (excess[1] - off * old[0]) * self.alone[1];
        let right = excess[0] + off * (other - old[1]) - first * old[0];
        let second_alone = where_least(other.smaller(right), zero, [zero, other], [zero, zero]);
        let one_alone = where_least(one.smaller(left), zero, [one, zero], second_alone);
        where_least(both[0].smaller(both[1]), zero, both, one_alone)
    }

    /// Moves both bodies.
    #[inline(always)]
    fn shift(&self, (a, b): (&mut Motion<W>, &mut Motion<W>), push: [W; 2], [turn_a, turn_b]: [W; 2]) {
        a[0] = a[0] + push[0] * self.linear[0];
        a[1] = a[1] + push[1] * self.linear[0];
        b[0] = b[0] - push[0] * self.linear[1];
        b[1] = b[1] - push[1] * self.linear[1];
        a[2] = a[2] + turn_a * self.angular[0];
        b[2] = b[2] - turn_b * self.angular[1];
    }
}

#[inline(always)]
fn reals<W: Wide>(lanes: W, [first, second]: &[Lane; 2]) -> [W; 2] {
    [lanes.reals(first), lanes.reals(second)]
}

#[inline(always)]
fn exacts<W: Wide>(lanes: W, [first, second]: &[Exact; 2]) -> [W; 2] {
    [lanes.row(first), lanes.row(second)]
}

/// For each point, `yes` where `left` is not below `right`, else `no`.
#[inline(always)]
fn where_least<W: Wide>(left: W, right: W, yes: [W; 2], no: [W; 2]) -> [W; 2] {
    [left.where_below(right, no[0], yes[0]), left.where_below(right, no[1], yes[1])]
}

#[inline(always)]
fn gather<W: Wide>(lanes: W, motion: &[Exact], bodies: &[u32; WIDE]) -> Motion<W> {
    let [x, y, turn, _] = lanes.gather(motion, bodies);
    [x, y, turn]
}

#[inline(always)]
fn scatter<W: Wide>(motion: &mut [Exact], bodies: &[u32; WIDE], [x, y, turn]: Motion<W>) {
    W::scatter([x, y, turn, x.like(0.0)], motion, bodies);
}

/// The value cut to the range from minus to plus the limit.
#[inline(always)]
fn within<W: Wide>(value: W, limit: W) -> W {
    value.smaller(limit).larger(limit.like(0.0) - limit)
}

/// A normal impulse whose change is taken this many times.
#[inline(always)]
fn relaxed<W: Wide>(now: W, old: W, relaxation: W) -> W {
    (old + relaxation * (now - old)).larger(old.like(0.0))
}

/// One iteration of a block, with this part of its over-relaxation.
#[inline(always)]
fn solve<W: Wide>(lanes: W, block: &mut Block, motion: &mut [Exact], over: f64) {
    let (mut a, mut b) = (gather(lanes, motion, &block.bodies[0]), gather(lanes, motion, &block.bodies[1]));
    let lines = Lines::of(lanes, block);
    let old = exacts(lanes, &block.normal_impulse);
    let zero = lanes.like(0.0);
    once(block, &lines, (&mut a, &mut b), (zero, over));
    // Friction of a tall body turns it: a contact without impulses to start from needs a few rounds for both.
    let idle = zero.where_below(old[0].larger(old[1]), zero, lanes.reals(&block.turns));
    let now = exacts(lanes, &block.normal_impulse);
    let is_new = zero.where_below(now[0].larger(now[1]), idle, zero);
    if is_new.to_array() != [0.0; WIDE] {
        let others = zero.like(1.0) - is_new;
        for _ in 1..ROUNDS {
            once(block, &lines, (&mut a, &mut b), (others, 0.0));
        }
    }
    scatter(motion, &block.bodies[0], a);
    scatter(motion, &block.bodies[1], b);
}

/// Solves the lanes where `done` is 0.
#[inline(always)]
fn once<W: Wide>(
    block: &mut Block,
    lines: &Lines<W>,
    (a, b): (&mut Motion<W>, &mut Motion<W>),
    (done, over): (W, f64),
) {
    let (gap, mass) = (reals(done, &block.gap), reals(done, &block.tangent));
    let (tangent_a, tangent_b) = (reals(done, &block.tangent_a), reals(done, &block.tangent_b));
    let (friction, belt) = (done.reals(&block.friction), done.reals(&block.belt));
    let (old, old_tangent) = (exacts(done, &block.normal_impulse), exacts(done, &block.tangent_impulse));
    let zero = done.like(0.0);
    let openings = lines.openings(a, b);
    let pressed = lines.press([openings[0] + gap[0].larger(zero), openings[1] + gap[1].larger(zero)], old);
    let relaxation = done.like(1.0) + done.reals(&block.over) * done.like(over);
    let pressed = [relaxed(pressed[0], old[0], relaxation), relaxed(pressed[1], old[1], relaxation)];
    let normal = where_least(zero, done, pressed, old);
    let change = [normal[0] - old[0], normal[1] - old[1]];
    let turns = [
        lines.normal_a[0] * change[0] + lines.normal_a[1] * change[1],
        lines.normal_b[0] * change[0] + lines.normal_b[1] * change[1],
    ];
    // Both points have the same tangential motion: each takes the share of its normal load.
    let total = normal[0] + normal[1];
    let (turned_a, turned_b) = (a[2] + turns[0] * lines.angular[0], b[2] - turns[1] * lines.angular[1]);
    let along = (a[1] - b[1]) * lines.normal[0] - (a[0] - b[0]) * lines.normal[1] - belt;
    let part = zero.where_below(total, zero.like(1.0) / total, zero);
    let held = [
        old_tangent[0]
            - relaxation * (along + tangent_a[0] * turned_a - tangent_b[0] * turned_b) * (normal[0] * part) * mass[0],
        old_tangent[1]
            - relaxation * (along + tangent_a[1] * turned_a - tangent_b[1] * turned_b) * (normal[1] * part) * mass[1],
    ];
    let held = [within(held[0], friction * normal[0]), within(held[1], friction * normal[1])];
    let tangent = where_least(zero, done, held, old_tangent);
    let slid = [tangent[0] - old_tangent[0], tangent[1] - old_tangent[1]];
    let (along_normal, along_tangent) = (change[0] + change[1], slid[0] + slid[1]);
    let push = [
        lines.normal[0] * along_normal - lines.normal[1] * along_tangent,
        lines.normal[1] * along_normal + lines.normal[0] * along_tangent,
    ];
    let mut turns = [
        turns[0] + (tangent_a[0] * slid[0] + tangent_a[1] * slid[1]),
        turns[1] + (tangent_b[0] * slid[0] + tangent_b[1] * slid[1]),
    ];
    if block.rolls {
        let (arm, mass) = (done.reals(&block.rolling_arm), done.row(&block.rolling_mass));
        let old = done.row(&block.rolling_impulse);
        let (limit, turn) = (arm * total, a[2] - b[2] + turns[0] * lines.angular[0] + turns[1] * lines.angular[1]);
        let moment = zero.where_below(done, old, within(old - turn * mass, limit));
        turns = [turns[0] + (moment - old), turns[1] + (moment - old)];
        block.rolling_impulse = moment.to_array();
    }
    lines.shift((a, b), push, turns);
    block.normal_impulse = [normal[0].to_array(), normal[1].to_array()];
    block.tangent_impulse = [tangent[0].to_array(), tangent[1].to_array()];
}

/// Moves the bodies of a block out of each other.
#[inline(always)]
fn separate<W: Wide>(lanes: W, block: &Block, motion: &mut [Exact], how: &Depenetration, fall: f64) {
    let (mut a, mut b) = (gather(lanes, motion, &block.bodies[0]), gather(lanes, motion, &block.bodies[1]));
    let (lines, size, gap) = (Lines::of(lanes, block), lanes.reals(&block.size), reals(lanes, &block.gap));
    let zero = lanes.like(0.0);
    let openings = lines.openings(&a, &b);
    let removed =
        [how.removed(zero - gap[0] - openings[0], size, fall), how.removed(zero - gap[1] - openings[1], size, fall)];
    if removed[0].larger(removed[1]).to_array() == [0.0; WIDE] {
        return;
    }
    let lacking = [zero - removed[0], zero - removed[1]];
    let normal = lines.press(lacking, [zero; 2]);
    let total = normal[0] + normal[1];
    let turns = [
        lines.normal_a[0] * normal[0] + lines.normal_a[1] * normal[1],
        lines.normal_b[0] * normal[0] + lines.normal_b[1] * normal[1],
    ];
    lines.shift((&mut a, &mut b), [lines.normal[0] * total, lines.normal[1] * total], turns);
    scatter(motion, &block.bodies[0], a);
    scatter(motion, &block.bodies[1], b);
}

impl Depenetration {
    /// The part of overlaps that a substep removes, as [`lacking`](Self::lacking).
    #[inline(always)]
    fn removed<W: Wide>(&self, overlap: W, size: W, fall: f64) -> W {
        let farthest =
            if fall > 0.0 { size.like(self.speed) * (size.like(fall) * size).sqrt() } else { size.like(f64::INFINITY) };
        let overlap = overlap - size.like(self.slop) * size;
        let deep = (overlap - size.like(self.deep) * size).larger(size.like(0.0));
        let removed = size.like(self.fraction) * overlap + size.like(self.deep_fraction - self.fraction) * deep;
        removed.larger(size.like(0.0)).smaller(farthest)
    }
}
