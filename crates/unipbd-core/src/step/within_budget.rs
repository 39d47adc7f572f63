//! A most wall-clock time per frame: fewer substeps than wanted, then fewer sweeps of contacts.

use std::time::Duration;

use super::Solver;
use super::budget::Budget;
use super::substeps::Choice;
use super::world::World;
use crate::observe::{Event, Severity, SubstepReason};

impl World {
    /// The substeps of a frame, no more than the budget allows, but one at least. Where even that is more, contacts are
    /// swept once.
    pub(super) fn within_budget(&mut self, choice: Choice) -> Choice {
        let allowed = self.budget.allowed();
        if let Some(rigid) = &mut self.parts.rigid {
            rigid.contacts.sweep_once(allowed == Some(0));
        }
        let Some(allowed) = allowed.filter(|allowed| *allowed < choice.substeps) else { return choice };
        let cut = Choice { substeps: allowed.max(1), wanted: choice.wanted, reason: SubstepReason::Budget };
        if !self.budget.told {
            self.budget.told = true;
            let message = format!(
                "substeps cut to {} of {} by the budget of {:.3} ms per frame: results depend on the machine from here on",
                cut.substeps,
                cut.wanted,
                1e3 * self.budget.most.unwrap_or_default().as_secs_f64()
            );
            self.events.push(Event { time: self.clock.time, severity: Severity::Warning, message });
        }
        cut
    }
}

impl Solver {
    /// From now on a frame takes no more than about this time of the clock, for games: by what frames before it took,
    /// fewer substeps are made than wanted, but one at least, and where one takes too long contacts are swept once. Then
    /// `substeps_reason` of the diagnostics is [`SubstepReason::Budget`], and one event tells so. `None`, the default,
    /// takes the budget away.
    ///
    /// Where it cuts, results depend on the machine and on what else it does: two runs differ. Where it does not, they
    /// are the same bits as without. It is no part of a state. A bare WebAssembly module has no clock, and no budget.
    pub fn set_budget(&mut self, most: Option<Duration>) {
        self.world.budget = Budget::new(most);
        if let Some(rigid) = &mut self.world.parts.rigid {
            rigid.contacts.sweep_once(false);
        }
    }

    /// The most time per frame, if there is one.
    pub fn budget(&self) -> Option<Duration> {
        self.world.budget.most
    }
}
