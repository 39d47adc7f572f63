//! Blocks and discs that put particles in the same place.

use super::checker::{Checker, rounded};
use super::geometry::Shape;
use crate::scene::layout::block_counts;
use crate::scene::{KeyPath, Scene};

/// The lattice of a block or a disc.
struct Lattice {
    path: KeyPath,
    /// A lattice point [m].
    origin: [f64; 2],
    /// First and last number of a point, counted from the origin, per axis.
    range: [[f64; 2]; 2],
    /// Radius of the disc about the origin that holds the points [m].
    radius: Option<f64>,
    spacing: f64,
}

impl Lattice {
    fn coordinate(&self, axis: usize, number: f64) -> f64 {
        self.origin[axis] + number * self.spacing
    }

    fn least(&self, axis: usize) -> f64 {
        self.coordinate(axis, self.range[axis][0])
    }

    fn most(&self, axis: usize) -> f64 {
        self.coordinate(axis, self.range[axis][1])
    }

    fn holds(&self, numbers: [f64; 2]) -> bool {
        let inside = |axis: usize| numbers[axis] >= self.range[axis][0] && numbers[axis] <= self.range[axis][1];
        let squared = (numbers[0] * numbers[0] + numbers[1] * numbers[1]) * self.spacing * self.spacing;
        inside(0) && inside(1) && self.radius.is_none_or(|radius| squared < radius * radius)
    }

    /// How near a particle of this lattice comes to `point`, where that is too near: within half a
    /// spacing, or in the middle of four particles.
    fn conflict(&self, point: [f64; 2]) -> Option<f64> {
        let place = [0, 1].map(|axis| (point[axis] - self.origin[axis]) / self.spacing);
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
            .map(|step: [f64; 2]| [place[0].floor() + step[0], place[1].floor() + step[1]]);
        let held = corners.into_iter().filter(|corner| self.holds(*corner));
        let distances = held.map(|corner| (corner[0] - place[0]).hypot(corner[1] - place[1]));
        let (count, nearest) = distances.fold((0, f64::INFINITY), |(count, least), next| (count + 1, least.min(next)));
        (nearest <= 0.5 + 1e-6 || count == 4).then_some(nearest * self.spacing)
    }

    /// Distance of some pair of particles that is too near [m].
    fn overlap(&self, other: &Lattice) -> Option<f64> {
        let margin = self.spacing * (0.5 + 1e-6);
        let [columns, rows] = [0, 1].map(|axis| {
            let from = ((other.least(axis) - margin - self.origin[axis]) / self.spacing).ceil();
            let to = ((other.most(axis) + margin - self.origin[axis]) / self.spacing).floor();
            (from.max(self.range[axis][0]) as i64, to.min(self.range[axis][1]) as i64)
        });
        (rows.0..=rows.1).find_map(|row| {
            (columns.0..=columns.1).find_map(|column| {
                let numbers = [column as f64, row as f64];
                let point = [0, 1].map(|axis| self.coordinate(axis, numbers[axis]));
                self.holds(numbers).then(|| other.conflict(point)).flatten()
            })
        })
    }
}

fn lattices(scene: &Scene, spacing: f64) -> Vec<Lattice> {
    let mut lattices = Vec::new();
    for (index, block) in scene.block.iter().enumerate() {
        if let Some(Shape::Rectangle { min, .. }) = Shape::of_block(block, spacing) {
            let range = block_counts(block, spacing).map(|count| [0.0, count - 1.0]);
            lattices.push(Lattice { path: KeyPath::entry("block", index), origin: min, range, radius: None, spacing });
        }
    }
    for (index, disc) in scene.disc.iter().enumerate() {
        if let Some(Shape::Disc { center, radius }) = Shape::of_disc(disc) {
            let reach = (radius / spacing).ceil();
            let range = [[-reach, reach]; 2];
            let path = KeyPath::entry("disc", index);
            lattices.push(Lattice { path, origin: center, range, radius: Some(radius), spacing });
        }
    }
    lattices
}

pub(super) fn check(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    let lattices = lattices(checker.scene, spacing);
    let mut order: Vec<usize> = (0..lattices.len()).collect();
    order.sort_by(|&a, &b| lattices[a].least(0).total_cmp(&lattices[b].least(0)));
    // A later entry is told about the first one it overlaps.
    let mut found: Vec<Option<(usize, f64)>> = vec![None; lattices.len()];
    for (place, &a) in order.iter().enumerate() {
        let end = lattices[a].most(0) + spacing;
        for &b in order[place + 1..].iter().take_while(|&&b| lattices[b].least(0) <= end) {
            let (first, later) = (a.min(b), a.max(b));
            if found[later].is_none_or(|(other, _)| first < other)
                && let Some(distance) = lattices[first].overlap(&lattices[later])
            {
                found[later] = Some((first, distance));
            }
        }
    }
    for (later, first, distance) in found.iter().enumerate().filter_map(|(i, f)| f.map(|(other, d)| (i, other, d))) {
        let other = &lattices[first].path;
        let apart = if distance < spacing * 1e-6 {
            "particles in the same place".to_owned()
        } else {
            format!("particles only {} m apart", rounded(distance))
        };
        let message = format!("overlaps {other}: {apart}");
        let hint = format!("let them touch edge to edge at most: particles should be one spacing ({spacing} m) apart");
        checker.problem(lattices[later].path.clone(), message, hint);
    }
}
