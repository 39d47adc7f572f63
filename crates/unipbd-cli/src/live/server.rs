//! The server: channels for the topics, and what arrives from viewers.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use foxglove::websocket::service::{Handler, Request as Call, Responder, Service, ServiceSchema};
use foxglove::websocket::{
    AnyClient, Capability, ChannelView, Client, GetParametersResponder, Parameter, ParameterHandler,
    PlaybackControlRequest, PlaybackState, ServerListener, SetParametersResponder,
};
use foxglove::{Context, FoxgloveError, PartialMetadata, RawChannel, Schema, WebSocketServer, WebSocketServerHandle};
use serde::Deserialize;

use super::controls::Shared;
use super::options::LiveOptions;
use super::requests::Request;
use crate::record::{EncodedFrame, Fields, Header, Topic, Topics, nanoseconds, topics};
use crate::simulation::Simulation;

/// Messages that wait for a viewer at most: about a second of frames. Beyond, the oldest are left out.
const BACKLOG: usize = 512;
/// Longest wait for viewers to hear that the server closes.
const FAREWELL: Duration = Duration::from_millis(500);
/// Frames that may be asked for at once.
const MOST_STEPS: u64 = 1_000_000;
const STEP_REQUEST: &str = r#"{"type":"object","properties":{"frames":{"type":"integer","minimum":1,"default":1}}}"#;
const STEP_RESPONSE: &str = r#"{"type":"object","properties":{"frame":{"type":"integer"},"time":{"type":"number"}}}"#;

/// A server that listens.
pub struct Server {
    /// `None` once it is closed.
    handle: Option<WebSocketServerHandle>,
    /// Holds the channels.
    _context: Arc<Context>,
    channels: BTreeMap<Topic, Arc<RawChannel>>,
    scene: BTreeMap<String, String>,
    host: String,
}

impl Server {
    pub fn start(
        options: &LiveOptions,
        header: &Header,
        fields: Fields,
        simulation: &Simulation,
        shared: &Shared,
    ) -> Result<Server, String> {
        let context = Context::new();
        let offered = topics(fields);
        let channels = Topic::ALL.into_iter().filter(|topic| offered.contains(*topic));
        let channels = channels.filter(|topic| *topic != Topic::Gauges || !header.gauges.is_empty());
        let channels = channels.map(|topic| channel(&context, topic, &header.gauges).map(|channel| (topic, channel)));
        let ears = Arc::new(Ears { shared: shared.clone() });
        let seconds = simulation.frames as f64 * simulation.solver.frame_time();
        let server = WebSocketServer::new()
            .context(&context)
            .name(title(header))
            .bind(&options.host, options.port)
            .message_backlog_size(BACKLOG)
            .capabilities([Capability::Time, Capability::Parameters, Capability::Services])
            .playback_time_range(0, nanoseconds(seconds))
            .services([step_service(&ears)])
            .parameter_handler(ears.clone())
            .listener(ears);
        let cannot = |error: FoxgloveError| format!("cannot listen at {}:{}: {error}", options.host, options.port);
        let channels = channels.collect::<Result<_, _>>().map_err(cannot)?;
        let handle = server.start_blocking().map_err(cannot)?;
        let scene = header.to_metadata(fields);
        Ok(Server { handle: Some(handle), _context: context, channels, scene, host: options.host.clone() })
    }

    pub fn url(&self) -> String {
        let port = self.handle.as_ref().map_or(0, WebSocketServerHandle::port);
        format!("ws://{}:{port}", self.host)
    }

    pub fn viewers(&self) -> usize {
        self.handle.as_ref().map_or(0, WebSocketServerHandle::client_count)
    }

    /// The metadata of the log.
    pub fn scene(&self) -> &BTreeMap<String, String> {
        &self.scene
    }

    /// Topics that somebody subscribes to.
    pub fn wanted(&self) -> Topics {
        self.channels.iter().filter(|(_, channel)| channel.has_sinks()).map(|(topic, _)| *topic).collect()
    }

    pub fn wants_diagnostics(&self) -> bool {
        self.channels.get(&Topic::Diagnostics).is_some_and(|channel| channel.has_sinks())
    }

    /// Hands messages to the queues of viewers, and the time with them.
    pub fn send(&self, frame: &EncodedFrame) {
        if let (Some(last), Some(handle)) = (frame.messages.last(), &self.handle) {
            handle.broadcast_time(last.time);
        }
        for message in &frame.messages {
            if let Some(channel) = self.channels.get(&message.topic) {
                let metadata = PartialMetadata { log_time: Some(message.time) };
                channel.log_with_meta(&frame.bytes[message.range.clone()], metadata);
            }
        }
    }

    /// Tells viewers how the controls stand.
    pub fn tell(&self, state: PlaybackState) {
        if let Some(handle) = &self.handle {
            handle.broadcast_playback_state(state);
        }
    }

    /// Tells viewers who have asked for it what the parameters are.
    pub fn tell_parameters(&self, parameters: Vec<Parameter>) {
        if let Some(handle) = &self.handle {
            handle.publish_parameter_values(parameters);
        }
    }
}

/// Viewers are told that the server closes; one that reads nothing is not waited for.
impl Drop for Server {
    fn drop(&mut self) {
        let Some(handle) = self.handle.take() else { return };
        let (done, told) = std::sync::mpsc::channel();
        let closing = handle.stop();
        let waiting = std::thread::Builder::new().name("live server".to_owned()).spawn(move || {
            closing.wait_blocking();
            let _ = done.send(());
        });
        if waiting.is_ok() {
            let _ = told.recv_timeout(FAREWELL);
        }
    }
}

fn channel(context: &Arc<Context>, topic: Topic, gauges: &[String]) -> Result<Arc<RawChannel>, FoxgloveError> {
    let (name, descriptors) = topic.schema(gauges);
    let schema = Schema::new(name, "protobuf", descriptors);
    context.channel_builder(topic.name()).message_encoding("protobuf").schema(schema).build_raw()
}

fn title(header: &Header) -> String {
    if header.setting.name.is_empty() { "unipbd".to_owned() } else { format!("unipbd: {}", header.setting.name) }
}

/// `/step`: pauses the run and has it go on by some frames.
fn step_service(ears: &Arc<Ears>) -> Service {
    let json = |name: &str, text: &'static str| Schema::new(name, "jsonschema", text.as_bytes());
    let schema = ServiceSchema::new("unipbd.Step")
        .with_request("json", json("unipbd.StepRequest", STEP_REQUEST))
        .with_response("json", json("unipbd.StepResponse", STEP_RESPONSE));
    Service::builder("/step", schema).handler(Step(ears.clone()))
}

/// Hears what viewers want and leaves it for the run.
struct Ears {
    shared: Shared,
}

impl ServerListener for Ears {
    fn on_subscribe(&self, _client: Client, channel: ChannelView<'_>) {
        self.shared.subscribe(Topic::from_name(channel.topic()).into_iter().collect());
    }

    fn on_playback_control_request(&self, request: PlaybackControlRequest) -> Option<PlaybackState> {
        Some(self.shared.control(&request))
    }
}

impl ParameterHandler for Ears {
    fn get(&self, _: AnyClient, names: Vec<String>, _: Option<String>, responder: GetParametersResponder) {
        self.shared.ask(Request::Get { names, responder });
    }

    fn set(&self, client: AnyClient, values: Vec<Parameter>, _: Option<String>, responder: SetParametersResponder) {
        self.shared.ask(Request::Set { values, client, responder });
    }
}

/// The service [`step_service`].
struct Step(Arc<Ears>);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StepRequest {
    #[serde(default = "one")]
    frames: u64,
}

fn one() -> u64 {
    1
}

impl Handler for Step {
    fn call(&self, request: Call, responder: Responder) {
        match serde_json::from_slice(request.payload()) {
            Ok(StepRequest { frames: frames @ 1..=MOST_STEPS }) => self.0.shared.step(frames, responder),
            Ok(_) => responder.respond_err(format!("frames is a number from 1 to {MOST_STEPS}")),
            Err(error) => responder.respond_err(format!("expected {{\"frames\": 1}}: {error}")),
        }
    }
}
