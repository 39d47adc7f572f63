//! A bound of the pressure. Fluid shut in between bodies that contacts hold would bear any.

/// A bound of the pressure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressureBound {
    /// Over density, of what rests and flows [m^2/s^2].
    pub pressure: f64,
    /// Speed that may be stopped along the whole grid, within a substep [m/s].
    pub stopped: f64,
}

impl PressureBound {
    /// None.
    pub const NONE: PressureBound = PressureBound { pressure: f64::INFINITY, stopped: 0.0 };

    /// Largest pressure over density on a grid of this length \[m] [m^2/s^2].
    pub fn limit(self, length: f64, dt: f64) -> f64 {
        self.pressure + self.stopped * length / dt
    }
}
