//! Peers from the Python registry: each runs in its own process and writes where its particles are. Their scripts read
//! their settings back.

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use unipbd_validation::compression::Errors;

use super::{Case, LOOK, Outcome, mean_height};

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
        let said = errors.lines().last().unwrap_or("it said nothing");
        return Err(format!("{script} {setting}: {said} ({})", output.status));
    };
    outcome(case, &found).ok_or_else(|| format!("{script} {setting}: no figures in {found:.60}"))
}

fn outcome(case: &Case, found: &Value) -> Option<Outcome> {
    let point = |value: &Value| Some([value[0].as_f64()?, value[1].as_f64()?]);
    let points = |value: &Value| value.as_array()?.iter().map(point).collect::<Option<Vec<_>>>();
    let looks: Vec<_> = found["looks"].as_array()?.iter().map(points).collect::<Option<_>>()?;
    Some(Outcome {
        solver: found["solver"].as_str()?.to_owned(),
        time: found["time"].as_f64()?,
        steps: found["steps"].as_u64()?,
        height: mean_height(looks.last()?),
        errors: looks.iter().map(|look| case.errors(look)).fold(Errors::default(), Errors::and),
    })
}
