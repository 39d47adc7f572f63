//! Four contacts that share no body, for the lanes of a sweep.

use super::bounds::NONE;
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use crate::math::Real;
use crate::simd::wide::WIDE;

/// One number of each lane. Those that hardly change within a substep have the precision of particles: a sweep is bound
/// by memory. Impulses, masses and motion do not.
pub(super) type Lane = [Real; WIDE];
pub(super) type Exact = [f64; WIDE];

/// Gap of a point that is not there \[m].
pub(super) const FAR: f64 = 1e12;

/// Four contacts; a lane without one is all zero, and its bodies are the idle one.
#[derive(Clone, Default)]
pub(super) struct Block {
    /// Rows of the motion of both bodies; walls and free lanes have the idle row behind all bodies.
    pub bodies: [[u32; WIDE]; 2],
    /// Rows of the loads of the second bodies, or of walls.
    pub loaded: [u32; WIDE],
    pub normal: [Lane; 2],
    /// By point: gap \[m], and moments about both centres of mass of unit impulses along normal and tangent \[m].
    pub gap: [Lane; 2],
    pub normal_a: [Lane; 2],
    pub normal_b: [Lane; 2],
    pub tangent_a: [Lane; 2],
    pub tangent_b: [Lane; 2],
    /// Responses to normal impulses, and the inverse of their matrix: both points, and across.
    pub response: [Lane; 3],
    pub inverse: [Lane; 3],
    /// By point: effective mass along the normal alone, and along the tangent \[kg].
    pub alone: [Lane; 2],
    pub tangent: [Lane; 2],
    pub friction: Lane,
    /// 1 for two points with friction.
    pub turns: Lane,
    /// Over-relaxation beyond 1.
    pub over: Lane,
    /// Way of moving surfaces along the tangent \[m].
    pub belt: Lane,
    /// Size of the smaller body \[m].
    pub size: Lane,
    /// Whether a lane resists rolling, the arms, and the effective masses.
    pub rolls: bool,
    pub rolling_arm: Lane,
    pub rolling_mass: Exact,
    /// Inverse masses and inertias of both bodies.
    pub linear: [Exact; 2],
    pub angular: [Exact; 2],
    /// Impulses by point, and that against rolling.
    pub normal_impulse: [Exact; 2],
    pub tangent_impulse: [Exact; 2],
    pub rolling_impulse: Exact,
}

impl Block {
    /// A block without contacts, among so many bodies.
    pub fn idle(bodies: usize) -> Block {
        Block { bodies: [[bodies as u32; WIDE]; 2], ..Block::default() }
    }

    /// Where the impulses of a contact are summed besides its first body: rows of walls lie behind the idle one.
    pub fn load_on(&mut self, lane: usize, contact: &Contact, cache: &ContactCache, bodies: usize) {
        let idle = bodies as u32;
        self.loaded[lane] = match (contact.b, cache.wall) {
            (NONE, NONE) => idle,
            (NONE, wall) => idle + 1 + wall,
            (body, _) => body,
        };
    }
}
