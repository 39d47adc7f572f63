//! Data that the lanes of a block keep between searches: the geometry of their contacts, fixed in the bodies.

use super::bounds::NONE;
use super::contact_block::{Block, Exact, Lane};
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::touch::Reference;
use crate::math::Real;
use crate::rigid::InverseMass;
use crate::simd::wide::WIDE;

/// The geometry of four contacts; a lane without one is all zero.
#[derive(Clone, Default)]
pub(super) struct Anchored {
    /// Normals in the coordinates of the solid they are fixed to.
    pub normal: [Exact; 2],
    /// By point: places on both bodies, in their coordinates \[m].
    pub on_a: [[Exact; 2]; 2],
    pub on_b: [[Exact; 2]; 2],
    /// Radii of discs \[m].
    pub radii: [Exact; 2],
    /// 1 where the normal is fixed to the first body; to the second.
    pub of_first: Lane,
    pub of_second: Lane,
    /// 1 where there is a second point.
    pub two: Lane,
    pub static_friction: Lane,
    pub kinetic_friction: Lane,
    /// Speed of the surfaces along the tangent [m/s].
    pub speed: Lane,
    /// Whether a normal is the line between two points, and whether friction depends on the speed of sliding.
    pub lines: bool,
    pub slides: bool,
}

impl Anchored {
    /// Notes what holds for any of the lanes with a contact.
    pub fn sum_up(&mut self, holders: &[u32; WIDE]) {
        let by_points = |lane: usize| self.of_first[lane] == 0.0 && self.of_second[lane] == 0.0;
        self.lines = (0..WIDE).any(|lane| holders[lane] != NONE && by_points(lane));
        self.slides = self.static_friction != self.kinetic_friction;
    }

    /// Takes the places of a contact into a lane.
    #[inline(always)]
    pub fn place(&mut self, lane: usize, cache: &ContactCache) {
        let lane = lane % WIDE;
        (self.normal[0][lane], self.normal[1][lane]) = (cache.normal.x, cache.normal.y);
        for (k, (on_a, on_b)) in cache.anchors.into_iter().enumerate() {
            (self.on_a[k][0][lane], self.on_a[k][1][lane]) = (on_a.x, on_a.y);
            (self.on_b[k][0][lane], self.on_b[k][1][lane]) = (on_b.x, on_b.y);
        }
    }

    /// Takes the geometry of a contact into a lane; zeros for one that is over.
    #[inline(always)]
    pub fn take(&mut self, lane: usize, contact: &Contact, cache: &ContactCache) {
        let (lane, surface) = (lane % WIDE, &cache.surface);
        self.place(lane, cache);
        (self.radii[0][lane], self.radii[1][lane]) = (cache.radii[0], cache.radii[1]);
        let flag = |is: bool| if is { 1.0 } else { 0.0 };
        self.of_first[lane] = flag(cache.reference == Reference::First);
        self.of_second[lane] = flag(cache.reference == Reference::Second);
        self.two[lane] = flag(contact.points().len() == 2);
        self.static_friction[lane] = surface.static_friction as Real;
        self.kinetic_friction[lane] = surface.kinetic_friction as Real;
        self.speed[lane] = surface.speed as Real;
    }
}

impl Block {
    /// Takes what a substep does not measure of a contact into a lane: bodies, masses, impulses.
    #[inline(always)]
    pub fn take(&mut self, lane: usize, contact: &Contact, masses: &[InverseMass], sizes: &[f64]) {
        let (lane, idle) = (lane % WIDE, masses.len() as u32);
        for (side, body) in [contact.a, contact.b].into_iter().enumerate() {
            self.bodies[side][lane] = body.min(idle);
            let mass = masses.get(body as usize).copied().unwrap_or_default();
            (self.linear[side][lane], self.angular[side][lane]) = (mass.linear, mass.angular);
        }
        // Kept where two discs lie at one place: no line between them has a direction.
        (self.normal[0][lane], self.normal[1][lane]) = (contact.normal.x as Real, contact.normal.y as Real);
        let size = |body: u32| sizes.get(body as usize).copied();
        let of_a = size(contact.a).unwrap_or(0.0);
        self.size[lane] = size(contact.b).map_or(of_a, |of_b| of_b.min(of_a)) as Real;
        self.rolling_arm[lane] = contact.rolling_arm as Real;
        self.rolling_impulse[lane] = contact.rolling_impulse;
        self.rolling_mass[lane] = super::complementarity::inverse(self.angular[0][lane] + self.angular[1][lane]);
        for k in 0..2 {
            let impulses = contact.points().get(k).map(|point| (point.normal_impulse, point.tangent_impulse));
            (self.normal_impulse[k][lane], self.tangent_impulse[k][lane]) = impulses.unwrap_or_default();
        }
    }

    /// Gives a contact the impulses of its lane.
    #[inline(always)]
    pub fn give_impulses(&self, lane: usize, contact: &mut Contact) {
        contact.rolling_impulse = self.rolling_impulse[lane];
        for (k, point) in contact.points_mut().iter_mut().enumerate() {
            point.normal_impulse = self.normal_impulse[k][lane];
            point.tangent_impulse = self.tangent_impulse[k][lane];
        }
    }

    /// Gives a contact what was measured in its lane.
    #[inline(always)]
    pub fn give_geometry(&self, lane: usize, contact: &mut Contact) {
        (contact.normal.x, contact.normal.y) = (f64::from(self.normal[0][lane]), f64::from(self.normal[1][lane]));
        for (k, point) in contact.points_mut().iter_mut().enumerate() {
            point.gap = f64::from(self.gap[k][lane]);
            (point.normal_a, point.normal_b) = (f64::from(self.normal_a[k][lane]), f64::from(self.normal_b[k][lane]));
            (point.tangent_a, point.tangent_b) =
                (f64::from(self.tangent_a[k][lane]), f64::from(self.tangent_b[k][lane]));
        }
    }
}

/// Whether any lane is not zero.
pub(super) fn any(lanes: &Lane) -> bool {
    *lanes != [0.0; WIDE]
}
