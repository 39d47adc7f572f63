//! Square blocks of the plane, and their motion statistics.

use crate::math::{Real, Vector};
use crate::periodic::{Periodic, PeriodicAxis};
use std::collections::HashMap;

/// Column and row of a block.
pub(super) type Key = (i32, i32);

/// Layout of the blocks.
pub(super) struct Layout {
    pub periodic: Periodic,
    x: Axis,
    y: Axis,
}

#[derive(Clone, Copy)]
struct Axis {
    inverse: Real,
    /// The period, and the number of blocks in it.
    period: Option<(PeriodicAxis, i32)>,
}

impl Axis {
    fn new(side: Real, periodic: Option<PeriodicAxis>) -> Axis {
        let Some(axis) = periodic else { return Axis { inverse: 1.0 / side, period: None } };
        let count = (axis.length / side).clamp(1.0, 1e9) as i32;
        Axis { inverse: count as Real / axis.length, period: Some((axis, count)) }
    }

    fn block(&self, x: Real) -> i32 {
        match self.period {
            // All distant positions share the last block.
            None => (x * self.inverse).floor().clamp(-1e9, 1e9) as i32,
            Some((axis, count)) => (((axis.wrap(x) - axis.from) * self.inverse) as i32).clamp(0, count - 1),
        }
    }

    fn shifted(&self, block: i32, by: i32) -> i32 {
        self.period.map_or(block + by, |(_, count)| (block + by).rem_euclid(count))
    }
}

impl Layout {
    pub fn new(side: Real, periodic: Periodic) -> Layout {
        Layout { periodic, x: Axis::new(side, periodic.x), y: Axis::new(side, periodic.y) }
    }

    /// The shorter side of a block \[m].
    pub fn side(&self) -> Real {
        1.0 / self.x.inverse.max(self.y.inverse)
    }

    pub fn key(&self, point: Vector) -> Key {
        (self.x.block(point.x), self.y.block(point.y))
    }

    /// Visits a block and all that are at most `reach` away.
    pub fn around(&self, (x, y): Key, reach: i32, mut visit: impl FnMut(Key)) {
        for (down, right) in (-reach..=reach).flat_map(|down| (-reach..=reach).map(move |right| (down, right))) {
            visit((self.x.shifted(x, right), self.y.shifted(y, down)));
        }
    }
}

/// Motion statistics of a block, or of a set of connected blocks.
#[derive(Clone, Copy)]
pub(super) struct Block {
    pub count: u32,
    /// Sum of the particle displacements since rest began \[m].
    pub moved: f64,
    /// The largest displacement \[m].
    pub farthest: Real,
    /// Rest time of the particle that came to rest last \[s].
    pub rest: Real,
    /// Fastest particle [m/s].
    pub speed: Real,
    /// Whether all its particles may sleep.
    pub sleepy: bool,
    /// Whether it moves too much to sleep, or to let adjacent blocks sleep.
    pub rough: bool,
}

impl Block {
    const EMPTY: Block =
        Block { count: 0, moved: 0.0, farthest: 0.0, rest: Real::INFINITY, speed: 0.0, sleepy: true, rough: false };

    /// Mean particle displacement since rest began \[m].
    pub fn mean(&self) -> f64 {
        self.moved / f64::from(self.count.max(1))
    }

    fn join(&mut self, other: &Block) {
        self.count += other.count;
        self.moved += other.moved;
        self.farthest = self.farthest.max(other.farthest);
        self.rest = self.rest.min(other.rest);
        self.speed = self.speed.max(other.speed);
        self.sleepy &= other.sleepy;
        self.rough |= other.rough;
    }
}

/// Blocks in the order of their first access.
#[derive(Default)]
pub(super) struct Blocks {
    all: Vec<(Key, Block)>,
    /// Used only for look-up, never iterated: its order does not matter.
    places: HashMap<Key, u32>,
    last: usize,
    /// The first block of the connected set of each block; blocks connect by sides or corners.
    roots: Vec<u32>,
    /// Motion statistics of each connected set, stored at its first block.
    wholes: Vec<Block>,
}

impl Blocks {
    pub fn clear(&mut self) {
        self.all.clear();
        self.places.clear();
        self.last = 0;
    }

    /// A block, empty at first. Rows are sorted by cell, so it is usually the last block again.
    pub fn at(&mut self, key: Key) -> &mut Block {
        if self.all.get(self.last).is_none_or(|&(known, _)| known != key) {
            let next = self.all.len() as u32;
            self.last = *self.places.entry(key).or_insert(next) as usize;
            if self.last == self.all.len() {
                self.all.push((key, Block::EMPTY));
            }
        }
        &mut self.all[self.last].1
    }

    pub fn all(&self) -> &[(Key, Block)] {
        &self.all
    }

    pub fn all_mut(&mut self) -> &mut [(Key, Block)] {
        &mut self.all
    }

    /// Finds the connected sets of blocks.
    pub fn connect(&mut self, layout: &Layout) {
        let (places, roots) = (&self.places, &mut self.roots);
        roots.clear();
        roots.extend(0..self.all.len() as u32);
        for (place, &(center, _)) in self.all.iter().enumerate() {
            layout.around(center, 1, |key| {
                if let Some(&other) = places.get(&key) {
                    let (a, b) = (root(roots, place as u32), root(roots, other));
                    roots[a.max(b) as usize] = a.min(b);
                }
            });
        }
        self.wholes.clear();
        self.wholes.resize(self.all.len(), Block::EMPTY);
        for (place, (_, block)) in self.all.iter().enumerate() {
            roots[place] = root(roots, place as u32);
            self.wholes[roots[place] as usize].join(block);
        }
    }

    /// Motion statistics of the connected set of the block at an index of [`all`](Self::all).
    pub fn whole(&self, place: usize) -> &Block {
        &self.wholes[self.roots[place] as usize]
    }

    /// A block, and its connected set.
    pub fn with_whole(&mut self, key: Key) -> (&Block, &Block) {
        self.at(key);
        (&self.all[self.last].1, self.whole(self.last))
    }
}

fn root(roots: &mut [u32], mut place: u32) -> u32 {
    while roots[place as usize] != place {
        let above = roots[roots[place as usize] as usize];
        roots[place as usize] = above;
        place = above;
    }
    place
}
