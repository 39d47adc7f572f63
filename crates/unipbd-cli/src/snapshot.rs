//! One output frame as plain arrays: what the recorder writes, the log reader returns and the
//! renderer draws. Row order is arbitrary but the same in all columns.

use unipbd_core::observe::WallOutline;
use unipbd_core::phase::{MaterialIndex, Phase};
use unipbd_core::rigid::Body;

/// One output frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Simulated time \[s].
    pub time: f64,
    /// Positions \[m].
    pub positions: Vec<[f32; 2]>,
    /// Stable ids.
    pub ids: Vec<u32>,
    /// Phase of each particle.
    pub phases: Vec<Phase>,
    /// Material of each particle.
    pub materials: Vec<MaterialIndex>,
    /// Velocities [m/s], where known.
    pub velocities: Option<Vec<[f32; 2]>>,
    /// Density errors C, as fractions, where known.
    pub density_errors: Option<Vec<f32>>,
    /// Temperatures, where known.
    pub temperatures: Option<Vec<f32>>,
    /// Rigid bodies.
    pub bodies: Vec<Body>,
}

impl Snapshot {
    /// Puts the rows in the order of their ids.
    pub fn sort_by_id(&mut self) {
        if self.ids.is_sorted() {
            return;
        }
        let mut order: Vec<usize> = (0..self.ids.len()).collect();
        order.sort_unstable_by_key(|&row| self.ids[row]);
        fn sort<T: Copy>(column: &mut Vec<T>, order: &[usize]) {
            *column = order.iter().map(|&row| column[row]).collect();
        }
        sort(&mut self.positions, &order);
        sort(&mut self.phases, &order);
        sort(&mut self.materials, &order);
        self.velocities.iter_mut().for_each(|column| sort(column, &order));
        self.density_errors.iter_mut().for_each(|column| sort(column, &order));
        self.temperatures.iter_mut().for_each(|column| sort(column, &order));
        sort(&mut self.ids, &order);
    }
}

/// Constant data of a run: the data besides frames that a picture or a log needs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Setting {
    /// Title of the scene.
    pub name: String,
    /// Rest distance of particles \[m].
    pub spacing: f64,
    /// Name, phase and colour of each material.
    pub materials: Vec<unipbd_core::observe::Material>,
    /// Walls to draw.
    pub walls: Vec<WallOutline>,
    /// Region to show, lower left and upper right \[m], where the scene names one.
    pub view: Option<([f64; 2], [f64; 2])>,
}
