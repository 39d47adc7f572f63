//! The opening of a substep for contacts in lanes: they are measured at the poses of the bodies, their equations
//! prepared, and the impulses of the last substep applied. The rules are those of [`Contact`](super::Contact).

use super::anchored::Anchored;
use super::contact_block::{Block, Exact, FAR};
use super::relaxation::over_in_lanes;
use super::step_context::StepContext;
use crate::simd::wide::{Kernel, Wide};

/// A vector in each lane.
type Place<W> = [W; 2];

/// Measures and prepares blocks.
pub(super) struct Open<'a> {
    pub blocks: &'a mut [Block],
    pub anchored: &'a [Anchored],
    /// Coordinates of the bodies.
    pub places: &'a [Exact],
    /// Their velocities, where friction depends on them.
    pub velocities: &'a [Exact],
    pub moment: &'a StepContext,
    /// Part of the impulses that is kept.
    pub kept: f64,
}

impl Kernel for Open<'_> {
    #[inline(always)]
    fn run<W: Wide>(self, lanes: W) {
        let fall = self.moment.fall();
        for (block, anchored) in self.blocks.iter_mut().zip(self.anchored) {
            measure(lanes, block, anchored, self.places, self.kept);
            block.over = over_in_lanes(lanes, block, fall).to_reals();
            prepare(lanes, block, anchored);
            let speed = lanes.reals(&anchored.speed);
            block.belt = (speed * speed.like(self.moment.dt)).to_reals();
            block.friction = anchored.static_friction;
            if anchored.slides {
                choose_friction(lanes, block, anchored, self.velocities, self.moment.slow);
            }
            let has_friction =
                lanes.like(0.0).where_below(lanes.reals(&block.friction), lanes.like(1.0), lanes.like(0.0));
            block.turns = (lanes.reals(&anchored.two) * has_friction).to_reals();
        }
    }
}

#[inline(always)]
fn place<W: Wide>(lanes: W, [x, y]: &[Exact; 2]) -> Place<W> {
    [lanes.row(x), lanes.row(y)]
}

#[inline(always)]
fn turned<W: Wide>([cosine, sine]: Place<W>, [x, y]: Place<W>) -> Place<W> {
    [cosine * x - sine * y, sine * x + cosine * y]
}

#[inline(always)]
fn dot<W: Wide>(a: Place<W>, b: Place<W>) -> W {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
fn perp_dot<W: Wide>(a: Place<W>, b: Place<W>) -> W {
    a[0] * b[1] - a[1] * b[0]
}

/// `yes` where a flag is set, else `no`.
#[inline(always)]
fn select<W: Wide>(flag: W, yes: Place<W>, no: Place<W>) -> Place<W> {
    let half = flag.like(0.5);
    [half.where_below(flag, yes[0], no[0]), half.where_below(flag, yes[1], no[1])]
}

/// The solids of a block at their poses.
struct Solids<W> {
    /// From the second body to the first \[m].
    between: Place<W>,
    normal: Place<W>,
    radii: [W; 2],
    of_first: W,
    of_second: W,
}

/// Measures normals, gaps and arms, and ages the impulses.
#[inline(always)]
fn measure<W: Wide>(lanes: W, block: &mut Block, of: &Anchored, places: &[Exact], kept: f64) {
    let [ax, ay, cosine_a, sine_a] = lanes.gather(places, &block.bodies[0]);
    let [bx, by, cosine_b, sine_b] = lanes.gather(places, &block.bodies[1]);
    let (turn_a, turn_b) = ([cosine_a, sine_a], [cosine_b, sine_b]);
    let on_a = [turned(turn_a, place(lanes, &of.on_a[0])), turned(turn_a, place(lanes, &of.on_a[1]))];
    let on_b = [turned(turn_b, place(lanes, &of.on_b[0])), turned(turn_b, place(lanes, &of.on_b[1]))];
    let (of_first, of_second) = (lanes.reals(&of.of_first), lanes.reals(&of.of_second));
    let between = [ax - bx, ay - by];
    let mut normal = turned(select(of_first, turn_a, turn_b), place(lanes, &of.normal));
    if of.lines {
        let way = [between[0] + on_a[0][0] - on_b[0][0], between[1] + on_a[0][1] - on_b[0][1]];
        let square = dot(way, way);
        let (length, before) = (square.sqrt(), [lanes.reals(&block.normal[0]), lanes.reals(&block.normal[1])]);
        let zero = lanes.like(0.0);
        let line = [
            zero.where_below(square, way[0] / length, before[0]),
            zero.where_below(square, way[1] / length, before[1]),
        ];
        normal = select(of_first + of_second, normal, line);
    }
    let solids = Solids { between, normal, radii: place(lanes, &of.radii), of_first, of_second };
    block.normal = [normal[0].to_reals(), normal[1].to_reals()];
    let one = lanes.like(1.0);
    point(block, 0, &solids, (on_a[0], on_b[0]), one, kept);
    point(block, 1, &solids, (on_a[1], on_b[1]), lanes.reals(&of.two), kept);
    block.rolling_impulse = (lanes.row(&block.rolling_impulse) * lanes.like(kept)).to_array();
}

/// Measures the points of this number; `there` is 1 where there is one.
#[inline(always)]
fn point<W: Wide>(
    block: &mut Block,
    k: usize,
    of: &Solids<W>,
    (on_a, on_b): (Place<W>, Place<W>),
    there: W,
    kept: f64,
) {
    let (normal, [radius_a, radius_b]) = (of.normal, of.radii);
    let from_b = [of.between[0] + on_a[0], of.between[1] + on_a[1]];
    let from_a = [on_b[0] - of.between[0], on_b[1] - of.between[1]];
    let gap = dot([from_b[0] - on_b[0], from_b[1] - on_b[1]], normal) - radius_a - radius_b;
    // The point on the face is the foot of the other point, not the anchor: bodies slide.
    let (deep_a, deep_b) = (radius_b + gap, radius_a + gap);
    let arm_a = select(
        of.of_first,
        [from_a[0] + normal[0] * deep_a, from_a[1] + normal[1] * deep_a],
        [on_a[0] - normal[0] * radius_a, on_a[1] - normal[1] * radius_a],
    );
    let arm_b = select(
        of.of_second,
        [from_b[0] - normal[0] * deep_b, from_b[1] - normal[1] * deep_b],
        [on_b[0] + normal[0] * radius_b, on_b[1] + normal[1] * radius_b],
    );
    let far = gap.like(FAR);
    block.gap[k] = gap.like(0.5).where_below(there, gap.smaller(far), far).to_reals();
    // The tangent is the normal turned left.
    block.normal_a[k] = (perp_dot(arm_a, normal) * there).to_reals();
    block.normal_b[k] = (perp_dot(arm_b, normal) * there).to_reals();
    block.tangent_a[k] = (dot(arm_a, normal) * there).to_reals();
    block.tangent_b[k] = (dot(arm_b, normal) * there).to_reals();
    block.normal_impulse[k] = (gap.row(&block.normal_impulse[k]) * gap.like(kept)).to_array();
    block.tangent_impulse[k] = (gap.row(&block.tangent_impulse[k]) * gap.like(kept)).to_array();
}

/// 1 over a response; 0 where nothing moves.
#[inline(always)]
fn inverse<W: Wide>(response: W) -> W {
    let zero = response.like(0.0);
    zero.where_below(response, response.like(1.0) / response, zero)
}

/// Prepares the equations: see [`Coupling`](super::complementarity::Coupling).
#[inline(always)]
fn prepare<W: Wide>(lanes: W, block: &mut Block, of: &Anchored) {
    let (two, zero) = (lanes.reals(&of.two), lanes.like(0.0));
    let (turn_a, turn_b) = (lanes.row(&block.angular[0]), lanes.row(&block.angular[1]));
    let linear = lanes.row(&block.linear[0]) + lanes.row(&block.linear[1]);
    let normal_a = [lanes.reals(&block.normal_a[0]), lanes.reals(&block.normal_a[1])];
    let normal_b = [lanes.reals(&block.normal_b[0]), lanes.reals(&block.normal_b[1])];
    let first = linear + normal_a[0] * normal_a[0] * turn_a + normal_b[0] * normal_b[0] * turn_b;
    let second = (linear + normal_a[1] * normal_a[1] * turn_a + normal_b[1] * normal_b[1] * turn_b) * two;
    let off = (linear + normal_a[0] * normal_a[1] * turn_a + normal_b[0] * normal_b[1] * turn_b) * two;
    let (determinant, product) = (first * second - off * off, first * second);
    let least = lanes.like(1e-6) * product;
    let by = zero.where_below(product, determinant.where_below(least, zero, inverse(determinant)), zero);
    // Both points have the same motion, as on a body without rotation: half of the impulse each.
    let share =
        zero.where_below(product, determinant.where_below(least, lanes.like(0.5), lanes.like(1.0)), lanes.like(1.0));
    let alone = [inverse(first) * share, inverse(second) * share];
    block.response = [
        zero.where_below(by, first, inverse(alone[0])).to_reals(),
        zero.where_below(by, second, inverse(alone[1])).to_reals(),
        zero.where_below(by, off, zero).to_reals(),
    ];
    block.inverse = [
        zero.where_below(by, second * by, alone[0]).to_reals(),
        zero.where_below(by, first * by, alone[1]).to_reals(),
        (off * by).to_reals(),
    ];
    block.alone = [alone[0].to_reals(), alone[1].to_reals()];
    let tangent = [along_tangent(lanes, block, 0, linear), along_tangent(lanes, block, 1, linear) * two];
    block.tangent = [inverse(tangent[0]).to_reals(), inverse(tangent[1]).to_reals()];
}

/// Response of a point to its own impulse along the tangent.
#[inline(always)]
fn along_tangent<W: Wide>(lanes: W, block: &Block, k: usize, linear: W) -> W {
    let (of_a, of_b) = (lanes.reals(&block.tangent_a[k]), lanes.reals(&block.tangent_b[k]));
    linear + of_a * of_a * lanes.row(&block.angular[0]) + of_b * of_b * lanes.row(&block.angular[1])
}

/// Kinetic friction where a point slides, static friction elsewhere.
#[inline(always)]
fn choose_friction<W: Wide>(lanes: W, block: &mut Block, of: &Anchored, velocities: &[Exact], slow: f64) {
    let [ax, ay, spin_a, _] = lanes.gather(velocities, &block.bodies[0]);
    let [bx, by, spin_b, _] = lanes.gather(velocities, &block.bodies[1]);
    let (normal, speed) = ([lanes.reals(&block.normal[0]), lanes.reals(&block.normal[1])], lanes.reals(&of.speed));
    let along = (ay - by) * normal[0] - (ax - bx) * normal[1] - speed;
    let zero = lanes.like(0.0);
    let mut friction = lanes.reals(&of.static_friction);
    for k in 0..2 {
        let turning = lanes.reals(&block.tangent_a[k]) * spin_a - lanes.reals(&block.tangent_b[k]) * spin_b;
        let slide = along + turning;
        // A point that is not there slides as one at the centres would.
        let fast = slide.larger(zero - slide);
        let there = if k == 0 { lanes.like(1.0) } else { lanes.reals(&of.two) };
        let kinetic = fast.where_below(lanes.like(slow), friction, lanes.reals(&of.kinetic_friction));
        friction = lanes.like(0.5).where_below(there, kinetic, friction);
    }
    block.friction = friction.to_reals();
}

/// Applies the impulses of blocks to the motion of the bodies.
pub(super) struct Start<'a> {
    pub blocks: &'a [Block],
    pub motion: &'a mut [Exact],
}

impl Kernel for Start<'_> {
    #[inline(always)]
    fn run<W: Wide>(self, lanes: W) {
        for block in self.blocks {
            let ([push_x, push_y], [turn_a, turn_b]) = push_of(lanes, block);
            shift(lanes, block, 0, self.motion, [push_x, push_y, turn_a]);
            let zero = lanes.like(0.0);
            shift(lanes, block, 1, self.motion, [zero - push_x, zero - push_y, zero - turn_b]);
        }
    }
}

/// The impulses of a block: along x and y on the first body, and the moments about both.
#[inline(always)]
pub(super) fn push_of<W: Wide>(lanes: W, block: &Block) -> (Place<W>, [W; 2]) {
    let normal = [lanes.row(&block.normal_impulse[0]), lanes.row(&block.normal_impulse[1])];
    let tangent = [lanes.row(&block.tangent_impulse[0]), lanes.row(&block.tangent_impulse[1])];
    let (along, across) = (normal[0] + normal[1], tangent[0] + tangent[1]);
    let (x, y) = (lanes.reals(&block.normal[0]), lanes.reals(&block.normal[1]));
    let rolling = lanes.row(&block.rolling_impulse);
    let turn_a = lanes.reals(&block.normal_a[0]) * normal[0]
        + lanes.reals(&block.normal_a[1]) * normal[1]
        + (lanes.reals(&block.tangent_a[0]) * tangent[0] + lanes.reals(&block.tangent_a[1]) * tangent[1]);
    let turn_b = lanes.reals(&block.normal_b[0]) * normal[0]
        + lanes.reals(&block.normal_b[1]) * normal[1]
        + (lanes.reals(&block.tangent_b[0]) * tangent[0] + lanes.reals(&block.tangent_b[1]) * tangent[1]);
    ([x * along - y * across, y * along + x * across], [turn_a + rolling, turn_b + rolling])
}

/// Moves the bodies of one side of a block.
#[inline(always)]
fn shift<W: Wide>(lanes: W, block: &Block, side: usize, motion: &mut [Exact], push: [W; 3]) {
    let [x, y, turn, _] = lanes.gather(motion, &block.bodies[side]);
    let (linear, angular) = (lanes.row(&block.linear[side]), lanes.row(&block.angular[side]));
    let moved = [x + push[0] * linear, y + push[1] * linear, turn + push[2] * angular, lanes.like(0.0)];
    W::scatter(moved, motion, &block.bodies[side]);
}
