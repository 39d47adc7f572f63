//! Which liquids of a start rest under their weight: those with a level surface and nothing open below it.

use std::collections::BTreeMap;
use std::ops::Bound;

use super::integrate::BodyForce;
use crate::constraints::Substep;
use crate::math::{Real, Vector};
use crate::phase::{MaterialIndex, Phase};
use crate::union_find::UnionFind;

/// Rows nearer than this many spacings are of one pool.
const CONNECTED: Real = 1.6;
/// Rows higher than this below the top of a pool may be its surface \[spacings].
const SURFACE: Real = 1.6;
/// Rows that fill the top layer \[spacings].
const TOP: Real = 0.5;
/// The depth from which on the pressure of a pool counts \[spacings].
const DEPTH: Real = 3.0;
/// Below its surface a pool is open where a row lacks this part of the density that its top lacks: a gap of half a
/// spacing beside a body lacks less, a free side as much.
const OPEN: Real = 0.75;
/// Density that a top lacks at least: under a lid there is none.
const LEAST_LACK: Real = 0.1;
/// Liquids of different densities lie in layers if they share less than this height \[spacings].
const SHARED: Real = 1.6;

/// The liquids and layers that rest.
#[derive(Default)]
pub(super) struct Resting {
    /// The pools that rest: their lowest and highest places, against gravity \[m].
    pools: Vec<[Real; 2]>,
    /// The number of the pool of each particle, by id.
    pool_of: Vec<Option<u32>>,
    /// Number of particles that rest, and of all movable ones of liquids.
    pub rests: usize,
    liquid: usize,
}

impl Resting {
    /// Whether a particle rests.
    pub fn has(&self, id: u32) -> bool {
        self.pool_of[id as usize].is_some()
    }

    /// The lowest and highest place of the pool in which a particle rests.
    pub fn pool(&self, id: u32) -> Option<[Real; 2]> {
        self.pool_of[id as usize].map(|pool| self.pools[pool as usize])
    }

    /// Whether all liquid rests.
    pub fn is_all(&self) -> bool {
        self.rests > 0 && self.rests == self.liquid
    }

    /// Depth of the deepest pool \[m].
    pub fn depth(&self) -> Real {
        self.pools.iter().map(|[bottom, top]| top - bottom).fold(0.0, Real::max)
    }
}

/// The input of the search for pools that rest.
pub(super) struct Start<'a> {
    pub now: Substep<'a>,
    /// Density errors by row.
    pub errors: &'a [Real],
    pub forces: &'a [BodyForce],
    pub gravity: Vector,
    pub spacing: Real,
}

/// Connected liquid.
#[derive(Clone, Copy)]
struct Pool {
    top: Real,
    bottom: Real,
    /// Density that the rows at the top lack, and their number.
    lack: Real,
    rows: Real,
    rests: bool,
}

impl Pool {
    const EMPTY: Pool = Pool { top: Real::NEG_INFINITY, bottom: Real::INFINITY, lack: 0.0, rows: 0.0, rests: true };
}

/// Lowest and highest place of a liquid in a pool, and the inverse mass of its particles.
#[derive(Clone, Copy)]
struct Layer {
    low: Real,
    high: Real,
    inverse_mass: Real,
}

/// Finds the liquids that rest.
pub(super) fn resting(start: &Start<'_>) -> Resting {
    let particles = start.now.particles;
    let rows: Vec<usize> = (0..particles.dense()).filter(|&row| start.is_liquid(row)).collect();
    let mut sets = start.connected(&rows);
    let roots: Vec<usize> = rows.iter().map(|&row| sets.root(row as u32) as usize).collect();
    let pools = start.pools(&rows, &roots);
    let mut found = Resting { liquid: rows.len(), ..Resting::default() };
    found.pool_of.resize(particles.ids_given() as usize, None);
    let mut numbers = vec![None; pools.len()];
    for (&row, &root) in rows.iter().zip(&roots).filter(|(_, root)| pools[**root].rests) {
        let number = *numbers[root].get_or_insert(found.pools.len() as u32);
        if number as usize == found.pools.len() {
            found.pools.push([pools[root].bottom, pools[root].top]);
        }
        found.pool_of[particles.id[row] as usize] = Some(number);
        found.rests += 1;
    }
    found
}

impl Start<'_> {
    fn is_liquid(&self, row: usize) -> bool {
        self.now.particles.phase[row] == Phase::Liquid && self.now.particles.inverse_mass[row] > 0.0
    }

    fn height(&self, row: usize) -> Real {
        -self.now.particles.position[row].dot(self.gravity.normalize_or_zero())
    }

    /// Sets of rows that are near each other.
    fn connected(&self, rows: &[usize]) -> UnionFind {
        let (particles, neighbors) = (self.now.particles, self.now.neighbors);
        let reach = CONNECTED * self.spacing;
        let mut sets = UnionFind::default();
        sets.reset(particles.dense());
        for &row in rows {
            let point = particles.position[row];
            for other in neighbors.runs_near(point).iter().flatten().filter(|&other| other < row) {
                let apart = neighbors.periodic().min_image(point - particles.position[other]);
                if apart.length_squared() < reach * reach && self.is_liquid(other) {
                    sets.unite(row as u32, other as u32);
                }
            }
        }
        sets
    }

    /// The pools, each at the place of its root.
    fn pools(&self, rows: &[usize], roots: &[usize]) -> Vec<Pool> {
        let particles = self.now.particles;
        let mut pools = vec![Pool::EMPTY; particles.dense()];
        for (&row, &root) in rows.iter().zip(roots) {
            let (pool, height) = (&mut pools[root], self.height(row));
            (pool.top, pool.bottom) = (pool.top.max(height), pool.bottom.min(height));
            let weighs = self.forces[usize::from(particles.material[row])].factor == 1.0;
            pool.rests &= weighs && particles.velocity[row] == Vector::ZERO;
        }
        for (&row, &root) in rows.iter().zip(roots) {
            let pool = &mut pools[root];
            if self.height(row) > pool.top - TOP * self.spacing {
                (pool.lack, pool.rows) = (pool.lack - self.errors[row], pool.rows + 1.0);
            }
        }
        for (&row, &root) in rows.iter().zip(roots) {
            let pool = &mut pools[root];
            let lack = (pool.lack / pool.rows).max(LEAST_LACK);
            let below = self.height(row) < pool.top - SURFACE * self.spacing;
            pool.rests &= !(below && -self.errors[row] > OPEN * lack);
            pool.rests &= pool.top - pool.bottom > DEPTH * self.spacing;
        }
        self.reject_mixed(rows, roots, &mut pools);
        pools
    }

    /// Pools whose liquids do not lie in layers do not rest.
    fn reject_mixed(&self, rows: &[usize], roots: &[usize], pools: &mut [Pool]) {
        let particles = self.now.particles;
        let mut layers: BTreeMap<(usize, MaterialIndex), Layer> = BTreeMap::new();
        for (&row, &root) in rows.iter().zip(roots) {
            let (height, inverse_mass) = (self.height(row), particles.inverse_mass[row]);
            let whole = Layer { low: height, high: height, inverse_mass };
            let layer = layers.entry((root, particles.material[row])).or_insert(whole);
            (layer.low, layer.high) = (layer.low.min(height), layer.high.max(height));
        }
        for (&(root, material), layer) in &layers {
            let later = (Bound::Excluded((root, material)), Bound::Excluded((root + 1, 0)));
            for (_, other) in layers.range(later) {
                let shared = layer.high.min(other.high) - layer.low.max(other.low);
                let differ = layer.inverse_mass != other.inverse_mass;
                pools[root].rests &= !(differ && shared > SHARED * self.spacing);
            }
        }
    }
}
