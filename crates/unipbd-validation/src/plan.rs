//! The lines of the accuracy sheet: which cases at which settings.

use unipbd_core::scene::SolverSettings;

use crate::case::Case;

/// Cases of one liquid in static walls, and near enough ones: they run with a coarse projection too.
const COARSE: [&str; 4] = ["column", "dam_break", "standing_wave", "elliptical_drop"];

/// The solver with this target.
pub fn settings(target: f64) -> SolverSettings {
    SolverSettings { target_compression: target, ..SolverSettings::default() }
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
    /// Whether a coarse projection goes before that of the particles.
    pub coarse: bool,
}

impl Line {
    /// The line of a case at its quick size.
    pub fn quick(case: &'static Case) -> Line {
        Line { case, resolution: case.quick, target: 0.01, coarse: false }
    }

    /// How the constraints are solved.
    pub fn solver(&self) -> SolverSettings {
        SolverSettings { coarse_projection: if self.coarse { 3 } else { 0 }, ..settings(self.target) }
    }
}

impl std::fmt::Display for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let coarse = if self.coarse { ", coarse projection" } else { "" };
        write!(f, "{} at {}, target {}{coarse}", self.case.name, self.resolution, self.target)
    }
}

/// The lines of a case in the sheet.
pub fn lines(case: &'static Case) -> Vec<Line> {
    let mut resolutions = case.full.to_vec();
    resolutions.dedup();
    let at = |resolution: u32| {
        let line = move |target: f64, coarse: bool| Line { case, resolution, target, coarse };
        let coarse = COARSE.contains(&case.name).then(|| line(0.01, true));
        case.targets.iter().map(move |&target| line(target, false)).chain(coarse)
    };
    resolutions.into_iter().flat_map(at).collect()
}
