//! Velocities from positions, for logs that have none.

use std::collections::HashMap;

use crate::snapshot::Snapshot;

/// Fills in velocities by differences to the frame before.
#[derive(Default)]
pub struct Speeds {
    time: f64,
    places: HashMap<u32, [f32; 2]>,
}

impl Speeds {
    /// Gives a frame velocities unless it has them: 0 to a particle that was not in the frame before.
    pub fn fill(&mut self, frame: &mut Snapshot) {
        if frame.velocities.is_some() {
            return;
        }
        let span = (frame.time - self.time) as f32;
        let velocity = |(id, [x, y]): (&u32, &[f32; 2])| match self.places.get(id) {
            Some([old_x, old_y]) if span > 0.0 => [(x - old_x) / span, (y - old_y) / span],
            _ => [0.0; 2],
        };
        let velocities = frame.ids.iter().zip(&frame.positions).map(velocity).collect();
        self.time = frame.time;
        self.places = frame.ids.iter().copied().zip(frame.positions.iter().copied()).collect();
        frame.velocities = Some(velocities);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_are_differences_by_id() {
        let mut speeds = Speeds::default();
        let mut first = Snapshot { ids: vec![4, 7], positions: vec![[0.0, 0.0], [1.0, 1.0]], ..Snapshot::default() };
        speeds.fill(&mut first);
        assert_eq!(first.velocities, Some(vec![[0.0; 2]; 2]));
        let (ids, positions) = (vec![7, 9], vec![[1.5, 0.0], [3.0, 3.0]]);
        let mut second = Snapshot { time: 0.5, ids, positions, ..Snapshot::default() };
        speeds.fill(&mut second);
        assert_eq!(second.velocities, Some(vec![[1.0, -2.0], [0.0; 2]]));
    }
}
