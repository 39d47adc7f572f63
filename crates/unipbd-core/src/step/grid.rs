//! The pressure grid in a substep.

use super::integrate;
use super::world::World;
use crate::coupling::RigidBodies;
use crate::math::Real;
use crate::pressure_grid::{Immersed, PressureBound};

impl World {
    pub(super) fn project_on_grid(&mut self) {
        let parts = &mut self.parts;
        let Some(grid) = parts.pressure_grid.as_mut().filter(|_| parts.particles.awake() > 0) else { return };
        if let Some(rigid) = &parts.rigid {
            let filled = grid.filled_mut();
            filled.clear();
            rigid.each_filled(|x| filled.push(x));
        }
        integrate::let_sleepers_fall(&mut parts.particles, &parts.forces, self.clock.dt as Real);
        if !self.project_on_grid_within(self.grid_pressure_bound()) {
            // Fluid shut in between bodies that hold each other bears anything: it parts them instead.
            self.parts.rigid.iter_mut().for_each(RigidBodies::find_mobilities_of_joints);
            self.project_on_grid_within(PressureBound::NONE);
        }
        let parts = &mut self.parts;
        integrate::stop_sleepers(&mut parts.particles);
        if let (Some(grid), Some(rigid)) = (&parts.pressure_grid, &mut parts.rigid) {
            grid.push_outlines(&parts.outlines, &mut rigid.bodies, self.clock.dt);
        }
    }

    /// Takes the pressure of the grid to fluids and bodies, if it is within this bound.
    fn project_on_grid_within(&mut self, bound: PressureBound) -> bool {
        let parts = &mut self.parts;
        let Some(grid) = &mut parts.pressure_grid else { return true };
        let mut immersed = parts.rigid.as_mut().map(RigidBodies::immersed);
        let bodies = immersed.as_mut().map(|(bodies, mobilities, counts)| Immersed { bodies, counts, mobilities });
        let around = (&parts.walls, &parts.outlines, bodies);
        grid.project(&mut parts.particles, around, (self.clock.dt, bound), parts.parallelism)
    }

    pub(super) fn add_grid_wall_forces(&mut self) {
        let parts = &self.parts;
        let Some(grid) = parts.pressure_grid.as_ref().filter(|_| parts.particles.awake() > 0) else { return };
        grid.push_walls(&parts.walls, &mut self.wall_impulses);
    }

    pub(super) fn add_grid_pressure(&mut self) {
        let parts = &mut self.parts;
        let last = self.clock.done + 1 == self.clock.substeps;
        if let Some(grid) = parts.pressure_grid.as_ref().filter(|_| last) {
            let per_pressure = self.clock.dt * self.clock.dt / parts.pressure_scale;
            grid.add_pressure(&mut parts.particles, self.clock.dt as Real, per_pressure as Real, parts.parallelism);
        }
    }
}
