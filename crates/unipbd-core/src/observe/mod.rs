//! The visible side of a run: diagnostics, events, the shapes of its walls.

mod diagnostics;
mod quantity;

use crate::math::Vector64;
use crate::phase::Phase;

pub use diagnostics::{Diagnostics, GaugeReading, GroupDiagnostics, MaterialDiagnostics, SubstepReason, WallForce};
pub use quantity::{Entry, Quantity, Table, Value};

/// How grave an [`Event`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Good to know.
    Info,
    /// The result may be less accurate than asked for.
    Warning,
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Simulated time [s].
    pub time: f64,
    /// How grave it is.
    pub severity: Severity,
    /// Description of the event.
    pub message: String,
}

/// A wall as a line to draw: straight pieces from point to point [m]. Its solid side lies to the
/// right of the way: a box full of wall runs clockwise, a tank to stay in counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct WallOutline {
    /// Corners in order.
    pub points: Vec<Vector64>,
    /// Whether the last point joins the first.
    pub closed: bool,
    /// Half-planes have no end: the line is a stretch of one.
    pub endless: bool,
}

/// A material as a run knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name given in the scene.
    pub name: String,
    /// Phase of its particles.
    pub phase: Phase,
    /// Rest density [kg/m^2]; 0 for smoke.
    pub density: f64,
    /// Colour as red, green, blue.
    pub color: [u8; 3],
}
