//! Events of joints that break.

use super::world::World;
use crate::observe::{Event, Severity};
use crate::rigid::Body;
use crate::rigid::JointState;

impl World {
    /// At the end of a frame: tells which joints broke in it.
    pub(super) fn report_broken_joints(&mut self) {
        let Some(rigid) = &self.parts.rigid else { return };
        let broke = rigid.contacts.broke();
        if broke.is_empty() {
            return;
        }
        let time = (self.clock.frame + 1) as f64 * self.parts.frame_time;
        let joints: Vec<_> = rigid.contacts.joints().collect();
        for &index in broke {
            let message = broken(index, &joints[index as usize], rigid.views());
            self.events.push(Event { time, severity: Severity::Info, message });
        }
    }
}

/// The message about a joint that has broken.
fn broken(index: u32, joint: &JointState, bodies: &[Body]) -> String {
    let name = if joint.name.is_empty() { format!("number {index}") } else { format!("\"{}\"", joint.name) };
    let body = &bodies[joint.joint.body as usize].name;
    let load = format!("{:.4} N, {:.4} N m", joint.force.length(), joint.torque.abs());
    format!("the joint {name} of the body \"{body}\" broke under a mean load of {load} in a frame")
}
