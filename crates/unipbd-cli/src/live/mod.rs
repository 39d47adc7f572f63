//! A run that viewers watch while it goes on: a server of the Foxglove WebSocket protocol, for Lichtblick and Foxglove.
//!
//! It sends the topics of the log ([`crate::record`]) with their schemas, each only while somebody subscribes to it. What
//! stays the same, walls, shapes and ids, is said again to every new subscriber. Viewers pause the run, move it by single
//! frames, change its speed and its parameters. No frame waits for a viewer: one that is too slow misses frames.

mod controls;
mod options;
mod pace;
mod parameters;
mod requests;
mod server;
mod stream;

use std::time::{Duration, Instant};

use foxglove::websocket::{Parameter, PlaybackState};
use unipbd_core::observe::{Diagnostics, Event, Severity};

use crate::record::{Fields, Header};
use crate::simulation::Simulation;

use controls::{Controls, Shared, Steps};
use pace::Pace;
use requests::Request;
use server::Server;
use stream::Stream;

pub use options::{DEFAULT_ADDRESS, InvalidAddress, LiveOptions, speed};

/// Longest wait before the caller can look for a signal.
const PATIENCE: Duration = Duration::from_millis(50);

/// The server of a run, and what viewers have asked of it.
pub struct Live {
    server: Server,
    shared: Shared,
    stream: Stream,
    pace: Pace,
    events: Vec<Event>,
}

impl Live {
    /// Starts to listen. Errors name the address: it is in use, or not one of this machine.
    pub fn start(
        options: &LiveOptions,
        header: &Header,
        fields: Fields,
        simulation: &Simulation,
    ) -> Result<Live, String> {
        let shared = Shared::new(Controls::new(options, simulation));
        let server = Server::start(options, header, fields, simulation, &shared)?;
        let stream = Stream::new(header, fields);
        Ok(Live { server, shared, stream, pace: Pace::new(), events: Vec::new() })
    }

    /// Where viewers connect: `ws://ADDRESS:PORT`.
    pub fn url(&self) -> String {
        self.server.url()
    }

    /// Viewers that are connected.
    pub fn viewers(&self) -> usize {
        self.server.viewers()
    }

    /// Does what viewers have asked for, and says whether the next frame is due. Waits for that, but no longer than
    /// 50 ms, so that the caller can look for signals and ask again.
    pub fn is_due(&mut self, simulation: &mut Simulation) -> bool {
        self.serve(simulation);
        let controls = self.shared.lock();
        if controls.paused && controls.steps.is_empty() {
            self.pace.rest();
            self.shared.wait(controls, PATIENCE);
            return false;
        }
        if !controls.steps.is_empty() {
            return true;
        }
        let now = Instant::now();
        match self.pace.due(simulation.solver.time(), controls.speed, now) {
            Some(due) if due > now => {
                self.shared.wait(controls, (due - now).min(PATIENCE));
                false
            }
            _ => true,
        }
    }

    /// Whether somebody wants the diagnostics of this frame: they cost time.
    pub fn wants_diagnostics(&self) -> bool {
        self.server.wants_diagnostics()
    }

    /// Changes by viewers since the last call, as events of the run.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Sends the state at the start or after a frame, if anybody watches.
    pub fn frame(&mut self, simulation: &Simulation, diagnostics: Option<&Diagnostics>, events: &[Event]) {
        let single = simulation.solver.frame() == 0 || !self.shared.lock().steps.is_empty();
        self.stream.add_events(events);
        self.stream.frame(&self.server, simulation, diagnostics, single);
        self.count_steps(simulation);
    }

    /// Tells viewers that the run is over. The last frame stays, for those who come later too, while `serve`
    /// is called.
    pub fn end(&mut self, simulation: &Simulation) {
        let mut controls = self.shared.lock();
        controls.ended = true;
        let waiting: Vec<Steps> = controls.steps.drain(..).collect();
        let state = controls.playback();
        drop(controls);
        waiting.into_iter().for_each(Steps::refuse);
        self.stream.frame(&self.server, simulation, None, true);
        self.server.tell(state);
    }

    /// Keeps the last frame for viewers, for 50 ms at most.
    pub fn hold(&mut self, simulation: &mut Simulation) {
        self.serve(simulation);
        self.shared.wait(self.shared.lock(), PATIENCE);
    }

    /// Answers what viewers have asked for since the last call.
    fn serve(&mut self, simulation: &mut Simulation) {
        let (requests, newcomers) = self.shared.lock().take_requests();
        for request in requests {
            self.answer(request, simulation);
        }
        if !newcomers.is_empty() {
            self.stream.welcome(&self.server, simulation, newcomers);
        }
    }

    fn answer(&mut self, request: Request, simulation: &mut Simulation) {
        match request {
            Request::Set { values, client, responder } => {
                let changes = parameters::set(&values, simulation, &self.shared);
                changes.refused.iter().for_each(|reason| client.send_warning(reason));
                let time = simulation.solver.time();
                let event = |message: String| Event { time, severity: Severity::Info, message };
                self.events.extend(changes.made.into_iter().map(event));
                let (all, state) = self.present(simulation);
                responder
                    .respond(all.iter().filter(|one| values.iter().any(|it| it.name == one.name)).cloned().collect());
                self.server.tell_parameters(all);
                self.server.tell(state);
            }
            Request::Get { names, responder } => {
                let wanted = |name: &str| names.is_empty() || names.iter().any(|it| it == name);
                let (all, _) = self.present(simulation);
                responder.respond(all.into_iter().filter(|one| wanted(&one.name)).collect());
            }
            Request::Controlled => {
                let (all, _) = self.present(simulation);
                self.server.tell_parameters(all);
            }
        }
    }

    /// The parameters and the state of the controls as they are now.
    fn present(&self, simulation: &Simulation) -> (Vec<Parameter>, PlaybackState) {
        let controls = self.shared.lock();
        (parameters::list(simulation, &controls, self.server.scene()), controls.playback())
    }

    /// Counts the frames that were asked for one by one.
    fn count_steps(&mut self, simulation: &Simulation) {
        let solver = &simulation.solver;
        let mut controls = self.shared.lock();
        controls.see(solver.time());
        let Some(steps) = controls.steps.front_mut().filter(|_| solver.frame() > 0) else { return };
        steps.left = steps.left.saturating_sub(1);
        if steps.left == 0 {
            let done = controls.steps.pop_front();
            drop(controls);
            done.into_iter().for_each(|steps| steps.finish(solver.frame(), solver.time()));
        }
    }
}
