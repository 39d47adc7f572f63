//! unipbd and salva2d on the cases of [`Case`].

use nalgebra::Vector2;
use salva2d::LiquidWorld;
use salva2d::object::interaction_groups::InteractionGroups;
use salva2d::object::{Boundary, Fluid, FluidHandle};
use salva2d::solver::{DFSPHSolver, DfsphParameters};
use unipbd_core::scene::{Block, Liquid, Scene, SolverSettings, Tank};
use unipbd_core::{BuildOptions, Solver};

use crate::case::{Case, Outcome, Runs, run};

struct Ours(Solver);

impl Runs for Ours {
    fn step(&mut self) -> f64 {
        self.0.step_frame().expect("the case does not diverge");
        self.0.frame_time()
    }
    fn positions(&self) -> Vec<[f64; 2]> {
        self.0.positions().iter().map(|x| [f64::from(x.x), f64::from(x.y)]).collect()
    }
}

/// A setting of unipbd.
#[derive(Clone, Copy)]
pub struct Setting {
    /// Kernel radius over the spacing.
    pub radius: f64,
    /// Target compression: it takes as many substeps as that wants.
    pub target: f64,
    /// Whether a coarse projection goes before that of the particles.
    pub coarse: bool,
}

/// unipbd with a setting, on one thread.
pub fn unipbd(case: &Case, setting: Setting) -> Outcome {
    let Setting { radius, target, coarse } = setting;
    let solver = SolverSettings { kernel_radius: radius, target_compression: target, ..SolverSettings::default() };
    let scene = Scene {
        spacing: case.dx,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], case.block)],
        tank: vec![Tank::new([0.0, 0.0], case.tank)],
        solver: SolverSettings { coarse_projection: if coarse { 3 } else { 0 }, ..solver },
        ..Scene::default()
    };
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    let solver = scene.build(options).unwrap_or_else(|problems| panic!("{problems}"));
    let name = if coarse { "unipbd, coarse projection" } else { "unipbd" };
    run(case, format!("{name}, h = {radius} dx, target {} %", 100.0 * target), &mut Ours(solver))
}

struct Salva {
    world: LiquidWorld,
    fluid: FluidHandle,
    dt: f32,
}

impl Runs for Salva {
    fn step(&mut self) -> f64 {
        self.world.step(self.dt, &Vector2::new(0.0, -9.81));
        f64::from(self.dt)
    }
    fn positions(&self) -> Vec<[f64; 2]> {
        let fluid = self.world.fluids().get(self.fluid).expect("the fluid stays");
        fluid.positions.iter().map(|x| [f64::from(x.x), f64::from(x.y)]).collect()
    }
}

/// salva2d's DFSPH with this largest density error, a fraction, and two layers of wall particles.
pub fn salva(case: &Case, error: f64, dt: f64) -> Outcome {
    let parameters = DfsphParameters { max_density_error: error as f32, ..DfsphParameters::default() };
    let solver: DFSPHSolver = DFSPHSolver::with_parameters(parameters);
    // Its particle volume is 0.8 (2 r)^2: that of the lattice.
    let radius = (case.dx / (2.0 * 0.8_f64.sqrt())) as f32;
    let mut world = LiquidWorld::new(solver, radius, 2.0, 1.0);
    let vector = |x: [f64; 2]| Vector2::new(x[0] as f32, x[1] as f32);
    let places = case.lattice().into_iter().map(vector).collect();
    let fluid = world.add_fluid(Fluid::new(places, radius, 1000.0, InteractionGroups::all()));
    let walls = walls(case).into_iter().map(vector).collect();
    world.add_boundary(Boundary::new(walls, InteractionGroups::all()));
    let name = format!("salva2d DFSPH {} %", 100.0 * error);
    run(case, name, &mut Salva { world, fluid, dt: dt as f32 })
}

/// Two layers of particles around the tank, open at the top.
fn walls(case: &Case) -> Vec<[f64; 2]> {
    let count = |length: f64| (length / case.dx).round() as i64;
    let (columns, rows) = (count(case.tank[0]), count(case.tank[1]));
    let outside = |&(i, j): &(i64, i64)| i < 0 || i >= columns || j < 0;
    let all = (-2..columns + 2).flat_map(|i| (-2..rows).map(move |j| (i, j)));
    all.filter(outside).map(|(i, j)| [(i as f64 + 0.5) * case.dx, (j as f64 + 0.5) * case.dx]).collect()
}
