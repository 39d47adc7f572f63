//! Blocks and discs that put particles in the same place.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::checker::{Checker, rounded};
use super::geometry::Shape;
use crate::scene::layout::block_counts;
use crate::scene::{KeyPath, Scene};

/// The lattice of a block or a disc.
struct Lattice {
    path: KeyPath,
    /// A lattice point \[m].
    origin: [f64; 2],
    /// First and last number of a point, counted from the origin, per axis.
    range: [[f64; 2]; 2],
    /// Radius of the disc about the origin that holds the points \[m].
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
        let distances = held.map(|corner| libm::hypot(corner[0] - place[0], corner[1] - place[1]));
        let (count, nearest) = distances.fold((0, f64::INFINITY), |(count, least), next| (count + 1, least.min(next)));
        (nearest <= 0.5 + 1e-6 || count == 4).then_some(nearest * self.spacing)
    }

    /// Distance of some pair of particles that is too near \[m].
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

/// For each lattice an earlier one that it overlaps, with the distance of two particles \[m].
///
/// A line sweeps over the plane from left to right. The lattices that it crosses are sorted by their lower ends; one that
/// overlaps is taken out at once, so the others hardly overlap, and each new one meets a few of them only.
fn sweep(lattices: &[Lattice], spacing: f64) -> Vec<Option<(usize, f64)>> {
    let mut found = vec![None; lattices.len()];
    let mut order: Vec<usize> = (0..lattices.len()).collect();
    order.sort_by(|&a, &b| lattices[a].least(0).total_cmp(&lattices[b].least(0)));
    let mut ends: BTreeSet<(Ordered, usize)> = BTreeSet::new();
    let mut crossed: BTreeSet<(Ordered, usize)> = BTreeSet::new();
    // No lattice that was crossed is taller.
    let mut tallest = 0.0_f64;
    for new in order {
        let [left, low, high] = [lattices[new].least(0), lattices[new].least(1), lattices[new].most(1)];
        while let Some(&(end, done)) = ends.first().filter(|(end, _)| end.0 + spacing < left) {
            ends.remove(&(end, done));
            crossed.remove(&(Ordered(lattices[done].least(1)), done));
        }
        let range = (Ordered(low - tallest - spacing), 0)..=(Ordered(high + spacing), usize::MAX);
        let near =
            crossed.range(range).map(|(_, other)| *other).filter(|&other| lattices[other].most(1) + spacing >= low);
        let mut met = Vec::new();
        for other in near {
            let (first, later) = (new.min(other), new.max(other));
            if let Some(distance) = lattices[first].overlap(&lattices[later]) {
                found[later] = Some((first, distance));
                met.push(later);
                if later == new {
                    break;
                }
            }
        }
        for &later in met.iter().filter(|&&later| later != new) {
            crossed.remove(&(Ordered(lattices[later].least(1)), later));
        }
        if !met.contains(&new) {
            tallest = tallest.max(high - low);
            crossed.insert((Ordered(low), new));
            ends.insert((Ordered(lattices[new].most(0)), new));
        }
    }
    found
}

/// A finite number with an order.
#[derive(Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

pub(super) fn check(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    let lattices = lattices(checker.scene, spacing);
    let found = sweep(&lattices, spacing);
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
