//! Light bodies give way within an iteration: without that each multiplier pushes them as if it were alone, and all
//! together throw them beyond the place where none would.

use super::{Density, DensitySettings as Settings};
use crate::constraints::{LightBody, Substep};
use crate::kernel::Shape;
use crate::math::{Real, dot3, larger, real, wide};
use crate::rigid::Mobility;

/// Change of the density error of a particle by a displacement of a body: along x, along y and by a rotation.
type Change = [f64; 3];

/// Rounds in which multipliers begin or cease to follow their errors.
const ROUNDS: usize = 4;

/// A particle near a light body.
struct Touched {
    row: usize,
    change: Change,
    /// Response of its density error, floored.
    response: Real,
    /// Multiplier before this iteration.
    old: Real,
}

impl<K: Shape> Density<K> {
    /// Lets light bodies answer to the multipliers, and these to the bodies: u = -W sum_i lambda_i g_i, and lambda_i as
    /// with an error of C_i + g_i u, solved together. Run between [`step_multipliers`](Self::step_multipliers) and
    /// [`correct`](Self::correct).
    pub(super) fn give_way(&mut self, now: Substep<'_>) {
        let share = f64::from(self.settings.velocity_share);
        for body in now.light {
            let (touched, mobility) = (self.touched(now, body), body.mobility.map(|row| row.map(|w| w * share)));
            let (mut moved, mut answering) = ([0.0; 3], Vec::new());
            for _ in 0..ROUNDS {
                let after: Vec<_> = touched.iter().map(|of| self.multiplier_after(now, of, moved)).collect();
                let now_answering: Vec<bool> = after.iter().map(|(_, answers)| *answers).collect();
                if now_answering == answering {
                    break;
                }
                answering = now_answering;
                let (mut push, mut stiffness) = ([0.0; 3], [[0.0; 3]; 3]);
                for (of, (multiplier, answers)) in touched.iter().zip(after) {
                    let multiplier = f64::from(multiplier);
                    let per_error = if answers { f64::from(self.per_error(now, of)) } else { 0.0 };
                    let along = dot3(of.change, moved) * per_error;
                    for k in 0..3 {
                        push[k] -= (multiplier - along) * of.change[k];
                        (0..3).for_each(|l| stiffness[k][l] += per_error * of.change[k] * of.change[l]);
                    }
                }
                moved = answer(mobility, stiffness, push);
            }
            for of in touched {
                let (new, _) = self.multiplier_after(now, &of, moved);
                self.multiplier[of.row] = new;
                self.step[of.row] = (new - of.old) / self.settings.step_unit;
            }
        }
    }

    /// Change of a multiplier by that of its error.
    fn per_error(&self, now: Substep<'_>, of: &Touched) -> Real {
        now.stiffness * self.relaxation(now, of.row) / of.response
    }

    /// The multiplier of a particle after a displacement of the body, and whether it follows the error: at a bound it does
    /// not.
    fn multiplier_after(&self, now: Substep<'_>, of: &Touched, moved: [f64; 3]) -> (Real, bool) {
        let (particles, limit) = (now.particles, now.pressure_limit * now.dt * now.dt);
        let material = self.settings.materials[usize::from(particles.materials()[of.row])];
        let error = self.error[of.row] + real(dot3(of.change, moved));
        let inverse_mass = particles.inverse_masses()[of.row];
        let new = material.multiplier(of.old, error, of.response, inverse_mass, now.stiffness, limit);
        (new, new == material.unbounded(of.old, error, of.response, now.stiffness))
    }

    fn relaxation(&self, now: Substep<'_>, row: usize) -> Real {
        self.settings.materials[usize::from(now.particles.materials()[row])].relaxation
    }

    /// The particles near a body, in the order of their rows.
    fn touched(&self, now: Substep<'_>, body: &LightBody) -> Vec<Touched> {
        let (particles, periodic) = (now.particles, now.neighbors.periodic());
        let places = self.places.iteration(now).pairs.gradient;
        let mut found: Vec<(usize, Change)> = Vec::new();
        for row in (body.samples.0..body.samples.1).filter_map(|id| now.rows.row(id)).map(|row| row as usize) {
            let arm = wide(particles.positions()[row]) - body.centre;
            now.neighbors.for_each(row, |other| {
                let moves = other < self.error.len() && particles.inverse_masses()[other] > 0.0;
                if moves && self.relaxation(now, other) > 0.0 {
                    let apart = periodic.min_image(places[row] - places[other]);
                    let gradient = wide(apart * (self.kernel.slope(apart.length()) * self.settings.volume));
                    found.push((other, [gradient.x, gradient.y, arm.perp_dot(gradient)]));
                }
            });
        }
        found.sort_by_key(|(row, _)| *row);
        let add = |sum: Change, (_, more): &(usize, Change)| std::array::from_fn(|k| sum[k] + more[k]);
        let of_row = |all: &[(usize, Change)]| self.touched_row(now, all[0].0, all.iter().fold([0.0; 3], add));
        found.chunk_by(|a, b| a.0 == b.0).map(of_row).collect()
    }

    fn touched_row(&self, now: Substep<'_>, row: usize, change: Change) -> Touched {
        let Settings { volume, unit, step_unit, materials, .. } = &self.settings;
        let inverse_mass = now.particles.inverse_masses()[row];
        let gradient = self.sums.gradient[row] * *volume + self.wall_gradient[row];
        let of_others = (volume / unit) * (volume / unit) * self.sums.response[row];
        let floor = materials[usize::from(now.particles.materials()[row])].response_min;
        Touched {
            row,
            change,
            response: larger(inverse_mass * gradient.length_squared() + of_others, floor),
            old: self.multiplier[row] - self.step[row] * step_unit,
        }
    }
}

/// Solves (1 + W K) u = W f by elimination.
fn answer(mobility: Mobility, stiffness: [[f64; 3]; 3], push: [f64; 3]) -> [f64; 3] {
    let column = |l: usize| stiffness.map(|row| row[l]);
    let unit = |k: usize, l: usize| f64::from(u8::from(k == l));
    let mut rows: [[f64; 4]; 3] = std::array::from_fn(|k| {
        let [a, b, c] = std::array::from_fn(|l| unit(k, l) + dot3(mobility[k], column(l)));
        [a, b, c, dot3(mobility[k], push)]
    });
    for pivot in 0..3 {
        for k in (0..3).filter(|&k| k != pivot) {
            let part = rows[k][pivot] / rows[pivot][pivot];
            rows[k] = std::array::from_fn(|l| rows[k][l] - part * rows[pivot][l]);
        }
    }
    std::array::from_fn(|k| rows[k][3] / rows[k][k])
}
