//! Lattices that fill the shapes of a scene.

use super::{Block, Disc, KeyPath, Scene};
use crate::math::Vector64;

/// Columns and rows of the lattice that fills a block.
pub(crate) fn block_counts(block: &Block, spacing: f64) -> [f64; 2] {
    [0, 1].map(|axis| ((block.max[axis] - block.min[axis]) / spacing).round().max(0.0))
}

/// Points of the lattice that fills a block, row by row from its lower left corner.
pub(crate) fn block_points(block: &Block, spacing: f64) -> Vec<Vector64> {
    let [columns, rows] = block_counts(block, spacing);
    let origin = Vector64::from(block.min) + spacing * 0.5;
    let mut points = Vec::with_capacity((columns * rows) as usize);
    for row in 0..rows as usize {
        for column in 0..columns as usize {
            points.push(origin + Vector64::new(column as f64, row as f64) * spacing);
        }
    }
    points
}

/// Points of the square lattice through the centre of a disc that lie inside it.
pub(crate) fn disc_points(disc: &Disc, spacing: f64) -> Vec<Vector64> {
    let center = Vector64::from(disc.center);
    let reach = (disc.radius / spacing).ceil() as i64;
    let mut points = Vec::new();
    for row in -reach..=reach {
        for column in -reach..=reach {
            let offset = Vector64::new(column as f64, row as f64) * spacing;
            if offset.length_squared() < disc.radius * disc.radius {
                points.push(center + offset);
            }
        }
    }
    points
}

/// Number of particles of a disc, without laying them out.
pub(crate) fn disc_count(disc: &Disc, spacing: f64) -> f64 {
    std::f64::consts::PI * (disc.radius / spacing) * (disc.radius / spacing)
}

/// Numbers of particles that the tables of a scene lay out at the start.
pub(crate) fn particle_counts(scene: &Scene) -> Vec<(KeyPath, f64)> {
    let spacing = scene.spacing;
    let blocks = scene.block.iter().map(|block| block_counts(block, spacing).into_iter().product::<f64>());
    let discs = scene.disc.iter().map(|disc| disc_count(disc, spacing));
    let points = scene.points.iter().map(|points| points.positions.len() as f64);
    let ropes = scene.rope.iter().map(|rope| rope.pieces(spacing) + 1.0);
    let paths = |kind: &'static str| (0..).map(move |index| KeyPath::entry(kind, index));
    let filled = paths("block").zip(blocks).chain(paths("disc").zip(discs));
    filled.chain(paths("points").zip(points)).chain(paths("rope").zip(ropes)).collect()
}
