//! One scene that runs, and what a page does to it.

use serde_json::Value;
use unipbd_core::observe::Table;
use unipbd_core::scene::CheckedScene;
use unipbd_core::{BuildOptions, Edit, Solver, Vector64};
use unipbd_scene_file::Override;

use crate::hand::Hand;
use crate::{answer, describe, pour};

/// Name of a pasted scene in messages.
const NAME: &str = "scene.toml";

/// A scene and its solver.
pub struct Session {
    pub(crate) solver: Solver,
    pub(crate) scene: CheckedScene,
    /// The text and the overrides as one tree.
    pub(crate) tree: Value,
    text: String,
    hand: Option<Hand>,
    /// Backing of the columns that are computed.
    pub(crate) outlines: Vec<f32>,
    pub(crate) poses: Vec<f64>,
}

/// Effect of a change of settings on a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changed {
    /// The run goes on from where it was.
    Continued,
    /// The change makes another scene: it starts anew.
    Restarted,
}

impl Session {
    /// Reads and builds a scene; each line of `settings` is an override, `liquid.water.kinematic_viscosity=2.0`.
    ///
    /// # Errors
    /// The mistakes of the scene as JSON: `text` as a terminal shows them, `problems` with their places.
    pub fn new(text: &str, settings: &str) -> Result<Session, Value> {
        let overrides = overrides(settings)?;
        let scene = unipbd_scene_file::parse(text, NAME, &overrides).map_err(|error| answer::mistakes(&error))?.scene;
        // One thread, which is what a page has.
        let solver = scene.build(BuildOptions { threads: Some(1), seed: None });
        let tree = describe::tree(text, &overrides);
        let text = text.to_owned();
        Ok(Session { solver, scene, tree, text, hand: None, outlines: Vec::new(), poses: Vec::new() })
    }

    /// Replaces all overrides. The run goes on where the new scene can hold its state; else it starts anew.
    ///
    /// # Errors
    /// As [`Session::new`]; the run is not changed then.
    pub fn change(&mut self, settings: &str) -> Result<Changed, Value> {
        let mut next = Session::new(&self.text, settings)?;
        let continued = next.solver.restore(&self.solver.save()).is_ok();
        if continued {
            // A state has its own gravity.
            let gravity = Edit::new().set_gravity(Vector64::from(next.scene.gravity));
            next.solver.apply(&gravity).map_err(|error| answer::failure(&error.to_string()))?;
            next.hand = self.hand.take();
        }
        *self = next;
        Ok(if continued { Changed::Continued } else { Changed::Restarted })
    }

    /// Advances by one frame; returns its substeps.
    ///
    /// # Errors
    /// Why the run cannot go on, as JSON.
    pub fn step(&mut self) -> Result<u32, Value> {
        let report = match self.hand {
            Some(hand) => {
                self.solver.wake_body(hand.body());
                self.solver.step_frame_with(|substep| {
                    hand.pull(substep);
                    Ok(())
                })
            }
            None => self.solver.step_frame(),
        };
        report.map(|report| report.substeps).map_err(|error| answer::failure(&error.to_string()))
    }

    /// Takes hold of the body at a point of the world \[m]; returns its number.
    pub fn grab(&mut self, point: Vector64) -> Option<u32> {
        self.hand = Hand::at(&self.solver, point);
        self.hand.map(|hand| hand.body())
    }

    /// Moves the hand \[m].
    pub fn drag(&mut self, point: Vector64) {
        self.hand.iter_mut().for_each(|hand| hand.target = point);
    }

    /// Lets go.
    pub fn release(&mut self) {
        self.hand = None;
    }

    /// Fills the free places of a disc \[m] with a material; returns the number of particles.
    ///
    /// # Errors
    /// Why nothing could be added, as JSON.
    pub fn pour(&mut self, material: usize, center: Vector64, radius: f64) -> Result<u32, Value> {
        pour::disc(&mut self.solver, material, center, radius).map_err(|message| answer::failure(&message))
    }

    /// Description of the scene for a page, as JSON.
    pub fn describe(&self) -> Value {
        describe::session(self)
    }

    /// The diagnostics under the names of their columns.
    pub fn diagnostics(&self) -> Value {
        let diagnostics = self.solver.diagnostics();
        answer::table(&diagnostics, Table::QUANTITIES)
    }

    /// Hash of the state, as [`Solver::state_hash`].
    pub fn hash(&self) -> u64 {
        self.solver.state_hash()
    }
}

fn overrides(settings: &str) -> Result<Vec<Override>, Value> {
    let lines = settings.lines().filter(|line| !line.trim().is_empty());
    let parsed: Result<Vec<Override>, _> = lines.map(str::parse::<Override>).collect();
    parsed.map_err(|error| answer::failure(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Column;

    const POOL: &str = "spacing = 0.1\n[[liquid]]\nname = \"water\"\n[[block]]\nmaterial = \"water\"\nmin = [0.0, 0.0]\n\
        max = [2.0, 1.0]\n[[tank]]\nmin = [0.0, 0.0]\nmax = [2.0, 3.0]\nopen = [\"top\"]\n\
        [[body]]\nname = \"float\"\nradius = 0.3\nposition = [1.0, 1.8]\ndensity = 300.0\n";

    #[test]
    fn mistakes_have_lines_and_columns() {
        let mistakes = Session::new("spacing = 0.1\n[[liquid]]\nnam = \"water\"\n", "").err().unwrap();
        let first = &mistakes["problems"][0];
        assert_eq!((&first["line"], &first["column"], &first["length"]), (&3.into(), &1.into(), &3.into()));
        assert!(mistakes["text"].as_str().unwrap().contains("^^^"));
    }

    #[test]
    fn a_change_of_viscosity_continues_and_one_of_spacing_restarts() {
        let mut session = Session::new(POOL, "liquid.water.kinematic_viscosity=1.0").unwrap();
        session.step().unwrap();
        let before = session.solver.positions().to_vec();
        assert_eq!(
            session.change("liquid.water.kinematic_viscosity=5.0\ngravity=[0.0, -1.0]").unwrap(),
            Changed::Continued
        );
        assert_eq!(session.solver.positions(), before);
        assert_eq!(session.solver.gravity().y, -1.0);
        session.step().unwrap();
        assert_eq!(session.change("spacing=0.2").unwrap(), Changed::Restarted);
        assert_eq!(session.solver.frame(), 0);
        assert!(session.change("liquid.water.densty=1.0").is_err());
    }

    #[test]
    fn a_hand_lifts_a_body() {
        let mut session = Session::new(POOL, "").unwrap();
        assert_eq!(session.grab(Vector64::new(0.1, 2.9)), None);
        assert_eq!(session.grab(Vector64::new(1.1, 1.9)), Some(0));
        session.drag(Vector64::new(1.0, 2.5));
        (0..90).for_each(|_| assert!(session.step().unwrap() > 0));
        assert!(session.solver.bodies()[0].position.distance(Vector64::new(1.0, 2.5)) < 0.3);
        session.release();
        (0..60).for_each(|_| assert!(session.step().unwrap() > 0));
        assert!(session.solver.bodies()[0].position.y < 1.6);
    }

    #[test]
    fn what_is_poured_fills_free_places_only() {
        let mut session = Session::new(POOL, "").unwrap();
        let before = session.solver.ids().len() as u32;
        let into_air = session.pour(0, Vector64::new(0.4, 2.3), 0.3).unwrap();
        assert!((20..=32).contains(&into_air), "{into_air}");
        assert_eq!(session.pour(0, Vector64::new(0.4, 0.5), 0.3).unwrap(), 0, "the pool is full");
        assert_eq!(session.pour(0, Vector64::new(1.0, 1.8), 0.2).unwrap(), 0, "the body is in the way");
        assert_eq!(session.pour(0, Vector64::new(5.0, 1.0), 0.2).unwrap(), 0, "there is wall");
        assert!(session.pour(7, Vector64::ZERO, 0.2).is_err());
        assert_eq!(session.solver.ids().len() as u32, before + into_air);
        (0..30).for_each(|_| assert!(session.step().unwrap() > 0));
    }

    #[test]
    fn columns_have_a_value_for_each_row() {
        let mut session = Session::new(POOL, "").unwrap();
        let rows = session.solver.ids().len();
        let mut length = |column| session.column(column).len();
        assert_eq!(length(Column::Positions), 2 * rows);
        assert_eq!(length(Column::Velocities), 2 * rows);
        assert_eq!(length(Column::Materials), rows);
        assert_eq!(length(Column::DensityErrors), rows);
        assert_eq!(length(Column::Temperatures), 0);
        assert_eq!(length(Column::Poses), 4);
        assert_eq!(length(Column::Outlines), 5);
        let about = session.describe();
        assert_eq!(about["materials"][0]["name"], "water");
        assert_eq!(about["scene"]["tank"][0]["open"][0], "top");
        assert!(session.diagnostics()["count_liquid"].as_u64().unwrap() > 150);
    }
}
