//! Read access to the state of a solver.

use std::time::Duration;

use super::Solver;
use super::world::World;
use crate::bytes::held;
use crate::math::Real;
use crate::observe::{Event, GaugeReading, WallForce, WallOutline};
use crate::phase::{MaterialIndex, Phase};
use crate::pressure_grid::PressureGrid;
use crate::sources::EmitterReading;

/// Read access common to a solver and the view of its substep.
macro_rules! shared_access {
    ($viewer:ty) => {
        impl $viewer {
            /// Simulated time; in a substep, that of its start \[s].
            pub fn time(&self) -> f64 {
                self.world.clock.time
            }

            /// Substeps done.
            pub fn step(&self) -> u64 {
                self.world.clock.step
            }

            /// The particles. Rows are re-sorted by steps; ids are stable.
            pub fn particles(&self) -> &crate::particles::Particles {
                &self.world.parts.particles
            }

            /// Positions by row \[m].
            pub fn positions(&self) -> &[crate::math::Vector] {
                self.particles().positions()
            }

            /// Velocities by row [m/s].
            pub fn velocities(&self) -> &[crate::math::Vector] {
                self.particles().velocities()
            }

            /// Stable ids by row.
            pub fn ids(&self) -> &[u32] {
                self.particles().ids()
            }

            /// The materials, by [`MaterialIndex`](crate::MaterialIndex).
            pub fn materials(&self) -> &[crate::observe::Material] {
                &self.world.parts.materials
            }

            /// Rigid bodies; in a substep, their state at the start of the frame:
            /// [`SubstepView::body_pose`](crate::SubstepView::body_pose) gives the current pose.
            pub fn bodies(&self) -> &[crate::rigid::Body] {
                self.world.parts.rigid.as_ref().map_or(&[], |rigid| rigid.views())
            }
        }
    };
}
pub(super) use shared_access;

shared_access!(Solver);

impl Solver {
    /// The emitters, in the order in which they came; those that were taken away too.
    pub fn emitters(&self) -> Vec<EmitterReading> {
        self.world.parts.emitters.as_ref().map_or_else(Vec::new, |emitters| emitters.readings())
    }

    /// Frames done.
    pub fn frame(&self) -> u64 {
        self.world.clock.frame
    }

    /// Length of a frame \[s].
    pub fn frame_time(&self) -> f64 {
        self.world.parts.frame_time
    }

    /// Gravity [m/s^2], without what `shaking` adds to it.
    pub fn gravity(&self) -> crate::math::Vector64 {
        self.world.parts.exact_gravity
    }

    /// Rest distance of particles \[m].
    pub fn spacing(&self) -> f64 {
        self.world.parts.spacing
    }

    /// Seed of the random choices.
    pub fn seed(&self) -> u64 {
        self.world.parts.seed
    }

    /// Phases by row.
    pub fn phases(&self) -> &[Phase] {
        self.particles().phases()
    }

    /// Materials by row.
    pub fn material_indices(&self) -> &[MaterialIndex] {
        self.particles().materials()
    }

    /// Density errors C = rho/rho0 - 1 at these positions by row; 0 without a density constraint.
    /// Measured on first access after a frame.
    pub fn density_errors(&self) -> &[Real] {
        self.look_on_threads(|world| {
            world.density_errors();
        });
        self.world.density_errors()
    }

    /// Constraint iterations of the last frame, all substeps together.
    pub fn iterations(&self) -> u32 {
        self.world.iterated
    }

    /// Pressure over density by row [m^2/s^2], from the momentum that the multipliers of the last substep
    /// carry. Measured on first access after a frame.
    pub fn pressures(&self) -> &[Real] {
        self.look_on_threads(|world| {
            world.pressures();
        });
        self.world.pressures()
    }

    /// Temperatures by row; empty when no material has one.
    pub fn temperatures(&self) -> &[Real] {
        self.particles().temperatures()
    }

    /// Advances each time particles are added or removed.
    pub fn id_generation(&self) -> u64 {
        self.world.clock.generation
    }

    /// Walls as lines to draw.
    pub fn wall_outlines(&self) -> &[WallOutline] {
        self.world.parts.walls.outlines()
    }

    /// Static walls.
    pub fn walls(&self) -> &crate::walls::Walls {
        &self.world.parts.walls
    }

    /// Mean forces in the last frame on the walls that have a name, of fluids and bodies together and apart; those on
    /// bodies are [`Body::fluid_force`](crate::rigid::Body::fluid_force) and
    /// [`contact_force`](crate::rigid::Body::contact_force). Those of fluids are zero before the first frame and after a
    /// restore.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # let water = vec![Liquid::new("water", 1000.0)];
    /// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
    /// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
    /// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// while solver.time() < 1.0 {
    ///     solver.step_frame()?;
    /// }
    /// let floor = &solver.wall_forces().into_iter().find(|wall| wall.name == "pool bottom").expect("its name");
    /// let weight = 1000.0 * 0.4 * 9.81; // 0.4 m^2 of water
    /// assert!((-floor.force.y / weight - 1.0).abs() < 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn wall_forces(&self) -> Vec<WallForce> {
        self.world.wall_forces()
    }

    /// Readings of the gauges of the scene now, as [`diagnostics`](Solver::diagnostics) has them; not a number where a
    /// gauge has nothing to read, as pressures and forces before the first frame.
    pub fn gauges(&self) -> Vec<GaugeReading> {
        self.look_on_threads(World::gauges)
    }

    /// Joints by index, with their loads; those that are broken or taken away keep their place.
    pub fn joints(&self) -> Vec<crate::rigid::JointState> {
        self.world.parts.rigid.as_ref().map_or_else(Vec::new, |rigid| rigid.contacts.joints().collect())
    }

    /// Takes the events since the last call.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.world.events)
    }

    /// Wall-clock time per stage since the start.
    pub fn timings(&self) -> &[(&'static str, Duration)] {
        self.world.timings.spent()
    }

    /// Memory held by particles, lists, indexes, constraint groups and effects \[bytes].
    pub fn memory_bytes(&self) -> usize {
        self.world.memory_bytes()
    }
}

impl World {
    pub fn memory_bytes(&self) -> usize {
        let parts = &self.parts;
        let shared = parts.particles.memory_bytes() + parts.neighbors.memory_bytes() + self.rows.memory_bytes();
        let groups = parts.groups.iter().map(|group| group.memory_bytes()).sum::<usize>();
        let effects = parts.effects.iter().map(|effect| effect.memory_bytes()).sum::<usize>();
        let grid = parts.pressure_grid.as_ref().map_or(0, PressureGrid::memory_bytes);
        let outlines = parts.outlines.memory_bytes() + parts.without_slip.memory_bytes();
        let room =
            grid + outlines + self.corrections.memory_bytes() + self.changes.memory_bytes() + held(&self.velocities);
        shared + groups + effects + room
    }
}
