//! Which pairs touch in a frame, and when that begins and ends.

use super::bounds::NONE;
use super::manifold::Contact;
use super::{ContactPoint, Contacts};
use crate::math::Vector64;
use crate::rigid::Bodies;
use std::collections::{BTreeMap, BTreeSet};

/// Two bodies, or a body and a wall, that touched in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPair {
    /// First body.
    pub body: u32,
    /// Second body; `None` for a wall.
    pub other: Option<u32>,
    /// The wall; `None` for two bodies.
    pub wall: Option<u32>,
    /// Impulse on the first body over the frame [N s].
    pub impulse: Vector64,
}

/// A contact that began or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactEvent {
    /// Frames watched before it.
    pub frame: u64,
    /// Whether it began.
    pub began: bool,
    /// First body; for a sensor the sensor.
    pub body: u32,
    /// Second body; `None` for a wall.
    pub other: Option<u32>,
    /// The wall; `None` for two bodies.
    pub wall: Option<u32>,
    /// Whether the first body is a sensor.
    pub sensor: bool,
}

/// Bodies and wall of a pair, `NONE` for none.
type Key = (u32, u32, u32);

/// Records about the pairs of a frame.
#[derive(Clone, Default)]
pub(super) struct Watch {
    on: bool,
    frame: u64,
    sums: BTreeMap<Key, Vector64>,
    touching: BTreeMap<Key, Vector64>,
    sensed: BTreeSet<(u32, u32)>,
    events: Vec<ContactEvent>,
}

fn index(index: u32) -> Option<u32> {
    (index != NONE).then_some(index)
}

impl Watch {
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// Adds the impulse of a contact in a substep [N s].
    pub fn add(&mut self, contact: &Contact, wall: u32, impulse: Vector64) {
        if self.on {
            *self.sums.entry((contact.a, contact.b, wall)).or_default() += impulse;
        }
    }

    /// Ends a frame.
    pub fn finish_frame(&mut self, bodies: &Bodies) {
        if !self.on {
            return;
        }
        let now = std::mem::take(&mut self.sums);
        let sensed = sensed(bodies);
        let frame = self.frame;
        let contact = |began: bool, &(body, other, wall): &Key| ContactEvent {
            frame,
            began,
            body,
            other: index(other),
            wall: index(wall),
            sensor: false,
        };
        let sensor = |began: bool, &(body, other): &(u32, u32)| ContactEvent {
            frame,
            began,
            body,
            other: Some(other),
            wall: None,
            sensor: true,
        };
        let ended = self.touching.keys().filter(|key| !now.contains_key(key)).map(|key| contact(false, key));
        self.events.extend(ended);
        self.events.extend(self.sensed.difference(&sensed).map(|key| sensor(false, key)));
        let began = now.keys().filter(|key| !self.touching.contains_key(key)).map(|key| contact(true, key));
        self.events.extend(began);
        self.events.extend(sensed.difference(&self.sensed).map(|key| sensor(true, key)));
        (self.touching, self.sensed, self.frame) = (now, sensed, self.frame + 1);
    }
}

/// Sensors and the bodies that they overlap.
fn sensed(bodies: &Bodies) -> BTreeSet<(u32, u32)> {
    let mut pairs = BTreeSet::new();
    let there = |sensor: bool| {
        bodies.views().iter().zip(0u32..).filter(move |(body, _)| body.sensor == sensor && !body.removed)
    };
    for (sensor, id) in there(true) {
        let Some(area) = sensor.placed() else { continue };
        for (body, other) in there(false).filter(|(body, _)| sensor.filter.allows(&body.filter)) {
            let near = (body.position - sensor.position).length()
                <= bodies.reaches[id as usize] + bodies.reaches[other as usize];
            if near && body.placed().is_some_and(|outline| outline.overlaps(&area)) {
                pairs.insert((id, other));
            }
        }
    }
    pairs
}

impl Contacts {
    /// From now on notes which bodies touch in each frame.
    pub(crate) fn watch(&mut self, on: bool) {
        self.watch = Watch { on, ..Watch::default() };
    }

    /// Pairs that touched in the last frame.
    pub(crate) fn watched_pairs(&self) -> Vec<ContactPair> {
        let pair = |(&(body, other, wall), &impulse): (&Key, &Vector64)| ContactPair {
            body,
            other: index(other),
            wall: index(wall),
            impulse,
        };
        self.watch.touching.iter().map(pair).collect()
    }

    /// Takes the events since the last call.
    pub(crate) fn take_events(&mut self) -> Vec<ContactEvent> {
        std::mem::take(&mut self.watch.events)
    }

    /// The contact points of the last substep, and those of sleeping bodies.
    pub(crate) fn all_points(&self, bodies: &Bodies) -> Vec<ContactPoint> {
        let mut points: Vec<ContactPoint> = self.points().collect();
        for (contact, cache) in self.narrow_phase.frozen() {
            for point in contact.points() {
                points.push(ContactPoint {
                    body: contact.a,
                    other: index(contact.b),
                    wall: index(cache.wall),
                    arm: contact.arm_a(point),
                    normal: contact.normal,
                    gap: point.gap,
                    normal_force: point.normal_impulse,
                    friction_force: point.tangent_impulse,
                    position: Vector64::ZERO,
                });
            }
        }
        for point in &mut points {
            point.position = bodies.pose(point.body).position + point.arm;
        }
        points
    }
}
