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
    /// The body follows waypoints smoothly; before the first and after the last it rests.
    Smooth(Vec<Waypoint>),
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

impl Waypoint {
    fn place(&self) -> Twist {
        Twist { linear: self.offset, angular: self.turn }
    }
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
            Motion::Path { waypoints, .. } | Motion::Smooth(waypoints) => {
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
            Motion::Smooth(waypoints) => along_curve(waypoints, time).0,
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
            Motion::Smooth(waypoints) => along_curve(waypoints, time).1,
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
    if time < first.time {
        return (first.place(), Twist::ZERO);
    }
    let next = waypoints.partition_point(|w| w.time <= time);
    let Some(to) = waypoints.get(next) else { return (last.place(), Twist::ZERO) };
    let from = &waypoints[next - 1];
    let rate = 1.0 / (to.time - from.time);
    let velocity = Twist { linear: (to.offset - from.offset) * rate, angular: (to.turn - from.turn) * rate };
    let mut place = from.place();
    place += velocity.scaled(time - from.time);
    (place, velocity)
}

/// Displacement and velocity on cubics (Hermite) through waypoints. The slope at a waypoint is that of the parabola
/// through it and its neighbours, so that velocities are continuous; it is 0 at the ends, and where two in a row are
/// equal, so that what holds its place does so.
pub(crate) fn along_curve(waypoints: &[Waypoint], time: f64) -> (Twist, Twist) {
    let (Some(first), Some(last)) = (waypoints.first(), waypoints.last()) else { return Default::default() };
    if time <= first.time {
        return (first.place(), Twist::ZERO);
    }
    let next = waypoints.partition_point(|w| w.time <= time);
    let Some(to) = waypoints.get(next) else { return (last.place(), Twist::ZERO) };
    let from = &waypoints[next - 1];
    let length = to.time - from.time;
    let s = (time - from.time) / length;
    let (start, end) = (slope(waypoints, next - 1).scaled(length), slope(waypoints, next).scaled(length));
    let mut way = to.place();
    way -= from.place();
    let (rest, both) = (1.0 - s, s * (1.0 - s));
    // from + s^2 (3 - 2 s) (to - from) + s (1 - s)^2 start - s^2 (1 - s) end
    let mut place = from.place();
    place += way.scaled(s * s * (3.0 - 2.0 * s));
    place += start.scaled(both * rest);
    place -= end.scaled(both * s);
    let mut rate = way.scaled(6.0 * both);
    rate += start.scaled(rest * (1.0 - 3.0 * s));
    rate -= end.scaled(s * (2.0 - 3.0 * s));
    (place, rate.scaled(1.0 / length))
}

/// The slope of the curve at a waypoint: 0 beside a stretch that holds.
fn slope(waypoints: &[Waypoint], index: usize) -> Twist {
    let (Some(before), Some(after)) = (index.checked_sub(1), waypoints.get(index + 1)) else { return Twist::ZERO };
    let (before, here) = (&waypoints[before], &waypoints[index]);
    let (long, short) = (here.time - before.time, after.time - here.time);
    let parabola = |values: [f64; 3]| {
        let (left, right) = ((values[1] - values[0]) / long, (values[2] - values[1]) / short);
        // The nearer neighbour weighs more.
        if left == 0.0 || right == 0.0 { 0.0 } else { (left * short + right * long) / (long + short) }
    };
    let of = |value: fn(&Waypoint) -> f64| parabola([before, here, after].map(value));
    Twist { linear: Vector64::new(of(|w| w.offset.x), of(|w| w.offset.y)), angular: of(|w| w.turn) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(times: &[f64], of: fn(f64) -> f64) -> Vec<Waypoint> {
        let sample = |&time: &f64| Waypoint { time, offset: Vector64::new(of(time), -2.0 * of(time)), turn: of(time) };
        times.iter().map(sample).collect()
    }

    #[test]
    fn a_smooth_motion_meets_its_samples_and_rests_before_and_behind_them() {
        let curve = samples(&[0.0, 0.3, 0.5, 1.1, 2.0], |t| 3.0 * t * t - t);
        let motion = Motion::Smooth(curve.clone());
        for sample in &curve {
            assert_eq!(motion.displacement(sample.time).linear, sample.offset);
            assert_eq!(motion.displacement(sample.time).angular, sample.turn);
        }
        for (time, end) in [(-1.0, &curve[0]), (5.0, &curve[4])] {
            assert_eq!((motion.displacement(time), motion.velocity(time)), (end.place(), Twist::ZERO));
        }
    }

    #[test]
    fn a_smooth_motion_is_exact_for_parabolas_within_and_its_velocity_is_continuous() {
        let motion = Motion::Smooth(samples(&[0.0, 0.3, 0.5, 1.1, 1.3, 2.0], |t| 3.0 * t * t - t));
        // The ends start and stop: their pieces are others.
        for k in 0..100 {
            let time = 0.3 + 1e-2 * f64::from(k);
            assert!((motion.displacement(time).angular - (3.0 * time * time - time)).abs() < 1e-12, "{time}");
            assert!((motion.velocity(time).angular - (6.0 * time - 1.0)).abs() < 1e-12, "{time}");
        }
        let holds = Motion::Smooth(samples(&[0.0, 1.0, 2.0, 3.0, 4.0], |t| if t < 1.5 { 0.5 } else { t }));
        assert_eq!((holds.displacement(0.7).angular, holds.velocity(0.7).angular), (0.5, 0.0));
        let mut last = motion.velocity(-0.1).angular;
        for k in 0..2200 {
            let time = 1e-3 * f64::from(k);
            let (velocity, small) = (motion.velocity(time).angular, 1e-6);
            assert!((velocity - last).abs() < 0.1, "a jump at {time}: {last} to {velocity}");
            let rate = (motion.displacement(time + small).linear - motion.displacement(time - small).linear).y;
            assert!((rate / (2.0 * small) - motion.velocity(time).linear.y).abs() < 1e-3, "{time}");
            last = velocity;
        }
    }
}
