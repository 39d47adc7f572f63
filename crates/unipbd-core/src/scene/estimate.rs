//! What a scene would cost, without building it.

use super::Scene;
use super::layout::{block_counts, disc_count};

/// What a scene would cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Particles at the start.
    pub particles_at_start: u64,
}

impl Scene {
    /// Estimates the cost of the scene without allocating its particles.
    pub fn estimate(&self) -> Estimate {
        let blocks: f64 =
            self.block.iter().map(|block| block_counts(block, self.spacing).iter().product::<f64>()).sum();
        let discs: f64 = self.disc.iter().map(|disc| disc_count(disc, self.spacing)).sum();
        Estimate { particles_at_start: (blocks + discs) as u64 }
    }
}
