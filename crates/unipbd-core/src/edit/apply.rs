//! Application of an edit that passed its checks.

use std::ops::Range;

use super::check::Checker;
use super::world::WorldChange;
use super::{Change, Edit, EditError, Points, Values};
use crate::math::{Vector, real, vector, wide};
use crate::particles::NewParticle;
use crate::phase::MaterialIndex;
use crate::rows::RowIndex;
use crate::scene::PointMotion;
use crate::step::{Population, Solver};

impl Solver {
    /// Makes all changes of an edit, or none. Returns the ids of the particles added.
    ///
    /// New particles may lie anywhere; two in the same place press each other away hard.
    ///
    /// # Errors
    /// [`EditError`] names the fault; nothing has changed then.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # use unipbd_core::{Edit, Vector64};
    /// # let scene = Scene {
    /// #     spacing: 0.1,
    /// #     half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])],
    /// #     body: vec![BodyDescription::rectangle([1.0, 1.0], [0.0, 1.0])],
    /// #     ..Scene::default()
    /// # };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// let disc = BodyDescription::disc(0.2, [0.0, 3.0]);
    /// let edit = Edit::new().add_body(disc).push_body(0, Vector64::new(50.0, 0.0), Vector64::new(0.0, 1.0));
    /// solver.apply(&edit)?;
    /// assert_eq!(solver.bodies().len(), 2);
    /// let faulty = Edit::new().remove_body(1).remove_body(7); // there is no body 7
    /// assert!(solver.apply(&faulty).is_err() && !solver.bodies()[1].removed);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn apply(&mut self, edit: &Edit) -> Result<Range<u32>, EditError> {
        Checker::new(self).check(edit)?;
        let first = self.particles().ids_given();
        if edit.is_empty() {
            return Ok(first..first);
        }
        let mut rows = RowIndex::default();
        rows.rebuild(self.ids());
        let mut felt = self.world.places(&edit.touched().filter_map(|id| rows.row(id)).collect::<Vec<_>>());
        edit.changes.iter().for_each(|change| self.change(change, &rows));
        felt.extend(self.world.places(&edit.touched().filter_map(|id| rows.row(id)).collect::<Vec<_>>()));
        self.drive(edit, &rows);
        let mut removed: Vec<u32> = edit.removals.iter().filter_map(|&id| rows.row(id)).collect();
        removed.sort_unstable();
        self.world.parts.particles.remove_rows(&removed);
        edit.additions.iter().for_each(|points| self.pour(points));
        felt.extend(edit.additions.iter().flat_map(|points| &points.positions).map(|&point| vector(point)));
        let last = self.particles().ids_given();
        let rows_before = self.particles().len();
        let done = self.change_world(&edit.world);
        felt.extend(done.places);
        let same = removed.is_empty() && first == self.particles().ids_given() && rows_before == self.particles().len();
        let gravity = edit.world.iter().any(|change| matches!(change, WorldChange::Gravity(_)));
        let population = if same { Population::Same } else { Population::Changed };
        self.on_threads(|world| {
            world.edited(population);
            if gravity {
                world.wake_all();
            }
            world.wake_near(&felt);
        });
        Ok(first..last)
    }

    /// Gives bodies their velocities, and their samples too: the next frame goes by the fastest particle.
    fn drive(&mut self, edit: &Edit, rows: &RowIndex) {
        let parts = &mut self.world.parts;
        if let Some(rigid) = parts.rigid.as_mut().filter(|_| !edit.bodies.is_empty()) {
            edit.bodies.iter().for_each(|&(body, velocity)| rigid.bodies.set_velocity(body, velocity));
            rigid.settle_samples(&mut parts.particles, rows);
            rigid.set_sample_velocities(&edit.bodies, &mut parts.particles, rows);
        }
    }

    fn change(&mut self, change: &Change, rows: &RowIndex) {
        let rows = change.ids.iter().filter_map(|&id| rows.row(id)).map(|row| row as usize);
        let periodic = self.world.parts.neighbors.periodic();
        let particles = &mut self.world.parts.particles;
        match &change.values {
            Values::Positions(positions) => {
                for (row, &position) in rows.zip(positions) {
                    particles.position[row] = periodic.wrap(vector(position));
                    particles.remainder[row] = Vector::ZERO;
                }
            }
            Values::Velocities(velocities) => {
                for (row, &velocity) in rows.zip(velocities) {
                    particles.velocity[row] = vector(velocity);
                    if particles.phase[row].is_passive() {
                        particles.displacement[row] = vector(velocity);
                    }
                }
            }
            Values::Temperatures(temperatures) => {
                for (row, &temperature) in rows.zip(temperatures) {
                    particles.temperature[row] = real(temperature);
                }
            }
            Values::Motion(motion) => {
                let area = self.world.parts.spacing * self.world.parts.spacing;
                for row in rows {
                    let density = self.world.parts.materials[usize::from(particles.material[row])].density;
                    particles.inverse_mass[row] = motion.inverse_mass(density * area);
                    if *motion == PointMotion::Kinematic {
                        particles.note_kinematic();
                    }
                }
            }
        }
    }

    fn pour(&mut self, points: &Points) {
        let parts = &mut self.world.parts;
        let materials = parts.materials.iter().enumerate();
        let Some((index, material)) = materials.into_iter().find(|(_, material)| material.name == points.material)
        else {
            return;
        };
        let mass = material.density * parts.spacing * parts.spacing;
        let periodic = parts.neighbors.periodic();
        for (number, &position) in points.positions.iter().enumerate() {
            let velocity = points.velocities.get(number).copied().unwrap_or(points.velocity);
            parts.particles.push(NewParticle {
                position: wide(periodic.wrap(vector(position))),
                velocity: vector(velocity),
                inverse_mass: points.motion.inverse_mass(mass),
                material: index as MaterialIndex,
                phase: material.phase,
                temperature: real(points.temperature),
            });
        }
    }
}
