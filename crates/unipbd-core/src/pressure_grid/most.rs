//! A bound of the pressure: fluid that is shut in between bodies which contacts hold would bear anything.

/// The largest pressure that can be true.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Most {
    /// Over density, of what rests and flows [m^2/s^2].
    pub pressure: f64,
    /// Speed that may be stopped along the whole grid, within a substep [m/s].
    pub stopped: f64,
}

impl Most {
    /// No limit.
    pub const ANY: Most = Most { pressure: f64::INFINITY, stopped: 0.0 };

    /// Over density, on a grid of this length \[m] [m^2/s^2].
    pub fn over(self, length: f64, dt: f64) -> f64 {
        self.pressure + self.stopped * length / dt
    }
}
