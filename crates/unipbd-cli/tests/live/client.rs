//! A viewer of the Foxglove WebSocket protocol, and a run for it to watch.

use std::collections::{BTreeMap, VecDeque};
use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use base64::prelude::{BASE64_STANDARD, Engine};
use prost_reflect::{DescriptorPool, DynamicMessage, MessageDescriptor};
use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// Water that falls in a tank with a motor in the air, 50 frames a second.
const SCENE: &str = r#"
name = "Live"
spacing = 0.1
duration = 1000.0
fps = 50

[solver]
substeps = 2

[[liquid]]
name = "water"

[[block]]
material = "water"
min = [0.0, 1.0]
max = [0.4, 1.4]

[[tank]]
min = [0.0, 0.0]
max = [3.0, 3.0]
open = ["top"]

[[body]]
name = "wheel"
position = [2.0, 2.0]
size = [0.6, 0.2]
density = 500.0

[[joint]]
name = "axle"
kind = "hinge"
body = "wheel"
at = [2.0, 2.0]
motor_speed_deg = 90.0
"#;

/// A run that viewers watch; it is killed where a test leaves it.
pub struct Run {
    child: Child,
    pub url: String,
    pub folder: TempDir,
    stderr: BufReader<std::process::ChildStderr>,
}

impl Run {
    /// Runs the scene at a free port with these arguments.
    pub fn start(arguments: &[&str]) -> Run {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("live.toml"), SCENE).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_unipbd"));
        command.args(["run", "live.toml", "--live", "127.0.0.1:0", "--threads", "1"]).args(arguments);
        command.current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut stderr = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        stderr.read_line(&mut line).unwrap();
        let url = line.split_whitespace().find(|word| word.starts_with("ws://")).unwrap_or_else(|| panic!("{line}"));
        let url = url.trim_end_matches(':').to_owned();
        Run { child, url, folder, stderr }
    }

    /// Ends the run as Ctrl-C does, by the signal that no shell ignores in the background; where there is none, kills it.
    pub fn interrupt(&mut self) {
        if cfg!(unix) {
            Command::new("kill").args(["-TERM", &self.child.id().to_string()]).status().unwrap();
        } else {
            self.child.kill().unwrap();
        }
    }

    /// Whether it ends by itself within a minute.
    pub fn ends(&mut self) -> bool {
        (0..600).any(|_| {
            std::thread::sleep(Duration::from_millis(100));
            self.child.try_wait().unwrap().is_some()
        })
    }

    /// Waits for the end; returns the exit code, standard output, and the rest of standard error.
    pub fn end(mut self) -> (Option<i32>, String, String) {
        let mut errors = String::new();
        self.stderr.read_to_string(&mut errors).unwrap();
        let mut text = String::new();
        self.child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
        (self.child.wait().unwrap().code(), text, errors)
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The command with these arguments, to its end, in the folder of a run.
pub fn command(run: &Run, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_unipbd")).args(arguments).current_dir(run.folder.path()).output().unwrap()
}

/// What a server sends.
#[derive(Debug)]
pub enum Heard {
    Text(Value),
    Data { topic: String, time: u64, message: Box<DynamicMessage> },
    Time(u64),
    Service(Value),
    Playback { status: u8, speed: f32 },
}

/// A viewer.
pub struct Viewer {
    socket: WebSocket<TcpStream>,
    pub info: Value,
    pub channels: BTreeMap<String, Value>,
    pub services: Value,
    kinds: BTreeMap<u64, (String, MessageDescriptor)>,
    /// What came while something else was waited for: data and answers have queues of their own.
    kept: VecDeque<Heard>,
}

impl Viewer {
    /// Connects, and reads the topics that are offered.
    pub fn connect(url: &str) -> Viewer {
        let mut request = url.into_client_request().unwrap();
        request.headers_mut().insert("Sec-WebSocket-Protocol", "foxglove.sdk.v1".parse().unwrap());
        let stream = TcpStream::connect(url.trim_start_matches("ws://")).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let (socket, answer) = tungstenite::client(request, stream).unwrap();
        assert_eq!(answer.headers()["Sec-WebSocket-Protocol"], "foxglove.sdk.v1");
        let mut viewer = Viewer {
            socket,
            info: Value::Null,
            channels: BTreeMap::new(),
            services: Value::Null,
            kinds: BTreeMap::new(),
            kept: VecDeque::new(),
        };
        viewer.info = viewer.text("serverInfo");
        while viewer.services.is_null() {
            let Heard::Text(message) = viewer.hear() else { continue };
            match message["op"].as_str() {
                Some("advertise") => {
                    for channel in message["channels"].as_array().unwrap() {
                        viewer.channels.insert(channel["topic"].as_str().unwrap().to_owned(), channel.clone());
                    }
                }
                Some("advertiseServices") => viewer.services = message["services"].clone(),
                other => panic!("{other:?}"),
            }
        }
        viewer
    }

    pub fn say(&mut self, message: Value) {
        self.socket.send(Message::text(message.to_string())).unwrap();
    }

    pub fn subscribe(&mut self, topics: &[&str]) {
        for topic in topics {
            let channel = &self.channels[*topic];
            let id = channel["id"].as_u64().unwrap();
            assert_eq!((&channel["encoding"], &channel["schemaEncoding"]), (&json!("protobuf"), &json!("protobuf")));
            let schema = BASE64_STANDARD.decode(channel["schema"].as_str().unwrap()).unwrap();
            let pool = DescriptorPool::decode(schema.as_slice()).unwrap();
            let kind = pool.get_message_by_name(channel["schemaName"].as_str().unwrap()).unwrap();
            self.kinds.insert(id, ((*topic).to_owned(), kind));
            self.say(json!({ "op": "subscribe", "subscriptions": [{ "id": id, "channelId": id }] }));
        }
    }

    /// The next message, whatever it is.
    pub fn hear(&mut self) -> Heard {
        self.kept.pop_front().unwrap_or_else(|| self.read())
    }

    /// The first message that is wanted; others are kept.
    fn wait<T>(&mut self, wanted: impl Fn(&Heard) -> Option<T>) -> T {
        let kept = self.kept.iter().enumerate().find_map(|(place, heard)| Some((place, wanted(heard)?)));
        if let Some((place, found)) = kept {
            self.kept.remove(place);
            return found;
        }
        loop {
            let heard = self.read();
            match wanted(&heard) {
                Some(found) => return found,
                None => self.kept.push_back(heard),
            }
        }
    }

    fn read(&mut self) -> Heard {
        loop {
            match self.socket.read().unwrap() {
                Message::Text(text) => return Heard::Text(serde_json::from_str(&text).unwrap()),
                Message::Binary(bytes) => return self.binary(&bytes),
                _ => {}
            }
        }
    }

    /// Hears all that comes until the server closes; whether it says so.
    pub fn closes(&mut self) -> bool {
        loop {
            match self.socket.read() {
                Ok(Message::Close(_)) => return true,
                Ok(_) => {}
                Err(_) => return false,
            }
        }
    }

    fn binary(&self, bytes: &[u8]) -> Heard {
        let number = |from: usize, length: usize| {
            bytes[from..from + length].iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte))
        };
        match bytes[0] {
            1 => {
                let (topic, kind) = &self.kinds[&number(1, 4)];
                let message = Box::new(DynamicMessage::decode(kind.clone(), &bytes[13..]).unwrap());
                Heard::Data { topic: topic.clone(), time: number(5, 8), message }
            }
            2 => Heard::Time(number(1, 8)),
            3 => {
                let encoding = number(9, 4) as usize;
                Heard::Service(serde_json::from_slice(&bytes[13 + encoding..]).unwrap())
            }
            5 => Heard::Playback { status: bytes[1], speed: f32::from_le_bytes(bytes[10..14].try_into().unwrap()) },
            other => panic!("opcode {other}"),
        }
    }

    /// The next text with this `op`.
    pub fn text(&mut self, op: &str) -> Value {
        self.wait(|heard| match heard {
            Heard::Text(message) if message["op"] == op => Some(message.clone()),
            _ => None,
        })
    }

    /// The next message on a topic, with its time.
    pub fn data(&mut self, wanted: &str) -> (u64, DynamicMessage) {
        self.wait(|heard| match heard {
            Heard::Data { topic, time, message } if topic == wanted => Some((*time, (**message).clone())),
            _ => None,
        })
    }

    /// Asks for this many frames.
    pub fn ask_for_steps(&mut self, frames: u64) {
        let id = self.services[0]["id"].as_u64().unwrap() as u32;
        let mut call = vec![2];
        call.extend(id.to_le_bytes());
        call.extend(1u32.to_le_bytes());
        call.extend(4u32.to_le_bytes());
        call.extend(b"json");
        call.extend(json!({ "frames": frames }).to_string().bytes());
        self.socket.send(Message::binary(call)).unwrap();
    }

    /// Has the run go on by this many frames; returns the frame it comes to.
    pub fn step(&mut self, frames: u64) -> Value {
        self.ask_for_steps(frames);
        self.wait(|heard| match heard {
            Heard::Service(answer) => Some(answer.clone()),
            Heard::Text(message) if message["op"] == "serviceCallFailure" => Some(message.clone()),
            _ => None,
        })
    }

    /// Uses the bar of the viewer: 0 plays, 1 pauses.
    pub fn control(&mut self, command: u8, speed: f32) {
        let mut request = vec![3, command];
        request.extend(speed.to_le_bytes());
        request.extend([0; 9]);
        request.extend(2u32.to_le_bytes());
        request.extend(b"me");
        self.socket.send(Message::binary(request)).unwrap();
    }

    /// The next state of the controls.
    pub fn playback(&mut self) -> (u8, f32) {
        self.wait(|heard| match heard {
            Heard::Playback { status, speed } => Some((*status, *speed)),
            _ => None,
        })
    }

    /// Sets a parameter; returns what the server makes of it.
    pub fn set(&mut self, name: &str, value: Value) -> Value {
        self.say(json!({ "op": "setParameters", "parameters": [{ "name": name, "value": value }], "id": "set" }));
        self.answer("set")[name].clone()
    }

    /// All parameters by name.
    pub fn parameters(&mut self) -> Value {
        self.say(json!({ "op": "getParameters", "parameterNames": [], "id": "get" }));
        self.answer("get")
    }

    fn answer(&mut self, id: &str) -> Value {
        let message = self.wait(|heard| match heard {
            Heard::Text(message) if message["op"] == "parameterValues" && message["id"] == id => Some(message.clone()),
            _ => None,
        });
        let found = message["parameters"].as_array().unwrap().iter();
        found
            .map(|one| (one["name"].as_str().unwrap().to_owned(), one["value"].clone()))
            .collect::<serde_json::Map<_, _>>()
            .into()
    }
}

/// The x and y of the points of a cloud.
pub fn points(cloud: &DynamicMessage) -> Vec<[f32; 2]> {
    let data = cloud.get_field_by_name("data").unwrap();
    let bytes = data.as_bytes().unwrap();
    let float = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
    bytes.chunks_exact(16).map(|point| [float(&point[..4]), float(&point[4..8])]).collect()
}
