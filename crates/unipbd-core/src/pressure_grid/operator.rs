//! The operator of the pressure system where bodies are in it: the couplings of the fluid alone, and the response of
//! the bodies as a whole.

use super::couplings::Couplings;
use super::solids::Solids;
use super::spans::Spans;
use super::{held_by, renew};
use crate::math::Real;
use crate::parallel::Parallelism;

/// Couplings of the fluid, without those of bodies; empty where there are none.
#[derive(Default)]
pub(super) struct Operator {
    right: Vec<Real>,
    upper: Vec<Real>,
    /// Sum of the couplings of each cell with all around, air included.
    pub total: Vec<Real>,
}

impl Operator {
    /// Takes the couplings of the fluid.
    pub fn copy(&mut self, couplings: &Couplings, spans: &Spans, stride: usize, parallelism: Parallelism) {
        let Couplings { right, upper, air } = couplings;
        // Other cells were fluid in the last substep.
        [&mut self.right, &mut self.upper, &mut self.total].into_iter().for_each(|column| renew(column, right.len()));
        let (own_right, own_upper, total) = (&mut self.right, &mut self.upper, &mut self.total);
        spans.each3(own_right, own_upper, total, parallelism, |first, own_right, own_upper, total| {
            for k in 0..total.len() {
                let cell = first + k;
                (own_right[k], own_upper[k]) = (right[cell], upper[cell]);
                total[k] = right[cell] + right[cell - 1] + upper[cell] + upper[cell - stride] + air[cell];
            }
        });
    }

    /// Applies the operator to a pressure, in the cells that count.
    pub fn image(
        &self,
        (solids, counts): (&Solids, impl Fn(usize) -> bool + Sync),
        (pressure, out): (&[Real], &mut [Real]),
        (spans, stride): (&Spans, usize),
        parallelism: Parallelism,
    ) {
        let (right, upper, total) = (&self.right, &self.upper, &self.total);
        spans.each(out, parallelism, |first, out| {
            for (cell, out) in (first..).zip(out) {
                let across = right[cell] * pressure[cell + 1] + right[cell - 1] * pressure[cell - 1];
                let along = upper[cell] * pressure[cell + stride] + upper[cell - stride] * pressure[cell - stride];
                *out = if counts(cell) { total[cell] * pressure[cell] - (across + along) } else { 0.0 };
            }
        });
        solids.respond(pressure, out, stride, counts);
    }

    /// Memory held [bytes].
    pub fn memory_bytes(&self) -> usize {
        held_by(&[&self.right, &self.upper, &self.total])
    }
}
