//! Pairs of pieces that may touch. The search is repeated only when a piece may leave its enlarged box.

use super::bounds::{Bounds, NONE};
use super::broad::Broad;
use super::pair::{Pair, may_touch};
use super::pieces::{Piece, Pieces};
use super::reach::Reach;
use super::touch::Points;
use crate::math::Vector64;
use crate::rigid::Bodies;

/// Frames for which the enlarged boxes hold a body that goes on as it does.
const ROOM: f64 = 2.0;
/// Room of the enlarged boxes in addition, relative to the size of the piece.
const SIDE: f64 = 0.07;

/// The contacts of a pair in the last search, or at the time it fell asleep.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Span {
    pub first: u32,
    pub count: u32,
    pub frozen: bool,
    pub searched: Searched,
}

/// How two bodies lay when their contacts were searched.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Searched {
    /// Place of one in the coordinates of the other \[m], and their angle \[rad].
    pub place: Vector64,
    pub turn: f64,
    /// All contacts with a smaller gap were found \[m].
    pub room: f64,
    /// Way after which the contacts are searched again \[m].
    pub hold: f64,
    /// The points that touched.
    pub points: Points,
}

impl Span {
    /// Whether it lies within this many contacts.
    pub fn fits(&self, contacts: usize) -> bool {
        self.first as usize + self.count as usize <= contacts
    }

    pub fn range(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// All pairs that may touch.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Pairs {
    excluded: Vec<(u32, u32)>,
    /// Enlarged boxes: pieces may move within them before pairs are searched again.
    fat: Vec<Bounds>,
    pub all: Vec<Pair>,
    pub spans: Vec<Span>,
    /// Pairs with at least one movable body.
    pub active: Vec<Active>,
    /// Flags of the bodies that were movable when `active` was listed.
    was_active: Vec<bool>,
    /// Spans of contacts whose pairs have left the list since its last update began.
    #[serde(skip)]
    pub dropped: Vec<Span>,
    #[serde(skip)]
    scratch: Scratch,
}

/// Buffers of the search.
#[derive(Clone, Default)]
struct Scratch {
    broad: Broad,
    /// Pieces that may leave their enlarged boxes, and a flag for each piece.
    leaving: Vec<u32>,
    leaves: Vec<bool>,
    /// Whether each piece has a new box, and the boxes that were left last.
    moved: Vec<bool>,
    before: Vec<Bounds>,
    /// Pairs that come to the list.
    found: Vec<(u32, u32)>,
    all: Vec<Pair>,
    spans: Vec<Span>,
}

/// A pair with at least one movable body.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Active {
    pub index: u32,
    pub bodies: (u32, u32),
}

impl Pairs {
    /// Disables collisions between these pairs of bodies, and enables all others; whether that changes anything.
    pub fn exclude_only(&mut self, mut pairs: Vec<(u32, u32)>) -> bool {
        pairs.iter_mut().for_each(|(a, b)| (*a, *b) = (*(a.min(b)), *(a.max(b))));
        pairs.sort_unstable();
        pairs.dedup();
        let changed = pairs != self.excluded;
        if changed {
            self.excluded = pairs;
            self.fat.clear();
        }
        changed
    }

    /// Pairs of a saved state, made anew between these pieces; `None` if the state makes no sense.
    pub fn at_saved(&self, saved: Pairs, pieces: &Pieces, bodies: &Bodies) -> Option<Pairs> {
        let count = saved.all.len();
        let ordered = saved.all.windows(2).all(|two| two[0].key < two[1].key);
        let known = |&(a, b): &(u32, u32)| {
            a < b && (b as usize) < pieces.count() && (a as usize) < pieces.all.len() && {
                let solid = pieces.all.get(b as usize).is_none() || pieces.body_of(b) != NONE;
                solid && may_touch(pieces, &self.excluded, bodies, a, b)
            }
        };
        let keys: Vec<(u32, u32)> = saved.all.iter().map(|pair| pair.key).collect();
        let spanned = saved.spans.len() == count;
        // Flags of bodies are read while boxes hold.
        let flagged = saved.fat.is_empty() || saved.was_active.len() == bodies.len();
        if !(ordered && spanned && flagged && keys.iter().all(known)) {
            return None;
        }
        let all: Vec<Pair> = keys.into_iter().map(|key| Pair::new(pieces, key)).collect();
        let listed = |active: &Active| all.get(active.index as usize).is_some_and(|pair| pair.bodies == active.bodies);
        let rising = saved.active.windows(2).all(|two| two[0].index < two[1].index);
        (rising && saved.active.iter().all(listed)).then(|| Pairs { all, excluded: self.excluded.clone(), ..saved })
    }

    /// Makes the list anew after pieces were, given the new place of each old piece; pairs that are left keep their
    /// contacts, with the surfaces of now. Returns their number.
    pub fn rebuild(&mut self, places: &[u32], pieces: &Pieces, bodies: &Bodies) -> usize {
        let spans = std::mem::take(&mut self.spans);
        for (pair, span) in std::mem::take(&mut self.all).into_iter().zip(spans) {
            let key = (places[pair.key.0 as usize], places[pair.key.1 as usize]);
            if key.0 != NONE && key.1 != NONE && may_touch(pieces, &self.excluded, bodies, key.0, key.1) {
                self.all.push(Pair::new(pieces, key));
                self.spans.push(Span { searched: Searched::default(), ..span });
            }
        }
        self.fat.clear();
        self.list_active(bodies);
        self.all.len()
    }

    /// Half-planes follow all pieces: their indices increase with the number of pieces.
    pub fn renumber(&mut self, pieces: &Pieces, added: usize) {
        let first = (pieces.all.len() - added) as u32;
        for pair in self.all.iter_mut().filter(|pair| added > 0 && pair.key.1 >= first) {
            pair.key.1 += added as u32;
        }
    }

    /// Bodies that became movable since the pairs were listed are searched.
    pub fn note_woken(&self, bodies: &Bodies, reach: &mut Reach) -> bool {
        let mut any = false;
        for (id, was) in self.was_active.iter().enumerate() {
            if !was && bodies.is_active(id) {
                (reach.wanted[id], any) = (true, true);
            }
        }
        any
    }

    /// Updates the list to contain all pairs of wanted bodies that can touch until the end of the frame; whether other
    /// bodies can move than in the last one.
    pub fn update(&mut self, pieces: &Pieces, bodies: &Bodies, reach: &mut Reach, gravity: f64) -> bool {
        self.dropped.clear();
        let others = self.was_active.len() != bodies.len()
            || (0..bodies.len()).any(|id| self.was_active[id] != bodies.is_active(id));
        if others {
            self.list_active(bodies);
        }
        reach.note(bodies);
        reach.allow(bodies, gravity, self.active.iter().map(|pair| pair.bodies));
        self.scratch.found.clear();
        self.scratch.moved.clear();
        self.scratch.moved.resize(pieces.all.len(), false);
        // A body near a fast body can be as fast after a collision: with the pairs known, both get the same allowance.
        for _ in 0..2 {
            self.find_leaving(pieces, bodies, reach);
            let known = self.scratch.found.len();
            self.renew(pieces, bodies, reach);
            let found = &self.scratch.found[known..];
            if found.is_empty() {
                break;
            }
            // All others are known.
            reach.allow_for(bodies, gravity, found.iter().map(|&key| Pair::new(pieces, key).bodies));
        }
        if self.replace(pieces) {
            self.list_active(bodies);
        }
        others
    }

    /// Finds the wanted pieces that may leave their enlarged boxes; all pieces, if there are no boxes yet.
    fn find_leaving(&mut self, pieces: &Pieces, bodies: &Bodies, reach: &Reach) {
        let Scratch { leaving, leaves, .. } = &mut self.scratch;
        let anew = self.fat.len() != pieces.all.len();
        let leaves_box = |(k, piece): (usize, &Piece)| {
            anew || (reach.is_wanted(piece.body)
                && bodies.is_active(piece.body as usize)
                && !self.fat[k].holds(&swept(&pieces.bounds[k], reach, piece.body, 1.0, 0.0)))
        };
        leaves.clear();
        leaves.extend(pieces.all.iter().enumerate().map(leaves_box));
        leaving.clear();
        leaving.extend((0..).zip(leaves.iter()).filter(|(_, leaves)| **leaves).map(|(k, _): (u32, _)| k));
    }

    /// New boxes, with room for several frames, for the pieces that leave theirs, and the pairs that come by them.
    fn renew(&mut self, pieces: &Pieces, bodies: &Bodies, reach: &Reach) {
        let (count, Scratch { broad, leaving, moved, before, .. }) = (pieces.all.len(), &mut self.scratch);
        if self.fat.len() != count {
            self.fat.clear();
            self.fat.resize(count, Bounds::EMPTY);
        }
        before.resize(count, Bounds::EMPTY);
        for &k in &*leaving {
            let (piece, bounds) = (&pieces.all[k as usize], &pieces.bounds[k as usize]);
            let new = match piece.body {
                NONE => *bounds,
                body => swept(bounds, reach, body, ROOM, SIDE * piece.size),
            };
            before[k as usize] = std::mem::replace(&mut self.fat[k as usize], new);
            moved[k as usize] = true;
        }
        if broad.len() == count {
            leaving.iter().for_each(|&k| broad.set(k, &self.fat[k as usize]));
        } else {
            broad.restart(&self.fat, pieces.bounds.iter().map(Bounds::extent));
        }
        self.find_new(pieces, bodies);
    }

    /// Finds the pairs whose boxes overlap now, and did not before. The list has all that did.
    fn find_new(&mut self, pieces: &Pieces, bodies: &Bodies) {
        let (fat, Scratch { broad, leaving, leaves, before, found, .. }) = (&self.fat, &mut self.scratch);
        let allowed = |a: u32, b: u32| may_touch(pieces, &self.excluded, bodies, a.min(b), a.max(b));
        for &a in &*leaving {
            let (now, then) = (&fat[a as usize], &before[a as usize]);
            broad.each_near(a, |b| {
                // A pair of two pieces that leave their boxes is found from both.
                let leaves_too = leaves[b as usize];
                let once = b != a && (a < b || !leaves_too);
                let other = if leaves_too { &before[b as usize] } else { &fat[b as usize] };
                if once && now.overlaps(&fat[b as usize]) && !then.overlaps(other) && allowed(a, b) {
                    found.push((a.min(b), a.max(b)));
                }
            });
            for (plane, index) in pieces.half_planes.iter().zip(fat.len() as u32..) {
                if plane.meets(now) && !plane.meets(then) && allowed(a, index) {
                    found.push((a, index));
                }
            }
        }
    }

    /// Drops the pairs whose boxes overlap no longer, and adds those found; all others keep their data. Returns whether
    /// the list changed.
    fn replace(&mut self, pieces: &Pieces) -> bool {
        let (fat, Scratch { moved, found, all, spans, .. }) = (&self.fat, &mut self.scratch);
        found.sort_unstable();
        found.dedup();
        let stays = |pair: &Pair| {
            let (a, b) = (pair.key.0 as usize, pair.key.1 as usize);
            match pieces.half_plane(pair.key.1) {
                Some(plane) => !moved[a] || plane.meets(&fat[a]),
                None => !(moved[a] || moved[b]) || fat[a].overlaps(&fat[b]),
            }
        };
        if found.is_empty() && self.all.iter().all(stays) {
            return false;
        }
        let add = |key: (u32, u32), all: &mut Vec<Pair>, spans: &mut Vec<Span>| {
            all.push(Pair::new(pieces, key));
            spans.push(Span::default());
        };
        let (mut new, mut from) = (found.iter().copied().peekable(), 0);
        for (k, (pair, span)) in self.all.iter().zip(&self.spans).enumerate() {
            let stays = stays(pair);
            if stays && new.peek().is_none_or(|key| *key > pair.key) {
                continue;
            }
            all.extend_from_slice(&self.all[from..k]);
            spans.extend_from_slice(&self.spans[from..k]);
            from = if stays { k } else { k + 1 };
            while let Some(key) = new.next_if(|key| *key < pair.key) {
                add(key, all, spans);
            }
            // It is known already where all boxes are new.
            new.next_if_eq(&pair.key);
            if !stays && span.count > 0 && !span.frozen {
                self.dropped.push(*span);
            }
        }
        all.extend_from_slice(&self.all[from..]);
        spans.extend_from_slice(&self.spans[from..]);
        new.for_each(|key| add(key, all, spans));
        self.all.clear();
        self.spans.clear();
        std::mem::swap(&mut self.all, all);
        std::mem::swap(&mut self.spans, spans);
        true
    }

    fn list_active(&mut self, bodies: &Bodies) {
        self.was_active.clear();
        self.was_active.extend((0..bodies.len()).map(|id| bodies.is_active(id)));
        let moving = |body: u32| body != NONE && self.was_active[body as usize];
        let listed = self.all.iter().zip(0..).filter(|(pair, _)| moving(pair.bodies.0) || moving(pair.bodies.1));
        self.active.clear();
        self.active.extend(listed.map(|(pair, index)| Active { index, bodies: pair.bodies }));
    }
}

/// The box that a piece covers on its way, for so many frames, with room around it \[m].
fn swept(bounds: &Bounds, reach: &Reach, body: u32, frames: f64, room: f64) -> Bounds {
    let (way, off) = reach.sweep(body);
    let way = way.linear * frames;
    let (low, high) = (bounds.low + way.min(Vector64::ZERO), bounds.high + way.max(Vector64::ZERO));
    Bounds { low, high }.grown(off * frames + room)
}
