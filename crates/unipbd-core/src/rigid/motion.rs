//! Prescribed motion of kinematic bodies.

use super::{Pose, Twist};
use crate::math::Vector64;
use std::f64::consts::TAU;

/// A prescribed motion: the position of the origin of a kinematic body as a function of time.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Motion {
    /// The body stays at its start pose.
    #[default]
    Still,
    /// The body moves and rotates at constant rates.
    Steady {
        /// Velocity [m/s].
        velocity: Vector64,
        /// Angular velocity, counter-clockwise [rad/s].
        spin: f64,
    },
    /// The body oscillates about its start pose as a sine.
    Oscillate {
        /// Largest displacement [m].
        amplitude: Vector64,
        /// Largest rotation [rad].
        swing: f64,
        /// Frequency [1/s].
        frequency: f64,
        /// Phase at time zero [rad].
        phase: f64,
    },
    /// The body follows waypoints in straight lines; before the first and after the last it rests.
    Path {
        /// Waypoints by increasing time.
        waypoints: Vec<Waypoint>,
        /// Behaviour after the last waypoint.
        repeat: Repeat,
    },
}

/// A waypoint of a path.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Waypoint {
    /// Time [s].
    pub time: f64,
    /// Displacement from the start [m].
    pub offset: Vector64,
    /// Rotation from the start [rad].
    pub turn: f64,
}

/// Behaviour of a path after its last waypoint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Repeat {
    /// Rest there.
    #[default]
    Once,
    /// Restart at the first waypoint.
    Loop,
}

impl Motion {
    /// Whether all its numbers are finite, and its times in order.
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Motion::Still => true,
            Motion::Steady { velocity, spin } => velocity.is_finite() && spin.is_finite(),
            Motion::Oscillate { amplitude, swing, frequency, phase } => {
                amplitude.is_finite() && [swing, frequency, phase].into_iter().all(|value| value.is_finite())
            }
            Motion::Path { waypoints, .. } => {
                let sound = |at: &Waypoint| at.offset.is_finite() && at.turn.is_finite() && at.time.is_finite();
                waypoints.iter().all(sound) && waypoints.windows(2).all(|two| two[0].time < two[1].time)
            }
        }
    }

    /// Whether the body never moves.
    pub fn is_still(&self) -> bool {
        *self == Motion::Still
    }

    /// Displacement and rotation from the start at a time [s].
    pub fn displacement(&self, time: f64) -> Twist {
        match self {
            Motion::Still => Twist::ZERO,
            Motion::Steady { velocity, spin } => Twist { linear: *velocity * time, angular: spin * time },
            Motion::Oscillate { amplitude, swing, frequency, phase } => {
                let wave = libm::sin(TAU * frequency * time + phase);
                Twist { linear: *amplitude * wave, angular: swing * wave }
            }
            Motion::Path { waypoints, repeat } => along_path(waypoints, *repeat, time).0,
        }
    }

    /// Velocity at a time [s].
    pub fn velocity(&self, time: f64) -> Twist {
        match self {
            Motion::Still => Twist::ZERO,
            Motion::Steady { velocity, spin } => Twist { linear: *velocity, angular: *spin },
            Motion::Oscillate { amplitude, swing, frequency, phase } => {
                let rate = TAU * frequency * libm::cos(TAU * frequency * time + phase);
                Twist { linear: *amplitude * rate, angular: swing * rate }
            }
            Motion::Path { waypoints, repeat } => along_path(waypoints, *repeat, time).1,
        }
    }

    /// The pose at a time [s] of a body that starts at `start`.
    pub fn pose(&self, start: Pose, time: f64) -> Pose {
        let moved = self.displacement(time);
        Pose { position: start.position + moved.linear, angle: start.angle + moved.angular }
    }
}

/// Displacement and velocity on a path of straight lines.
fn along_path(waypoints: &[Waypoint], repeat: Repeat, time: f64) -> (Twist, Twist) {
    let (Some(first), Some(last)) = (waypoints.first(), waypoints.last()) else { return Default::default() };
    let duration = last.time - first.time;
    let time = match repeat {
        Repeat::Loop if duration > 0.0 && time > first.time => first.time + (time - first.time) % duration,
        _ => time,
    };
    let at = |w: &Waypoint| Twist { linear: w.offset, angular: w.turn };
    if time < first.time {
        return (at(first), Twist::ZERO);
    }
    let next = waypoints.partition_point(|w| w.time <= time);
    let Some(to) = waypoints.get(next) else { return (at(last), Twist::ZERO) };
    let from = &waypoints[next - 1];
    let rate = 1.0 / (to.time - from.time);
    let velocity = Twist { linear: (to.offset - from.offset) * rate, angular: (to.turn - from.turn) * rate };
    let mut place = at(from);
    place += velocity.scaled(time - from.time);
    (place, velocity)
}
