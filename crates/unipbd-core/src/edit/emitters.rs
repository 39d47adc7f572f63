//! Changes of emitters: whether they can be made, and their application.

use super::EmitterChange;
use super::error::{EditError, unfit};
use super::world::WorldChange;
use crate::math::{Vector, vector};
use crate::rows::RowIndex;
use crate::scene::{Emitter, Scene};
use crate::sources::{EmitterSystem, problem_of};
use crate::step::Solver;

/// Emitters at most.
const MOST_EMITTERS: usize = 10_000;

/// The emitters that there will be after the changes so far; none for those that were taken away.
pub(super) struct Emitters<'a> {
    all: Vec<Option<Emitter>>,
    kit: &'a Scene,
    now: f64,
}

impl<'a> Emitters<'a> {
    pub fn of(solver: &'a Solver) -> Self {
        let readings = solver.emitters().into_iter();
        let all = readings.map(|reading| (!reading.removed).then_some(reading.description)).collect();
        Emitters { all, kit: &solver.world.parts.kit, now: solver.time() }
    }

    pub fn add(&mut self, emitter: &Emitter) -> Result<(), EditError> {
        if self.all.len() >= MOST_EMITTERS {
            return unfit(format!("no more than {MOST_EMITTERS} emitters fit"));
        }
        let taken = |known: &Emitter| !emitter.name.is_empty() && known.name == emitter.name;
        if self.all.iter().flatten().any(taken) {
            return unfit(format!("there is an emitter \"{}\" already", emitter.name));
        }
        self.check("the new emitter cannot be made", emitter)?;
        self.all.push(Some(emitter.clone()));
        Ok(())
    }

    pub fn change(&mut self, number: u32, change: &EmitterChange) -> Result<(), EditError> {
        let changed = change.applied(self.there(number)?, self.now);
        self.check("the emitter cannot be changed", &changed)?;
        self.all[number as usize] = Some(changed);
        Ok(())
    }

    pub fn remove(&mut self, number: u32) -> Result<(), EditError> {
        self.there(number)?;
        self.all[number as usize] = None;
        Ok(())
    }

    fn check(&self, what: &str, emitter: &Emitter) -> Result<(), EditError> {
        match problem_of(emitter, self.kit) {
            Some(problem) => unfit(format!("{what}: {problem}")),
            None => Ok(()),
        }
    }

    fn there(&self, number: u32) -> Result<&Emitter, EditError> {
        match self.all.get(number as usize) {
            Some(Some(emitter)) => Ok(emitter),
            Some(None) => unfit(format!("the emitter {number} was taken away")),
            None => unfit(format!("there is no emitter {number}")),
        }
    }
}

impl Solver {
    /// Makes one change of emitters; returns the places where it is felt.
    pub(super) fn change_emitters(&mut self, change: &WorldChange) -> Vec<Vector> {
        let mut rows = RowIndex::default();
        rows.rebuild(self.ids());
        let (now, parts) = (self.world.clock.time, &mut self.world.parts);
        let system = parts.emitters.get_or_insert_with(EmitterSystem::none);
        match change {
            WorldChange::AddEmitter(emitter) => system.add(emitter, &parts.kit, parts.seed),
            WorldChange::ChangeEmitter { emitter, change } => {
                system.change(*emitter as usize, change, &parts.kit, now);
            }
            WorldChange::RemoveEmitter(emitter) => system.remove(*emitter as usize, &mut parts.particles, &rows),
            _ => {}
        }
        system.readings().iter().map(|reading| vector(reading.description.position.into())).collect()
    }
}
