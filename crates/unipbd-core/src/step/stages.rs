//! The work of each stage.

use super::integrate;
use super::pipeline::CorrectionStep;
use super::world::World;
use super::{SolverError, Stage};
use crate::constraints::{ConstraintGroup, DensityGroup};
use crate::effects::Advected;
use crate::math::{Real, Vector, wide};
use crate::neighbors::{Prepared, SearchPositions};
use crate::parallel::Parallelism;
use crate::particles::Particles;

/// Speed in spacings per frame beyond which a run has diverged.
pub(crate) const ABSURD_SPEED: f64 = 1e6;

impl World {
    /// One substep: the stages, in order.
    pub(super) fn substep(&mut self) -> Result<(), SolverError> {
        self.stepped += (self.parts.particles.len() - self.parts.particles.asleep()) as u64;
        (0..self.plan.substep.len()).try_for_each(|index| self.run_timed(self.plan.substep[index]))
    }

    pub(super) fn run_timed(&mut self, stage: Stage) -> Result<(), SolverError> {
        let mut timings = std::mem::take(&mut self.timings);
        let done = timings.time(stage, || self.run(stage));
        self.timings = timings;
        done
    }

    pub(super) fn run(&mut self, stage: Stage) -> Result<(), SolverError> {
        match stage {
            Stage::Remove => self.remove(),
            Stage::Emit => self.emit(),
            Stage::Predict => self.predict(),
            Stage::Contacts => self.predict_bodies(),
            Stage::WakeAroundBodies => self.wake_around_bodies(),
            Stage::PressureGrid => self.project_on_grid(),
            Stage::GridWallForces => self.add_grid_wall_forces(),
            Stage::PlaceSamples => self.place_samples(),
            Stage::FindNeighbors => self.find_neighbors(self.parts.search_positions),
            Stage::BeginGroups => self.begin_groups(),
            Stage::Project => self.project(),
            Stage::KeepOutOfWalls => self.keep_out_of_walls(),
            Stage::StoreDensity => self.store_density(),
            Stage::AddGridPressure => self.add_grid_pressure(),
            Stage::ContactsAgain => self.iterate_contacts(),
            Stage::UpdateVelocities => return self.update_velocities(),
            Stage::MoveBodies => self.move_bodies(),
            Stage::SettleSamples => self.settle_samples(),
            Stage::FinishGroups => self.finish_groups(),
            Stage::RefreshNeighbors => self.find_neighbors(SearchPositions::Predicted),
            Stage::Effects => self.apply_effects(),
            Stage::AdvectSmoke => self.advect_smoke(),
            Stage::Sleep => self.decide_sleep(),
            Stage::FinishBodies => self.finish_bodies(),
        }
        Ok(())
    }

    fn emit(&mut self) {
        let (parts, clock) = (&mut self.parts, &self.clock);
        let Some(emitters) = &mut parts.emitters else { return };
        let changes = emitters.will_change(clock.time, clock.dt);
        let added = emitters.advance(clock.time, clock.dt, &mut parts.particles, &self.rows, &parts.neighbors);
        // The throttle may have opened since the call of `changes`.
        if changes || added > 0 {
            self.population_changed();
        }
    }

    fn predict(&mut self) {
        self.measure_push();
        let parts = &mut self.parts;
        integrate::predict(&mut parts.particles, &parts.forces, self.clock.dt as Real, parts.parallelism);
        parts.particles.clear_accelerations();
    }

    fn predict_bodies(&mut self) {
        let parts = &mut self.parts;
        let Some(rigid) = &mut parts.rigid else { return };
        rigid.contacts.run_on(parts.parallelism);
        rigid.contacts.meet_particles(!parts.groups.is_empty());
        rigid.carry_anchors(&parts.particles, &self.rows);
        rigid.predict(self.clock.dt, self.clock.time, wide(parts.gravity));
        if parts.pressure_grid.is_some() || !parts.without_slip.is_empty() || rigid.any_light() {
            rigid.find_mobilities();
        }
        rigid.iterate_contacts();
    }

    fn place_samples(&mut self) {
        let parts = &mut self.parts;
        let Some(rigid) = &mut parts.rigid else { return };
        rigid.place_samples(&mut parts.particles, &self.rows);
        rigid.find_light();
        rigid.place_outlines(&mut parts.outlines);
        rigid.place_outlines(&mut parts.without_slip);
    }

    fn iterate_contacts(&mut self) {
        let Some(rigid) = &mut self.parts.rigid else { return };
        rigid.iterate_contacts();
    }

    fn move_bodies(&mut self) {
        let parts = &mut self.parts;
        let Some(rigid) = &mut parts.rigid else { return };
        rigid.integrate(self.clock.dt);
    }

    fn settle_samples(&mut self) {
        let parts = &mut self.parts;
        let Some(rigid) = &mut parts.rigid else { return };
        rigid.settle_samples(&mut parts.particles, &self.rows);
        rigid.place_outlines(&mut parts.outlines);
    }

    fn finish_bodies(&mut self) {
        let Some(rigid) = &mut self.parts.rigid else { return };
        rigid.follow_particles(&self.parts.particles, &self.rows);
        rigid.finish_frame(self.parts.frame_time);
        self.report_broken_joints();
    }

    /// Makes the neighbour list valid for these positions.
    pub(super) fn find_neighbors(&mut self, at: SearchPositions) {
        let parts = &mut self.parts;
        let prepared = parts.neighbors.prepare(&mut parts.particles, at, parts.parallelism);
        if prepared == Prepared::Rebuilt {
            self.index_rows();
        }
    }

    /// Updates the list outside of a substep, in a scene that keeps one valid.
    pub(super) fn find_neighbors_if_listed(&mut self) {
        if self.plan.has_neighbors() {
            self.find_neighbors(self.parts.search_positions);
        }
    }

    fn begin_groups(&mut self) {
        let mut groups = std::mem::take(&mut self.parts.groups);
        let now = World::now(&self.parts, &self.rows, &self.clock);
        groups.iter_mut().for_each(|group| group.begin_substep(now));
        self.parts.groups = groups;
    }

    fn project(&mut self) {
        let mut groups = std::mem::take(&mut self.parts.groups);
        for _ in 0..self.parts.iterations {
            for group in &mut groups {
                self.reset_corrections();
                group.project(World::now(&self.parts, &self.rows, &self.clock), &mut self.corrections);
                self.apply_corrections();
            }
            self.iterated += 1;
            // A violation belongs to the positions at the start of the iteration.
            let within = |group: &dyn ConstraintGroup| group.violation().unwrap_or(0.0) <= self.parts.tolerance;
            if self.parts.tolerance > 0.0 && groups.iter().all(|group| within(group.as_ref())) {
                break;
            }
        }
        self.parts.groups = groups;
    }

    fn keep_out_of_walls(&mut self) {
        self.reset_corrections();
        self.apply_corrections();
    }

    fn store_density(&mut self) {
        let particles = &mut self.parts.particles;
        for columns in self.parts.groups.iter().filter_map(|group| group.as_density()).map(DensityGroup::columns) {
            particles.density_error[..columns.error.len()].copy_from_slice(columns.error);
            particles.multiplier[..columns.multiplier.len()].copy_from_slice(columns.multiplier);
        }
    }

    fn reset_corrections(&mut self) {
        let particles = &self.parts.particles;
        self.corrections.reset(particles.len(), particles.listed_bands(), particles.listed());
    }

    fn apply_corrections(&mut self) {
        for index in 0..self.plan.corrections.len() {
            match self.plan.corrections[index] {
                CorrectionStep::Shift => self.shift(),
                CorrectionStep::LoadWalls => self.load_walls(),
                CorrectionStep::Displace => self.displace(),
                CorrectionStep::LoadBodies => self.load_bodies(),
                CorrectionStep::PushOut => self.push_out(),
            }
        }
    }

    fn shift(&mut self) {
        integrate::shift(&mut self.parts.particles, &self.corrections, self.parts.parallelism);
    }

    /// Adds the forces of the corrections, and of the walls themselves, to the measured walls.
    fn load_walls(&mut self) {
        integrate::load_walls(&self.parts.particles, &mut self.corrections, &self.parts.walls);
        let inverse_dt = 1.0 / self.clock.dt;
        for (impulse, load) in self.wall_impulses.iter_mut().zip(self.corrections.wall_loads()) {
            *impulse += *load * inverse_dt;
        }
    }

    fn displace(&mut self) {
        let parts = &mut self.parts;
        integrate::apply(&mut parts.particles, &self.corrections, &parts.walls, parts.parallelism);
    }

    fn load_bodies(&mut self) {
        let parts = &mut self.parts;
        let Some(rigid) = &mut parts.rigid else { return };
        rigid.take_loads(self.corrections.loads(), &parts.particles, &self.rows, self.clock.dt);
        rigid.take_outline_loads(self.corrections.outline_loads(), &parts.outlines, self.clock.dt);
        rigid.take_outline_loads(self.corrections.shear_loads(), &parts.without_slip, self.clock.dt);
    }

    fn push_out(&mut self) {
        let parts = &mut self.parts;
        let Some(rigid) = &mut parts.rigid else { return };
        let walls = (&parts.walls, &parts.outlines);
        rigid.push_out(&mut parts.particles, &parts.neighbors, walls, &self.rows, self.clock.dt);
    }

    fn update_velocities(&mut self) -> Result<(), SolverError> {
        let parts = &mut self.parts;
        let (dt, periodic) = (self.clock.dt as Real, parts.neighbors.periodic());
        integrate::update_velocities(&mut parts.particles, dt, periodic, parts.parallelism);
        self.check_speeds()
    }

    /// The speed from which on a run counts as diverged [m/s].
    pub(super) fn speed_limit(&self) -> f64 {
        ABSURD_SPEED * self.parts.spacing / self.parts.frame_time
    }

    /// Refuses accelerations of a hook by which a particle would be absurdly fast after one substep.
    pub(super) fn check_accelerations(&self) -> Result<(), SolverError> {
        let (particles, limit) = (&self.parts.particles, self.speed_limit() / self.clock.dt);
        let absurd = |acceleration: &Vector| {
            let size = wide(*acceleration).length();
            size.is_nan() || size >= limit
        };
        let Some(row) = particles.acceleration.iter().position(absurd) else { return Ok(()) };
        Err(SolverError::Hook {
            step: self.clock.step,
            time: self.clock.time,
            particle: particles.id[row],
            material: self.parts.materials[usize::from(particles.material[row])].name.clone(),
            acceleration: wide(particles.acceleration[row]).to_array(),
            limit,
        })
    }

    fn check_speeds(&mut self) -> Result<(), SolverError> {
        let parts = &self.parts;
        let velocities = &parts.particles.velocity;
        let square = |row: usize| {
            let square = velocities[row].length_squared();
            if square.is_nan() { Real::INFINITY } else { square }
        };
        let [awake, loose] = parts.particles.bands();
        let of_loose = parts.parallelism.max(loose.len(), |row| square(loose.start + row));
        let largest = parts.parallelism.max(awake.len(), square).max(of_loose).max(0.0);
        self.clock.speed = f64::from(largest).sqrt();
        if self.clock.speed < self.speed_limit() {
            return Ok(());
        }
        let row = (0..velocities.len()).find(|&row| square(row) == largest).unwrap_or(0);
        Err(SolverError::Diverged {
            stage: Stage::UpdateVelocities.name(),
            step: self.clock.step,
            time: self.clock.time,
            particle: parts.particles.id[row],
            material: parts.materials[usize::from(parts.particles.material[row])].name.clone(),
            what: format!("moves at {} m/s", velocities[row].length()),
        })
    }

    fn finish_groups(&mut self) {
        let mut groups = std::mem::take(&mut self.parts.groups);
        for group in &mut groups {
            // The group gets the velocities before its own changes.
            self.velocities.clone_from(&self.parts.particles.velocity);
            group.finish_velocities(World::now(&self.parts, &self.rows, &self.clock), &mut self.velocities);
            std::mem::swap(&mut self.parts.particles.velocity, &mut self.velocities);
        }
        self.parts.groups = groups;
    }

    fn apply_effects(&mut self) {
        let mut effects = std::mem::take(&mut self.parts.effects);
        for effect in &mut effects {
            let temperatures = !self.parts.particles.temperature.is_empty();
            self.changes.reset(self.parts.particles.listed(), temperatures);
            effect.apply(World::now(&self.parts, &self.rows, &self.clock), &mut self.changes);
            self.apply_changes();
            self.note_cut(effect.name(), effect.stable_fraction());
        }
        self.parts.effects = effects;
    }

    /// Issues one warning when an effect is limited for stability; a new warning is possible after the limit ends.
    fn note_cut(&mut self, effect: &'static str, stable_fraction: f64) {
        let known = self.cut.iter().position(|name| *name == effect);
        match known {
            Some(index) if stable_fraction >= 1.0 => drop(self.cut.remove(index)),
            None if stable_fraction < 1.0 => {
                self.cut.push(effect);
                self.warn_of_cut(effect, stable_fraction);
            }
            _ => (),
        }
        let wanted = (f64::from(self.clock.substeps) / stable_fraction).ceil().min(f64::from(u32::MAX)) as u32;
        self.choice.wanted = self.choice.wanted.max(wanted);
    }

    fn apply_changes(&mut self) {
        let awake = self.parts.particles.awake();
        let particles = &mut self.parts.particles;
        let (changes, inverse_masses) = (&self.changes, &particles.inverse_mass);
        self.parts.parallelism.update(&mut particles.velocity[..awake], |row, velocity| {
            if inverse_masses[row] > 0.0 {
                *velocity += changes.velocity[row];
            }
        });
        let warmed = changes.temperature.len().min(awake);
        self.parts.parallelism.update(&mut particles.temperature[..warmed], |row, temperature| {
            if inverse_masses[row] > 0.0 {
                *temperature += changes.temperature[row];
            }
        });
    }

    fn advect_smoke(&mut self) {
        let Some(mut smoke) = self.parts.smoke.take() else { return };
        let advected = smoke.advect(World::now(&self.parts, &self.rows, &self.clock));
        move_smoke(&mut self.parts.particles, advected, self.parts.parallelism);
        smoke.set_last_dt(self.clock.dt as Real);
        self.parts.smoke = Some(smoke);
    }
}

/// Moves smoke to its advected positions; its displacement column keeps the velocity of one substep ago.
fn move_smoke(particles: &mut Particles, advected: &[Advected], parallelism: Parallelism) {
    let dense = particles.dense();
    let phase = &particles.phase[dense..];
    let (position, start) = (&mut particles.position[dense..], &mut particles.start[dense..]);
    let (velocity, displacement) = (&mut particles.velocity[dense..], &mut particles.displacement[dense..]);
    parallelism.chunks4(position, start, velocity, displacement, |first, position, start, velocity, displacement| {
        for k in 0..position.len() {
            let (phase, now) = (phase[first + k], advected[first + k]);
            if phase.is_passive() {
                (displacement[k], velocity[k]) = (velocity[k], now.velocity);
                (position[k], start[k]) = (now.position, now.position);
            }
        }
    });
}
