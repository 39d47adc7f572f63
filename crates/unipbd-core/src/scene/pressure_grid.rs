//! Whether a scene uses the pressure grid.

use super::{BodyDescription, BodyKind, BodySolver, JointDescription, JointRule, Scene, Substeps};
use crate::shapes::Shape;
use crate::union_find::UnionFind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Fewer particles fill so few cells that the grid is all surface.
const LEAST_PARTICLES: f64 = 60.0;

/// Bodies that nothing moves are walls of the grid from this thickness on, in spacings: two of its cells. Thinner ones
/// could lie between the corners of its cells, and water of 50 spacings leaks through them.
pub(crate) const WALL_OF_GRID: f64 = 4.0;

/// Bodies on joints that answer to the pressure together, at most: the cost grows as their cube.
pub(crate) const MOST_JOINED: usize = 32;

/// Width of a cell of the grid \[spacings]; along periodic axes it may differ by this part.
pub(crate) const CELL: f64 = 2.0;
const CELL_ERROR: f64 = 0.12;
/// How well cells fill a period, and the least number of them.
const PERIOD_ERROR: f64 = 1e-5;
const LEAST_PERIOD: f64 = 8.0;

/// Whether a grid carries the smooth part of the pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum PressureGridUse {
    /// Where it supports the scene and pays.
    #[default]
    Auto,
    /// Always.
    On,
    /// Never: the particles alone carry the pressure.
    Off,
}

/// The decision about the pressure grid, and its reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PressureGridChoice {
    /// Whether the scene uses the grid.
    pub used: bool,
    /// Why.
    pub reason: String,
}

impl PressureGridChoice {
    fn off(reason: impl Into<String>) -> Self {
        PressureGridChoice { used: false, reason: reason.into() }
    }
}

impl Scene {
    /// Whether the scene uses the pressure grid, and why.
    pub fn pressure_grid(&self) -> PressureGridChoice {
        match self.solver.pressure_grid {
            PressureGridUse::On => PressureGridChoice { used: true, reason: "solver.pressure_grid is \"on\"".into() },
            PressureGridUse::Off => PressureGridChoice::off("solver.pressure_grid is \"off\""),
            PressureGridUse::Auto => self.where_the_grid_pays(),
        }
    }

    /// Whether the scene uses the pressure grid.
    pub fn uses_pressure_grid(&self) -> bool {
        self.pressure_grid().used
    }

    /// Whether particles alone carry the pressure around bodies that fluids move: they resist being rearranged, the more the
    /// higher the pressure, and so slow what sinks and rises in them.
    pub fn slows_bodies(&self) -> bool {
        let fluid = self.materials().any(|material| material.phase().is_fluid());
        fluid && self.body.iter().any(|body| body.kind == BodyKind::Dynamic) && !self.uses_pressure_grid()
    }

    fn where_the_grid_pays(&self) -> PressureGridChoice {
        if let Some((what, _)) = self.pressure_grid_obstacles().first() {
            return PressureGridChoice::off(format!("it does not support {what}"));
        }
        if let Substeps::Fixed(count) = self.solver.substeps {
            return PressureGridChoice::off(format!("the number of substeps is fixed at {count}"));
        }
        if self.has_tied_particles() {
            return PressureGridChoice::off("water around ropes and soft bodies is calmer without it");
        }
        if self.solver.sleep {
            return PressureGridChoice::off("a pool that was stirred seldom falls asleep with it");
        }
        if let Some(reason) = self.hard_joint() {
            return PressureGridChoice::off(reason);
        }
        if self.liquid.iter().any(|liquid| liquid.surface_tension != 0.0) {
            return PressureGridChoice::off("its cells are too wide for surface tension");
        }
        if let Some(name) = self.thin_wall() {
            return PressureGridChoice::off(format!("its cells are too wide for the wall that the body {name} is"));
        }
        if !self.has_closed_tank() && !self.is_endless() && self.materials().any(|material| material.is_two_sided()) {
            return PressureGridChoice::off("gas in the open does not keep its momentum with it");
        }
        if self.domain_repeats() && self.has_several_densities() {
            return PressureGridChoice::off("in periodic domains liquids of several densities stay mixed with it");
        }
        let particles = self.most_particles();
        if particles < LEAST_PARTICLES {
            return PressureGridChoice::off(format!("{particles} particles are too few for it to pay"));
        }
        PressureGridChoice { used: true, reason: "substeps then follow the speed alone".into() }
    }

    /// Whether particles hang together: as ropes, solids and soft bodies.
    pub(crate) fn has_tied_particles(&self) -> bool {
        let matched = |body: &BodyDescription| body.solver == BodySolver::ShapeMatching;
        !self.rope.is_empty() || !self.solid.is_empty() || self.body.iter().any(matched)
    }

    /// Whether a tank is closed on all sides.
    pub(crate) fn has_closed_tank(&self) -> bool {
        self.tank.iter().any(|tank| tank.open.is_empty())
    }

    /// Whether the domain has no end along both axes.
    fn is_endless(&self) -> bool {
        self.domain.periodic_x.is_some() && self.domain.periodic_y.is_some()
    }

    /// Whether the domain repeats along an axis.
    fn domain_repeats(&self) -> bool {
        self.domain.periodic_x.is_some() || self.domain.periodic_y.is_some()
    }

    fn has_several_densities(&self) -> bool {
        let mut masses = self.materials().filter(|m| m.phase().is_fluid()).map(|m| m.particle_mass(self.spacing));
        masses.next().is_some_and(|first| masses.any(|mass| mass != first))
    }

    /// Cells of the pressure grid in each period, zero without one. `None` where its square cells, about two spacings wide,
    /// fill the periods in no even number.
    pub(crate) fn cells_of_periods(&self) -> Option<[usize; 2]> {
        let lengths = [self.domain.periodic_x, self.domain.periodic_y].map(|period| period.map(|[from, to]| to - from));
        let Some(first) = lengths[0].or(lengths[1]) else { return Some([0; 2]) };
        let fits = |cell: f64, length: Option<f64>| {
            let cells = length.map_or(0.0, |length| length / cell);
            let whole = (cells / 2.0).round() * 2.0;
            let even = (cells - whole).abs() <= PERIOD_ERROR * whole;
            (even && (length.is_none() || whole >= LEAST_PERIOD)).then_some(whole as usize)
        };
        // Multiples of eight are halved most often by the coarser grids.
        let counts = [8.0, 4.0, 2.0].into_iter().flat_map(|step| {
            let nearest = (first / (CELL * self.spacing) / step).round();
            [0.0, -1.0, 1.0].map(|aside| (nearest + aside) * step)
        });
        let near = counts.filter(|count| (first / (count * CELL * self.spacing) - 1.0).abs() <= CELL_ERROR);
        let mut cells = near.map(|count| lengths.map(|length| fits(first / count, length)));
        cells.find_map(|[x, y]| Some([x?, y?]))
    }

    /// A body that no fluid moves and that is thinner than walls of the grid are.
    fn thin_wall(&self) -> Option<String> {
        let fixed = |body: &&BodyDescription| body.kind != BodyKind::Dynamic && !body.sensor;
        self.body.iter().filter(fixed).find(|body| self.is_thin(body)).map(|body| format!("{:?}", body.name))
    }

    /// Whether a body is thinner than walls of the grid are.
    fn is_thin(&self, body: &BodyDescription) -> bool {
        let shape = body.shape();
        // The scene may not have been validated yet.
        if shape.check().is_err() {
            return false;
        }
        // The width of a compact body is twice its reach from the centre.
        let reach = -shape.nearest(shape.moments().centroid).distance;
        shape.thickness().max(2.0 * reach) < (WALL_OF_GRID - 0.5) * self.spacing
    }

    /// Why bodies on a joint move worse with the grid.
    fn hard_joint(&self) -> Option<String> {
        let moving = self.moving_bodies();
        let turns = |joint: &&JointDescription| matches!(joint.kind, JointRule::Hinge | JointRule::Slider);
        for joint in self.joint.iter().filter(turns) {
            let mut joined = ends(joint).map(|name| name.and_then(|name| moving.get(name)));
            joined.sort_unstable();
            for body in joined.into_iter().flatten().map(|&number| &self.body[number as usize]) {
                if self.is_thin(body) {
                    return Some(format!("its cells are too wide for the body {:?} on a joint", body.name));
                }
                if joint.kind == JointRule::Hinge && is_hollowed(&body.shape()) {
                    return Some(format!("the body {:?} would turn too slowly with it: it is not convex", body.name));
                }
            }
        }
        let most = self.longest_chain(&moving);
        (most > MOST_JOINED).then(|| format!("it does not carry chains of {most} bodies on joints"))
    }

    /// The numbers of the moving bodies by their names.
    fn moving_bodies(&self) -> BTreeMap<&str, u32> {
        let moving = (0..).zip(&self.body).filter(|(_, body)| body.kind == BodyKind::Dynamic);
        moving.map(|(number, body)| (body.name.as_str(), number)).collect()
    }

    /// Number of moving bodies that hang together by joints, at most.
    fn longest_chain(&self, moving: &BTreeMap<&str, u32>) -> usize {
        let mut chains = UnionFind::default();
        chains.reset(self.body.len());
        for joint in &self.joint {
            if let [Some(a), Some(b)] = ends(joint).map(|name| name.and_then(|name| moving.get(name))) {
                chains.unite(*a, *b);
            }
        }
        let mut lengths = vec![0; self.body.len()];
        (0..self.body.len() as u32).for_each(|body| lengths[chains.root(body) as usize] += 1);
        lengths.into_iter().max().unwrap_or(0)
    }

    /// The properties of the scene that the pressure grid does not support, and what to do about each.
    pub(crate) fn pressure_grid_obstacles(&self) -> Vec<(&'static str, &'static str)> {
        const OFF: &str = "write \"auto\" or \"off\": the particles alone carry the pressure of such a scene";
        let periodic = self.domain_repeats();
        let dry = !self.materials().any(|material| material.phase().is_fluid());
        let all = [
            (dry, "a scene without a fluid", OFF),
            (periodic && !self.body.is_empty(), "bodies in periodic domains", OFF),
            (self.cells_of_periods().is_none(), "periods that are no even number of square cells", OFF),
            (self.legacy.changes_density(), "the density constraints of [legacy]", "leave out the table [legacy]"),
        ];
        all.into_iter().filter(|(stands, ..)| *stands).map(|(_, what, instead)| (what, instead)).collect()
    }
}

/// The names of the bodies of a joint.
fn ends(joint: &JointDescription) -> [Option<&str>; 2] {
    [Some(joint.body.as_str()), joint.other.as_deref()]
}

/// Whether a shape has corners that point inwards, as a wheel with paddles has.
fn is_hollowed(shape: &Shape) -> bool {
    let Shape::Polygon(corners) = shape else { return false };
    let (count, corner) = (corners.len(), |k: usize| corners[k % corners.len()]);
    let turns = (0..count).map(|k| (corner(k + 1) - corner(k)).perp_dot(corner(k + 2) - corner(k + 1)));
    let (least, most) = turns.fold((0.0_f64, 0.0_f64), |(least, most), turn| (least.min(turn), most.max(turn)));
    let straight = 1e-9 * most.max(-least);
    least < -straight && most > straight
}
