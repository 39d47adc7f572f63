//! A most wall-clock time per frame: fewer substeps than wanted, then fewer sweeps of contacts.

use std::time::Duration;

use super::Solver;
use super::substeps::Choice;
use super::timings::Stopwatch;
use super::world::World;
use crate::observe::{Event, Severity, SubstepReason};

/// Frames whose costs are remembered: one that the system held up counts little.
const REMEMBERED: usize = 5;

/// The budget of a frame, and what frames have cost. Not part of a state.
#[derive(Default)]
pub(super) struct Budget {
    most: Option<Duration>,
    /// Since the running frame began, and since its substeps did.
    running: Option<(Stopwatch, Stopwatch)>,
    /// Time of a substep, and of the rest of the frame, in the last frames [s].
    costs: Vec<[f64; 2]>,
    told: bool,
}

impl Budget {
    /// The second largest of the remembered costs: of a substep, and of the rest of a frame [s].
    fn expected(&self) -> Option<[f64; 2]> {
        let of = |part: usize| {
            let mut costs: Vec<f64> = self.costs.iter().map(|cost| cost[part]).collect();
            costs.sort_by(|a, b| b.total_cmp(a));
            costs.get(1).or(costs.first()).copied()
        };
        Some([of(0)?, of(1)?])
    }

    /// Substeps that the budget allows, possibly none; `None` without a budget, or where nothing is known yet.
    fn allowed(&self) -> Option<u32> {
        let most = self.most?.as_secs_f64();
        let [substep, rest] = self.expected()?;
        // As a cast saturates, a substep that costs nothing is allowed any number of times.
        Some(((most - rest).max(0.0) / substep) as u32)
    }

    /// A frame begins.
    pub fn begin_frame(&mut self) {
        self.running = self.most.is_some().then(|| (Stopwatch::start(), Stopwatch::start()));
    }

    /// Its substeps begin.
    pub fn begin_substeps(&mut self) {
        if let Some((_, substeps)) = &mut self.running {
            *substeps = Stopwatch::start();
        }
    }

    /// It ends after so many substeps.
    pub fn end_frame(&mut self, substeps: u32) {
        let Some((whole, running)) = self.running.take().filter(|_| substeps > 0) else { return };
        let (whole, stepping) = (whole.elapsed().as_secs_f64(), running.elapsed().as_secs_f64());
        if self.costs.len() == REMEMBERED {
            self.costs.remove(0);
        }
        self.costs.push([stepping / f64::from(substeps), (whole - stepping).max(0.0)]);
    }
}

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
        self.world.budget = Budget { most, ..Budget::default() };
        if let Some(rigid) = &mut self.world.parts.rigid {
            rigid.contacts.sweep_once(false);
        }
    }

    /// The most time per frame, if there is one.
    pub fn budget(&self) -> Option<Duration> {
        self.world.budget.most
    }
}
