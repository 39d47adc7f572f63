//! Contacts of samples with samples of other bodies, and with walls.
//!
//! Two samples overlap where they are closer than a spacing. The way out is that of the signed distance of the
//! shallower one, d = min(|phi_i|, |phi_j|), where both lie deep; at the surface it is the line between them, but
//! never into the body: x_ij - 2 (x_ij . n) n where x_ij points inwards (Macklin et al. 2014, section 5.1).
//! Friction is that of positions (equations 23 to 25). With n contacts each sees an n-th of the mass, which is
//! averaging where both sides have as many, and keeps momentum where they have not.

use super::ShapeMatching;
use crate::constraints::{Corrections, Substep};
use crate::math::{Vector64, vector, wide};
use crate::phase::Phase;
use crate::rigid::Surface;
use crate::scene::OVER_RELAXATION;

/// Samples with less signed distance than this lie at the surface \[spacings].
const SURFACE: f64 = 0.75;
/// Part of an old overlap that a round takes out.
const OLD_PART: f64 = 0.05;

/// A sample: member and number in it.
type Sample = (usize, usize);

/// Two samples, or a sample and a wall, that overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    a: Sample,
    /// The other sample; none for a wall.
    b: Option<Sample>,
    /// The measured number of the wall, where it has one.
    wall: Option<u16>,
    /// Unit normal, towards the first.
    normal: Vector64,
    /// Overlap where the substep began \[m].
    old: f64,
    surface: Surface,
}

/// How many contacts push each member and each sample in a round.
struct Counts {
    members: Vec<u32>,
    samples: Vec<Vec<u32>>,
}

impl ShapeMatching {
    /// Lists the overlaps, each once.
    pub(super) fn find_touches(&mut self, now: Substep<'_>) {
        let mut touches = std::mem::take(&mut self.touches);
        touches.clear();
        for member in (0..self.members.len()).filter(|&member| self.members[member].is_matched()) {
            for sample in 0..self.rows[member].len() {
                self.touch_samples((member, sample), now, &mut touches);
                self.touch_walls((member, sample), now, &mut touches);
            }
        }
        self.touches = touches;
    }

    fn touch_samples(&self, a: Sample, now: Substep<'_>, touches: &mut Vec<Touch>) {
        let row = self.rows[a.0][a.1] as usize;
        if row >= now.particles.listed() {
            return;
        }
        let mut near = Vec::new();
        now.neighbors.for_each(row, |other| {
            if now.particles.phases()[other] == Phase::Rigid {
                near.extend(self.sample_of(now.particles.ids()[other]));
            }
        });
        near.sort_unstable();
        for b in near.into_iter().filter(|b| b.0 != a.0 && (!self.members[b.0].is_matched() || a.0 < b.0)) {
            let (first, second) = (&self.members[a.0], &self.members[b.0]);
            let apart = now.neighbors.periodic().min_image(vector(self.places[a.0][a.1] - self.places[b.0][b.1]));
            let apart = wide(apart);
            if apart.length_squared() >= self.spacing * self.spacing || !first.filter.allows(&second.filter) {
                continue;
            }
            let (normal, depth) = self.way_out(a, b, apart);
            let starts = [a, b].map(|(m, k)| wide(now.particles.starts()[self.rows[m][k] as usize]));
            let old = depth + (apart - (starts[0] - starts[1])).dot(normal);
            let surface = first.surface.combined(&second.surface, self.rule);
            touches.push(Touch::new((a, Some(b)), normal, old, surface));
        }
    }

    /// The direction in which a sample leaves another, and how far it must.
    fn way_out(&self, a: Sample, b: Sample, apart: Vector64) -> (Vector64, f64) {
        let [at_a, at_b] = [a, b].map(|(member, sample)| {
            let near = self.members[member].distances[sample];
            (near.distance.abs(), self.fits[member].rotation.rotate(near.normal))
        });
        let (least, normal) = if at_a.0 < at_b.0 { (at_a.0, -at_a.1) } else { (at_b.0, at_b.1) };
        let distance = apart.length();
        if least >= SURFACE * self.spacing || distance == 0.0 {
            return (normal, least.max(self.spacing - distance));
        }
        let inwards = apart.dot(normal).min(0.0);
        ((apart - normal * (2.0 * inwards)) / distance, self.spacing - distance)
    }

    fn touch_walls(&self, a: Sample, now: Substep<'_>, touches: &mut Vec<Touch>) {
        let row = self.rows[a.0][a.1] as usize;
        let (place, start) = (self.places[a.0][a.1], wide(now.particles.starts()[row]));
        for hit in now.walls.touches(vector(place), super::radius(self.spacing)) {
            let (normal, depth) = (wide(hit.normal), f64::from(hit.depth));
            let surface =
                self.members[a.0].surface.combined(&Surface::with_friction(f64::from(hit.friction)), self.rule);
            let old = depth + (place - start).dot(normal);
            touches.push(Touch { wall: hit.measured, ..Touch::new((a, None), normal, old, surface) });
        }
    }

    fn sample_of(&self, id: u32) -> Option<Sample> {
        let member = self.members.partition_point(|member| member.ids().end <= id);
        let first = self.members.get(member)?.ids().start;
        (id >= first).then(|| (member, (id - first) as usize))
    }

    /// One round: all contacts from one state.
    pub(super) fn part(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let depths: Vec<f64> = self.touches.iter().map(|touch| self.depth(touch, now)).collect();
        let counts = self.count(&depths);
        let pushes: Vec<Vector64> = self
            .touches
            .iter()
            .zip(&depths)
            .map(|(touch, &depth)| if depth > 0.0 { self.push(touch, depth, &counts, now) } else { Vector64::ZERO })
            .collect();
        for (k, &push) in pushes.iter().enumerate() {
            let touch = self.touches[k];
            self.places[touch.a.0][touch.a.1] += push * self.members[touch.a.0].inverse_mass;
            match touch.b {
                Some((member, sample)) if self.members[member].is_matched() => {
                    self.places[member][sample] -= push * self.members[member].inverse_mass;
                }
                Some((member, sample)) => {
                    out.loads_mut()[self.rows[member][sample] as usize] -= vector(push);
                    self.shift_whole((member, sample), -push);
                }
                None => {
                    touch.wall.into_iter().for_each(|wall| out.wall_loads_mut()[usize::from(wall)] -= push);
                }
            }
        }
    }

    /// Moves all samples of a body that has a pose as a push on one of them will move it.
    fn shift_whole(&mut self, (m, k): Sample, push: Vector64) {
        let (member, center) = (&self.members[m], self.fits[m].center);
        let linear = push * (member.inverse_mass / self.rows[m].len() as f64);
        let angular = (self.places[m][k] - center).perp_dot(push) * member.inverse_mass / member.spread;
        if member.inverse_mass > 0.0 {
            self.places[m].iter_mut().for_each(|place| *place += linear + (*place - center).perp() * angular);
        }
    }

    fn count(&self, depths: &[f64]) -> Counts {
        let samples = self.rows.iter().map(|rows| vec![0; rows.len()]).collect();
        let mut counts = Counts { members: vec![0; self.rows.len()], samples };
        for (touch, _) in self.touches.iter().zip(depths).filter(|(_, depth)| **depth > 0.0) {
            for (member, sample) in std::iter::once(touch.a).chain(touch.b) {
                counts.members[member] += 1;
                counts.samples[member][sample] += 1;
            }
        }
        counts
    }

    /// The way out, less the part of the sliding that friction holds back, as an impulse times dt [kg m].
    fn push(&self, touch: &Touch, depth: f64, counts: &Counts, now: Substep<'_>) -> Vector64 {
        let gain = |along: Vector64| {
            let of = |sample: Sample| self.response(sample, along, counts, now);
            of(touch.a) + touch.b.map_or(0.0, of)
        };
        let moved = self.relative(touch, now);
        let tangent = touch.normal.perp();
        let normal = depth / gain(touch.normal);
        let stop = moved.dot(tangent) / gain(tangent);
        touch.normal * normal - tangent * touch.surface.held_back(stop, normal)
    }

    /// How far a unit push moves a sample [1/kg], split among contacts: alone where its body is soft, with all of
    /// its body where the fit that follows is stiff, or where a pose moves it.
    fn response(&self, (m, k): Sample, along: Vector64, counts: &Counts, now: Substep<'_>) -> f64 {
        let (member, fit) = (&self.members[m], &self.fits[m]);
        let lever = (self.places[m][k] - fit.center).perp_dot(along);
        let whole = member.inverse_mass * (1.0 / self.rows[m].len() as f64 + lever * lever / member.spread);
        let shares = (f64::from(counts.members[m]) / OVER_RELAXATION).max(1.0);
        let alone = member.inverse_mass * f64::from(counts.samples[m][k]);
        let stiff = member.part(f64::from(now.dt));
        stiff * whole * shares + (1.0 - stiff) * alone
    }

    /// Displacement of the first sample relative to the second in this substep \[m].
    fn relative(&self, touch: &Touch, now: Substep<'_>) -> Vector64 {
        let moved = |(m, s): Sample| self.places[m][s] - wide(now.particles.starts()[self.rows[m][s] as usize]);
        moved(touch.a) - touch.b.map_or(Vector64::ZERO, moved)
    }

    /// The part of an overlap that a round removes \[m]: all of the overlap that arose in this substep, and a part of
    /// the older overlap. Full removal would shoot bodies apart that start overlapped.
    fn depth(&self, touch: &Touch, now: Substep<'_>) -> f64 {
        let opened = self.relative(touch, now).dot(touch.normal);
        let (overlap, old) = (touch.old - opened, touch.old.max(0.0));
        if overlap <= 0.0 { 0.0 } else { (overlap - old).max(0.0) + OLD_PART * overlap.min(old) }
    }
}

impl Touch {
    fn new((a, b): (Sample, Option<Sample>), normal: Vector64, old: f64, surface: Surface) -> Touch {
        Touch { a, b, wall: None, normal, old, surface }
    }
}
