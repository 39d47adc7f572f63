//! Bodies from a saved state: what the scene decides is kept from the run, what a run changes is checked.

use super::{Bodies, Body, InverseMass, Twist};

impl Bodies {
    /// These bodies at the moment of a saved state; `None` if the state makes no sense.
    pub(crate) fn at_saved(&self, saved: Bodies) -> Option<Bodies> {
        let finite = |twist: &Twist| twist.linear.is_finite() && twist.angular.is_finite();
        let twists = [&saved.velocities, &saved.displacements, &saved.contact_loads, &saved.fluid_loads];
        let driven = saved.scripts.iter().all(|script| script.driven.as_ref().is_none_or(finite));
        let placed = saved.poses.iter().all(|pose| pose.position.is_finite() && pose.angle.is_finite());
        let seen = saved.views.iter().all(is_finite);
        let moving = twists.into_iter().flatten().all(finite);
        // Only what contacts can move falls asleep.
        let sleeping =
            (0..self.len()).all(|id| !saved.asleep.get(id).is_some_and(|&asleep| asleep) || self.is_dynamic(id));
        if !(saved.is_like(self) && driven && placed && seen && moving && sleeping) {
            return None;
        }
        let mut taken = self.clone();
        for (mine, script) in taken.scripts.iter_mut().zip(&saved.scripts) {
            mine.driven = script.driven;
        }
        (0..taken.len()).for_each(|id| taken.find_mover(id));
        for ((mine, view), matched) in taken.views.iter_mut().zip(saved.views).zip(&self.matched) {
            take_motion(mine, view, matched.is_some());
        }
        let response = |(&asleep, &awake): (&bool, &InverseMass)| if asleep { InverseMass::default() } else { awake };
        taken.inverse_masses = saved.asleep.iter().zip(&self.awake_responses).map(response).collect();
        (taken.poses, taken.velocities, taken.displacements) = (saved.poses, saved.velocities, saved.displacements);
        (taken.contact_loads, taken.fluid_loads) = (saved.contact_loads, saved.fluid_loads);
        (taken.asleep, taken.pushed) = (saved.asleep, saved.pushed);
        Some(taken)
    }
}

/// Takes over the state that a run changes of a body as it is seen from outside.
fn take_motion(mine: &mut Body, saved: Body, bends: bool) {
    (mine.position, mine.angle) = (saved.position, saved.angle);
    (mine.velocity, mine.angular_velocity) = (saved.velocity, saved.angular_velocity);
    (mine.fluid_force, mine.fluid_torque) = (saved.fluid_force, saved.fluid_torque);
    (mine.contact_force, mine.contact_torque) = (saved.contact_force, saved.contact_torque);
    mine.asleep = saved.asleep;
    if bends {
        mine.outline = saved.outline;
    }
}

fn is_finite(body: &Body) -> bool {
    let vectors = [body.position, body.velocity, body.fluid_force, body.contact_force];
    let numbers = [body.angle, body.angular_velocity, body.fluid_torque, body.contact_torque];
    vectors.iter().chain(&body.outline).all(|vector| vector.is_finite()) && numbers.into_iter().all(f64::is_finite)
}
