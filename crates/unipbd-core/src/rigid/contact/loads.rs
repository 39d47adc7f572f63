//! Sums of the impulses on bodies and walls over a frame, from contacts in lanes.

use super::blocks::{Blocks, CHUNK};
use super::contact_block::{Block, Exact};
use super::lanes::Rule;
use super::opening::push_of;
use crate::math::Vector64;
use crate::rigid::Twist;
use crate::simd::wide::{Kernel, Wide, run};

/// Adds the impulses of blocks to the sums.
struct Load<'a> {
    blocks: &'a [Block],
    /// Along x and y, moments, and nothing.
    loads: &'a mut [Exact],
    per_second: f64,
}

impl Kernel for Load<'_> {
    #[inline(always)]
    fn run<W: Wide>(self, lanes: W) {
        let (zero, per_second) = (lanes.like(0.0), lanes.like(self.per_second));
        for block in self.blocks {
            let ([x, y], [turn_a, turn_b]) = push_of(lanes, block);
            let (x, y) = (x * per_second, y * per_second);
            let on_a = W::rows([x, y, turn_a * per_second, zero]);
            let on_b = W::rows([zero - x, zero - y, zero - turn_b * per_second, zero]);
            for (rows, bodies) in [(on_a, &block.bodies[0]), (on_b, &block.loaded)] {
                // One after the other: bodies that contacts do not move may be in several lanes.
                for (push, &body) in rows.iter().zip(bodies) {
                    let sum = &mut self.loads[body as usize];
                    *sum = (lanes.row(sum) + lanes.row(push)).to_array();
                }
            }
        }
    }
}

impl Blocks {
    /// Adds the impulses of a substep of this length \[s] to the loads of bodies and of so many walls, and removes
    /// overlap by this rule.
    pub fn load_and_separate(&mut self, (dt, walls): (f64, usize), rule: Rule) {
        self.loads.resize(self.motion.len() + walls, [0.0; 4]);
        for first in (0..self.all.len()).step_by(CHUNK) {
            let chunk = first..self.all.len().min(first + CHUNK);
            run(Load { blocks: &self.all[chunk.clone()], loads: &mut self.loads, per_second: 1.0 / dt });
            // They are still near the processor.
            self.pass_over(chunk, rule);
        }
    }

    /// Gives the loads since the last call to bodies and walls.
    pub fn give_loads(&mut self, bodies: &mut [Twist], walls: &mut [Vector64]) {
        let (of_bodies, others) = self.loads.split_at(bodies.len().min(self.loads.len()));
        for (sum, &[x, y, angular, _]) in bodies.iter_mut().zip(of_bodies) {
            *sum += Twist { linear: Vector64::new(x, y), angular };
        }
        // The idle row lies between.
        for (sum, &[x, y, ..]) in walls.iter_mut().zip(others.iter().skip(1)) {
            *sum += Vector64::new(x, y);
        }
        self.loads.clear();
    }
}
