//! The number of substeps that rigid bodies need: by speed, spin, mass ratio, and height of stacks.

use super::RigidBodies;
use crate::math::Vector64;
use crate::union_find::UnionFind;

/// Way of a body in a substep, relative to its size: beyond it contacts are found at one end of a body only.
const WAY: f64 = 0.5;
/// Rotation of a polygon in a substep \[rad].
const TURN: f64 = 0.25;
/// Substeps squared per mass ratio, and per way that gravity moves a body in a frame relative to its size. A body of
/// 100 kg dropped on one of 1 kg and 0.5 m overlaps it by 26 % of that size at 1 substep, 7 % at 2, 0.4 % at 8:
/// with this factor by less than half a percent.
const CONVERGENCE: f64 = 125.0;
/// Substeps of a polygon that touches something: a box on a slope stands up to 99 % of its limit at 2, 98 % at 1.
const LEAST: f64 = 2.0;
/// Part of its width with which a body seals a shaft: gas hardly gets past.
const SEALS: f64 = 0.8;
/// Height of a stack of bodies that one substep per frame can carry.
const BODIES_PER_SUBSTEP: f64 = 4.0;

/// Substeps per frame wanted by bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyDemand {
    /// By speed and spin.
    pub motion: f64,
    /// By the height of stacks and the mass ratio of bodies that act on each other.
    pub support: f64,
}

impl RigidBodies {
    /// Substeps that a frame of this length \[s] needs.
    pub(crate) fn demand(&self, frame: f64, gravity: Vector64) -> BodyDemand {
        let stacked = self.support_chain(gravity) / BODIES_PER_SUBSTEP;
        BodyDemand {
            motion: self.motion(frame),
            support: stacked.max(self.convergence(frame, gravity.length())).max(self.least()),
        }
    }

    /// Fastest motion of a body's centre [m/s].
    pub(crate) fn fastest(&self) -> f64 {
        self.bodies.velocities.iter().map(|velocity| velocity.linear.length()).fold(0.0, f64::max)
    }

    /// Whether a body is moved by what pushes it.
    pub(crate) fn has_dynamic(&self) -> bool {
        (0..self.bodies.len()).any(|id| self.bodies.is_dynamic(id))
    }

    /// Whether a body may seal a shaft of this width \[m] across a direction.
    pub(crate) fn spans(&self, across: Vector64, width: f64) -> bool {
        let bodies = &self.bodies;
        let extent = |id: usize| {
            let (pose, core) = (&bodies.poses[id], &bodies.cores[id]);
            let along = |corner: &Vector64| (pose.apply(*corner) - pose.position).dot(across);
            let ends = bodies.views()[id]
                .outline
                .iter()
                .map(along)
                .fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at), high.max(at)));
            (ends.1 - ends.0).max(2.0 * core.radius)
        };
        (0..bodies.len()).any(|id| bodies.is_dynamic(id) && extent(id) >= SEALS * width)
    }

    /// Weight of all bodies that something moves \[N].
    pub(crate) fn weight(&self, gravity: f64) -> f64 {
        let bodies = &self.bodies;
        let masses = (0..bodies.len()).filter(|&id| bodies.is_dynamic(id)).map(|id| bodies.views()[id].mass);
        gravity * masses.sum::<f64>()
    }

    /// Largest pressure by which a body may press on a fluid: that of its fall and of its weight \[Pa].
    pub(crate) fn pressure(&self, gravity: f64) -> f64 {
        let bodies = &self.bodies;
        let dynamic = (0..bodies.len()).filter(|&id| bodies.is_dynamic(id) && !bodies.asleep[id]);
        let pressures = dynamic.map(|id| {
            let (mass, size) = (1.0 / bodies.awake_responses[id].linear, bodies.sizes[id]);
            mass / (size * size) * (0.5 * bodies.velocities[id].linear.length_squared() + gravity * size)
        });
        pressures.fold(0.0, f64::max)
    }

    fn least(&self) -> f64 {
        let bodies = &self.bodies;
        let polygon = |id: u32| {
            bodies.is_dynamic(id as usize) && !bodies.asleep[id as usize] && bodies.cores[id as usize].radius == 0.0
        };
        let touches = match self.contacts.is_fresh() {
            true => (0..bodies.len() as u32).any(polygon),
            false => self.contacts.pressed().any(|(a, _)| polygon(a)),
        };
        if touches { LEAST } else { 0.0 }
    }

    fn motion(&self, frame: f64) -> f64 {
        let bodies = &self.bodies;
        let moving = (0..bodies.len()).filter(|&id| bodies.is_active(id));
        let wanted = moving.map(|id| {
            let (velocity, round) = (&bodies.velocities[id], bodies.cores[id].radius > 0.0);
            let way = frame * velocity.linear.length() / (WAY * bodies.sizes[id]);
            if round { way } else { way.max(frame * velocity.angular.abs() / TURN) }
        });
        wanted.fold(0.0, f64::max)
    }

    /// Bodies that act on each other form a group: its heaviest body may rest on its lightest and smallest.
    fn convergence(&self, frame: f64, gravity: f64) -> f64 {
        let (bodies, mut groups) = (&self.bodies, UnionFind::default());
        let movable = |id: u32| bodies.is_dynamic(id as usize) && !bodies.asleep[id as usize];
        groups.reset(bodies.len());
        for (a, b) in self.contacts.linked().filter(|&(a, b)| movable(a) && movable(b)) {
            groups.unite(a, b);
        }
        let mut extremes = vec![(0u32, 0.0f64, f64::INFINITY, f64::INFINITY); bodies.len()];
        for id in (0..bodies.len() as u32).filter(|&id| movable(id)) {
            // Before the first search all bodies count as one group.
            let root = if self.contacts.is_fresh() { 0 } else { groups.root(id) } as usize;
            let (count, heavy, light, small) = &mut extremes[root];
            let mass = 1.0 / bodies.awake_responses[id as usize].linear;
            (*count, *heavy, *light) = (*count + 1, heavy.max(mass), light.min(mass));
            *small = small.min(bodies.sizes[id as usize]);
        }
        let fall = gravity * frame * frame;
        let wanted = |&(count, heavy, light, small): &(u32, f64, f64, f64)| {
            if count > 1 { (CONVERGENCE * fall / small * heavy / light).sqrt() } else { 0.0 }
        };
        extremes.iter().map(wanted).fold(0.0, f64::max)
    }

    /// Bodies that may have to carry each other: the height of all that are awake over the smallest.
    fn support_chain(&self, gravity: Vector64) -> f64 {
        let bodies = &self.bodies;
        let awake = || (0..bodies.len()).filter(|&id| bodies.is_dynamic(id) && !bodies.asleep[id]);
        let down = gravity.normalize_or_zero();
        let heights = awake().map(|id| bodies.poses[id].position.dot(down));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
        let smallest = awake().map(|id| bodies.sizes[id]).fold(f64::INFINITY, f64::min);
        if high >= low { ((high - low) / smallest + 1.0).min(awake().count() as f64) } else { 0.0 }
    }
}
