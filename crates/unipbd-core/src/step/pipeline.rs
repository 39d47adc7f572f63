//! The stages of a frame and of its substeps: the entry point for readers.

/// One stage. A scene runs only the stages it needs, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// Once per frame, at its start: removes particles past their lifetime or outside the domain.
    Remove,
    /// Emitters move their rows, release particles and add new ones.
    Emit,
    /// Applies body forces to the velocities and predicts the positions.
    Predict,
    /// Searches the contacts of bodies, once per frame if they move as predicted, predicts the bodies, and solves
    /// contacts and joints once.
    Contacts,
    /// Wakes the liquid around bodies that were woken.
    WakeAroundBodies,
    /// Projects the velocities of fluids and bodies on a grid, which carries the smooth part of the pressure.
    PressureGrid,
    /// Adds the forces of the grid's pressure on the measured walls.
    GridWallForces,
    /// Moves the samples of bodies to the predicted poses.
    PlaceSamples,
    /// Makes the neighbour list valid for the predicted positions.
    FindNeighbors,
    /// Constraint groups prepare for the substep.
    BeginGroups,
    /// Constraint groups move particles, one after the other, each from one state; after each of them
    /// their corrections are applied.
    Project,
    /// Without groups: keeps particles out of walls, by the same steps.
    KeepOutOfWalls,
    /// Stores the density errors and multipliers by particle.
    StoreDensity,
    /// In the last substep of a frame: adds the pressure of the grid to the multipliers, which are read as pressures.
    AddGridPressure,
    /// Solves contacts and joints again, after the fluid has pushed the bodies.
    ContactsAgain,
    /// Velocities follow from the displacements.
    UpdateVelocities,
    /// Sets pose and velocity of bodies, applies restitution, removes overlap.
    MoveBodies,
    /// Moves the samples of bodies to their poses.
    SettleSamples,
    /// Velocity changes by groups that request this stage.
    FinishGroups,
    /// Makes the neighbour list valid for the projected positions, for effects and smoke.
    RefreshNeighbors,
    /// Viscosity, drag, vorticity, heat.
    Effects,
    /// Smoke moves with its carrier.
    AdvectSmoke,
    /// Once per frame, at its end: liquid at rest falls asleep, disturbed liquid wakes.
    Sleep,
    /// Once per frame, at its end: the bodies' forces, sleep and poses of bodies made of particles.
    FinishBodies,
}

impl Stage {
    /// The name of the stage in timings and output.
    pub const fn name(self) -> &'static str {
        match self {
            Stage::Remove => "remove",
            Stage::Emit => "emit",
            Stage::Predict => "predict",
            Stage::PressureGrid => "pressure_grid",
            Stage::GridWallForces => "grid_wall_forces",
            Stage::Contacts => "contacts",
            Stage::WakeAroundBodies => "wake_around_bodies",
            Stage::PlaceSamples => "place_samples",
            Stage::FindNeighbors => "find_neighbors",
            Stage::BeginGroups => "begin_groups",
            Stage::Project => "project",
            Stage::KeepOutOfWalls => "keep_out_of_walls",
            Stage::StoreDensity => "store_density",
            Stage::AddGridPressure => "add_grid_pressure",
            Stage::ContactsAgain => "contacts_again",
            Stage::UpdateVelocities => "update_velocities",
            Stage::MoveBodies => "move_bodies",
            Stage::SettleSamples => "settle_samples",
            Stage::FinishGroups => "finish_groups",
            Stage::RefreshNeighbors => "refresh_neighbors",
            Stage::Effects => "effects",
            Stage::AdvectSmoke => "advect_smoke",
            Stage::Sleep => "sleep",
            Stage::FinishBodies => "finish_bodies",
        }
    }
}

/// One step of applying the corrections of a group, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum CorrectionStep {
    /// Moves that do not change velocities.
    Shift,
    /// Forces on the measured walls, from the corrections and from particles in contact with a wall.
    LoadWalls,
    /// Displacements; particles are kept out of walls.
    Displace,
    /// Forces of the fluid on the bodies.
    LoadBodies,
    /// Fluid particles are pushed out of the bodies.
    PushOut,
}

/// The properties of a scene that decide which stages run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Features {
    pub removal: bool,
    pub emitters: bool,
    pub pressure_grid: bool,
    pub bodies: bool,
    /// Particles move with bodies: their samples, or ends of ropes.
    pub samples: bool,
    pub sleep: bool,
    pub neighbors: bool,
    pub groups: bool,
    pub density: bool,
    pub walls: bool,
    pub measured_walls: bool,
    pub velocity_passes: bool,
    pub effects: bool,
    pub smoke: bool,
}

/// The stages of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// At the start of a frame.
    pub begin: Vec<Stage>,
    /// In each substep.
    pub substep: Vec<Stage>,
    /// At the end of a frame.
    pub end: Vec<Stage>,
    /// After each group of each iteration.
    pub corrections: Vec<CorrectionStep>,
}

impl Plan {
    /// Selects the stages. Called when a scene is built or changed, never within a step.
    pub fn new(with: Features) -> Plan {
        Plan {
            begin: needed([(Stage::Remove, with.removal)]),
            substep: needed([
                (Stage::Emit, with.emitters),
                (Stage::Predict, true),
                (Stage::Contacts, with.bodies),
                (Stage::WakeAroundBodies, with.bodies && with.sleep),
                (Stage::PressureGrid, with.pressure_grid),
                (Stage::GridWallForces, with.pressure_grid && with.measured_walls),
                (Stage::PlaceSamples, with.samples),
                (Stage::FindNeighbors, with.neighbors),
                (Stage::BeginGroups, with.groups),
                (Stage::Project, with.groups),
                (Stage::KeepOutOfWalls, with.walls && !with.groups),
                (Stage::StoreDensity, with.density),
                (Stage::AddGridPressure, with.pressure_grid),
                (Stage::ContactsAgain, with.bodies),
                (Stage::UpdateVelocities, true),
                (Stage::MoveBodies, with.bodies),
                (Stage::SettleSamples, with.samples),
                (Stage::FinishGroups, with.velocity_passes),
                (Stage::RefreshNeighbors, with.neighbors && (with.effects || with.smoke)),
                (Stage::Effects, with.effects),
                (Stage::AdvectSmoke, with.smoke),
            ]),
            end: needed([(Stage::Sleep, with.sleep), (Stage::FinishBodies, with.bodies)]),
            corrections: needed([
                (CorrectionStep::Shift, true),
                (CorrectionStep::LoadWalls, with.measured_walls),
                (CorrectionStep::Displace, true),
                (CorrectionStep::LoadBodies, with.samples),
                (CorrectionStep::PushOut, with.samples && with.neighbors),
            ]),
        }
    }

    /// Whether a group holds the density of fluids.
    pub fn has_density(&self) -> bool {
        self.substep.contains(&Stage::StoreDensity)
    }

    /// Whether the scene keeps a neighbour list.
    pub fn has_neighbors(&self) -> bool {
        self.substep.contains(&Stage::FindNeighbors)
    }
}

fn needed<T, const N: usize>(steps: [(T, bool); N]) -> Vec<T> {
    steps.into_iter().filter_map(|(step, needed)| needed.then_some(step)).collect()
}
