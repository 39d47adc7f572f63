//! A body that a pointer drags: a damped spring between the point it was taken at and the pointer.

use unipbd_core::math::direction;
use unipbd_core::rigid::{Body, BodyKind};
use unipbd_core::step::Solid;
use unipbd_core::{Solver, SubstepView, Vector64};

/// Angular frequency of the spring [rad/s]: it follows a pointer in about a quarter of a second, and a substep of a
/// sixtieth of a second resolves it.
const STIFFNESS: f64 = 14.0;

/// A spring that holds a body.
#[derive(Clone, Copy, Debug)]
pub struct Hand {
    body: u32,
    /// The point it was taken at, in body coordinates \[m].
    anchor: Vector64,
    /// Where the pointer is \[m].
    pub target: Vector64,
}

impl Hand {
    /// Takes hold of the body at a point, if one that can move is there.
    pub fn at(solver: &Solver, point: Vector64) -> Option<Hand> {
        let moves = |id: u32| solver.bodies().get(id as usize).is_some_and(|body| body.kind == BodyKind::Dynamic);
        let held = solver.query().without_walls().at(point).into_iter().find_map(|solid| match solid {
            Solid::Body(body) if moves(body) => Some(body),
            Solid::Body(_) | Solid::Wall(_) => None,
        })?;
        let body = &solver.bodies()[held as usize];
        let anchor = direction(-body.angle).rotate(point - body.position);
        Some(Hand { body: held, anchor, target: point })
    }

    /// The number of the body.
    pub fn body(&self) -> u32 {
        self.body
    }

    /// Applies its force in a substep.
    pub fn pull(&self, substep: &mut SubstepView<'_>) {
        let (pose, velocity) = (substep.body_pose(self.body), substep.body_velocity(self.body));
        let arm = direction(pose.angle).rotate(self.anchor);
        let point = pose.position + arm;
        let speed = velocity.linear + velocity.angular * arm.perp();
        let mass = felt_mass(&substep.bodies()[self.body as usize], arm);
        let pull = (self.target - point) * (STIFFNESS * STIFFNESS) - speed * (2.0 * STIFFNESS);
        substep.push_body_at(self.body, pull * mass, point);
    }
}

/// The least mass that a force at the end of an arm can feel \[kg]: with it the spring is damped critically or more.
fn felt_mass(body: &Body, arm: Vector64) -> f64 {
    let turning = if body.inertia > 0.0 { arm.length_squared() / body.inertia } else { 0.0 };
    1.0 / (1.0 / body.mass + turning)
}
