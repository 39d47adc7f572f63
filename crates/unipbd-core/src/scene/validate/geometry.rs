//! Shapes of a scene as the checks see them: where its particles are.

use super::checker::Checker;
use crate::scene::layout::block_counts;
use crate::scene::{Block, Disc, Domain, Emitter, KeyPath};

/// A coordinate axis.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
}

/// Both axes.
pub(super) const AXES: [Axis; 2] = [Axis::X, Axis::Y];

impl Axis {
    pub(super) fn index(self) -> usize {
        self as usize
    }

    pub(super) fn name(self) -> &'static str {
        ["x", "y"][self.index()]
    }

    pub(super) fn periodic_key(self) -> &'static str {
        ["periodic_x", "periodic_y"][self.index()]
    }

    /// `[from, to]` where the axis is periodic.
    pub(super) fn extent(self, domain: &Domain) -> Option<[f64; 2]> {
        [domain.periodic_x, domain.periodic_y][self.index()]
    }
}

/// The region that the particle centres of a source span at the start \[m].
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Rectangle { min: [f64; 2], max: [f64; 2] },
    Disc { center: [f64; 2], radius: f64 },
    Segment([[f64; 2]; 2]),
}

impl Shape {
    /// The rectangle through the outermost particles of a block; none if the block makes no sense.
    pub(super) fn of_block(block: &Block, spacing: f64) -> Option<Shape> {
        let counts = block_counts(block, spacing);
        let sane = counts.into_iter().chain(block.min).all(f64::is_finite) && counts.into_iter().all(|n| n >= 1.0);
        let min = block.min.map(|value| value + 0.5 * spacing);
        let max = [0, 1].map(|axis| min[axis] + (counts[axis] - 1.0) * spacing);
        sane.then_some(Shape::Rectangle { min, max })
    }

    /// The disc itself: its outermost particles lie just inside; none if it makes no sense.
    pub(super) fn of_disc(disc: &Disc) -> Option<Shape> {
        let Disc { center, radius, .. } = *disc;
        let sane = center.into_iter().all(f64::is_finite) && radius.is_finite() && radius > 0.0;
        sane.then_some(Shape::Disc { center, radius })
    }

    /// The line through the outermost columns of an emitter; none if it makes no sense.
    pub(super) fn of_emitter(emitter: &Emitter, spacing: f64) -> Option<Shape> {
        let [x, y] = emitter.position;
        let sheath = emitter.sheath.as_ref().map_or(0.0, |sheath| sheath.thickness);
        let half = (emitter.width * 0.5 + sheath - spacing * 0.5).max(0.0);
        let length = libm::hypot(emitter.direction[0], emitter.direction[1]);
        let across = [-emitter.direction[1] / length * half, emitter.direction[0] / length * half];
        let ends = [[x - across[0], y - across[1]], [x + across[0], y + across[1]]];
        let sane = emitter.width > 0.0 && sheath >= 0.0 && ends.as_flattened().iter().all(|value| value.is_finite());
        sane.then_some(Shape::Segment(ends))
    }

    /// How far the shape reaches along a unit vector: the largest scalar product with its points \[m].
    pub(super) fn reach(&self, direction: [f64; 2]) -> f64 {
        let along = |point: [f64; 2]| point[0] * direction[0] + point[1] * direction[1];
        match *self {
            Shape::Rectangle { min, max } => {
                let corner = [0, 1].map(|axis| if direction[axis] >= 0.0 { max[axis] } else { min[axis] });
                along(corner)
            }
            Shape::Disc { center, radius } => along(center) + radius,
            Shape::Segment([from, to]) => along(from).max(along(to)),
        }
    }

    /// Whether the shape and the inside of a box have points in common.
    pub(super) fn meets_box(&self, min: [f64; 2], max: [f64; 2]) -> bool {
        match *self {
            Shape::Rectangle { min: least, max: most } => {
                [0, 1].into_iter().all(|axis| least[axis] < max[axis] && most[axis] > min[axis])
            }
            Shape::Disc { center, radius } => {
                let gap = [0, 1].map(|axis| (min[axis] - center[axis]).max(center[axis] - max[axis]).max(0.0));
                libm::hypot(gap[0], gap[1]) < radius
            }
            Shape::Segment(ends) => segment_meets_box(ends, min, max),
        }
    }
}

/// Clips the segment against the box, axis by axis (Liang and Barsky 1984).
fn segment_meets_box([from, to]: [[f64; 2]; 2], min: [f64; 2], max: [f64; 2]) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let step = to[axis] - from[axis];
        if step == 0.0 {
            if from[axis] <= min[axis] || from[axis] >= max[axis] {
                return false;
            }
            continue;
        }
        let cuts = [(min[axis] - from[axis]) / step, (max[axis] - from[axis]) / step];
        enter = enter.max(cuts[0].min(cuts[1]));
        leave = leave.min(cuts[0].max(cuts[1]));
    }
    enter <= leave
}

/// A source of particles whose shape makes sense.
pub(super) struct Source {
    pub(super) path: KeyPath,
    pub(super) shape: Shape,
}

/// All sources whose shape makes sense; none where the spacing does not.
pub(super) fn sources(checker: &Checker) -> Vec<Source> {
    let Some(spacing) = checker.spacing else { return Vec::new() };
    let scene = checker.scene;
    let blocks = scene.block.iter().map(|block| Shape::of_block(block, spacing));
    let discs = scene.disc.iter().map(Shape::of_disc);
    let emitters = scene.emitter.iter().map(|emitter| Shape::of_emitter(emitter, spacing));
    let named = |kind: &'static str, shapes: Vec<Option<Shape>>| {
        shapes
            .into_iter()
            .enumerate()
            .filter_map(move |(index, shape)| Some(Source { path: KeyPath::entry(kind, index), shape: shape? }))
    };
    named("block", blocks.collect())
        .chain(named("disc", discs.collect()))
        .chain(named("emitter", emitters.collect()))
        .collect()
}
