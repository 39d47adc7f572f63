//! Liquids at rest: blocks of liquid that have hardly moved for a while are held in place until
//! there is motion near them.
//!
//! The plane is cut into square blocks. Connected blocks of liquid, and of bodies in it, fall asleep
//! together once their particles have moved by less than [`STILL`] spacings in the mean for some
//! time, and in no block by more than [`ROUGH`]. A sleeping block wakes when a block around it is rough:
//! motion spreads by one block per frame, or by its distance at the current speed if that is larger. Sleeping
//! blocks adjacent to awake blocks still have a pressure, so that they respond to awake particles.
//!
//! The state consists of two columns: the rest position of each particle, and its rest time. Blocks are
//! rebuilt in each frame, from the awake rows.

mod blocks;

use crate::math::{Real, Vector, Vector64, real};
use crate::particles::Particles;
use crate::periodic::Periodic;
use crate::phase::Phase;
use crate::scene::Scene;
use blocks::{Blocks, Key, Layout};
use std::ops::Range;

/// Side of a block in spacings.
const BLOCK: f64 = 8.0;
/// Mean displacement, in spacings, up to which connected blocks are at rest...
const STILL: f64 = 0.05;
/// ...that of each of them...
const ROUGH: f64 = 0.1;
/// ...and that of any particle.
const FAR: f64 = 1.0;
/// How long they must have been at rest, in frames...
const FRAMES: f64 = 30.0;
/// ...and in the time of a fall by half a spacing: a liquid that has just begun to fall is not at rest.
const FALLS: f64 = 7.0;
/// Upper limit of the wake distance, in blocks.
const FARTHEST: i32 = 16;

/// Puts liquid to sleep and wakes it.
pub(crate) struct LiquidSleep {
    layout: Layout,
    still: f64,
    rough: f64,
    far: Real,
    frame_time: Real,
    delay: Real,
    blocks: Blocks,
    /// The blocks of sleeping rows, sorted, and the sleeping blocks adjacent to awake ones.
    sleeping: Vec<Key>,
    border: Vec<Key>,
    last_border: Vec<Key>,
    /// Whether these match the rows.
    known: bool,
    /// Blocks to be woken, and blocks to be put to sleep.
    waking: Vec<Key>,
    falling_asleep: Vec<Key>,
    order: Vec<u32>,
}

/// How long liquid must have been at rest before it sleeps \[s].
fn delay(scene: &Scene) -> f64 {
    let gravity = Vector64::from(scene.gravity).length();
    let fall = if gravity > 0.0 { FALLS * (scene.spacing / gravity).sqrt() } else { 0.0 };
    fall.max(FRAMES / scene.fps)
}

impl LiquidSleep {
    /// The sleep rules of a scene, or `None` if the scene does not enable sleep.
    pub fn new(scene: &Scene, periodic: Periodic) -> Option<Self> {
        let spacings = |count: f64| real(count * scene.spacing);
        scene.solver.sleep.then(|| LiquidSleep {
            layout: Layout::new(spacings(BLOCK), periodic),
            still: STILL * scene.spacing,
            rough: ROUGH * scene.spacing,
            far: spacings(FAR),
            frame_time: real(1.0 / scene.fps),
            delay: real(delay(scene)),
            blocks: Blocks::default(),
            sleeping: Vec::new(),
            border: Vec::new(),
            last_border: Vec::new(),
            known: false,
            waking: Vec::new(),
            falling_asleep: Vec::new(),
            order: Vec::new(),
        })
    }

    /// Invalidates the blocks: the rows were changed outside of this module.
    pub fn forget(&mut self) {
        self.known = false;
    }

    /// Ends a frame: selects the blocks that wake and fall asleep. `may` is whether the sample of this id may sleep.
    pub fn decide(&mut self, particles: &mut Particles, may: impl Fn(u32) -> bool) {
        self.know(particles);
        self.measure(particles, may);
        self.note_rest(particles);
        self.find_waking();
        self.find_falling_asleep();
    }

    /// Selects the sleeping blocks near some points to wake, and no other blocks.
    pub fn wake_near(&mut self, points: &[Vector], particles: &Particles) {
        self.know(particles);
        self.blocks.clear();
        particles.position[..particles.awake()].iter().for_each(|&position| {
            self.blocks.at(self.layout.key(position));
        });
        self.falling_asleep.clear();
        self.waking.clear();
        for &point in points {
            self.layout.around(self.layout.key(point), 1, |key| keep_if(&self.sleeping, key, &mut self.waking));
        }
        tidy(&mut self.waking);
    }

    /// Whether a sleeping row at this point is about to wake.
    pub fn is_waking(&self, point: Vector) -> bool {
        holds(&self.waking, self.layout.key(point))
    }

    /// Adds the sleeping block of a point to the blocks to wake.
    pub fn wake_also(&mut self, point: Vector) {
        let key = self.layout.key(point);
        if let (true, Err(place)) = (holds(&self.sleeping, key), self.waking.binary_search(&key)) {
            self.waking.insert(place, key);
        }
    }

    /// Finds the blocks of the sleeping rows.
    fn know(&mut self, particles: &Particles) {
        if self.known {
            return;
        }
        let blocks = |rows: Range<usize>, keys: &mut Vec<Key>| {
            keys.clear();
            keys.extend(particles.position[rows].iter().map(|&position| self.layout.key(position)));
            tidy(keys);
        };
        blocks(particles.awake()..particles.dense(), &mut self.sleeping);
        blocks(particles.awake()..particles.listed(), &mut self.border);
        self.known = true;
    }

    /// Measures the motion of the awake rows, block by block.
    fn measure(&mut self, particles: &Particles, may: impl Fn(u32) -> bool) {
        self.blocks.clear();
        for row in 0..particles.awake() {
            let position = particles.position[row];
            let moved = self.layout.periodic.min_image(position - particles.anchor[row]).length();
            let block = self.blocks.at(self.layout.key(position));
            block.count += 1;
            block.moved += f64::from(moved);
            block.farthest = block.farthest.max(moved);
            block.rest = block.rest.min(particles.rest[row]);
            block.speed = block.speed.max(particles.velocity[row].length());
            block.sleepy &= match particles.phase[row] {
                Phase::Liquid => particles.inverse_mass[row] > 0.0,
                phase => phase == Phase::Rigid && may(particles.id[row]),
            };
        }
        for (_, block) in self.blocks.all_mut() {
            block.rough = block.mean() > self.rough || block.farthest > self.far;
        }
        self.blocks.connect(&self.layout);
    }

    /// Rest restarts for all particles in a rough block, and in a connected set that is not still.
    fn note_rest(&mut self, particles: &mut Particles) {
        for row in 0..particles.awake() {
            let position = particles.position[row];
            let (block, whole) = self.blocks.with_whole(self.layout.key(position));
            if block.rough || whole.mean() > self.still {
                (particles.anchor[row], particles.rest[row]) = (position, 0.0);
            } else {
                particles.rest[row] += self.frame_time;
            }
        }
    }

    /// Wakes sleeping blocks near a rough block, within the distance of its fastest particle in a frame.
    fn find_waking(&mut self) {
        self.waking.clear();
        if self.sleeping.is_empty() {
            return;
        }
        for &(center, block) in self.blocks.all() {
            if block.rough {
                let reach = 1 + (block.speed * self.frame_time / self.layout.side()).min(FARTHEST as Real) as i32;
                self.layout.around(center, reach, |key| keep_if(&self.sleeping, key, &mut self.waking));
            }
        }
        tidy(&mut self.waking);
    }

    /// Connected blocks that have been at rest long enough fall asleep.
    fn find_falling_asleep(&mut self) {
        self.falling_asleep.clear();
        for (place, &(key, _)) in self.blocks.all().iter().enumerate() {
            let whole = self.blocks.whole(place);
            let calm = whole.sleepy && !whole.rough && whole.mean() <= self.still;
            if calm && whole.rest + self.frame_time >= self.delay {
                self.falling_asleep.push(key);
            }
        }
        self.falling_asleep.sort_unstable();
    }

    /// The sleeping blocks adjacent to awake ones.
    fn find_border(&mut self) {
        self.sleeping.retain(|&key| !holds(&self.waking, key));
        self.sleeping.extend_from_slice(&self.falling_asleep);
        tidy(&mut self.sleeping);
        self.border.clear();
        let (layout, sleeping, border) = (&self.layout, &self.sleeping, &mut self.border);
        let awake = self.blocks.all().iter().map(|&(key, _)| key).filter(|&key| !holds(&self.falling_asleep, key));
        for center in awake.chain(self.waking.iter().copied()) {
            layout.around(center, 1, |key| keep_if(sleeping, key, border));
        }
        tidy(border);
    }

    /// The new order of the dense rows, if it differs.
    pub fn plan(&mut self, particles: &Particles) -> Option<Plan<'_>> {
        std::mem::swap(&mut self.border, &mut self.last_border);
        self.find_border();
        if self.waking.is_empty() && self.falling_asleep.is_empty() && self.border == self.last_border {
            return None;
        }
        let (awake, dense) = (particles.awake(), particles.dense());
        let within =
            |keys: &[Key], row: u32| !keys.is_empty() && holds(keys, self.layout.key(particles.position[row as usize]));
        let (now_awake, now_asleep) = (0..awake as u32, awake as u32..dense as u32);
        self.order.clear();
        self.order.extend(now_awake.clone().filter(|&row| !within(&self.falling_asleep, row)));
        let stayed = self.order.len();
        self.order.extend(now_asleep.clone().filter(|&row| within(&self.waking, row)));
        let awake = self.order.len();
        let sleeping = now_asleep.filter(|&row| !within(&self.waking, row));
        let sleeping = sleeping.chain(now_awake.filter(|&row| within(&self.falling_asleep, row)));
        self.order.extend(sleeping.clone().filter(|&row| within(&self.border, row)));
        let border = self.order.len() - awake;
        self.order.extend(sleeping.filter(|&row| !within(&self.border, row)));
        Some(Plan { order: &self.order, woken: stayed..awake, awake, border })
    }
}

/// The rows that sleep from now on.
pub(crate) struct Plan<'a> {
    /// The dense rows in their new order: those awake, those asleep near them, all others.
    pub order: &'a [u32],
    /// Number of rows awake.
    pub awake: usize,
    /// Number of rows asleep near them.
    pub border: usize,
    /// Rows that were asleep before, in the new order.
    woken: Range<usize>,
}

impl Plan<'_> {
    /// Stops sleeping rows, and restarts the rest of woken rows. Call it with the rows in their
    /// new order.
    pub fn settle(&self, particles: &mut Particles) {
        for row in self.woken.clone() {
            (particles.anchor[row], particles.rest[row]) = (particles.position[row], 0.0);
        }
        let sleeping = self.awake..particles.dense();
        particles.velocity[sleeping.clone()].fill(Vector::ZERO);
        particles.displacement[sleeping].fill(Vector::ZERO);
    }
}

fn tidy(keys: &mut Vec<Key>) {
    keys.sort_unstable();
    keys.dedup();
}

fn holds(keys: &[Key], key: Key) -> bool {
    keys.binary_search(&key).is_ok()
}

fn keep_if(sleeping: &[Key], key: Key, kept: &mut Vec<Key>) {
    if holds(sleeping, key) {
        kept.push(key);
    }
}
