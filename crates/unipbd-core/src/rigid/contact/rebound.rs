//! Restitution: contacts that rebound in a substep, on the velocities at its end.
//!
//! The impact falls within the substep. The body falls to the surface, rebounds, and flies the rest of the substep.
//! Velocities are those of a leapfrog scheme, half a step of gravity behind the positions: with both, the height of
//! an elastic rebound is exact at every step. Friction of the rebound has the limit of both normal impulses together.

use super::complementarity;
use super::contact_cache::{ContactCache, Rebound};
use super::manifold::{Contact, entry};
use super::push::Push;
use crate::rigid::Twist;

/// How a body flies before and after an impact in a substep.
fn flight(gap: f64, approach: f64, pull: f64, restitution: f64, dt: f64) -> Rebound {
    let (gap, before) = (gap.max(0.0), (approach + 0.5 * pull * dt).min(0.0));
    let impact = (before * before - 2.0 * pull * gap).max(0.0).sqrt();
    let time = if gap > 0.0 { (2.0 * gap / (impact - before)).min(dt) } else { 0.0 };
    let (left, speed) = (dt - time, restitution * impact);
    let (velocity, flown) = (speed + pull * (left - 0.5 * dt), (speed + 0.5 * pull * left) * left);
    Rebound { velocity: velocity.max(0.0), flown: flown.max(0.0), normal: 0.0, tangent: 0.0 }
}

impl Contact {
    fn acts(&self, k: usize, cache: &ContactCache, slowest: f64) -> bool {
        self.points().get(k).is_some_and(|point| point.normal_impulse > 0.0 && cache.approach[k] < -slowest)
    }

    /// Whether the contact rebounds: its impact speed exceeded `slowest` [m/s].
    pub fn rebounds(&self, cache: &ContactCache, slowest: f64) -> bool {
        cache.surface.restitution > 0.0 && (0..2).any(|k| self.acts(k, cache, slowest))
    }

    /// Computes the flight of the points that rebound.
    pub fn begin_rebound(&self, cache: &mut ContactCache, dt: f64, slowest: f64) {
        for k in 0..2 {
            if !self.acts(k, cache, slowest) {
                continue;
            }
            let gap = self.points()[k].gap;
            cache.rebound[k] = flight(gap, cache.approach[k], cache.pull, cache.surface.restitution, dt);
        }
    }

    /// One velocity iteration towards the rebound; the total impulse of the substep stays repulsive.
    pub fn rebound(&self, cache: &mut ContactCache, velocities: &[Twist], dt: f64, slowest: f64) -> Push {
        let (a, b) = (entry(velocities, self.a), entry(velocities, self.b));
        let acts = [0, 1].map(|k| self.acts(k, cache, slowest));
        let mut excess = [0.0; 2];
        for (k, point) in self.points().iter().enumerate() {
            excess[k] = self.opening(point, &a, &b) - cache.rebound[k].velocity;
        }
        let coupling = self.effective_mass.normal.restricted_to(acts);
        let old = cache.rebound.map(|rebound| rebound.normal);
        let mut lower = [0.0; 2];
        for (lower, point) in lower.iter_mut().zip(self.points()) {
            *lower = -point.normal_impulse / dt;
        }
        let total = complementarity::solve(&coupling, excess, old, lower);
        let change = [total[0] - old[0], total[1] - old[1]];
        let (turned_a, turned_b) = self.turned_by(change);
        let all: f64 = self.points().iter().zip(total).map(|(point, add)| point.normal_impulse / dt + add).sum();
        let mut push = Push::default();
        for (k, point) in self.points().iter().enumerate() {
            let normal = point.normal_impulse / dt + total[k];
            let slide = self.slide(point, &a, &b) - cache.surface.speed
                + point.tangent_a * turned_a
                + point.tangent_b * turned_b;
            let share = if all > 0.0 { normal / all } else { 0.0 };
            let (limit, held) = (self.effective_mass.friction * normal, point.tangent_impulse / dt);
            let stop = slide * share * self.effective_mass.tangent[k];
            let tangent = (held + cache.rebound[k].tangent - stop).clamp(-limit, limit) - held;
            self.add_push(&mut push, point, change[k], tangent - cache.rebound[k].tangent);
            (cache.rebound[k].normal, cache.rebound[k].tangent) = (total[k], tangent);
        }
        push
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flight_over_an_elastic_impact_keeps_the_energy() {
        let (dt, pull) = (1.0 / 60.0, -9.81);
        for gap in [0.0, 0.01, 0.03, 0.06] {
            // The true velocity at the start is half a step of gravity ahead.
            let Rebound { velocity, flown, .. } = flight(gap, -4.0, pull, 1.0, dt);
            let (before, after) = (-4.0 + 0.5 * pull * dt, velocity + 0.5 * pull * dt);
            let change = 0.5 * (after * after - before * before) - pull * (flown - gap);
            println!("gap {gap}: energy changes by {change:.1e} m^2/s^2");
            assert!(change.abs() < 1e-12);
        }
    }
}
