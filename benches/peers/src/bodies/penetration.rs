//! How deep bodies lie in each other: one measure for all engines, from their poses alone.

use super::{Kind, Pose, SIZE, Setup};

/// Overlap of bodies with each other, floor and walls.
#[derive(Clone, Copy, Default)]
pub struct Penetration {
    /// The deepest of all [m].
    pub deepest: f64,
    /// Mean over the bodies of the deepest of each [m]: one pair that is wedged does not decide it.
    pub mean: f64,
}

/// Measures the overlaps of all bodies; 0 where nothing overlaps.
///
/// Two boxes overlap by the least shift that parts them: along a normal of a side of one of them, as for any two
/// convex polygons (separating axes).
pub fn measure(setup: &Setup, poses: &[Pose]) -> Penetration {
    let mut depths: Vec<f64> = poses.iter().map(|pose| in_walls(setup, pose).max(0.0)).collect();
    for (a, b) in near_pairs(poses) {
        let depth = overlap(setup.kind, &poses[a], &poses[b]);
        depths[a] = depths[a].max(depth);
        depths[b] = depths[b].max(depth);
    }
    let deepest = depths.iter().copied().fold(0.0, f64::max);
    Penetration { deepest, mean: depths.iter().sum::<f64>() / poses.len() as f64 }
}

fn overlap(kind: Kind, a: &Pose, b: &Pose) -> f64 {
    let apart = [b.place[0] - a.place[0], b.place[1] - a.place[1]];
    match kind {
        Kind::Discs => SIZE - apart[0].hypot(apart[1]),
        Kind::Boxes => {
            let along = |axis: [f64; 2]| reach(a, axis) + reach(b, axis) - dot(apart, axis).abs();
            axes(a).into_iter().chain(axes(b)).map(along).fold(f64::INFINITY, f64::min)
        }
    }
}

fn in_walls(setup: &Setup, pose: &Pose) -> f64 {
    let half = |axis: [f64; 2]| match setup.kind {
        Kind::Discs => SIZE / 2.0,
        Kind::Boxes => reach(pose, axis),
    };
    let [x, y] = pose.place;
    let floor = half([0.0, 1.0]) - y;
    setup.width.map_or(floor, |width| floor.max(half([1.0, 0.0]) - x.min(width - x)))
}

/// Normals of the sides of a box.
fn axes(pose: &Pose) -> [[f64; 2]; 2] {
    let (sin, cos) = pose.angle.sin_cos();
    [[cos, sin], [-sin, cos]]
}

/// Half the width of a box along an axis [m].
fn reach(pose: &Pose, axis: [f64; 2]) -> f64 {
    axes(pose).into_iter().map(|side| 0.5 * SIZE * dot(side, axis).abs()).sum()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Pairs whose centres lie closer along x than two boxes can reach.
fn near_pairs(poses: &[Pose]) -> impl Iterator<Item = (usize, usize)> {
    let reach = std::f64::consts::SQRT_2 * SIZE;
    let mut order: Vec<usize> = (0..poses.len()).collect();
    order.sort_by(|&a, &b| poses[a].place[0].total_cmp(&poses[b].place[0]));
    let behind = move |first: usize| {
        let a = order[first];
        let near = order[first + 1..].iter().take_while(move |&&b| poses[b].place[0] - poses[a].place[0] < reach);
        let close = near.filter(move |&&b| (poses[b].place[1] - poses[a].place[1]).abs() < reach);
        close.map(move |&b| (a, b)).collect::<Vec<_>>()
    };
    (0..poses.len()).flat_map(behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup(kind: Kind) -> Setup {
        Setup { kind, places: Vec::new(), width: Some(10.0) }
    }

    fn at(x: f64, y: f64, degrees: f64) -> Pose {
        Pose { place: [x, y], angle: degrees.to_radians() }
    }

    #[track_caller]
    fn overlaps(kind: Kind, poses: &[Pose], depth: f64) {
        let found = measure(&setup(kind), poses).deepest;
        assert!((found - depth).abs() < 1e-9, "{found} for {depth}");
    }

    #[test]
    fn bodies_apart_do_not_overlap_and_others_by_the_least_shift_that_parts_them() {
        overlaps(Kind::Boxes, &[at(1.0, 1.0, 0.0), at(1.51, 1.0, 0.0)], 0.0);
        overlaps(Kind::Boxes, &[at(1.0, 1.0, 0.0), at(1.49, 1.2, 0.0)], 0.01);
        overlaps(Kind::Discs, &[at(1.0, 1.0, 0.0), at(1.3, 1.39, 0.0)], 0.5 - 0.3_f64.hypot(0.39));
    }

    #[test]
    fn the_mean_is_that_of_each_bodys_deepest_overlap() {
        let found = measure(
            &setup(Kind::Boxes),
            &[at(1.0, 1.0, 0.0), at(1.49, 1.0, 0.0), at(1.97, 1.0, 0.0), at(5.0, 1.0, 0.0)],
        );
        assert!((found.mean - 0.0125).abs() < 1e-9 && (found.deepest - 0.02).abs() < 1e-9);
    }

    #[test]
    fn a_corner_sinks_into_a_side_by_its_depth() {
        let corner = 0.25 * 2.0_f64.sqrt();
        overlaps(Kind::Boxes, &[at(1.0, 1.0, 0.0), at(1.0, 1.25 + corner - 0.02, 45.0)], 0.02);
    }

    #[test]
    fn walls_count_and_so_does_the_turn_of_a_box() {
        overlaps(Kind::Boxes, &[at(5.0, 0.24, 0.0)], 0.01);
        overlaps(Kind::Boxes, &[at(9.8, 1.0, 0.0)], 0.05);
        overlaps(Kind::Boxes, &[at(5.0, 0.25, 45.0)], 0.25 * 2.0_f64.sqrt() - 0.25);
        overlaps(Kind::Discs, &[at(0.2, 1.0, 45.0)], 0.05);
    }
}
