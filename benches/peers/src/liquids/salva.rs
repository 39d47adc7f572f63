//! salva2d on the cases of [`Case`].

use nalgebra::Vector2;
use salva2d::LiquidWorld;
use salva2d::object::interaction_groups::InteractionGroups;
use salva2d::object::{Boundary, Fluid, FluidHandle};
use salva2d::solver::{DFSPHSolver, DfsphParameters};

use super::{Case, GRAVITY, Solver, Spent};
use crate::readback::ReadBack;

struct Salva {
    world: LiquidWorld,
    fluid: FluidHandle,
    error: f64,
    dt: f64,
    now: f64,
}

impl Salva {
    fn fluid(&self) -> &Fluid {
        self.world.fluids().get(self.fluid).expect("the fluid stays")
    }

    fn check(&self, case: &Case, asked: DfsphParameters, radius: f32) -> Result<(), String> {
        let found = self.world.dfsph_parameters().ok_or("the solver is not DFSPH")?;
        ReadBack::default()
            .number("density error", f64::from(asked.max_density_error), f64::from(found.max_density_error))
            .same("pressure iterations", asked.max_pressure_iter, found.max_pressure_iter)
            .same("divergence iterations", asked.max_divergence_iter, found.max_divergence_iter)
            .number("particle radius", f64::from(radius), f64::from(self.world.particle_radius()))
            .number("kernel radius", 4.0 * f64::from(radius), f64::from(self.world.h()))
            .number("density", 1000.0, f64::from(self.fluid().density0))
            .same("particles", case.lattice().len(), self.fluid().num_particles())
            .same("threads", 1, rayon::current_num_threads())
            .done()
    }
}

impl Solver for Salva {
    fn name(&self) -> String {
        format!("salva2d 0.11 DFSPH {} %", 100.0 * self.error)
    }

    fn advance(&mut self, until: f64) -> Result<Spent, String> {
        let (world, dt) = (&mut self.world, self.dt);
        Ok(Spent::by(&mut self.now, until, || {
            world.step(dt as f32, &Vector2::new(0.0, -GRAVITY as f32));
            (dt, 1)
        }))
    }

    fn positions(&self) -> Vec<[f64; 2]> {
        self.fluid().positions.iter().map(|x| [f64::from(x.x), f64::from(x.y)]).collect()
    }
}

/// salva2d's DFSPH with this largest density error, a fraction, and two layers of wall particles.
pub fn salva(case: &Case, error: f64) -> Result<Box<dyn Solver>, String> {
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
    let salva = Salva { world, fluid, error, dt: case.step(), now: 0.0 };
    salva.check(case, parameters, radius)?;
    Ok(Box::new(salva))
}

/// Two layers of particles around the tank, open at the top.
fn walls(case: &Case) -> Vec<[f64; 2]> {
    let count = |length: f64| (length / case.dx).round() as i64;
    let (columns, rows) = (count(case.tank[0]), count(case.tank[1]));
    let outside = |&(i, j): &(i64, i64)| i < 0 || i >= columns || j < 0;
    let all = (-2..columns + 2).flat_map(|i| (-2..rows).map(move |j| (i, j)));
    all.filter(outside).map(|(i, j)| [(i as f64 + 0.5) * case.dx, (j as f64 + 0.5) * case.dx]).collect()
}
