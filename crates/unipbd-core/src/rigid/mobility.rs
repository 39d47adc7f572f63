//! How bodies that contacts and joints hold answer to a load: the pressure of a fluid moves them only where they are
//! free to go.
//!
//! A row J of a constraint that holds takes its direction out of the inverse mass: W - W J^T (J W J^T)^-1 J W. Bodies on
//! joints share one matrix W, so that a load on one moves the others too; a spring gives way, which adds to J W J^T.

use super::InverseMass;
use crate::math::dot3;
use crate::scene::MOST_JOINED;
use crate::union_find::UnionFind;
use std::ops::Range;

/// A row of a constraint that holds two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldRow {
    /// For each body its index, and the change of the constraint by a displacement along x, along y and by a rotation.
    pub sides: [Side; 2],
    /// Change of the constraint per impulse that it gives way to [1/kg]; 0 is rigid.
    pub softness: f64,
}

/// A body, and how a row moves with it. The world, and that of a wall, has an index without a body.
pub(crate) type Side = (u32, [f64; 3]);

/// Change of the velocity of a body by a force and a torque: the inverse mass, as far as nothing holds the body.
pub(crate) type Mobility = [[f64; 3]; 3];

/// A contact partner holds a body if its mobility along the contact is at most this part of that of the body.
const HOLDS: f64 = 0.05;
/// A body whose mobility along a contact is this part of that of the free body is held: the rest is rounding, and
/// taking out its direction would take out any other.
const ROUNDING: f64 = 1e-9;
/// Rounds over all rows: the bodies of a stack are held from the ground up.
const ROUNDS: usize = 8;
/// Mobilities of all bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mobilities {
    /// Bodies, group by group: those of a group hang together by joints.
    members: Vec<u32>,
    groups: Vec<Group>,
    /// Group of each body, and its place in it.
    places: Vec<(u32, u32)>,
    /// The matrices of all groups, row by row.
    entries: Vec<f64>,
    joined: UnionFind,
    rows: Vec<HeldRow>,
    moved: Vec<f64>,
}

/// Bodies that share a matrix.
#[derive(Clone, Debug)]
struct Group {
    members: Range<usize>,
    /// Where its matrix begins.
    first: usize,
}

impl Group {
    /// Rows of its matrix.
    fn size(&self) -> usize {
        3 * self.members.len()
    }
}

impl Mobilities {
    /// Finds the mobilities of bodies, from the rows of joints and of contacts.
    pub fn find(
        &mut self,
        free: &[InverseMass],
        joints: impl Iterator<Item = HeldRow>,
        contacts: impl Iterator<Item = HeldRow>,
    ) {
        let mut rows = std::mem::take(&mut self.rows);
        rows.clear();
        rows.extend(joints);
        self.group(free, &rows);
        self.set_free(free);
        rows.retain(|row| !self.join(free, row));
        rows.extend(contacts);
        for _ in 0..ROUNDS {
            let left = rows.len();
            rows.retain(|row| !self.hold(free, row));
            if rows.is_empty() || rows.len() == left {
                break;
            }
        }
        self.rows = rows;
    }

    /// Whether contacts and joints hold no body, each other's neither, and all can move.
    pub fn are_free(&self, free: &[InverseMass]) -> bool {
        let is_free = |(body, &inverse_mass): (u32, &InverseMass)| {
            let [x, y, turn] = self.of(body);
            let whole = [x[0], y[1], turn[2]] == diagonal(inverse_mass);
            is_movable(&inverse_mass) && self.companions(body).len() == 1 && whole
        };
        (0..).zip(free).all(is_free)
    }

    /// The mobility of a body.
    pub fn of(&self, body: u32) -> Mobility {
        self.between(body, body)
    }

    /// Change of the velocity of a body by a force and a torque on another one of its group.
    pub fn between(&self, body: u32, other: u32) -> Mobility {
        let ((group, row), (_, column)) = (self.places[body as usize], self.places[other as usize]);
        let group = &self.groups[group as usize];
        let at = |k: usize| group.first + (3 * row as usize + k) * group.size() + 3 * column as usize;
        [0, 1, 2].map(|k| [0, 1, 2].map(|l| self.entries[at(k) + l]))
    }

    /// The bodies that a load on this one moves, by joints: itself too.
    pub fn companions(&self, body: u32) -> &[u32] {
        let (group, _) = self.places[body as usize];
        &self.members[self.groups[group as usize].members.clone()]
    }

    /// Groups the bodies that joints hold together; those of a group that is too large are alone.
    fn group(&mut self, free: &[InverseMass], joints: &[HeldRow]) {
        let joined = &mut self.joined;
        joined.reset(free.len());
        let movable = |body: u32| free.get(body as usize).is_some_and(is_movable);
        for [(a, _), (b, _)] in joints.iter().map(|row| row.sides) {
            if movable(a) && movable(b) {
                joined.unite(a, b);
            }
        }
        self.members.clear();
        self.members.extend(0..free.len() as u32);
        self.members.sort_unstable_by_key(|&body| (joined.root(body), body));
        self.groups.clear();
        self.places.clear();
        self.places.resize(free.len(), (0, 0));
        let (mut from, mut first) = (0, 0);
        for of_root in self.members.chunk_by(|&a, &b| joined.root(a) == joined.root(b)) {
            let size = if of_root.len() > MOST_JOINED { 1 } else { of_root.len() };
            for together in of_root.chunks(size) {
                let group = Group { members: from..from + size, first };
                (from, first) = (from + size, first + group.size() * group.size());
                for (place, &body) in together.iter().enumerate() {
                    self.places[body as usize] = (self.groups.len() as u32, place as u32);
                }
                self.groups.push(group);
            }
        }
        self.entries.clear();
        self.entries.resize(first, 0.0);
    }

    /// Starts with bodies that nothing holds.
    fn set_free(&mut self, free: &[InverseMass]) {
        for group in &self.groups {
            for (place, &body) in self.members[group.members.clone()].iter().enumerate() {
                for (k, inverse_mass) in diagonal(free[body as usize]).into_iter().enumerate() {
                    self.entries[group.first + (3 * place + k) * (group.size() + 1)] = inverse_mass;
                }
            }
        }
    }

    /// Takes the direction of a joint from the bodies it holds, unless they are in two groups.
    fn join(&mut self, free: &[InverseMass], row: &HeldRow) -> bool {
        let [a, b] = row.sides.map(|(body, _)| free.get(body as usize).is_some_and(is_movable));
        let group = |side: usize| self.places.get(row.sides[side].0 as usize).map(|(group, _)| *group);
        if a && b && group(0) != group(1) {
            return false;
        }
        self.take(free, &row.sides[usize::from(!a)..1 + usize::from(b)], row.softness);
        true
    }

    /// Takes the direction of a row from one body, if the other one holds it.
    fn hold(&mut self, free: &[InverseMass], row: &HeldRow) -> bool {
        let along = |(body, way): Side| match free.get(body as usize) {
            Some(free) => {
                let [found, most] = [dot3(times(&self.of(body), way), way), along_free(*free, way)];
                if found > ROUNDING * most { found } else { 0.0 }
            }
            None => 0.0,
        };
        let [a, b] = row.sides;
        let (of_a, of_b) = (along(a), along(b));
        let held = if of_b <= HOLDS * of_a { a } else { b };
        let least = HOLDS * of_a.max(of_b);
        let holds = of_a.min(of_b) <= least && least > 0.0;
        if holds && (held.0 as usize) < free.len() {
            self.take(free, &[held], row.softness);
        }
        holds
    }

    /// Takes a direction of some bodies of one group from its matrix.
    fn take(&mut self, free: &[InverseMass], sides: &[Side], softness: f64) {
        let Some((body, _)) = sides.first() else { return };
        let group = &self.groups[self.places[*body as usize].0 as usize];
        let size = group.size();
        let matrix = &mut self.entries[group.first..group.first + size * size];
        let moved = &mut self.moved;
        moved.clear();
        moved.resize(size, 0.0);
        let at = |body: u32| 3 * self.places[body as usize].1 as usize;
        for (line, moved) in matrix.chunks_exact(size).zip(moved.iter_mut()) {
            *moved = sides.iter().map(|(body, way)| of_three(&line[at(*body)..], *way)).sum();
        }
        let along: f64 = sides.iter().map(|(body, way)| of_three(&moved[at(*body)..], *way)).sum();
        let most: f64 = sides.iter().map(|(body, way)| along_free(free[*body as usize], *way)).sum();
        if along <= ROUNDING * most {
            return;
        }
        for (line, a) in matrix.chunks_exact_mut(size).zip(&*moved) {
            line.iter_mut().zip(&*moved).for_each(|(entry, b)| *entry -= a * b / (along + softness));
        }
    }
}

fn is_movable(body: &InverseMass) -> bool {
    *body != InverseMass::default()
}

fn times(mobility: &Mobility, way: [f64; 3]) -> [f64; 3] {
    mobility.map(|row| dot3(row, way))
}

/// The same with the first three of some entries.
fn of_three(entries: &[f64], way: [f64; 3]) -> f64 {
    dot3([entries[0], entries[1], entries[2]], way)
}

fn diagonal(body: InverseMass) -> [f64; 3] {
    [body.linear, body.linear, body.angular]
}

/// Mobility of a free body along a way.
fn along_free(body: InverseMass, way: [f64; 3]) -> f64 {
    dot3(diagonal(body), way.map(|part| part * part))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: u32 = u32::MAX;
    const FREE: InverseMass = InverseMass { linear: 2.0, angular: 3.0 };

    fn row(a: u32, on_a: [f64; 3], b: u32, on_b: [f64; 3]) -> HeldRow {
        HeldRow { sides: [(a, on_a), (b, on_b)], softness: 0.0 }
    }

    fn found(free: &[InverseMass], rows: &[HeldRow]) -> Mobilities {
        let mut mobilities = Mobilities::default();
        mobilities.find(free, std::iter::empty(), rows.iter().copied());
        mobilities
    }

    fn joined(free: &[InverseMass], rows: &[HeldRow]) -> Mobilities {
        let mut mobilities = Mobilities::default();
        mobilities.find(free, rows.iter().copied(), std::iter::empty());
        mobilities
    }

    #[test]
    fn a_box_on_two_points_slides_alone() {
        let points = [-0.5, 0.5].map(|arm| row(0, [0.0, 1.0, arm], WALL, [0.0, -1.0, 0.0]));
        let [x, y, turn] = found(&[FREE], &points).of(0);
        assert_eq!(x, [2.0, 0.0, 0.0]);
        assert!(y.into_iter().chain(turn).all(|entry| entry.abs() < 1e-12), "{y:?} {turn:?}");
    }

    #[test]
    fn more_contacts_than_a_body_has_freedoms_leave_it_without_mobility() {
        // A box flush in a corner, with arms that no binary fraction holds.
        let floor = [-0.3, 0.3, 0.1].map(|arm| row(0, [0.0, 1.0, arm], WALL, [0.0; 3]));
        let side = [-0.3, 0.3, 0.7].map(|arm| row(0, [1.0, 0.0, arm / 3.0], WALL, [0.0; 3]));
        let slanted = [0.1, 0.2].map(|arm| row(0, [0.6, 0.8, arm], WALL, [0.0; 3]));
        let rows: Vec<HeldRow> = floor.into_iter().chain(side).chain(slanted).collect();
        for first in 0..rows.len() {
            let turned: Vec<HeldRow> = rows.iter().cycle().skip(first).take(rows.len()).copied().collect();
            let mobility = found(&[InverseMass { linear: 1.0 / 27.4, angular: 1.0 / 0.36 }], &turned).of(0);
            assert!(mobility.iter().flatten().all(|entry| entry.abs() < 1e-9), "{first}: {mobility:?}");
        }
    }

    #[test]
    fn a_hinge_leaves_the_rotation_about_it() {
        let arm = 0.5;
        let hinge = [row(0, [1.0, 0.0, 0.0], WALL, [0.0; 3]), row(0, [0.0, 1.0, arm], WALL, [0.0; 3])];
        let [_, y, turn] = found(&[FREE], &hinge).of(0);
        let inertia = 1.0 / 3.0 + arm * arm / 2.0;
        assert!((turn[2] - 1.0 / inertia).abs() < 1e-12);
        assert!((y[2] + arm / inertia).abs() < 1e-12, "the hinge stays where it is");
    }

    #[test]
    fn a_stack_is_held_from_the_ground_up_in_any_order() {
        let (up, down) = ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
        let stack = [row(2, up, 1, down), row(1, up, 0, down), row(0, up, WALL, down)];
        let mobilities = found(&[FREE; 3], &stack);
        assert!((0..3).all(|body| mobilities.of(body)[1][1].abs() < 1e-12));
    }

    #[test]
    fn two_bodies_of_like_mass_do_not_hold_each_other_and_a_heavy_one_holds_a_light_one() {
        let heavy = InverseMass { linear: 0.02, angular: 0.03 };
        let touch = [row(0, [1.0, 0.0, 0.0], 1, [-1.0, 0.0, 0.0])];
        assert_eq!(found(&[FREE; 2], &touch).of(0)[0][0], 2.0);
        let mobilities = found(&[FREE, heavy], &touch);
        assert_eq!((mobilities.of(0)[0][0], mobilities.of(1)[0][0]), (0.0, 0.02));
    }

    #[test]
    fn bodies_on_a_weld_move_as_one() {
        let (apart, light) = (1.5, InverseMass { linear: 4.0, angular: 5.0 });
        // Unlike arms of both anchors: they meet between the bodies.
        let on = |axis: [f64; 2], turn: f64, arm: f64| [axis[0], axis[1], arm * axis[1] + turn];
        let weld = [([1.0, 0.0], 0.0), ([0.0, 1.0], 0.0), ([0.0, 0.0], 1.0)]
            .map(|(axis, turn)| row(0, on(axis, turn, 0.5), 1, on(axis, turn, 0.5 - apart).map(|part| -part)));
        let mobilities = joined(&[FREE, light], &weld);
        assert_eq!(mobilities.companions(1), [0, 1]);
        let (mass, other) = (1.0 / FREE.linear, 1.0 / light.linear);
        let inertia = 1.0 / FREE.angular + 1.0 / light.angular + mass * other / (mass + other) * apart * apart;
        let [x, _, turn] = mobilities.between(0, 1);
        assert!((x[0] - 1.0 / (mass + other)).abs() < 1e-12 && x[1].abs() < 1e-12, "{x:?}");
        assert!((turn[2] - 1.0 / inertia).abs() < 1e-12, "{turn:?}");
        assert_eq!(mobilities.between(0, 1)[1][2], mobilities.between(1, 0)[2][1]);
    }

    #[test]
    fn a_spring_gives_way_between_a_rod_and_nothing() {
        let along = |softness: f64| {
            let rod = HeldRow { softness, ..row(0, [1.0, 0.0, 0.0], 1, [-1.0, 0.0, 0.0]) };
            joined(&[FREE; 2], &[rod]).of(0)[0][0]
        };
        assert_eq!((along(0.0), along(4.0)), (1.0, 1.5));
        assert!((along(1e9) - 2.0).abs() < 1e-6);
    }

    #[test]
    fn a_long_chain_is_held_body_by_body() {
        let count = MOST_JOINED as u32 + 1;
        let hinge = |body: u32| row(body, [1.0, 0.0, 0.0], body + 1, [-1.0, 0.0, 0.0]);
        let anchored = row(0, [1.0, 0.0, 0.0], WALL, [0.0; 3]);
        let chain: Vec<HeldRow> = (0..count - 1).map(hinge).chain([anchored]).collect();
        let mobilities = joined(&vec![FREE; count as usize], &chain);
        assert_eq!(mobilities.companions(3), [3]);
        assert!(mobilities.of(0)[0][0].abs() < 1e-12 && mobilities.of(3)[0][0].abs() < 1e-12);
    }
}
