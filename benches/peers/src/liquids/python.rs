//! Peers from the Python registry: each runs in its own process, to the next look for each line that it is given, and
//! writes where its particles are. The scripts read their settings back.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::Value;

use super::{Case, LOOK, Solver, Spent};

struct Python {
    name: String,
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    positions: Vec<[f64; 2]>,
}

/// Starts `script` of this crate's `python` folder.
pub fn python(case: &Case, script: &str, setting: &str) -> Result<Box<dyn Solver>, String> {
    let python = std::env::var("PEERS_PYTHON").map_err(|_| "no Python environment: start by peers.sh".to_owned())?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("python").join(script);
    let numbers = [case.dx, case.block[0], case.block[1], case.tank[0], case.tank[1], case.seconds, LOOK];
    let mut command = Command::new(python);
    command.arg(path).args(numbers.map(|number| number.to_string())).arg(setting);
    if let (true, Ok(library)) = (script.starts_with("splish"), std::env::var("PEERS_LIBGL")) {
        command.env("LD_PRELOAD", library);
    }
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| error.to_string())?;
    let (input, output) = (child.stdin.take().expect("piped"), child.stdout.take().expect("piped"));
    let name = format!("{script} {setting}");
    let mut peer = Python { name, child, input, output: BufReader::new(output), positions: Vec::new() };
    peer.name = peer.next()?["solver"].as_str().ok_or("a peer without a name")?.to_owned();
    Ok(Box::new(peer))
}

impl Python {
    /// The next line that is an object; whatever else it prints is passed over.
    fn next(&mut self) -> Result<Value, String> {
        let mut line = String::new();
        while self.output.read_line(&mut line).is_ok_and(|length| length > 0) {
            match serde_json::from_str(&line) {
                Ok(found @ Value::Object(_)) => return Ok(found),
                _ => line.clear(),
            }
        }
        let mut said = String::new();
        let _ = self.child.stderr.as_mut().expect("piped").read_to_string(&mut said);
        Err(format!("{}: {}", self.name, said.lines().last().unwrap_or("it said nothing")))
    }
}

impl Solver for Python {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn advance(&mut self, _: f64) -> Result<Spent, String> {
        let asked = self.input.write_all(b"\n").and_then(|()| self.input.flush());
        let found = self.next()?;
        asked.map_err(|error| error.to_string())?;
        let point = |value: &Value| Some([value[0].as_f64()?, value[1].as_f64()?]);
        let positions = found["positions"].as_array().and_then(|list| list.iter().map(point).collect());
        self.positions = positions.ok_or_else(|| format!("{}: no positions", self.name))?;
        let spent = || Some(Spent { time: found["time"].as_f64()?, steps: found["steps"].as_u64()? });
        spent().ok_or_else(|| format!("{}: no time", self.name))
    }

    fn positions(&self) -> Vec<[f64; 2]> {
        self.positions.clone()
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
