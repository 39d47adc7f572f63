use std::time::{Duration, Instant};

use unipbd_core::observe::{Diagnostics, Event};

use super::server::Server;
use crate::record::{EncodedFrame, Encoder, Fields, FrameState, Header, Topic, Topics};
use crate::simulation::Simulation;

/// Shortest time between two frames of a run that goes on: no viewer shows more.
const SHORTEST: Duration = Duration::from_millis(8);
/// Events kept for the next frame that is sent; the oldest go first.
const MOST_EVENTS: usize = 1000;

/// Turns frames into messages, for the topics that somebody subscribes to.
pub struct Stream {
    encoder: Encoder,
    fields: Fields,
    frame: EncodedFrame,
    /// Events since the last frame that was sent.
    events: Vec<Event>,
    sent: Option<Instant>,
}

impl Stream {
    pub fn new(header: &Header, fields: Fields) -> Self {
        let encoder = Encoder::new(header, fields);
        Stream { encoder, fields, frame: EncodedFrame::default(), events: Vec::new(), sent: None }
    }

    /// Keeps events for the next frame.
    pub fn add_events(&mut self, events: &[Event]) {
        self.events.extend_from_slice(events);
        let surplus = self.events.len().saturating_sub(MOST_EVENTS);
        self.events.drain(..surplus);
    }

    /// Sends a frame to those who subscribe, unless the last one was sent a moment ago; `whole` runs leave none out.
    pub fn frame(&mut self, server: &Server, simulation: &Simulation, known: Option<&Diagnostics>, whole: bool) {
        let wanted = server.wanted();
        if wanted.is_empty() {
            // Nobody will ask for what is over.
            self.events.clear();
            return;
        }
        if !whole && self.sent.is_some_and(|sent| sent.elapsed() < SHORTEST) {
            return;
        }
        self.sent = Some(Instant::now());
        if self.fields.any() {
            // A viewer that has missed frames has missed the ids too.
            self.encoder.say_again([Topic::Columns].into_iter().collect());
        }
        self.send(server, simulation, known, wanted);
        self.events.clear();
    }

    /// Sends the present state of these topics whole, for new subscribers.
    pub fn welcome(&mut self, server: &Server, simulation: &Simulation, topics: Topics) {
        self.encoder.say_again(topics);
        let events = std::mem::take(&mut self.events);
        self.send(server, simulation, None, topics);
        self.events = events;
    }

    fn send(&mut self, server: &Server, simulation: &Simulation, known: Option<&Diagnostics>, topics: Topics) {
        let measured = topics.contains(Topic::Diagnostics);
        let found = (measured && known.is_none()).then(|| simulation.solver.diagnostics());
        let state = FrameState {
            snapshot: &simulation.snapshot(self.fields),
            diagnostics: known.or(found.as_ref()),
            state_hash: measured.then(|| simulation.solver.state_hash()),
            events: &self.events,
        };
        // The columns of a snapshot of the solver fit each other.
        if self.encoder.encode(&state, topics, &mut self.frame).is_ok() {
            server.send(&self.frame);
        }
    }
}
