//! Whether changes of bodies, joints and gravity can be made.

use super::check::{Checker, both_finite, finite};
use super::emitters::Emitters;
use super::error::unfit;
use super::ropes::Lines;
use super::world::WorldChange;
use super::{BodyChange, Edit, EditError};
use crate::rigid::BodyKind;
use crate::rigid::contact::{JointKind, Motor};
use crate::scene::{BodyDescription, BodySolver, JointDescription, MOST_BODIES, Scene};
use crate::shapes::Shape;

/// The bodies and joints that there will be after the changes so far.
struct Roster<'a> {
    bodies: Vec<Entry>,
    /// Kinds of the joints; none for those that are over.
    joints: Vec<Option<JointKind>>,
    emitters: Emitters<'a>,
    ropes: Lines<'a>,
}

struct Entry {
    name: String,
    there: bool,
    soft: bool,
    kind: BodyKind,
}

impl Checker<'_> {
    pub(super) fn world(&self, edit: &Edit) -> Result<(), EditError> {
        if edit.world.is_empty() {
            return Ok(());
        }
        let rigid = self.solver.world.parts.rigid.as_ref();
        let soft = |id: usize| rigid.is_some_and(|rigid| rigid.bodies.elasticity(id).is_some());
        let bodies = self.solver.bodies().iter().enumerate().map(|(id, body)| Entry {
            name: body.name.clone(),
            there: !body.removed,
            soft: soft(id),
            kind: body.kind,
        });
        let joints = self.solver.joints().into_iter();
        let joints = joints.map(|joint| (!joint.removed).then_some(joint.joint.kind));
        let emitters = Emitters::of(self.solver);
        let ropes = Lines::of(self.solver);
        let mut roster = Roster { bodies: bodies.collect(), joints: joints.collect(), emitters, ropes };
        edit.world.iter().try_for_each(|change| self.world_change(change, &mut roster))
    }

    fn world_change(&self, change: &WorldChange, roster: &mut Roster<'_>) -> Result<(), EditError> {
        match change {
            WorldChange::Gravity(gravity) => both_finite("gravity", 0, *gravity),
            WorldChange::AddBody(body) => self.new_body(body, roster),
            WorldChange::RemoveBody(body) => {
                let taken = *body as usize;
                roster.rigid(*body)?;
                roster.bodies[taken].there = false;
                Ok(())
            }
            WorldChange::MoveBody { body, position, angle } => {
                roster.rigid(*body)?;
                self.positions(&[*position])?;
                finite("angle", 0, *angle)
            }
            WorldChange::ChangeBody { body, change } => {
                roster.rigid(*body)?;
                values(change)?;
                change.shape.as_ref().map_or(Ok(()), |shape| self.new_shape(shape))?;
                if let Some(kind) = change.kind {
                    roster.bodies[*body as usize].kind = kind;
                }
                Ok(())
            }
            WorldChange::Strike { body, impulse, point } => {
                if roster.rigid(*body)?.kind != BodyKind::Dynamic {
                    return unfit(format!("the body {body} is not dynamic: no push moves it"));
                }
                both_finite("impulse", 0, *impulse)?;
                self.positions(&[*point])
            }
            WorldChange::AddJoint(joint) => self.new_joint(joint, roster),
            WorldChange::RemoveJoint(joint) => {
                roster.joint(*joint)?;
                roster.joints[*joint as usize] = None;
                Ok(())
            }
            WorldChange::Motor { joint, motor } => motor_fits(roster.joint(*joint)?, *motor),
            WorldChange::AddEmitter(emitter) => roster.emitters.add(emitter),
            WorldChange::ChangeEmitter { emitter, change } => roster.emitters.change(*emitter, change),
            WorldChange::RemoveEmitter(emitter) => roster.emitters.remove(*emitter),
            WorldChange::AddRope(rope) => {
                rope.body.iter().chain(&rope.from_body).try_for_each(|name| roster.holds(name, "rope"))?;
                self.positions(&[rope.from.into(), rope.to.into()])?;
                // A rope on a body brings a joint.
                let tied = rope.body.is_some() || rope.from_body.is_some();
                roster.joints.extend(tied.then_some(Some(JointKind::Weld { angle: 0.0 })));
                roster.ropes.add(rope)
            }
            WorldChange::CutRope { rope, piece } => roster.ropes.cut(*rope, *piece),
            WorldChange::RemoveRope(rope) => roster.ropes.remove(*rope),
        }
    }

    /// A scene of nothing but the new table, at the scale of the run: its checks are those of scene files.
    fn small_scene(&self) -> Scene {
        Scene { spacing: self.solver.spacing(), fps: 1.0 / self.solver.frame_time(), ..Scene::default() }
    }

    fn new_body(&self, body: &BodyDescription, roster: &mut Roster<'_>) -> Result<(), EditError> {
        if body.solver == BodySolver::ShapeMatching {
            return unfit("a body that is particles cannot be added to a run: describe it in the scene");
        }
        let scene = Scene { body: vec![body.clone()], ..self.small_scene() };
        let problems = scene.validate();
        if let Some(problem) = problems.0.first() {
            return unfit(format!("the new body cannot be made: {problem}"));
        }
        for (name, _) in body.instances(roster.bodies.len()) {
            if roster.bodies.iter().any(|entry| entry.there && entry.name == name) {
                return unfit(format!("there is a body \"{name}\" already"));
            }
            roster.bodies.push(Entry { name, there: true, soft: false, kind: body.kind });
        }
        if roster.bodies.iter().filter(|entry| entry.there).count() > MOST_BODIES {
            return unfit(format!("no more than {MOST_BODIES} bodies fit"));
        }
        Ok(())
    }

    fn new_shape(&self, shape: &Shape) -> Result<(), EditError> {
        let (radius, outline) = match shape {
            Shape::Disc { radius } => (Some(*radius), None),
            Shape::Polygon(corners) => (None, Some(corners.iter().map(|corner| corner.to_array()).collect())),
        };
        let body = BodyDescription { radius, outline, size: None, ..BodyDescription::disc(1.0, [0.0; 2]) };
        let scene = Scene { body: vec![body], ..self.small_scene() };
        match scene.validate().0.first() {
            Some(problem) => unfit(format!("the new shape cannot be made: {problem}")),
            None => Ok(()),
        }
    }

    fn new_joint(&self, joint: &JointDescription, roster: &mut Roster<'_>) -> Result<(), EditError> {
        for name in std::iter::once(&joint.body).chain(&joint.other) {
            roster.holds(name, "joint")?;
        }
        // Stand-ins for the bodies, well apart.
        let far = |k: f64| [1e3 * k * self.solver.spacing(), 0.0];
        let stand_in = |name: &String, k: f64| BodyDescription {
            name: name.clone(),
            ..BodyDescription::disc(2.0 * self.solver.spacing(), far(k))
        };
        let mut body = vec![stand_in(&joint.body, 1.0)];
        body.extend(joint.other.iter().filter(|other| **other != joint.body).map(|other| stand_in(other, 2.0)));
        let scene = Scene { body, joint: vec![joint.clone()], ..self.small_scene() };
        if let Some(problem) = scene.validate().0.first() {
            return unfit(format!("the new joint cannot be made: {problem}"));
        }
        roster.joints.push(Some(match joint.kind {
            crate::scene::JointRule::Hinge => JointKind::Hinge { motor: None, limits: None },
            _ => JointKind::Weld { angle: 0.0 },
        }));
        Ok(())
    }
}

impl Roster<'_> {
    /// A body that is there and has a pose of its own.
    fn rigid(&self, body: u32) -> Result<&Entry, EditError> {
        match self.bodies.get(body as usize) {
            Some(entry) if entry.soft => unfit(format!("the body \"{}\" is particles: change these", entry.name)),
            Some(entry) if entry.there => Ok(entry),
            Some(entry) => unfit(format!("the body \"{}\" was taken away", entry.name)),
            None => unfit(format!("there is no body {body}")),
        }
    }

    /// Whether there is a body of this name that a joint or rope can hold.
    fn holds(&self, name: &str, what: &str) -> Result<(), EditError> {
        match self.bodies.iter().find(|entry| entry.there && entry.name == name) {
            None => unfit(format!("there is no body \"{name}\"")),
            Some(entry) if entry.soft => unfit(format!("the body \"{name}\" is particles: no {what} holds it")),
            Some(_) => Ok(()),
        }
    }

    fn joint(&self, joint: u32) -> Result<&JointKind, EditError> {
        match self.joints.get(joint as usize) {
            Some(Some(kind)) => Ok(kind),
            Some(None) => unfit(format!("the joint {joint} was taken away")),
            None => unfit(format!("there is no joint {joint}")),
        }
    }
}

fn motor_fits(kind: &JointKind, motor: Option<Motor>) -> Result<(), EditError> {
    if !matches!(kind, JointKind::Hinge { .. } | JointKind::Slider { .. }) {
        return unfit("only a hinge or a slider has a motor");
    }
    match motor {
        Some(motor) if !(motor.speed.is_finite() && motor.max_torque >= 0.0) => {
            unfit("a motor needs a finite speed, and a torque or force that is not negative")
        }
        _ => Ok(()),
    }
}

fn values(change: &BodyChange) -> Result<(), EditError> {
    let checks = [
        ("mass", change.mass, f64::MIN_POSITIVE, f64::MAX),
        ("friction", change.friction, 0.0, f64::MAX),
        ("rolling_friction", change.rolling_friction, 0.0, f64::MAX),
        ("restitution", change.restitution, 0.0, 1.0),
        ("surface_speed", change.surface_speed, f64::MIN, f64::MAX),
        ("gravity_factor", change.gravity_factor, f64::MIN, f64::MAX),
        ("linear_damping", change.linear_damping, 0.0, f64::MAX),
        ("angular_damping", change.angular_damping, 0.0, f64::MAX),
    ];
    for (what, value, least, most) in checks {
        if let Some(value) = value {
            finite(what, 0, value)?;
            if !(least..=most).contains(&value) {
                let reason = format!("is {value}: too small or too large");
                return Err(EditError::Value { what, index: 0, reason });
            }
        }
    }
    Ok(())
}
