//! The lines of the accuracy sheet: which cases at which settings.

use unipbd_core::scene::{PressureGridUse, SolverSettings};

use crate::case::Case;

/// Cases of one liquid in static walls, and near enough ones: they run with the pressure grid too.
const WITH_GRID: [&str; 5] = ["column", "dam_break", "standing_wave", "elliptical_drop", "oscillating_drop"];

/// Cases that are there for the pressure grid: their quick size runs with it.
const FOR_GRID: [&str; 11] = [
    "solitary_wave",
    "drain",
    "taylor_green_box",
    "vortex_pair",
    "vortex_pair_gas",
    "light_floats",
    "added_mass",
    "piston",
    "press",
    "slab",
    "work",
];

/// The particles alone, with this target.
pub fn settings(target: f64) -> SolverSettings {
    SolverSettings { target_compression: target, pressure_grid: PressureGridUse::Off, ..SolverSettings::default() }
}

/// One line of the sheet: a case and how it runs.
#[derive(Clone, Copy)]
pub struct Line {
    /// The case.
    pub case: &'static Case,
    /// Particles along its length.
    pub resolution: u32,
    /// Target compression.
    pub target: f64,
    /// Whether the pressure grid is on.
    pub grid: bool,
}

impl Line {
    /// The line of a case at its quick size.
    pub fn quick(case: &'static Case) -> Line {
        Line { case, resolution: case.quick, target: 0.01, grid: FOR_GRID.contains(&case.name) }
    }

    /// How the constraints are solved.
    pub fn solver(&self) -> SolverSettings {
        let pressure_grid = if self.grid { PressureGridUse::On } else { PressureGridUse::Off };
        SolverSettings { pressure_grid, ..settings(self.target) }
    }
}

impl std::fmt::Display for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let grid = if self.grid { ", pressure grid" } else { "" };
        write!(f, "{} at {}, target {}{grid}", self.case.name, self.resolution, self.target)
    }
}

/// The lines of a case in the sheet.
pub fn lines(case: &'static Case) -> Vec<Line> {
    let mut resolutions = case.full.to_vec();
    resolutions.dedup();
    let at = |resolution: u32| {
        let line = move |target: f64, grid: bool| Line { case, resolution, target, grid };
        let with_grid = (WITH_GRID.contains(&case.name) || FOR_GRID.contains(&case.name)).then(|| line(0.01, true));
        case.targets.iter().map(move |&target| line(target, false)).chain(with_grid)
    };
    resolutions.into_iter().flat_map(at).collect()
}
