//! Parameters that viewers can change: each change is an edit of the run like any other.

use std::collections::BTreeMap;

use foxglove::websocket::{Parameter, ParameterValue};
use unipbd_core::rigid::JointState;
use unipbd_core::{Edit, Vector64};

use super::controls::{Controls, Shared};
use super::options::speed;
use crate::simulation::Simulation;

/// Whether the run stands still.
const PAUSED: &str = "paused";
/// Simulated seconds per second.
const SPEED: &str = "speed";
/// Gravitational acceleration [m/s^2].
const GRAVITY: &str = "gravity";
/// The metadata of the log.
const SCENE: &str = "scene";
/// Speeds of motors begin like this, then comes the name of the joint, or its number.
const MOTOR: &str = "motor_speed/";

/// Result of a request to change parameters.
#[derive(Debug, Default)]
pub struct Changes {
    /// Changes made, for the log.
    pub made: Vec<String>,
    /// Changes refused, with reasons.
    pub refused: Vec<String>,
}

/// All parameters with their values.
pub fn list(simulation: &Simulation, controls: &Controls, scene: &BTreeMap<String, String>) -> Vec<Parameter> {
    let gravity = simulation.solver.gravity();
    let entries = scene.iter().map(|(key, value)| (key.clone(), ParameterValue::String(value.clone())));
    let mut all = vec![
        Parameter { name: PAUSED.to_owned(), r#type: None, value: Some(ParameterValue::Bool(controls.paused)) },
        Parameter::float64(SPEED, controls.speed),
        Parameter::float64_array(GRAVITY, [gravity.x, gravity.y]),
    ];
    for (number, joint) in simulation.solver.joints().iter().enumerate() {
        if let Some(motor) = joint.joint.motor().filter(|_| !joint.removed && !joint.broken) {
            all.push(Parameter::float64(motor_name(number, joint), motor.speed));
        }
    }
    all.push(Parameter { name: SCENE.to_owned(), r#type: None, value: Some(ParameterValue::Dict(entries.collect())) });
    all
}

/// Changes parameters, those that can be.
pub fn set(values: &[Parameter], simulation: &mut Simulation, shared: &Shared) -> Changes {
    let mut changes = Changes::default();
    for parameter in values {
        let changed = match (parameter.name.as_str(), &parameter.value) {
            (name, None) => Err(format!("{name} cannot be unset")),
            (PAUSED, Some(value)) => pause(value, shared),
            (SPEED, Some(value)) => set_speed(value, shared),
            (GRAVITY, Some(value)) => gravity(value, simulation).map(Some),
            (name, Some(value)) => match name.strip_prefix(MOTOR) {
                Some(joint) => motor(joint, value, simulation).map(Some),
                None if name == SCENE => Err("scene cannot be changed while it runs".to_owned()),
                None => Err(format!("there is no parameter {name}")),
            },
        };
        match changed {
            Ok(made) => changes.made.extend(made.map(|change| format!("a viewer set {change}"))),
            Err(reason) => changes.refused.push(reason),
        }
    }
    changes
}

fn pause(value: &ParameterValue, shared: &Shared) -> Result<Option<String>, String> {
    let ParameterValue::Bool(paused) = value else { return Err("paused is true or false".to_owned()) };
    shared.lock().paused = *paused;
    Ok(None)
}

fn set_speed(value: &ParameterValue, shared: &Shared) -> Result<Option<String>, String> {
    let wanted = number(value).ok_or_else(|| "speed is a number".to_owned())?;
    shared.lock().speed = speed(wanted).map_err(|reason| format!("speed: {reason}"))?;
    Ok(None)
}

fn gravity(value: &ParameterValue, simulation: &mut Simulation) -> Result<String, String> {
    let numbers: Option<Vec<f64>> = match value {
        ParameterValue::Array(values) => values.iter().map(number).collect(),
        _ => None,
    };
    let Some(&[x, y]) = numbers.as_deref() else { return Err("gravity is two numbers, such as [0, -9.81]".to_owned()) };
    let edit = Edit::new().set_gravity(Vector64::new(x, y));
    simulation.solver.apply(&edit).map_err(|error| error.to_string())?;
    Ok(format!("gravity to [{x}, {y}] m/s^2"))
}

fn motor(wanted: &str, value: &ParameterValue, simulation: &mut Simulation) -> Result<String, String> {
    let speed = number(value).ok_or_else(|| format!("{MOTOR}{wanted} is a number"))?;
    let joints = simulation.solver.joints();
    let found = joints.iter().enumerate().find_map(|(number, joint)| {
        let motor = joint.joint.motor()?;
        (motor_name(number, joint).strip_prefix(MOTOR) == Some(wanted)).then_some((number as u32, motor))
    });
    let (number, mut motor) = found.ok_or_else(|| format!("there is no motor {wanted}"))?;
    motor.speed = speed;
    simulation.solver.apply(&Edit::new().set_motor(number, Some(motor))).map_err(|error| error.to_string())?;
    Ok(format!("the speed of motor {wanted} to {speed}"))
}

fn motor_name(number: usize, joint: &JointState) -> String {
    if joint.name.is_empty() { format!("{MOTOR}{number}") } else { format!("{MOTOR}{}", joint.name) }
}

fn number(value: &ParameterValue) -> Option<f64> {
    match value {
        ParameterValue::Float64(value) => Some(*value),
        ParameterValue::Integer(value) => Some(*value as f64),
        _ => None,
    }
}
