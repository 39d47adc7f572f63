//! Positions of particles from frame to frame, as small numbers.

use std::collections::HashMap;

use crate::render::view::View;
use crate::snapshot::Snapshot;

/// Quanta in a spacing: finer than a pixel shows.
const QUANTA_PER_SPACING: f64 = 16.0;
/// Widths of the view in which particles are told apart from its edge.
const REACH: f64 = 3.0;

/// The particles of all frames so far.
pub(super) struct Motion {
    /// Centre of the region \[m].
    pub middle: [f64; 2],
    /// Step of positions \[m].
    pub quantum: f64,
    /// Ids, materials and places of the last frame, and where each particle was in the frame before.
    last: Option<Places>,
    earlier: Option<[Vec<i16>; 2]>,
    frames: Vec<Vec<u8>>,
}

struct Places {
    ids: Vec<u32>,
    materials: Vec<u8>,
    places: [Vec<i16>; 2],
    from: Option<Vec<u32>>,
}

/// No row: a particle that was not there.
const NEW: u32 = u32::MAX;

impl Motion {
    pub fn new(view: View, spacing: f64) -> Motion {
        let span = (0..2).map(|axis| view.max[axis] - view.min[axis]).fold(0.0, f64::max);
        let quantum = (spacing / QUANTA_PER_SPACING).max(REACH * span / f64::from(u16::MAX));
        let middle = [0, 1].map(|axis| 0.5 * (view.min[axis] + view.max[axis]));
        Motion { middle, quantum, last: None, earlier: None, frames: Vec::new() }
    }

    /// The bytes of a frame.
    pub fn frame(&self, number: usize) -> &[u8] {
        &self.frames[number]
    }

    pub fn push(&mut self, frame: &Snapshot) {
        let materials: Vec<u8> = frame.materials.iter().map(|material| (*material).min(255) as u8).collect();
        let places =
            [0, 1].map(|axis| frame.positions.iter().map(|at| self.quanta(at[axis], axis)).collect::<Vec<i16>>());
        let same = |last: &Places| last.ids == frame.ids && last.materials == materials;
        let from = if self.last.as_ref().is_some_and(same) { None } else { Some(self.rows_before(&frame.ids)) };
        let mut bytes = (frame.ids.len() as u32).to_le_bytes().to_vec();
        bytes.push(u8::from(from.is_some()));
        if let Some(from) = &from {
            // Mostly the row after that of the particle before: zeros.
            let before = std::iter::once(NEW).chain(from.iter().copied());
            let steps = from.iter().zip(before).map(|(row, before)| row.wrapping_sub(before.wrapping_add(1)));
            bytes.extend(steps.flat_map(u32::to_le_bytes));
            bytes.extend(&materials);
        }
        for (axis, places) in places.iter().enumerate() {
            let folded =
                |(row, place): (usize, &i16)| fold(place.wrapping_sub(self.expected(from.as_deref(), axis, row)));
            let folded: Vec<u16> = places.iter().enumerate().map(folded).collect();
            bytes.extend(folded.iter().map(|value| value.to_le_bytes()[0]));
            bytes.extend(folded.iter().map(|value| value.to_le_bytes()[1]));
        }
        self.frames.push(bytes);
        self.earlier = self.last.take().map(|last| last.places);
        self.last = Some(Places { ids: frame.ids.clone(), materials, places, from });
    }

    fn quanta(&self, position: f32, axis: usize) -> i16 {
        let steps = (f64::from(position) - self.middle[axis]) / self.quantum;
        steps.round().clamp(f64::from(i16::MIN), f64::from(i16::MAX)) as i16
    }

    fn rows_before(&self, ids: &[u32]) -> Vec<u32> {
        let before = self.last.iter().flat_map(|last| &last.ids);
        let rows: HashMap<u32, u32> = before.copied().zip(0..).collect();
        ids.iter().map(|id| rows.get(id).copied().unwrap_or(NEW)).collect()
    }

    /// A particle goes on as it went; one that is new starts at the middle.
    fn expected(&self, from: Option<&[u32]>, axis: usize, row: usize) -> i16 {
        let one = from.map_or(row as u32, |from| from[row]);
        let Some(last) = self.last.as_ref().filter(|_| one != NEW) else { return 0 };
        let two = last.from.as_ref().map_or(one, |from| from[one as usize]);
        let place = last.places[axis][one as usize];
        match &self.earlier {
            Some(earlier) if two != NEW => place.wrapping_mul(2).wrapping_sub(earlier[axis][two as usize]),
            _ => place,
        }
    }
}

/// 0, -1, 1, -2 ... as 0, 1, 2, 3 ...
fn fold(value: i16) -> u16 {
    ((value << 1) ^ (value >> 15)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_steps_of_either_sign_fold_to_small_numbers() {
        assert_eq!([0, -1, 1, -2, 2, i16::MIN].map(fold), [0, 1, 2, 3, 4, u16::MAX]);
    }

    #[test]
    fn a_steady_motion_costs_nothing_but_zeros() {
        let view = View { min: [0.0; 2], max: [1.0; 2] };
        let mut motion = Motion::new(view, 0.016);
        for k in 0..4_u8 {
            let position = [0.5 + 0.01 * f32::from(k), 0.25];
            motion.push(&Snapshot {
                positions: vec![position],
                ids: vec![3],
                materials: vec![0],
                ..Snapshot::default()
            });
        }
        assert!(motion.quantum < 0.00101);
        // Count, mark, and four bytes of residual.
        assert_eq!(motion.frame(0).len(), 5 + 4 + 1 + 4);
        assert_eq!(motion.frame(3), [1, 0, 0, 0, 0, 0, 0, 0, 0]);
    }
}
