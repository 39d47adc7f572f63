//! Contacts and joints of rigid bodies, solved on the displacements of a substep.
//!
//! Contacts are constraints on the displacement u of a substep, warm started with the impulses of the
//! last one and solved by Gauss-Seidel sweeps, there and back, over-relaxed; or by Jacobi sweeps in
//! which a body's mass is split among its contacts (Tonge et al. 2012, "Mass splitting for jitter-free parallel rigid
//! body simulation"). Overlap never becomes velocity: a separate pass removes it from the positions. A substep calls, in
//! this order:
//!
//! 1. [`Contacts::begin_substep`] finds the contacts, once per frame unless a body leaves its prediction,
//! 2. [`Bodies::predict`] and [`Contacts::warm_start`],
//! 3. [`Contacts::iterate`], before and again after the fluid has pushed the bodies,
//! 4. [`Bodies::integrate`],
//! 5. [`Contacts::restitute`] and [`Contacts::depenetrate`];
//!
//! a frame ends with [`Contacts::finish_frame`] and [`Bodies::finish_frame`].

mod anchored;
mod block;
mod blocks;
mod bounds;
mod broad;
mod collide;
mod complementarity;
mod contact_block;
mod contact_cache;
mod contact_set;
mod exposure;
mod finish;
mod frames;
mod in_place;
mod islands;
mod jacobi;
mod joint;
mod joint_set;
mod lanes;
mod linked;
mod loads;
mod manifold;
mod narrow_phase;
mod opening;
mod pair;
mod pair_contacts;
mod pairs;
mod pieces;
mod push;
mod reach;
mod rebound;
mod relaxation;
mod rows;
mod saved;
mod settings;
mod solver;
mod step_context;
mod substep;
mod sweep;
mod touch;
mod waking;
mod watch;

pub use islands::SleepSettings;
pub use joint::{DistanceRule, Joint, JointKind, JointState, Limits, Motor, Strength};
pub use settings::{ContactSettings, Depenetration};
pub use watch::{ContactEvent, ContactPair};

pub(crate) use linked::Linked;
pub(crate) use manifold::{Contact, entry};
pub(crate) use push::Push;
pub(crate) use solver::{ContactSolver, Split};
pub(crate) use sweep::Sweep;

use crate::math::Vector64;
use crate::parallel::Parallelism;
use crate::rigid::Wall;
use crate::rigid::{Bodies, HeldRow, InverseMass, Twist};
use crate::scene::ContactMethod;
use blocks::Blocks;
use bounds::NONE;
use contact_cache::{ContactCache, Point};
use islands::Islands;
use jacobi::Jacobi;
use narrow_phase::NarrowPhase;
use solver::InTurn;
use std::sync::Arc;
use step_context::StepContext;
use watch::Watch;

/// The contacts and joints of all bodies: solver state that lasts from substep to substep.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub struct Contacts {
    settings: ContactSettings,
    /// Whether a call of [`Contacts::iterate`] sweeps once, whatever the settings say.
    #[serde(skip)]
    once: bool,
    #[serde(skip, default = "in_turn")]
    solver: Arc<dyn ContactSolver>,
    narrow_phase: NarrowPhase,
    joints: Vec<Linked>,
    /// Joints that broke in the last frame.
    broke: Vec<u32>,
    #[serde(skip)]
    watch: Watch,
    islands: Islands,
    jacobi: Jacobi,
    blocks: Blocks,
    split: Vec<InverseMass>,
    /// Inverse masses for contacts; empty if they equal those of the bodies.
    scaled: Vec<InverseMass>,
    counts: Vec<u32>,
    corrections: Vec<Twist>,
    wall_impulses: Vec<Vector64>,
    wall_forces: Vec<Vector64>,
    #[serde(skip)]
    wall_names: Vec<String>,
    /// Whether a contact rebounds in this substep.
    #[serde(skip)]
    rebounding: bool,
    /// Whether the first sweep of this substep goes through the contacts from the last to the first.
    backward: bool,
    /// Sweeps of this substep so far.
    #[serde(skip)]
    swept: u32,
    /// Whether particles push the bodies between the two calls of [`Contacts::iterate`] of a substep.
    #[serde(skip)]
    among_particles: bool,
    dt: f64,
    #[serde(skip)]
    moment: StepContext,
    warm_factor: f64,
    gravity: f64,
    up: Vector64,
}

/// Readable data of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// First body.
    pub body: u32,
    /// Second body; `None` for a contact with a wall.
    pub other: Option<u32>,
    /// The wall; `None` for a contact of two bodies.
    pub wall: Option<u32>,
    /// From the centre of mass of the first body to the point \[m].
    pub arm: Vector64,
    /// The point, at the poses of the end of the frame \[m]; only where [`Solver::contacts`](crate::Solver::contacts) tells
    /// it.
    pub position: Vector64,
    /// Unit normal, towards the first body.
    pub normal: Vector64,
    /// Distance of the surfaces at the start of the last substep, negative when they overlap \[m].
    pub gap: f64,
    /// Normal force on the first body over the last substep \[N].
    pub normal_force: f64,
    /// Friction force on the first body, along the normal turned left \[N].
    pub friction_force: f64,
}

impl Contacts {
    /// An empty set of contacts between bodies and these walls.
    pub fn new(walls: &[Wall], settings: ContactSettings) -> Contacts {
        Contacts {
            solver: match settings.method {
                ContactMethod::GaussSeidel => in_turn(),
                ContactMethod::SplitJacobi => Arc::new(Split),
            },
            settings,
            once: false,
            narrow_phase: NarrowPhase::new(walls, settings.friction_rule),
            joints: Vec::new(),
            broke: Vec::new(),
            watch: Watch::default(),
            islands: Islands::default(),
            jacobi: Jacobi::default(),
            blocks: Blocks::default(),
            split: Vec::new(),
            scaled: Vec::new(),
            counts: Vec::new(),
            corrections: Vec::new(),
            wall_impulses: vec![Vector64::ZERO; walls.len()],
            wall_forces: vec![Vector64::ZERO; walls.len()],
            wall_names: walls.iter().map(|wall| wall.name.clone()).collect(),
            rebounding: false,
            backward: false,
            swept: 0,
            among_particles: false,
            dt: 0.0,
            moment: StepContext::default(),
            warm_factor: 1.0,
            gravity: 0.0,
            up: Vector64::ZERO,
        }
    }

    /// The same, with another contact solver.
    pub(crate) fn solved_by(self, solver: Arc<dyn ContactSolver>) -> Contacts {
        Contacts { solver, ..self }
    }

    /// From now on the search and the sweeps may run on the pool of the caller, or may not.
    pub(crate) fn run_on(&mut self, parallelism: Parallelism) {
        self.narrow_phase.parallelism = parallelism;
        self.jacobi.parallelism = parallelism;
    }

    /// Whether particles push the bodies from now on.
    pub(crate) fn meet_particles(&mut self, among_particles: bool) {
        self.among_particles = among_particles;
    }

    /// Ends a frame of length `frame_time` \[s]: mean forces on walls, and sleep. Call it before
    /// [`Bodies::finish_frame`].
    pub fn finish_frame(&mut self, bodies: &mut Bodies, frame_time: f64) {
        self.blocks.give_loads(&mut bodies.contact_loads, &mut self.wall_impulses);
        // Sleeping bodies load their supports as they did when they fell asleep.
        for (contact, cache) in self.narrow_phase.frozen() {
            let push = contact.total_push(cache, 1.0);
            if contact.is_pressed() {
                self.watch.add(contact, cache.wall, push.linear * frame_time);
            }
            if cache.wall != NONE {
                self.wall_impulses[cache.wall as usize] -= push.linear * frame_time;
            }
            for (body, load) in [(contact.a, push.on_a()), (contact.b, push.on_b().scaled(-1.0))] {
                if body != NONE && !bodies.is_dynamic(body as usize) {
                    bodies.contact_loads[body as usize] += load.scaled(frame_time);
                }
            }
        }
        self.finish_joints(frame_time);
        self.watch.finish_frame(bodies);
        for (force, impulse) in self.wall_forces.iter_mut().zip(&mut self.wall_impulses) {
            *force = std::mem::take(impulse) / frame_time;
        }
        self.narrow_phase.begin_frame(frame_time);
        if let Some(settings) = self.settings.sleep {
            // Without sleep they stay in the lanes until they are read.
            self.note_impulses();
            let fell_asleep = self.islands.sleep(
                bodies,
                self.narrow_phase.contacts(),
                &self.joints,
                &settings,
                (frame_time, self.gravity),
            );
            if fell_asleep {
                self.narrow_phase.freeze(bodies, self.dt);
            }
        }
    }

    /// Puts bodies to sleep, those that touch each other as one island.
    pub(crate) fn put_to_sleep(&mut self, bodies: &mut Bodies, falling_asleep: &[u32]) {
        if !falling_asleep.is_empty() {
            self.note_impulses();
            self.islands.resize(bodies.len());
            self.islands.put_to_sleep(bodies, falling_asleep, self.narrow_phase.contacts(), &self.joints);
            self.narrow_phase.freeze(bodies, self.dt);
        }
    }

    /// Pairs of bodies that act on each other through contacts or joints.
    pub(crate) fn linked(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.pressed()
            .chain(self.joints.iter().filter(|linked| linked.is_live()).map(Linked::bodies))
            .filter(|&(_, b)| b != NONE)
    }

    /// The bodies of the contacts that carry a load.
    pub(crate) fn pressed(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.noted().map(|(contact, _)| contact).filter(Contact::is_pressed).map(|contact| (contact.a, contact.b))
    }

    /// The contacts with the impulses and gaps that they have so far, also where only lanes have them.
    fn noted(&self) -> impl Iterator<Item = (Contact, &ContactCache)> + '_ {
        let in_lanes = self.in_lanes();
        let rows = self.narrow_phase.contacts().iter().zip(self.narrow_phase.caches()).enumerate();
        rows.map(move |(number, (contact, cache))| {
            let mut noted = *contact;
            self.blocks.give_back_to(number, &mut noted, in_lanes);
            (noted, cache)
        })
    }

    /// Whether lanes hold impulses that the contacts do not have yet.
    pub(crate) fn lacks_impulses(&self) -> bool {
        self.blocks.live
    }

    /// The rows of the contacts that carry a load, as of [`Contacts::note_impulses`].
    pub(crate) fn held_rows(&self) -> impl Iterator<Item = HeldRow> + '_ {
        self.narrow_phase.contacts().iter().flat_map(|contact| {
            let (n, pressed) = (contact.normal, |point: &&Point| point.normal_impulse > 0.0);
            contact.points().iter().filter(pressed).map(move |point| HeldRow {
                sides: [(contact.a, [n.x, n.y, point.normal_a]), (contact.b, [-n.x, -n.y, -point.normal_b])],
                softness: 0.0,
            })
        })
    }

    /// Whether no substep has been taken.
    pub(crate) fn is_fresh(&self) -> bool {
        self.dt == 0.0
    }

    /// Force of the bodies on each wall over the last frame, mean \[N]; in the order of the walls.
    pub fn wall_forces(&self) -> &[Vector64] {
        &self.wall_forces
    }

    /// Mean force of the bodies over the last frame on the walls of this name \[N].
    pub(crate) fn wall_force(&self, name: &str) -> Vector64 {
        let named = self.wall_names.iter().zip(&self.wall_forces).filter(|(of, _)| *of == name);
        named.map(|(_, force)| *force).sum()
    }

    /// The contacts of the last substep between bodies that were awake.
    pub fn points(&self) -> impl Iterator<Item = ContactPoint> + '_ {
        let index = |index: u32| (index != NONE).then_some(index);
        let read = move |contact: &Contact, cache: &ContactCache, k: usize| {
            let point = &contact.points()[k];
            ContactPoint {
                body: contact.a,
                other: index(contact.b),
                wall: index(cache.wall),
                arm: contact.arm_a(point),
                position: Vector64::ZERO,
                normal: contact.normal,
                gap: point.gap,
                normal_force: point.normal_impulse / (self.dt * self.dt) + cache.rebound[k].normal / self.dt,
                friction_force: point.tangent_impulse / (self.dt * self.dt) + cache.rebound[k].tangent / self.dt,
            }
        };
        self.noted()
            .flat_map(move |(contact, cache)| (0..contact.points().len()).map(move |k| read(&contact, cache, k)))
    }
}

fn in_turn() -> Arc<dyn ContactSolver> {
    Arc::new(InTurn)
}

/// The inverse masses for contacts: the scaled ones, if there are any.
fn seen<'a>(scaled: &'a [InverseMass], own: &'a [InverseMass]) -> &'a [InverseMass] {
    if scaled.is_empty() { own } else { scaled }
}
