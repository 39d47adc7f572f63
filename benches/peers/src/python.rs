//! Peers from the Python registry: each runs in its own process and writes where its particles are.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::case::{Case, LOOK, Outcome};

/// Runs `script` of this crate's `python` folder; a reason where it could not.
pub fn peer(case: &Case, script: &str, setting: &str) -> Result<Outcome, String> {
    let python = std::env::var("PEERS_PYTHON").map_err(|_| "no Python environment: start by peers.sh".to_owned())?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("python").join(script);
    let numbers = [case.dx, case.block[0], case.block[1], case.tank[0], case.tank[1], case.seconds, LOOK];
    let mut command = Command::new(python);
    command.arg(path).args(numbers.map(|number| number.to_string())).arg(setting);
    if let (true, Ok(library)) = (script.starts_with("splish"), std::env::var("PEERS_LIBGL")) {
        command.env("LD_PRELOAD", library);
    }
    let output = command.output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let found = text.lines().rev().find_map(|line| serde_json::from_str::<Value>(line).ok().filter(Value::is_object));
    let Some(found) = found else {
        let errors = String::from_utf8_lossy(&output.stderr);
        return Err(errors.lines().last().unwrap_or("it said nothing").to_owned());
    };
    let number = |value: &Value| value.as_f64().unwrap_or(0.0);
    let point = |value: &Value| [number(&value[0]), number(&value[1])];
    let points =
        |value: &Value| value.as_array().map_or_else(Vec::new, |list| list.iter().map(point).collect::<Vec<_>>());
    let looks: Vec<_> = found["looks"].as_array().map_or_else(Vec::new, |looks| looks.iter().map(points).collect());
    let last = looks.last().ok_or("it never looked")?;
    Ok(Outcome {
        solver: found["solver"].as_str().unwrap_or(script).to_owned(),
        time: number(&found["time"]),
        steps: number(&found["steps"]) as u64,
        height: last.iter().map(|x| x[1]).sum::<f64>() / last.len() as f64,
        compression: looks.iter().map(|look| case.compression(look)).collect(),
    })
}
