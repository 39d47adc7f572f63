//! Whether an edit can be made as a whole.

use super::{Change, Edit, EditError, Points, Values};
use crate::math::{Vector64, wide};
use crate::observe::Material;
use crate::phase::Phase;
use crate::rigid::{BodyKind, Twist};
use crate::scene::{FARTHEST, PointMotion, crowd};
use crate::step::{ABSURD_SPEED, Solver};

/// The state that an edit is checked against.
pub(super) struct Checker<'a> {
    pub(super) solver: &'a Solver,
    /// All ids in ascending order.
    ids: Vec<u32>,
}

impl<'a> Checker<'a> {
    pub fn new(solver: &'a Solver) -> Self {
        let mut ids = solver.ids().to_vec();
        ids.sort_unstable();
        Checker { solver, ids }
    }

    pub fn check(&self, edit: &Edit) -> Result<(), EditError> {
        for change in &edit.changes {
            self.ids(&change.ids)?;
            self.values(change)?;
        }
        let changed = edit.changes.iter().flat_map(|change| &change.ids);
        self.no_samples(changed.chain(&edit.removals).copied().collect())?;
        self.ids(&edit.removals)?;
        edit.bodies.iter().try_for_each(|(body, velocity)| self.body(*body, velocity))?;
        edit.additions.iter().try_for_each(|points| self.points(points))?;
        self.crowding(edit)?;
        self.world(edit)?;
        let added: usize = edit.additions.iter().map(|points| points.positions.len()).sum();
        let left = (u32::MAX - self.solver.particles().ids_given()) as usize;
        if added >= left { Err(EditError::Unfit(format!("no more than {left} ids are left"))) } else { Ok(()) }
    }

    /// Refuses places with so many particles that no list of their pairs could be held.
    fn crowding(&self, edit: &Edit) -> Result<(), EditError> {
        let moved = edit.changes.iter().filter_map(|change| match &change.values {
            Values::Positions(positions) => Some(&positions[..]),
            _ => None,
        });
        let dense = |points: &&Points| self.material(&points.material).is_ok_and(|known| known.phase.is_dense());
        let added = edit.additions.iter().filter(dense).map(|points| &points.positions[..]);
        let new: Vec<Vector64> = moved.chain(added).flatten().copied().collect();
        if new.is_empty() {
            return Ok(());
        }
        let particles = self.solver.particles();
        let leave = edit.changes.iter().filter(|change| matches!(change.values, Values::Positions(_)));
        let mut gone: Vec<u32> = leave.flat_map(|change| &change.ids).chain(&edit.removals).copied().collect();
        gone.sort_unstable();
        let stays = |row: &usize| gone.binary_search(&particles.ids()[*row]).is_err();
        let there = (0..particles.dense()).filter(stays).map(|row| wide(particles.positions()[row]));
        match crowd(new, there, self.solver.reach()) {
            Some(crowd) => {
                Err(EditError::Unfit(format!("it would bring {crowd}: leave about one spacing between them")))
            }
            None => Ok(()),
        }
    }

    fn ids(&self, ids: &[u32]) -> Result<(), EditError> {
        let mut sorted = ids.to_vec();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(EditError::RepeatedId(pair[0]));
        }
        match ids.iter().find(|id| self.ids.binary_search(id).is_err()) {
            Some(&id) => Err(EditError::UnknownId(id)),
            None => Ok(()),
        }
    }

    fn values(&self, change: &Change) -> Result<(), EditError> {
        let count = change.ids.len();
        match &change.values {
            Values::Positions(positions) => {
                lengths("positions", count, positions.len())?;
                self.positions(positions)
            }
            Values::Velocities(velocities) => {
                lengths("velocities", count, velocities.len())?;
                self.velocities(velocities)
            }
            Values::Temperatures(temperatures) => {
                lengths("temperatures", count, temperatures.len())?;
                if !self.solver.particles().optional().temperature {
                    return Err(EditError::Unfit("the scene has no gas, so no temperatures".to_owned()));
                }
                temperatures.iter().enumerate().try_for_each(|(index, value)| finite("temperature", index, *value))
            }
            Values::Motion(_) => self.motion(&change.ids),
        }
    }

    /// Samples go where their body goes, and stay as long as it does.
    fn no_samples(&self, mut ids: Vec<u32>) -> Result<(), EditError> {
        let particles = self.solver.particles();
        if !particles.phases().contains(&Phase::Rigid) {
            return Ok(());
        }
        ids.sort_unstable();
        let sample =
            |row: &usize| particles.phases()[*row] == Phase::Rigid && ids.binary_search(&particles.ids()[*row]).is_ok();
        match (0..particles.len()).find(sample) {
            Some(row) => {
                let id = particles.ids()[row];
                Err(EditError::Unfit(format!("particle {id} is a sample of a rigid body: change the body instead")))
            }
            None => Ok(()),
        }
    }

    fn body(&self, id: u32, velocity: &Twist) -> Result<(), EditError> {
        let bodies = self.solver.bodies();
        let body = bodies.get(id as usize).ok_or_else(|| EditError::Unfit(format!("there is no body {id}")))?;
        if body.removed {
            return Err(EditError::Unfit(format!("the body \"{}\" was taken away", body.name)));
        }
        if body.kind == BodyKind::Static {
            return Err(EditError::Unfit(format!("the body \"{}\" is static: it never moves", body.name)));
        }
        self.velocities(&[velocity.linear])?;
        finite("angular velocity", 0, velocity.angular)
    }

    /// Smoke follows its carrier, whatever motion is set.
    fn motion(&self, ids: &[u32]) -> Result<(), EditError> {
        let particles = self.solver.particles();
        let smoke = |row: &usize| particles.phases()[*row].is_passive();
        let mut wanted = ids.to_vec();
        wanted.sort_unstable();
        let mut rows = (0..particles.len()).filter(smoke);
        match rows.find(|&row| wanted.binary_search(&particles.ids()[row]).is_ok()) {
            Some(row) => {
                let id = particles.ids()[row];
                Err(EditError::Unfit(format!("particle {id} is smoke: it moves with its carrier")))
            }
            None => Ok(()),
        }
    }

    fn points(&self, points: &Points) -> Result<(), EditError> {
        let material = self.material(&points.material)?;
        self.positions(&points.positions)?;
        if !points.velocities.is_empty() {
            lengths("velocities", points.positions.len(), points.velocities.len())?;
        }
        self.velocities(&points.velocities)?;
        self.velocities(&[points.velocity])?;
        finite("temperature", 0, points.temperature)?;
        if material.phase == Phase::Smoke && points.motion != PointMotion::Free {
            return Err(EditError::Unfit(format!("\"{}\" is smoke: it cannot be kinematic", material.name)));
        }
        if material.phase == Phase::Rigid {
            return Err(EditError::Unfit(format!("the particles of \"{}\" belong to its body", material.name)));
        }
        Ok(())
    }

    fn material(&self, name: &str) -> Result<&'a Material, EditError> {
        let materials = self.solver.materials();
        materials.iter().find(|material| material.name == name).ok_or_else(|| EditError::UnknownMaterial {
            name: name.to_owned(),
            known: materials.iter().map(|material| material.name.clone()).collect(),
        })
    }

    pub(super) fn positions(&self, positions: &[Vector64]) -> Result<(), EditError> {
        let limit = FARTHEST * self.solver.spacing();
        for (index, position) in positions.iter().enumerate() {
            both_finite("position", index, *position)?;
            if position.abs().max_element() > limit {
                let reason = format!("({}, {}) is farther than {limit} m from the origin", position.x, position.y);
                return Err(EditError::Value { what: "position", index, reason });
            }
        }
        Ok(())
    }

    fn velocities(&self, velocities: &[Vector64]) -> Result<(), EditError> {
        let limit = ABSURD_SPEED * self.solver.spacing() / self.solver.frame_time();
        for (index, velocity) in velocities.iter().enumerate() {
            both_finite("velocity", index, *velocity)?;
            if velocity.length() >= limit {
                let reason = format!("({}, {}) is faster than {limit} m/s", velocity.x, velocity.y);
                return Err(EditError::Value { what: "velocity", index, reason });
            }
        }
        Ok(())
    }
}

fn lengths(what: &'static str, particles: usize, values: usize) -> Result<(), EditError> {
    if particles == values { Ok(()) } else { Err(EditError::Lengths { what, particles, values }) }
}

pub(super) fn both_finite(what: &'static str, index: usize, value: Vector64) -> Result<(), EditError> {
    finite(what, index, value.x)?;
    finite(what, index, value.y)
}

pub(super) fn finite(what: &'static str, index: usize, value: f64) -> Result<(), EditError> {
    // A value that overflows the particles' precision is as bad as an infinite one.
    if crate::math::real(value).is_finite() {
        return Ok(());
    }
    Err(EditError::Value { what, index, reason: format!("is {value}, not a finite number") })
}
