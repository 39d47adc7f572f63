//! unipbd on the cases of [`Case`].

use unipbd_core::BuildOptions;
use unipbd_core::scene::{Block, Liquid, PressureGridUse, Scene, SolverSettings, Tank};

use super::{Case, GRAVITY, Solver, Spent};
use crate::readback::ReadBack;

/// Frames per second.
const FPS: f64 = 60.0;

struct Unipbd {
    solver: unipbd_core::Solver,
    setting: Setting,
    now: f64,
}

impl Solver for Unipbd {
    fn name(&self) -> String {
        self.setting.name()
    }

    fn advance(&mut self, until: f64) -> Result<Spent, String> {
        let solver = &mut self.solver;
        Ok(Spent::by(&mut self.now, until, || {
            let frame = solver.step_frame().expect("the case does not diverge");
            (solver.frame_time(), u64::from(frame.substeps))
        }))
    }

    fn positions(&self) -> Vec<[f64; 2]> {
        self.solver.positions().iter().map(|x| [f64::from(x.x), f64::from(x.y)]).collect()
    }
}

/// A setting of unipbd.
#[derive(Clone, Copy)]
pub struct Setting {
    /// Kernel radius over the spacing.
    pub radius: f64,
    /// Target compression: it takes as many substeps as that wants.
    pub target: f64,
    /// Whether the pressure grid is on.
    pub grid: bool,
}

impl Setting {
    pub fn name(self) -> String {
        let name = if self.grid { "unipbd, pressure grid" } else { "unipbd" };
        let default = if self.is_default() { " (default)" } else { "" };
        format!("{name}, h = {} dx, target {} %{default}", self.radius, 100.0 * self.target)
    }

    /// Whether a scene that sets nothing has it.
    pub fn is_default(self) -> bool {
        let default = SolverSettings::default();
        self.grid && (self.radius, self.target) == (default.kernel_radius, default.target_compression)
    }
}

/// unipbd with a setting, on one thread.
pub fn unipbd(case: &Case, setting: Setting) -> Result<Box<dyn Solver>, String> {
    let Setting { radius, target, grid } = setting;
    let solver = SolverSettings { kernel_radius: radius, target_compression: target, ..SolverSettings::default() };
    let scene = Scene {
        spacing: case.dx,
        gravity: [0.0, -GRAVITY],
        fps: FPS,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], case.block)],
        tank: vec![Tank::new([0.0, 0.0], case.tank)],
        solver: SolverSettings { pressure_grid: if grid { PressureGridUse::On } else { PressureGridUse::Off }, ..solver },
        ..Scene::default()
    };
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    let solver = scene.build(options).map_err(|problems| problems.to_string())?;
    ReadBack::default()
        .number("spacing", case.dx, solver.spacing())
        .number("frame", 1.0 / FPS, solver.frame_time())
        .same("particles", case.lattice().len(), solver.positions().len())
        .same("threads", 1, solver.threads())
        .done()?;
    Ok(Box::new(Unipbd { solver, setting, now: 0.0 }))
}
