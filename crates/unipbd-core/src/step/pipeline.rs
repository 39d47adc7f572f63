//! The stages of a substep: the page to read first.

/// One stage of a substep. A scene runs only those it needs, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Emitters move their rows, let particles go and add new ones.
    Emit,
    /// Velocities take up the body forces, positions are predicted.
    Predict,
    /// A grid takes the smooth part of the pressure.
    CoarseProjection,
    /// Bodies are predicted; their contacts and joints are found and solved once; samples follow.
    Contacts,
    /// The neighbour list is made valid for the predicted positions.
    FindNeighbors,
    /// Constraint groups prepare for the substep.
    BeginGroups,
    /// Constraint groups move particles, one after the other, each from one state.
    Project,
    /// Contacts and joints are solved again, now that the fluid has pushed the bodies.
    ContactsAgain,
    /// Velocities follow from the displacements.
    UpdateVelocities,
    /// Bodies take up pose and velocity, rebound, and are moved out of each other.
    MoveBodies,
    /// Groups that asked for it change the velocities.
    FinishGroups,
    /// Viscosity, drag, vorticity, heat.
    Effects,
    /// Smoke moves with its carrier.
    AdvectSmoke,
    /// Once per frame, at its end, where liquids may: what is at rest falls asleep, what is disturbed wakes.
    Sleep,
}

impl Stage {
    /// The name under which the stage is timed and shown.
    pub const fn name(self) -> &'static str {
        match self {
            Stage::Emit => "emit",
            Stage::Predict => "predict",
            Stage::CoarseProjection => "coarse_projection",
            Stage::Contacts => "contacts",
            Stage::FindNeighbors => "find_neighbors",
            Stage::BeginGroups => "begin_groups",
            Stage::Project => "project",
            Stage::ContactsAgain => "contacts_again",
            Stage::UpdateVelocities => "update_velocities",
            Stage::MoveBodies => "move_bodies",
            Stage::FinishGroups => "finish_groups",
            Stage::Effects => "effects",
            Stage::AdvectSmoke => "advect_smoke",
            Stage::Sleep => "sleep",
        }
    }
}

/// What decides which stages a scene runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Features {
    pub emitters: bool,
    pub coarse: bool,
    pub bodies: bool,
    pub neighbors: bool,
    pub groups: bool,
    /// Groups, or walls that anything can run into.
    pub projection: bool,
    pub velocity_passes: bool,
    pub effects: bool,
    pub smoke: bool,
}

/// The stages of a substep with these features. Decided when a scene is built or changed, not asked
/// per particle and step: what a scene does not use is not in its list.
pub(super) fn pipeline(features: Features) -> Vec<Stage> {
    let stages = [
        (Stage::Emit, features.emitters),
        (Stage::Predict, true),
        (Stage::CoarseProjection, features.coarse),
        (Stage::Contacts, features.bodies),
        (Stage::FindNeighbors, features.neighbors),
        (Stage::BeginGroups, features.groups),
        (Stage::Project, features.projection),
        (Stage::ContactsAgain, features.bodies),
        (Stage::UpdateVelocities, true),
        (Stage::MoveBodies, features.bodies),
        (Stage::FinishGroups, features.velocity_passes),
        (Stage::Effects, features.effects),
        (Stage::AdvectSmoke, features.smoke),
    ];
    stages.into_iter().filter_map(|(stage, needed)| needed.then_some(stage)).collect()
}
