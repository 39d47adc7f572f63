//! The direction out of a box: for points, discs and paths.

use super::{Hit, Rectangle};
use crate::math::{Real, Vector};

impl Rectangle {
    /// The nearest side, for a point inside.
    pub(super) fn hit(&self, x: Vector) -> Option<Hit> {
        let (low, high) = (x - self.min, self.max - x);
        if low.cmple(Vector::ZERO).any() || high.cmple(Vector::ZERO).any() {
            return None;
        }
        let sides = [(low.x, -Vector::X), (high.x, Vector::X), (low.y, -Vector::Y), (high.y, Vector::Y)];
        let (depth, normal) = sides.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Hit { normal, depth, friction: self.friction, measured: self.measured })
    }

    /// A disc about `x`, a sample of a body, that reaches in.
    pub(super) fn touch(&self, x: Vector, radius: Real) -> Option<Hit> {
        let apart = x - x.clamp(self.min, self.max);
        let distance = apart.length();
        if distance == 0.0 {
            return self.hit(x).map(|hit| Hit { depth: hit.depth + radius, friction: self.body_friction, ..hit });
        }
        let hit = Hit {
            normal: apart / distance,
            depth: radius - distance,
            friction: self.body_friction,
            measured: self.measured,
        };
        (distance < radius).then_some(hit)
    }

    /// The way out for a path that ends inside or beyond: the side nearest to its end if it can have come in
    /// there, else the one by which it entered.
    pub(super) fn hit_on_path(&self, start: Vector, x: Vector) -> Option<Hit> {
        if start.max(x).cmple(self.min).any() || start.min(x).cmpge(self.max).any() {
            return None;
        }
        let nearest = self.hit(x);
        let slack = 1e-3 * (self.max - self.min).min_element();
        let open = |hit: &Hit| (start - x).dot(hit.normal) >= hit.depth - slack;
        nearest.filter(open).or_else(|| self.entry(start, x)).or(nearest)
    }

    /// Slab method: the path is inside from the last side it enters to the first side it leaves. A path that
    /// starts inside (or on a side, within rounding) is treated as starting on the nearest side.
    fn entry(&self, start: Vector, x: Vector) -> Option<Hit> {
        let mut from = start;
        if let Some(inside) = self.hit(start) {
            from = Vector::select(inside.normal.cmpgt(Vector::ZERO), self.max, from);
            from = Vector::select(inside.normal.cmplt(Vector::ZERO), self.min, from);
        }
        let way = x - from;
        let (mut enter, mut leave, mut side) = (-1.0, 1.0, None);
        for axis in [Vector::X, Vector::Y] {
            let (at, step) = (from.dot(axis), way.dot(axis));
            let (low, high) = (self.min.dot(axis), self.max.dot(axis));
            if step == 0.0 {
                if at <= low || at >= high {
                    return None;
                }
                continue;
            }
            let (near, far) = if step > 0.0 { (low, high) } else { (high, low) };
            let (comes, goes) = ((near - at) / step, (far - at) / step);
            if comes > enter {
                let normal = if step > 0.0 { -axis } else { axis };
                (enter, side) = (comes, Some((normal, (near - x.dot(axis)).abs())));
            }
            leave = goes.min(leave);
        }
        let (normal, depth) = side?;
        let meets = enter >= 0.0 && enter < leave;
        meets.then_some(Hit { normal, depth, friction: self.friction, measured: self.measured })
    }
}
