//! Sleep of liquids in the frame loop.

use super::world::{Parts, World};
use crate::math::{Real, Vector};
use crate::rows::RowIndex;
use crate::sleep::LiquidSleep;

impl World {
    pub(super) fn decide_sleep(&mut self) {
        self.rearrange(|sleep, parts| {
            let rigid = parts.rigid.as_ref();
            sleep.decide(&mut parts.particles, |id| rigid.is_some_and(|rigid| rigid.may_rest(id)));
        });
    }

    /// Whether all movable rows sleep: then the next frame is equal to the last.
    pub(super) fn sleeps(&self) -> bool {
        let particles = &self.parts.particles;
        particles.asleep() > 0 && particles.asleep() == particles.len() && !self.emits()
    }

    /// Whether there are emitters or injectors.
    pub fn emits(&self) -> bool {
        self.parts.emitters.as_ref().is_some_and(|emitters| !emitters.is_over())
    }

    /// Wakes the sleeping rows around some points.
    pub fn wake_near(&mut self, points: &[Vector]) {
        if !points.is_empty() && self.parts.particles.asleep() > 0 {
            self.rearrange(|sleep, parts| sleep.wake_near(points, &parts.particles));
        }
    }

    /// A body that was woken by another body, or by a joint, wakes the liquid around it.
    pub(super) fn wake_around_bodies(&mut self) {
        let (particles, mut places) = (&self.parts.particles, Vec::new());
        let Some(rigid) = self.parts.rigid.as_ref().filter(|_| particles.asleep() > 0) else { return };
        rigid.each_sample_left_asleep(particles, &self.rows, |row| places.push(particles.position[row]));
        self.wake_near(&places);
    }

    /// Wakes all rows and bodies; they may fall asleep again.
    pub fn wake_all(&mut self) {
        if self.parts.particles.asleep() > 0 {
            self.parts.particles.set_asleep(0, 0);
            self.rows_rearranged();
        }
        if let Some(sleep) = &mut self.parts.sleep {
            sleep.forget();
        }
        if let Some(rigid) = &mut self.parts.rigid {
            rigid.contacts.wake_all(&mut rigid.bodies);
            rigid.bodies.refresh_views();
        }
    }

    /// Wakes a body with all that sleeps with it.
    pub(super) fn wake_body(&mut self, body: u32) {
        let Some(rigid) = &mut self.parts.rigid else { return };
        rigid.contacts.wake(&mut rigid.bodies, body);
        rigid.bodies.refresh_views();
        self.wake_around_bodies();
    }

    /// Wakes all rows and disables sleep.
    pub(super) fn wake_for_good(&mut self) {
        if self.parts.particles.asleep() > 0 {
            self.parts.particles.set_asleep(0, 0);
            self.rows_rearranged();
        }
        self.parts.sleep = None;
    }

    /// The positions of some rows, if there are sleeping rows that their removal could affect.
    pub(crate) fn places(&self, rows: &[u32]) -> Vec<Vector> {
        let particles = &self.parts.particles;
        let rows = if particles.asleep() > 0 { rows } else { &[] };
        rows.iter().map(|&row| particles.position[row as usize]).collect()
    }

    /// A hook that pushes or moves a sleeping row wakes it.
    pub(super) fn wake_what_hooks_moved(&mut self) {
        if !std::mem::take(&mut self.hooked) {
            return;
        }
        let particles = &self.parts.particles;
        let moved = |row: &u32| {
            let row = *row as usize;
            let pushed = particles.acceleration.get(row).is_some_and(|&a| a != Vector::ZERO);
            pushed || particles.velocity[row] != Vector::ZERO
        };
        let rows: Vec<u32> = (particles.awake() as u32..particles.dense() as u32).filter(moved).collect();
        let places = self.places(&rows);
        self.wake_near(&places);
    }

    /// Sleeping rows keep their pressure when the length of a substep changes: multipliers are proportional to dt^2.
    pub(super) fn keep_pressure_asleep(&mut self, before: f64) {
        let particles = &mut self.parts.particles;
        if particles.asleep() > 0 && before > 0.0 && before != self.clock.dt {
            let ratio = self.clock.dt / before;
            let sleeping = particles.awake()..particles.dense();
            particles.multiplier[sleeping].iter_mut().for_each(|multiplier| *multiplier *= (ratio * ratio) as Real);
        }
    }

    /// Sorts the rows into the order selected by sleep; bodies sleep and wake with their samples.
    fn rearrange(&mut self, decide: impl FnOnce(&mut LiquidSleep, &mut Parts)) {
        let Some(mut sleep) = self.parts.sleep.take() else { return };
        decide(&mut sleep, &mut self.parts);
        let parts = &mut self.parts;
        wake_bodies(&mut sleep, parts, &self.rows);
        if let Some(plan) = sleep.plan(&parts.particles) {
            parts.neighbors.reorder_dense(&mut parts.particles, plan.order, parts.parallelism);
            parts.particles.set_asleep(plan.order.len() - plan.awake, plan.border);
            plan.settle(&mut parts.particles);
            self.rows_rearranged();
            if let Some(rigid) = &mut self.parts.rigid {
                rigid.put_to_sleep(&self.parts.particles, &self.rows);
            }
        }
        self.parts.sleep = Some(sleep);
    }

    fn rows_rearranged(&mut self) {
        self.parts.neighbors.invalidate();
        self.index_rows();
        // A caller may request neighbours between two frames.
        if self.clock.done == 0 || self.clock.done == self.clock.substeps {
            self.parts.particles.start_here();
            self.find_neighbors(self.parts.search_positions);
        }
    }
}

/// Wakes bodies with a waking sample, together with all of their samples.
fn wake_bodies(sleep: &mut LiquidSleep, parts: &mut Parts, rows: &RowIndex) {
    let (Some(rigid), particles) = (&mut parts.rigid, &parts.particles) else { return };
    let asleep = |row: usize| row >= particles.awake();
    while rigid.wake_bodies(rows, |row| asleep(row) && sleep.is_waking(particles.position[row])) {
        rigid.each_sample_left_asleep(particles, rows, |row| sleep.wake_also(particles.position[row]));
    }
}
