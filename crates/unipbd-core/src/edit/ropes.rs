//! Changes of ropes: whether they can be made, and their application.

use super::error::{EditError, unfit};
use super::world::WorldChange;
use crate::coupling::{MOST_PIECES, RopeReading};
use crate::math::{Vector, vector};
use crate::scene::{BodyDescription, Rope, Scene};
use crate::step::Solver;

/// The ropes that there will be after the changes so far; none for those that were taken away.
pub(super) struct Lines<'a> {
    all: Vec<Option<RopeReading>>,
    kit: &'a Scene,
    pieces: f64,
    ids_left: f64,
}

impl<'a> Lines<'a> {
    pub fn of(solver: &'a Solver) -> Self {
        let all: Vec<_> = solver.ropes().into_iter().map(|rope| (!rope.removed).then_some(rope)).collect();
        let pieces = solver.ropes().iter().map(|rope| rope.points.len() as f64).sum();
        let ids_left = f64::from(u32::MAX - solver.particles().ids_given());
        Lines { all, kit: &solver.world.parts.kit, pieces, ids_left }
    }

    /// Whether a rope can be laid; its bodies are known.
    pub fn add(&mut self, rope: &Rope) -> Result<(), EditError> {
        // Stand-ins for the bodies, well apart.
        let far = |k: usize| [1e3 * (k + 1) as f64 * self.kit.spacing, 0.0];
        let mut names: Vec<&String> = rope.body.iter().chain(&rope.from_body).collect();
        names.dedup();
        let stand_in = |(k, name): (usize, &&String)| BodyDescription {
            name: (*name).clone(),
            ..BodyDescription::disc(2.0 * self.kit.spacing, far(k))
        };
        let body = names.iter().enumerate().map(stand_in).collect();
        let scene = Scene { body, rope: vec![rope.clone()], ..self.kit.clone() };
        if let Some(problem) = scene.validate().0.first() {
            return unfit(format!("the new rope cannot be made: {problem}"));
        }
        let pieces = rope.pieces(self.kit.spacing);
        self.pieces += pieces;
        self.ids_left -= pieces + 1.0;
        if self.pieces > MOST_PIECES || self.ids_left < 1.0 {
            return unfit(format!("the new rope has {pieces:.0} pieces: no more than {MOST_PIECES:.0} fit in a run"));
        }
        self.all.push(Some(RopeReading::new(pieces as u32)));
        Ok(())
    }

    pub fn cut(&mut self, number: u32, piece: u32) -> Result<(), EditError> {
        let rope = self.there(number)?;
        let pieces = rope.points.len() as u32 - 1;
        if piece >= pieces {
            return unfit(format!(
                "the rope {number} has no piece {piece}: they are numbered from 0 to {}",
                pieces - 1
            ));
        }
        if rope.cuts.contains(&piece) {
            return unfit(format!("piece {piece} of the rope {number} is cut already"));
        }
        rope.cuts.push(piece);
        Ok(())
    }

    pub fn remove(&mut self, number: u32) -> Result<(), EditError> {
        self.there(number)?;
        self.all[number as usize] = None;
        Ok(())
    }

    fn there(&mut self, number: u32) -> Result<&mut RopeReading, EditError> {
        match self.all.get_mut(number as usize) {
            Some(Some(rope)) => Ok(rope),
            Some(None) => unfit(format!("the rope {number} was taken away")),
            None => unfit(format!("there is no rope {number}")),
        }
    }
}

impl Solver {
    /// Makes one change of ropes; returns the places where it is felt, and the ids of points to remove.
    pub(super) fn change_ropes(&mut self, change: &WorldChange) -> (Vec<Vector>, Vec<u32>) {
        let parts = &mut self.world.parts;
        let mut ropes = std::mem::take(&mut parts.ropes);
        let (mut places, mut gone) = (Vec::new(), Vec::new());
        match change {
            WorldChange::AddRope(rope) => {
                ropes.add(rope, &parts.kit, &mut parts.particles);
                if let Some(rigid) = &mut parts.rigid {
                    ropes.fasten(ropes.len() - 1, rope, parts.spacing, rigid);
                }
                places.extend([rope.from, rope.to].map(|end| vector(end.into())));
            }
            WorldChange::CutRope { rope, piece } => ropes.cut(*rope as usize, *piece, parts.rigid.as_mut()),
            WorldChange::RemoveRope(rope) => gone.extend(ropes.remove(*rope as usize, parts.rigid.as_mut())),
            _ => {}
        }
        self.world.set_ropes(ropes);
        (places, gone)
    }
}
