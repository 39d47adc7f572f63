//! Contacts in blocks of four that share no body, for the lanes of a sweep.
//!
//! Contacts that share a body keep their order from block to block, so that a sweep over the blocks moves the bodies as
//! a sweep over the contacts one after the other would: it is the same for every number of lanes and threads. In a large
//! heap contacts stay in their lanes from search to search, and those that come lie behind all others: see
//! [`in_place`](super::in_place).

use super::anchored::{Anchored, any};
use super::bounds::NONE;
use super::contact_block::{Block, Exact, FAR, Lane};
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::opening::{Open, Start};
use super::relaxation::over;
use super::step_context::StepContext;
use crate::math::Real;
use crate::parallel::Parallelism;
use crate::rigid::{Bodies, InverseMass, Twist};
use crate::simd::wide::{WIDE, run};
use rayon::prelude::*;

/// Blocks per task, and the minimum number of blocks for parallel tasks.
pub(super) const CHUNK: usize = 64;
const PARALLEL_FROM: usize = 512;

/// All contacts of a substep in blocks.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Blocks {
    /// Block and lane of each contact, as WIDE x block + lane; [`NONE`] for one that is over.
    pub slots: Vec<u32>,
    /// Bodies at the last ordering, its number of blocks, and the contacts that have come or gone since.
    pub bodies: u32,
    pub ordered: u32,
    pub changes: u32,
    #[serde(skip)]
    pub all: Vec<Block>,
    #[serde(skip)]
    pub anchored: Vec<Anchored>,
    /// Whether the impulses of the lanes are newer than those of the contacts.
    #[serde(skip)]
    pub live: bool,
    /// The contact in each lane, or [`NONE`].
    #[serde(skip)]
    pub holders: Vec<[u32; WIDE]>,
    /// Motion of the bodies: along x and y, rotation, and nothing. The last row is idle.
    #[serde(skip)]
    pub motion: Vec<Exact>,
    #[serde(skip)]
    velocities: Vec<Exact>,
    /// Impulses over the frame on bodies, the idle row, and walls [N s], [N m s].
    #[serde(skip)]
    pub loads: Vec<Exact>,
    #[serde(skip)]
    order: Order,
}

/// Buffers of an ordering.
#[derive(Clone, Default)]
struct Order {
    /// The block after the last one of each body.
    next: Vec<u32>,
    /// Contacts in each block, and a block at or behind it with room.
    filled: Vec<u8>,
    room: Vec<u32>,
}

impl Blocks {
    /// Gives each contact the first block behind those of the contacts before it that share one of its bodies.
    pub fn assign(&mut self, contacts: &[Contact], bodies: &Bodies) {
        let order = &mut self.order;
        order.next.clear();
        order.next.resize(bodies.len(), 0);
        order.filled.clear();
        order.room.clear();
        self.slots.clear();
        self.holders.clear();
        for (contact, number) in contacts.iter().zip(0u32..) {
            // Walls, and bodies that contacts do not move, may be in all lanes at once.
            let moved = |body: &u32| *body != NONE && bodies.is_dynamic(*body as usize);
            let sides = [contact.a, contact.b];
            let first = sides.iter().filter(|body| moved(body)).map(|&body| order.next[body as usize]).max();
            let block = order.find_room(first.unwrap_or(0));
            let lane = order.filled[block as usize];
            self.slots.push(WIDE as u32 * block + u32::from(lane));
            self.holders.resize(order.room.len(), [NONE; WIDE]);
            self.holders[block as usize][usize::from(lane)] = number;
            order.filled[block as usize] += 1;
            if usize::from(lane) + 1 == WIDE {
                order.room[block as usize] = block + 1;
            }
            for body in sides.into_iter().filter(moved) {
                order.next[body as usize] = block + 1;
            }
        }
        (self.bodies, self.ordered, self.changes) = (bodies.len() as u32, self.holders.len() as u32, 0);
        self.lay_out(bodies.len());
    }

    /// Makes the blocks of the lanes that are held.
    pub fn lay_out(&mut self, bodies: usize) {
        // The lanes with a contact are filled in each substep.
        let idle = Block::idle(bodies);
        self.all.resize(self.holders.len(), Block::default());
        for (block, _) in self.all.iter_mut().zip(&self.holders).filter(|(_, holders)| holders.contains(&NONE)) {
            block.clone_from(&idle);
        }
        self.anchored.resize(self.all.len(), Anchored::default());
    }

    /// Whether these are the blocks of so many contacts and bodies.
    pub fn fits(&self, contacts: usize, bodies: usize) -> bool {
        self.slots.len() == contacts && self.bodies as usize == bodies && !self.is_to_be_laid_out()
    }

    /// Block and lane of a contact.
    pub fn slot(&self, contact: usize) -> (usize, usize) {
        (self.slots[contact] as usize / WIDE, self.slots[contact] as usize % WIDE)
    }

    /// Takes the contacts of a search into the lanes, block by block.
    pub fn take(&mut self, contacts: &[Contact], caches: &[ContactCache], masses: &[InverseMass], sizes: &[f64]) {
        for ((block, anchored), holders) in self.all.iter_mut().zip(&mut self.anchored).zip(&self.holders) {
            if holders.contains(&NONE) {
                *anchored = Anchored::default();
            }
            for (lane, &holder) in holders.iter().enumerate().filter(|(_, holder)| **holder != NONE) {
                let contact = (&contacts[holder as usize], &caches[holder as usize]);
                take((block, anchored), lane, contact, (masses, sizes));
            }
            sum_up((block, anchored), holders);
        }
    }

    /// Opens a substep: measures and prepares all contacts at these places, with a part of their impulses, and moves
    /// the bodies by these.
    pub fn open(
        &mut self,
        places: &[Exact],
        velocities: &[Twist],
        (moment, kept): (&StepContext, f64),
        parallelism: Parallelism,
    ) {
        self.velocities.clear();
        if self.anchored.iter().any(|anchored| anchored.slides) {
            self.velocities.extend(rows(velocities));
        }
        let (velocities, motion) = (&self.velocities[..], &mut self.motion[..]);
        let open = |blocks: &mut [Block], anchored: &[Anchored]| {
            run(Open { blocks, anchored, places, velocities, moment, kept });
        };
        let is_parallel = parallelism == Parallelism::Pool && self.all.len() >= PARALLEL_FROM;
        if is_parallel {
            let chunks = self.all.par_chunks_mut(CHUNK).zip(self.anchored.par_chunks(CHUNK));
            chunks.for_each(|(blocks, anchored)| open(blocks, anchored));
        }
        for (blocks, anchored) in self.all.chunks_mut(CHUNK).zip(self.anchored.chunks(CHUNK)) {
            if !is_parallel {
                open(blocks, anchored);
            }
            // The blocks just prepared are still near the processor.
            run(Start { blocks, motion });
        }
        self.live = true;
    }

    /// Fills the lanes with contacts that were prepared one by one, block by block.
    pub fn fill(&mut self, contacts: &[Contact], (masses, sizes): (&[InverseMass], &[f64]), fall: f64) {
        for (block, holders) in self.all.iter_mut().zip(&self.holders) {
            for (lane, &holder) in holders.iter().enumerate().filter(|(_, holder)| **holder != NONE) {
                block.take(lane, &contacts[holder as usize], masses, sizes);
                contacts[holder as usize].fill(block, lane, fall);
            }
            block.rolls = any(&block.rolling_arm);
        }
        self.live = true;
    }

    /// Gives the contacts the impulses of their lanes, and what was measured there; nothing if they have it.
    pub fn give_back(&mut self, contacts: &mut [Contact], with_geometry: bool) {
        if self.live {
            for (number, contact) in contacts.iter_mut().enumerate() {
                self.give_back_to(number, contact, with_geometry);
            }
            self.live = false;
        }
    }

    /// The same for one contact, or a copy of it.
    #[inline(always)]
    pub fn give_back_to(&self, number: usize, contact: &mut Contact, with_geometry: bool) {
        if self.live && self.slots[number] != NONE {
            let (at, lane) = self.slot(number);
            self.all[at].give_impulses(lane, contact);
            if with_geometry {
                self.all[at].give_geometry(lane, contact);
            }
        }
    }

    /// Takes the motion of the bodies.
    pub fn take_motion(&mut self, motion: &[Twist]) {
        self.motion.clear();
        self.motion.extend(rows(motion));
    }

    /// Gives the motion back to the bodies.
    pub fn give_motion(&self, motion: &mut [Twist]) {
        for (of, &[x, y, angular, _]) in motion.iter_mut().zip(&self.motion) {
            (of.linear.x, of.linear.y, of.angular) = (x, y, angular);
        }
    }
}

/// Takes a contact of a search into a lane.
#[inline(always)]
pub(super) fn take(
    (block, anchored): (&mut Block, &mut Anchored),
    lane: usize,
    (contact, cache): (&Contact, &ContactCache),
    (masses, sizes): (&[InverseMass], &[f64]),
) {
    block.take(lane, contact, masses, sizes);
    block.load_on(lane, contact, cache, masses.len());
    anchored.take(lane, contact, cache);
}

/// Notes what holds for any of the lanes.
#[inline(always)]
pub(super) fn sum_up((block, anchored): (&mut Block, &mut Anchored), holders: &[u32; WIDE]) {
    block.rolls = any(&block.rolling_arm);
    anchored.sum_up(holders);
}

impl Order {
    /// The first block with room, at or behind this one.
    fn find_room(&mut self, from: u32) -> u32 {
        let mut block = from;
        loop {
            if block as usize >= self.room.len() {
                self.room.push(block);
                self.filled.push(0);
            }
            let behind = self.room[block as usize];
            if behind == block {
                break;
            }
            block = behind;
        }
        // The next search takes the short way.
        let mut passed = from;
        while passed != block {
            passed = std::mem::replace(&mut self.room[passed as usize], block);
        }
        block
    }
}

/// Rows of the motion of bodies, and the idle one.
fn rows(motion: &[Twist]) -> impl Iterator<Item = Exact> + '_ {
    let row = |of: &Twist| [of.linear.x, of.linear.y, of.angular, 0.0];
    motion.iter().map(row).chain([[0.0; WIDE]])
}

impl Contact {
    /// Fills a lane with what was prepared.
    fn fill(&self, block: &mut Block, lane: usize, fall: f64) {
        let size = f64::from(block.size[lane]);
        let mut set = |of: fn(&mut Block) -> &mut Lane, value: f64| of(block)[lane] = value as Real;
        set(|block| &mut block.normal[0], self.normal.x);
        set(|block| &mut block.normal[1], self.normal.y);
        let mass = &self.effective_mass;
        let (response, inverse, alone) = mass.normal.matrices();
        set(|block| &mut block.friction, mass.friction);
        set(|block| &mut block.belt, mass.belt);
        set(|block| &mut block.over, over(self.is_pressed(), fall, size));
        set(|block| &mut block.turns, if self.points().len() == 2 && mass.friction > 0.0 { 1.0 } else { 0.0 });
        for k in 0..3 {
            (block.response[k][lane], block.inverse[k][lane]) = (response[k] as Real, inverse[k] as Real);
        }
        for (k, alone) in alone.into_iter().enumerate() {
            let point = self.points().get(k).copied().unwrap_or_else(super::contact_cache::Point::absent);
            block.gap[k][lane] = point.gap.min(FAR) as Real;
            (block.normal_a[k][lane], block.normal_b[k][lane]) = (point.normal_a as Real, point.normal_b as Real);
            (block.tangent_a[k][lane], block.tangent_b[k][lane]) = (point.tangent_a as Real, point.tangent_b as Real);
            (block.alone[k][lane], block.tangent[k][lane]) = (alone as Real, mass.tangent[k] as Real);
        }
    }
}
