//! Ropes: rows of points, the constraints between them, and the ends that are fixed to bodies.

use std::ops::Range;

use super::RigidBodies;
use crate::constraints::{Batch, ConstraintGroup, Distance, Tether};
use crate::math::{Vector64, real, vector};
use crate::particles::{NewParticle, Particles};
use crate::phase::MaterialIndex;
use crate::scene::{Link, Rope, Scene, Tethers};

/// Pieces of all ropes at most.
pub(crate) const MOST_PIECES: f64 = 1e7;

/// The ropes of a run; a rope that was taken away keeps its number.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ropes {
    lines: Vec<Line>,
}

/// One rope.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Line {
    /// Id of its first point; those of the others follow.
    first: u32,
    pieces: u32,
    /// Length of a piece \[m].
    length: f64,
    /// Inverse stiffness of a piece [m/N].
    compliance: f64,
    rod: bool,
    /// Whether all points are tethered to the first end, and to the last.
    tethered: [bool; 2],
    /// The joint that keeps the bodies at its ends within its length.
    joint: Option<u32>,
    /// Pieces that are cut, in ascending order.
    cuts: Vec<u32>,
    removed: bool,
}

/// A rope as it is read from outside.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RopeReading {
    /// Ids of its points, from its first end to its last.
    pub points: Range<u32>,
    /// Pieces that are cut: number k lies between the points k and k + 1.
    pub cuts: Vec<u32>,
    /// Whether it was taken away.
    pub removed: bool,
}

impl RopeReading {
    /// A rope of so many pieces that is not laid yet.
    pub(crate) fn new(pieces: u32) -> Self {
        RopeReading { points: 0..pieces + 1, cuts: Vec::new(), removed: false }
    }
}

impl Line {
    fn ids(&self) -> Range<u32> {
        self.first..self.first + self.pieces + 1
    }

    fn is_sound(&self) -> bool {
        let rising = self.cuts.windows(2).all(|two| two[0] < two[1]);
        let finite =
            self.length > 0.0 && self.length.is_finite() && self.compliance >= 0.0 && self.compliance.is_finite();
        finite && rising && self.pieces > 0 && self.cuts.last().is_none_or(|&cut| cut < self.pieces)
    }

    /// Whether no piece between these points is cut.
    fn whole(&self, points: Range<u32>) -> bool {
        !self.cuts.iter().any(|cut| points.contains(cut))
    }
}

impl Ropes {
    /// Number of ropes, those that were taken away included.
    pub(crate) fn len(&self) -> usize {
        self.lines.len()
    }

    /// The ropes, in the order in which they came.
    pub(crate) fn readings(&self) -> Vec<RopeReading> {
        let reading = |line: &Line| RopeReading { points: line.ids(), cuts: line.cuts.clone(), removed: line.removed };
        self.lines.iter().map(reading).collect()
    }

    /// Adds the points of a rope; `scene` has its material.
    pub(crate) fn add(&mut self, rope: &Rope, scene: &Scene, particles: &mut Particles) {
        let Some((index, material)) = scene.material(&rope.material) else { return };
        let pieces = rope.pieces(scene.spacing) as u32;
        let inverse_mass = real(1.0 / material.particle_mass(scene.spacing));
        let [from, to] = [rope.from, rope.to].map(Vector64::from);
        let held = [rope.held.first() || rope.from_body.is_some(), rope.held.last() || rope.body.is_some()];
        let first = particles.ids_given();
        for number in 0..=pieces {
            let fixed = number == 0 && held[0] || number == pieces && held[1];
            particles.push(NewParticle {
                position: from + (to - from) * (f64::from(number) / f64::from(pieces)),
                velocity: vector(Vector64::ZERO),
                inverse_mass: if fixed { 0.0 } else { inverse_mass },
                material: index as MaterialIndex,
                phase: material.phase(),
                temperature: 0.0,
            });
        }
        self.lines.push(Line {
            first,
            pieces,
            length: rope.full_length() / f64::from(pieces),
            compliance: rope.compliance,
            rod: rope.link == Link::Rod,
            tethered: held.map(|held| held && rope.tethers == Tethers::All),
            joint: None,
            cuts: Vec::new(),
            removed: false,
        });
    }

    /// Fixes the ends of a rope that was laid to bodies, where its description says so.
    pub(crate) fn fasten(&mut self, number: usize, rope: &Rope, spacing: f64, rigid: &mut RigidBodies) {
        let line = &mut self.lines[number];
        let (first, last) = (line.first, line.first + line.pieces);
        rope.body.iter().for_each(|body| rigid.tie(last, body, rope.to.into()));
        rope.from_body.iter().for_each(|body| rigid.tie(first, body, rope.from.into()));
        line.joint = rigid.join_rope(rope, [first, last], spacing);
    }

    /// Cuts a piece: nothing keeps its ends together.
    pub(crate) fn cut(&mut self, number: usize, piece: u32, rigid: Option<&mut RigidBodies>) {
        let line = &mut self.lines[number];
        if let Err(place) = line.cuts.binary_search(&piece) {
            line.cuts.insert(place, piece);
        }
        if let (Some(joint), Some(rigid)) = (line.joint.take(), rigid) {
            rigid.part_rope(joint);
        }
    }

    /// Takes a rope away; returns the ids of its points, to be removed.
    pub(crate) fn remove(&mut self, number: usize, rigid: Option<&mut RigidBodies>) -> Range<u32> {
        let line = &mut self.lines[number];
        line.removed = true;
        if let Some(rigid) = rigid {
            rigid.untie(line.ids());
            line.joint.take().into_iter().for_each(|joint| rigid.part_rope(joint));
        }
        line.ids()
    }

    /// The constraints between the points.
    pub(crate) fn groups(&self) -> Vec<Box<dyn ConstraintGroup>> {
        let (mut distances, mut tethers) = (Vec::new(), Vec::new());
        for line in self.lines.iter().filter(|line| !line.removed) {
            let (length, compliance) = (real(line.length), real(line.compliance));
            for piece in (0..line.pieces).filter(|&piece| line.whole(piece..piece + 1)) {
                let particles = [line.first + piece, line.first + piece + 1];
                match line.rod {
                    false => tethers.push(Tether { particles, length, compliance }),
                    true => distances.push(Distance { particles, length, compliance }),
                }
            }
            add_tethers(line, &mut tethers);
        }
        let mut groups: Vec<Box<dyn ConstraintGroup>> = Vec::new();
        if !distances.is_empty() {
            groups.push(Box::new(Batch::new(distances)));
        }
        if !tethers.is_empty() {
            groups.push(Box::new(Batch::new(tethers)));
        }
        groups
    }

    /// Whether these may be the ropes of a run that began with so many of its own: from a saved state.
    pub(crate) fn are_sound(&self, of_scene: usize, ids_given: u32, joints: usize) -> bool {
        let pieces: f64 = self.lines.iter().map(|line| f64::from(line.pieces)).sum();
        let known = |line: &Line| {
            let end = line.first.checked_add(line.pieces).is_some_and(|last| last < ids_given);
            end && line.joint.is_none_or(|joint| (joint as usize) < joints)
        };
        self.lines.len() >= of_scene
            && pieces <= MOST_PIECES
            && self.lines.iter().all(|line| line.is_sound() && known(line))
            && self.lines.windows(2).all(|two| two[0].first + two[0].pieces < two[1].first)
    }
}

/// Tethers of the points of a rope to its ends, where no cut is between.
fn add_tethers(line: &Line, tethers: &mut Vec<Tether>) {
    for end in [0, line.pieces].into_iter().filter(|&end| line.tethered[usize::from(end > 0)]) {
        let far = |number: &u32| number.abs_diff(end) > 1 && line.whole((*number).min(end)..(*number).max(end));
        for number in (0..=line.pieces).filter(far) {
            let count = f64::from(number.abs_diff(end));
            let (length, compliance) = (real(line.length * count), real(line.compliance * count));
            tethers.push(Tether { particles: [line.first + end, line.first + number], length, compliance });
        }
    }
}
