//! Emitters: rows of particles behind a face are moved across it and released.
//!
//! Behind each column of the face are three kinematic particles of the emitter. They complete the
//! neighbourhood of the fluid in front; the first particle to cross the face is released, and a new one is added
//! three spacings behind. (Particles released at random positions have ten times the pressure.)

use super::columns::{Column, columns};
use super::injector::RegionInjector;
use crate::math::{Real, Vector, Vector64, real, vector, wide};
use crate::neighbors::Neighbors;
use crate::particles::{NewParticle, Particles};
use crate::phase::{MaterialIndex, Phase};
use crate::rng::Rng;
use crate::rows::RowIndex;
use crate::scene::{Emitter, Scene};

use super::saved::{ColumnState, EmitterState, ROWS_BEHIND};

/// Mean compression ahead of the face at which the throttle begins to close; at twice that it is closed.
const THROTTLE_COMPRESSION: f64 = 0.015;
/// Flow distance, in spacings, over which the compression ahead is averaged while it grows...
const WAY_TO_CLOSE: f64 = 1.0;
/// ...and while it falls: a nozzle that opens immediately would hit an obstacle repeatedly.
const WAY_TO_OPEN: f64 = 8.0;

/// All emitters of a scene.
pub struct EmitterSystem {
    pub(super) emitters: Vec<Nozzle>,
    pub(super) injectors: Vec<RegionInjector>,
}

pub(super) struct Nozzle {
    /// Its description, with all changes since the start.
    pub description: Emitter,
    /// Whether it was taken away; its number is not given to another.
    pub removed: bool,
    /// Whether it was switched off.
    pub off: bool,
    position: Vector64,
    direction: Vector64,
    spacing: f64,
    carrier: Carrier,
    smoke: Option<Markers>,
    pub columns: Vec<Column>,
    pub state: EmitterState,
}

struct Carrier {
    material: MaterialIndex,
    phase: Phase,
    inverse_mass: Real,
}

struct Markers {
    material: MaterialIndex,
    per_particle: u32,
}

impl EmitterSystem {
    /// The emitters of a scene.
    pub fn new(scene: &Scene, seed: u64) -> Self {
        let nozzle = |(number, emitter)| Nozzle::new(emitter, scene, Rng::new(seed, number as u64));
        let injector = |(number, injector)| RegionInjector::new(injector, scene, seed, number);
        EmitterSystem {
            emitters: scene.emitter.iter().enumerate().map(nozzle).collect(),
            injectors: scene.injector.iter().enumerate().filter_map(injector).collect(),
        }
    }

    /// Maximum emitter speed at this time [m/s].
    pub fn speed_max(&self, time: f64) -> f64 {
        let active = self.emitters.iter().filter(|nozzle| nozzle.is_active(time));
        active.flat_map(|nozzle| &nozzle.columns).map(|column| column.speed).fold(0.0, f64::max)
    }

    /// Advances all emitters by `dt` from `time`: releases particles, adds new ones, sets the speed of
    /// the particles behind the face. Returns the number of particles added.
    pub fn advance(
        &mut self,
        time: f64,
        dt: f64,
        particles: &mut Particles,
        rows: &RowIndex,
        neighbors: &Neighbors,
    ) -> u64 {
        let before = particles.ids_given();
        for nozzle in &mut self.emitters {
            nozzle.advance(time, dt, particles, rows, neighbors);
        }
        for injector in &self.injectors {
            injector.advance(time, dt, particles, neighbors);
        }
        u64::from(particles.ids_given() - before)
    }

    /// Whether the next [`advance`](Self::advance) by `dt` adds or releases particles.
    pub fn will_change(&self, time: f64, dt: f64) -> bool {
        self.emitters.iter().any(|nozzle| nozzle.will_change(time, dt))
            || self.injectors.iter().any(|injector| injector.will_change(time, dt))
    }

    /// Number of columns of each emitter.
    pub fn columns(&self) -> impl Iterator<Item = usize> {
        self.emitters.iter().map(|nozzle| nozzle.columns.len())
    }
}

impl Nozzle {
    pub fn new(emitter: &Emitter, scene: &Scene, rng: Rng) -> Self {
        let spacing = scene.spacing;
        let index = |name: &str| scene.material(name).map_or(0, |(index, _)| index as MaterialIndex);
        let carrier = scene.material(&emitter.material).map_or_else(
            || Carrier { material: 0, phase: Phase::Gas, inverse_mass: 1.0 },
            |(index, material)| Carrier {
                material: index as MaterialIndex,
                phase: material.phase(),
                inverse_mass: real(1.0 / material.particle_mass(spacing)),
            },
        );
        let columns = columns(emitter, spacing);
        let still = ColumnState { progress: 0.0, behind: [0; ROWS_BEHIND] };
        let markers = |smoke: &crate::scene::SmokeSource| Markers {
            material: index(&smoke.material),
            per_particle: smoke.per_particle,
        };
        Nozzle {
            description: emitter.clone(),
            removed: false,
            off: false,
            position: emitter.position.into(),
            direction: Vector64::from(emitter.direction).normalize_or(Vector64::Y),
            spacing,
            carrier,
            smoke: emitter.smoke.as_ref().map(markers),
            state: EmitterState {
                rng: rng.state(),
                running: false,
                compression: 0.0,
                columns: vec![still; columns.len()],
            },
            columns,
        }
    }

    pub fn is_active(&self, time: f64) -> bool {
        let Emitter { start, stop, .. } = self.description;
        !self.removed && !self.off && time >= start && stop.is_none_or(|stop| time < stop)
    }

    fn will_change(&self, time: f64, dt: f64) -> bool {
        let crossing = |(column, state): (&Column, &ColumnState)| {
            state.progress + column.speed * self.state.throttle() * dt / column.row >= 1.0
        };
        self.is_active(time) != self.state.running
            || self.state.running && self.columns.iter().zip(&self.state.columns).any(crossing)
    }

    fn advance(&mut self, time: f64, dt: f64, particles: &mut Particles, rows: &RowIndex, neighbors: &Neighbors) {
        match (self.is_active(time), self.state.running) {
            (true, false) => self.open(particles),
            (false, true) => self.close(particles, rows),
            (false, false) => return,
            (true, true) => {}
        }
        if !self.state.running {
            return;
        }
        // After a removal of particles the rows of the list are invalid: the throttle stays unchanged.
        if self.description.throttle && neighbors.is_current() {
            self.feel(dt, particles, neighbors);
        }
        for index in 0..self.columns.len() {
            self.advance_column(index, dt, particles, rows);
        }
    }

    /// Adds the rows behind the face.
    fn open(&mut self, particles: &mut Particles) {
        self.state.running = true;
        for index in 0..self.columns.len() {
            for row in 0..ROWS_BEHIND {
                self.state.columns[index].behind[row] = self.add_behind(index, (row + 1) as f64, particles);
            }
        }
    }

    /// Releases all particles behind the face.
    pub fn close(&mut self, particles: &mut Particles, rows: &RowIndex) {
        self.state.running = false;
        for column in &self.state.columns {
            for row in column.behind.iter().filter_map(|&id| rows.row(id)) {
                particles.inverse_mass[row as usize] = self.carrier.inverse_mass;
            }
        }
    }

    fn advance_column(&mut self, index: usize, dt: f64, particles: &mut Particles, rows: &RowIndex) {
        let column = &self.columns[index];
        let speed = column.speed * self.state.throttle();
        let way = speed * dt / column.row;
        self.state.columns[index].progress += way;
        while self.state.columns[index].progress >= 1.0 {
            self.state.columns[index].progress -= 1.0;
            self.let_go(index, way, particles, rows);
        }
        let velocity = vector(self.direction * speed);
        for &id in &self.state.columns[index].behind {
            if let Some(row) = row_of(id, particles, rows) {
                particles.velocity[row] = velocity;
            }
        }
    }

    /// Releases the first particle of a column, with its smoke, and adds a new last one, which goes this way with the
    /// others in this substep, in rows.
    fn let_go(&mut self, index: usize, way: f64, particles: &mut Particles, rows: &RowIndex) {
        let first = self.state.columns[index].behind[0];
        if let Some(row) = row_of(first, particles, rows) {
            particles.inverse_mass[row] = self.carrier.inverse_mass;
            if let Some(age) = particles.age.get_mut(row) {
                *age = 0.0;
            }
            if self.columns[index].core {
                let (position, velocity) = (particles.position[row], particles.velocity[row]);
                self.add_smoke(position, velocity, particles);
            }
        }
        let progress = self.state.columns[index].progress;
        let last = self.add_behind(index, ROWS_BEHIND as f64 - progress + way, particles);
        let behind = &mut self.state.columns[index].behind;
        behind.rotate_left(1);
        behind[ROWS_BEHIND - 1] = last;
    }

    /// Adds a particle of a column, `distance` rows behind the face.
    fn add_behind(&mut self, index: usize, distance: f64, particles: &mut Particles) -> u32 {
        let column = &self.columns[index];
        let (offset, row, speed, temperature) = (column.offset, column.row, column.speed, column.temperature);
        let shift = self.random_vector() * self.description.jitter;
        let place =
            self.position + self.direction.perp() * offset - self.direction * (distance * row) + shift * self.spacing;
        particles.push(NewParticle {
            position: place,
            velocity: vector(self.direction * (speed * self.state.throttle())),
            inverse_mass: 0.0,
            material: self.carrier.material,
            phase: self.carrier.phase,
            temperature,
        })
    }

    /// Adds the markers of one core particle around it.
    fn add_smoke(&mut self, position: Vector, velocity: Vector, particles: &mut Particles) {
        let Some((material, count)) = self.smoke.as_ref().map(|smoke| (smoke.material, smoke.per_particle)) else {
            return;
        };
        for _ in 0..count {
            let shift = self.random_vector() * (0.5 * self.spacing);
            particles.push(NewParticle {
                position: wide(position + vector(shift)),
                velocity,
                inverse_mass: 0.0,
                material,
                phase: Phase::Smoke,
                temperature: 0.0,
            });
        }
    }

    fn random_vector(&mut self) -> Vector64 {
        let mut rng = Rng::from_state(self.state.rng);
        let shift = Vector64::new(rng.signed_unit(), rng.signed_unit());
        self.state.rng = rng.state();
        shift
    }

    /// Updates the compression ahead of the face, averaged over the flow distance.
    fn feel(&mut self, dt: f64, particles: &Particles, neighbors: &Neighbors) {
        let (felt, now) = (self.state.compression, self.compression_ahead(particles, neighbors));
        let fastest = self.columns.iter().map(|column| column.speed).fold(0.0, f64::max);
        let way = if now > felt { WAY_TO_CLOSE } else { WAY_TO_OPEN };
        let part = (fastest * dt / (way * self.spacing)).min(1.0);
        self.state.compression = (felt + (now - felt) * part).min(1.0);
    }

    /// Mean of max(C, 0) just ahead of the face.
    fn compression_ahead(&self, particles: &Particles, neighbors: &Neighbors) -> f64 {
        let (mut sum, mut count) = (0.0, 0_u32);
        let reach = 1.5 * self.spacing;
        for column in &self.columns {
            let probe = self.position + self.direction.perp() * column.offset + self.direction * reach;
            let probe = vector(probe);
            neighbors.for_each_near(probe, real(reach), |row| {
                if (particles.position[row] - probe).length() < real(reach) && particles.inverse_mass[row] > 0.0 {
                    sum += f64::from(particles.density_error[row].max(0.0));
                    count += 1;
                }
            });
        }
        if count > 0 { sum / f64::from(count) } else { 0.0 }
    }
}

impl EmitterState {
    /// Fraction of the full speed of the nozzle.
    fn throttle(&self) -> f64 {
        (2.0 - self.compression / THROTTLE_COMPRESSION).clamp(0.0, 1.0)
    }
}

/// The row of a particle that may be missing in the index: one added in this substep.
fn row_of(id: u32, particles: &Particles, rows: &RowIndex) -> Option<usize> {
    match rows.row(id) {
        Some(row) => Some(row as usize),
        None => particles.id.iter().rposition(|&other| other == id),
    }
}
