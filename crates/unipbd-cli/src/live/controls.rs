//! State shared by viewers and the run: whether it goes on, how fast, and the requests of viewers.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use foxglove::websocket::service::Responder;
use foxglove::websocket::{PlaybackCommand, PlaybackControlRequest, PlaybackState, PlaybackStatus};
use serde_json::json;

use super::options::{LiveOptions, speed};
use super::requests::{Request, Requests};
use crate::record::Topics;
use crate::simulation::Simulation;

/// Frames asked for one by one.
pub struct Steps {
    /// How many are still to be done.
    pub left: u64,
    responder: Responder,
}

impl Steps {
    /// Answers once they are done.
    pub fn finish(self, frame: u64, time: f64) {
        self.responder.respond_ok(json!({ "frame": frame, "time": time }).to_string());
    }

    /// Answers that they will not be done.
    pub fn refuse(self) {
        self.responder.respond_err("the run has ended".to_owned());
    }
}

/// The state of the controls.
pub struct Controls {
    /// Whether the run stands still.
    pub paused: bool,
    /// Simulated seconds per second of the clock; 0 is as fast as it can.
    pub speed: f64,
    /// Whether the run is over.
    pub ended: bool,
    /// Frames asked for one by one.
    pub steps: VecDeque<Steps>,
    requests: Requests,
    /// Topics with new subscribers.
    newcomers: Topics,
    /// Simulated time \[ns].
    time: u64,
}

impl Controls {
    pub fn new(options: &LiveOptions, simulation: &Simulation) -> Self {
        let mut controls = Controls {
            paused: options.paused,
            speed: options.speed,
            ended: false,
            steps: VecDeque::new(),
            requests: Requests::default(),
            newcomers: Topics::default(),
            time: 0,
        };
        controls.see(simulation.solver.time());
        controls
    }

    /// Notes the simulated time \[s].
    pub fn see(&mut self, time: f64) {
        self.time = crate::record::nanoseconds(time);
    }

    /// The controls as a viewer shows them.
    pub fn playback(&self) -> PlaybackState {
        let status = match (self.ended, self.paused) {
            (true, _) => PlaybackStatus::Ended,
            (false, true) => PlaybackStatus::Paused,
            (false, false) => PlaybackStatus::Playing,
        };
        let playback_speed = self.speed as f32;
        PlaybackState { status, current_time: self.time, playback_speed, did_seek: false, request_id: None }
    }

    /// Does what the bar of a viewer asks for; a run cannot go to another time.
    fn control(&mut self, request: &PlaybackControlRequest) {
        self.paused = request.playback_command == PlaybackCommand::Pause;
        if let Ok(speed) = speed(f64::from(request.playback_speed)) {
            self.speed = speed;
        }
        self.requests.push(Request::Controlled);
    }

    /// Requests since the last call, and the topics with new subscribers.
    pub fn take_requests(&mut self) -> (Vec<Request>, Topics) {
        (self.requests.take(), std::mem::take(&mut self.newcomers))
    }
}

/// The controls, and the bell that the server rings when somebody has used them.
#[derive(Clone)]
pub struct Shared(Arc<(Mutex<Controls>, Condvar)>);

impl Shared {
    pub fn new(controls: Controls) -> Self {
        Shared(Arc::new((Mutex::new(controls), Condvar::new())))
    }

    pub fn lock(&self) -> MutexGuard<'_, Controls> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until somebody uses the controls.
    pub fn wait(&self, controls: MutexGuard<'_, Controls>, at_most: Duration) {
        drop(self.0.1.wait_timeout(controls, at_most));
    }

    /// Leaves a request for the run.
    pub fn ask(&self, request: Request) {
        self.lock().requests.push(request);
        self.0.1.notify_all();
    }

    /// Notes a new subscriber of these topics.
    pub fn subscribe(&self, topics: Topics) {
        self.lock().newcomers.extend(topics);
        self.0.1.notify_all();
    }

    /// Does what the bar of a viewer asks for.
    pub fn control(&self, request: &PlaybackControlRequest) -> PlaybackState {
        let mut controls = self.lock();
        controls.control(request);
        self.0.1.notify_all();
        controls.playback()
    }

    /// Pauses the run and has it go on by this many frames.
    pub fn step(&self, frames: u64, responder: Responder) {
        let steps = Steps { left: frames, responder };
        let mut controls = self.lock();
        if controls.ended {
            drop(controls);
            return steps.refuse();
        }
        controls.paused = true;
        controls.steps.push_back(steps);
        controls.requests.push(Request::Controlled);
        self.0.1.notify_all();
    }
}
