//! One warning for a fluid that is far from its rest density, frame after frame.
//!
//! The mean |C| counts. Of a liquid only compression does: at a free surface, in spray and in a rope, particles lack
//! neighbours, and C is negative where nothing is wrong. A gas may be thin for longer: where it begins to flow out.

use super::watched::{Errors, Watched};
use super::world::World;
use crate::math::{real, wide};
use crate::observe::{Event, Severity, SubstepReason};
use crate::phase::Phase;

/// Mean |C| of a material from which on a run is no longer to be trusted.
const FAR_OFF: f64 = 0.1;
/// Frames in a row that it takes: a splash may pass it for one...
const FRAMES: u32 = 2;
/// ...and a gas that begins to flow out for a quarter of a second at the usual rate.
const THIN_FRAMES: u32 = 15;
/// Distance of two particles, in spacings, that counts as one place.
const ONE_PLACE: f64 = 1e-3;

impl World {
    /// At the end of a frame: warns of each material once.
    pub(super) fn watch_density(&mut self) {
        // A frame in which all rows sleep changes no density, and must cost nothing.
        if !self.plan.has_density() || self.sleeps() {
            return;
        }
        let mut errors = std::mem::take(&mut self.material_errors);
        self.sum_errors(&mut errors);
        self.watched.resize(errors.len(), Watched::default());
        for (material, errors) in errors.iter().enumerate() {
            let watched = &mut self.watched[material];
            let off = errors.count > 0 && errors.size > FAR_OFF * errors.count as f64;
            watched.frames = if off { watched.frames + 1 } else { 0 };
            let enough = if errors.sum < 0.0 { THIN_FRAMES } else { FRAMES };
            if watched.frames >= enough && !watched.warned {
                watched.warned = true;
                self.warn_of_density(material, errors);
            }
        }
        self.material_errors = errors;
    }

    fn sum_errors(&self, all: &mut Vec<Errors>) {
        let particles = &self.parts.particles;
        all.clear();
        all.resize(self.parts.materials.len(), Errors::default());
        for row in (0..particles.dense()).filter(|&row| particles.inverse_mass[row] > 0.0) {
            let error = match particles.phase[row] {
                Phase::Liquid => particles.density_error[row].max(0.0),
                Phase::Gas => particles.density_error[row],
                _ => continue,
            };
            let of = &mut all[usize::from(particles.material[row])];
            of.count += 1;
            of.sum += f64::from(error);
            of.size += f64::from(error.abs());
            if error.abs() > of.largest {
                (of.worst, of.largest) = (row, error.abs());
            }
        }
    }

    fn warn_of_density(&mut self, material: usize, errors: &Errors) {
        let [x, y] = wide(self.parts.particles.position[errors.worst]).to_array();
        let (count, name) = (errors.count as f64, &self.parts.materials[material].name);
        let message = format!(
            "the density of \"{name}\" is off by {:.0} % in the mean for more than a frame (C {:+.0} % in the mean), most at \
             ({x:.3}, {y:.3}): {}",
            100.0 * errors.size / count,
            100.0 * errors.sum / count,
            self.likely_why(errors)
        );
        self.events.push(Event { time: self.clock.time, severity: Severity::Warning, message });
    }

    fn likely_why(&self, errors: &Errors) -> String {
        let wanted = self.choice.wanted.max(self.clock.substeps);
        if self.shares_its_place(errors.worst) {
            return "particles lie in one place there and never part; move them apart at the start".to_owned();
        }
        if errors.sum < 0.0 {
            return "its particles are farther apart than at rest, as where it flows out or is stirred".to_owned();
        }
        if self.choice.reason == SubstepReason::Budget {
            return "the budget of a frame allows fewer substeps than it wants".to_owned();
        }
        if wanted > self.clock.substeps {
            let taken = self.clock.substeps;
            return format!(
                "the frame wants {wanted} substeps and took {taken}; raise `solver.substeps` or `solver.max_substeps`"
            );
        }
        "more of it is there than fits between walls and bodies, or `solver.substeps` is too low".to_owned()
    }

    /// Whether another particle is where this one is.
    fn shares_its_place(&self, row: usize) -> bool {
        let particles = &self.parts.particles;
        let near = real(ONE_PLACE * self.parts.spacing * ONE_PLACE * self.parts.spacing);
        let here = particles.position[row];
        let others = particles.position[..particles.dense()].iter().enumerate();
        others.filter(|&(other, _)| other != row).any(|(_, place)| (*place - here).length_squared() < near)
    }
}
