//! Diagnostics: sums and extremes over the state, computed when asked for.

use super::Solver;
use super::world::World;
use crate::constraints::DensityGroup;
use crate::math::{Real, Vector64, wide};
use crate::observe::{Diagnostics, Entry, GroupDiagnostics, Material, MaterialDiagnostics, WallForce};
use crate::phase::Phase;
use crate::rigid::BodyKind;

/// Sums over a stretch of rows, combined in a fixed order.
#[derive(Clone, Copy, Default)]
struct Sums {
    kinetic: f64,
    potential: f64,
    momentum: Vector64,
    angular: f64,
    speed_squared: f64,
}

impl Sums {
    fn join(self, other: Sums) -> Sums {
        Sums {
            kinetic: self.kinetic + other.kinetic,
            potential: self.potential + other.potential,
            momentum: self.momentum + other.momentum,
            angular: self.angular + other.angular,
            speed_squared: self.speed_squared.max(other.speed_squared),
        }
    }
}

impl Solver {
    /// The state in numbers.
    pub fn diagnostics(&self) -> Diagnostics {
        self.look_on_threads(World::diagnostics)
    }
}

impl World {
    fn diagnostics(&self) -> Diagnostics {
        let (clock, sums) = (&self.clock, self.sums().join(self.body_sums()));
        let materials = self.material_diagnostics();
        let fluids = || materials.iter().zip(&self.parts.materials).filter(|(_, material)| material.phase.is_fluid());
        let fluid_count: u64 = fluids().map(|(diagnostics, _)| diagnostics.count).sum();
        let fluid_mean = |of: fn(&MaterialDiagnostics) -> f64| {
            let weighted: f64 = fluids().map(|(d, _)| of(d) * d.count as f64).sum();
            if fluid_count > 0 { weighted / fluid_count as f64 } else { 0.0 }
        };
        let mut counts = [0; Phase::ALL.len()];
        for (diagnostics, material) in materials.iter().zip(&self.parts.materials) {
            counts[material.phase as usize] += diagnostics.count;
        }
        let groups = self.parts.groups.iter().filter_map(|group| {
            Some(GroupDiagnostics { name: group.name().to_owned(), violation: group.violation()? })
        });
        Diagnostics {
            time: clock.time,
            frame: clock.frame,
            step: clock.step,
            substeps: clock.substeps,
            substeps_wanted: self.choice.wanted,
            substeps_reason: self.choice.reason,
            iterations: self.iterated,
            list_builds: clock.list_builds,
            counts,
            density_error_mean: fluid_mean(|d| d.density_error_mean),
            density_error_mean_abs: fluid_mean(|d| d.density_error_mean_abs),
            density_error_max: fluids().map(|(d, _)| d.density_error_max).fold(0.0, f64::max),
            density_error_min: fluids().map(|(d, _)| d.density_error_min).fold(0.0, f64::min),
            pressure_max: self.pressure_max(),
            kinetic_energy: sums.kinetic,
            potential_energy: sums.potential,
            momentum: sums.momentum,
            angular_momentum: sums.angular,
            speed_max: sums.speed_squared.sqrt(),
            contact_penetration: self.contact_penetration(),
            groups: groups.collect(),
            walls: self.wall_forces(),
            gauges: self.gauges(),
            materials,
        }
    }

    pub(super) fn wall_forces(&self) -> Vec<WallForce> {
        let names = self.parts.walls.measured().iter();
        let of_bodies =
            |name: &str| self.parts.rigid.as_ref().map_or(Vector64::ZERO, |rigid| rigid.contacts.wall_force(name));
        let both = |(name, &fluid_force): (&String, &Vector64)| {
            let contact_force = of_bodies(name);
            WallForce { name: name.clone(), force: fluid_force + contact_force, fluid_force, contact_force }
        };
        names.zip(&self.wall_forces).map(both).collect()
    }

    /// The group that holds the density, if the scene has fluids.
    fn density_group(&self) -> Option<&dyn DensityGroup> {
        self.parts.groups.iter().find_map(|group| group.as_density())
    }

    /// Density errors at the present positions by row; measured on first access.
    pub(super) fn density_errors(&self) -> &[Real] {
        let searches = self.plan.has_neighbors();
        if searches && !self.parts.neighbors.is_current() {
            // After an error within a frame there may be no list: the list of the last substep is used.
            return &self.parts.particles.density_error;
        }
        self.measured.density.get_or_init(|| {
            let now = World::now(&self.parts, &self.rows, &self.clock);
            let measured = self.density_group().map(|group| group.measure_density(now));
            measured.unwrap_or_else(|| vec![0.0; self.parts.particles.len()])
        })
    }

    fn body_sums(&self) -> Sums {
        let gravity = wide(self.parts.gravity);
        let bodies = self.parts.rigid.as_ref().map_or(&[][..], |rigid| rigid.views());
        // Bodies made of particles are already counted with their particles.
        let posed = |id: usize| self.parts.rigid.as_ref().is_none_or(|rigid| rigid.bodies.elasticity(id).is_none());
        let moving = bodies.iter().enumerate().filter(|(id, body)| body.kind == BodyKind::Dynamic && posed(*id));
        moving.fold(Sums::default(), |sums, (_, body)| {
            let (x, v, spin) = (body.position, body.velocity, body.angular_velocity);
            // A body without rotation may have an infinite moment of inertia.
            let turning = if spin == 0.0 { 0.0 } else { body.inertia * spin };
            sums.join(Sums {
                kinetic: 0.5 * (body.mass * v.length_squared() + turning * spin),
                potential: -body.mass * gravity.dot(x),
                momentum: v * body.mass,
                angular: body.mass * x.perp_dot(v) + turning,
                speed_squared: 0.0,
            })
        })
    }

    fn contact_penetration(&self) -> f64 {
        let Some(rigid) = &self.parts.rigid else { return 0.0 };
        rigid.contacts.points().map(|point| -point.gap).fold(0.0, f64::max)
    }

    fn sums(&self) -> Sums {
        let (particles, forces) = (&self.parts.particles, &self.parts.forces);
        let leaf = |rows: std::ops::Range<usize>| {
            rows.fold(Sums::default(), |sums, row| {
                let inverse_mass = f64::from(particles.inverse_mass[row]);
                if inverse_mass == 0.0 {
                    return sums;
                }
                let (x, v, mass) = (wide(particles.position[row]), wide(particles.velocity[row]), 1.0 / inverse_mass);
                // A temperature-dependent force has no potential.
                let force = &forces[usize::from(particles.material[row])];
                let acceleration = if force.thermal { Vector64::ZERO } else { wide(force.acceleration) };
                sums.join(Sums {
                    kinetic: 0.5 * mass * v.length_squared(),
                    potential: -mass * acceleration.dot(x),
                    momentum: v * mass,
                    angular: mass * x.perp_dot(v),
                    speed_squared: v.length_squared(),
                })
            })
        };
        self.parts.parallelism.reduce(particles.len(), leaf, Sums::join)
    }

    fn material_diagnostics(&self) -> Vec<MaterialDiagnostics> {
        let (particles, errors) = (&self.parts.particles, self.density_errors());
        let named = |material: &Material| MaterialDiagnostics::named(&material.name);
        let mut all: Vec<_> = self.parts.materials.iter().map(named).collect();
        for row in 0..particles.len() {
            let error = f64::from(errors[row]);
            let of = &mut all[usize::from(particles.material[row])];
            of.count += 1;
            if particles.inverse_mass[row] > 0.0 {
                of.density_error_mean += error.max(0.0);
                of.density_error_mean_abs += error.abs();
                of.density_error_max = of.density_error_max.max(error);
                of.density_error_min = of.density_error_min.min(error);
            }
        }
        for of in &mut all {
            of.density_error_mean /= of.count.max(1) as f64;
            of.density_error_mean_abs /= of.count.max(1) as f64;
        }
        all
    }

    /// Pressure over density by row; measured on first access.
    pub(super) fn pressures(&self) -> &[Real] {
        self.measured.pressure.get_or_init(|| {
            if self.clock.dt == 0.0 {
                return vec![0.0; self.parts.particles.len()];
            }
            let now = World::now(&self.parts, &self.rows, &self.clock);
            let group = self.density_group().filter(|_| self.can_read_momentum());
            let measured = group.and_then(|group| group.measure_pressure(now));
            let mut pressures = measured.unwrap_or_else(|| self.pressures_of_multipliers());
            if self.can_read_momentum() {
                self.parts.groups.iter().for_each(|group| group.add_pressures(now, &mut pressures));
            }
            pressures
        })
    }

    /// Whether pressures can be read from the momentum that pairs carry: with neighbours to look at, and where the
    /// multipliers carry all of it, no grid a part.
    fn can_read_momentum(&self) -> bool {
        let listed = self.plan.has_neighbors() && self.parts.neighbors.is_current();
        listed && self.parts.pressure_grid.is_none()
    }

    /// lambda/(m dt^2), as on the lattice at rest: the fallback for groups without a better estimate.
    fn pressures_of_multipliers(&self) -> Vec<Real> {
        let scale = (self.parts.pressure_scale / (self.clock.dt * self.clock.dt)) as Real;
        let particles = &self.parts.particles;
        (0..particles.len()).map(|row| particles.multiplier[row] * particles.inverse_mass[row] * scale).collect()
    }

    /// The largest pressure over density: cheap enough for every frame.
    fn pressure_max(&self) -> f64 {
        if self.clock.dt == 0.0 {
            return 0.0;
        }
        if self.can_read_momentum() {
            let now = World::now(&self.parts, &self.rows, &self.clock);
            let measured = self.density_group().and_then(|group| group.measure_pressure_max(now));
            if let Some(largest) = measured {
                return f64::from(largest);
            }
        }
        let particles = &self.parts.particles;
        let pressure = |row: usize| particles.multiplier[row] * particles.inverse_mass[row];
        let largest = self.parts.parallelism.max(particles.dense(), pressure);
        let scale = (self.parts.pressure_scale / (self.clock.dt * self.clock.dt)) as Real;
        f64::from(largest.max(0.0) * scale)
    }
}
