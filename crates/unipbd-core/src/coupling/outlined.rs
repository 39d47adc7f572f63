//! Bodies whose outlines are walls of the fluid: static and kinematic ones, which nothing moves that the fluid does.
//! They have no samples among the particles.

use super::RigidBodies;
use crate::constraints::{LightBody, OutlineLoad};
use crate::math::{Vector, direction, vector};
use crate::particles::Particles;
use crate::rigid::{Body, BodyKind, Pose};
use crate::scene::WALL_OF_GRID;
use crate::shapes::Shape;
use crate::walls::{OutlineSpec, Outlines, Place};

/// Bodies thinner than this, in spacings, keep samples: they cover too little of a kernel to hold a fluid.
const THIN: f64 = 1.0;
/// A body of less than this part of the mass of the fluid that it displaces is light.
const LIGHT: f64 = 0.2;

/// How fluids and particles meet the bodies of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met {
    /// Id of the first sample.
    pub first_sample: u32,
    /// Whether bodies that the fluid does not move are walls to it.
    pub outlines: bool,
}

/// How a fluid meets a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Meeting {
    /// Not at all.
    #[default]
    None,
    /// By samples among the particles.
    Samples,
    /// By its outline; the pressure grid moves it, or moves with it.
    Outline,
    /// By its outline, which is a wall of the pressure grid too.
    FixedOutline,
}

/// Whether a body is a wall to fluids by its outline, where the scene lets it.
pub(crate) fn is_outlined(body: &Body, spacing: f64) -> bool {
    let met = !body.samples.is_empty() && !body.surface.no_slip;
    body.kind != BodyKind::Dynamic && met && shape(body).thickness() >= THIN * spacing
}

/// The shape of a body about its centre of mass.
pub(super) fn shape(body: &Body) -> Shape {
    match body.radius > 0.0 {
        true => Shape::Disc { radius: body.radius },
        false => Shape::Polygon(body.outline.clone()),
    }
}

impl RigidBodies {
    /// Whether the fluid meets a body by its outline.
    pub(crate) fn by_outline(&self, body: u32) -> bool {
        let (first, end) = self.sample_ids[body as usize];
        self.outlines && first == end && !self.bodies.samples(body).is_empty()
    }

    /// Finds the bodies that the fluid meets: bodies came, changed or went.
    pub(super) fn find_met(&mut self) {
        let ids = &self.sample_ids;
        let sampled = |body: u32| ids[body as usize].0 < ids[body as usize].1;
        let met = |body: u32| match (sampled(body), self.by_outline(body)) {
            (true, _) => Meeting::Samples,
            (_, true) if self.is_wall_of_grid(body) => Meeting::FixedOutline,
            (_, true) => Meeting::Outline,
            _ => Meeting::None,
        };
        let met: Vec<Meeting> = (0..self.bodies.len() as u32).map(met).collect();
        let mut order: Vec<u32> = (0..self.bodies.len() as u32).filter(|&body| sampled(body)).collect();
        order.sort_unstable_by_key(|&body| ids[body as usize].0);
        (self.met, self.sampled) = (met, order);
    }

    fn is_wall_of_grid(&self, body: u32) -> bool {
        let view = &self.views()[body as usize];
        view.kind == BodyKind::Static && shape(view).thickness() >= WALL_OF_GRID * self.spacing
    }

    /// Takes the outlines that the fluid meets.
    pub(crate) fn set_outlines(&self, outlines: &mut Outlines) {
        let met = (0..self.bodies.len() as u32).filter(|&body| self.by_outline(body));
        outlines.set(met.map(|body| OutlineSpec {
            body,
            shape: shape(&self.views()[body as usize]),
            still: self.views()[body as usize].kind == BodyKind::Static,
            fixed: self.met[body as usize] == Meeting::FixedOutline,
        }));
        self.place_outlines(outlines);
        outlines.find_touching();
    }

    /// Takes the outlines that viscous fluids do not slip along.
    pub(crate) fn set_without_slip(&self, outlines: &mut Outlines) {
        let sticks = |body: &u32| {
            let spec = &self.bodies.specifications()[*body as usize];
            let met = matches!(self.met[*body as usize], Meeting::Samples);
            met && spec.surface.no_slip && spec.matched.is_none()
        };
        outlines.set((0..self.bodies.len() as u32).filter(sticks).map(|body| OutlineSpec {
            body,
            shape: shape(&self.views()[body as usize]),
            still: self.views()[body as usize].kind == BodyKind::Static,
            fixed: false,
        }));
        self.place_outlines(outlines);
    }

    /// Takes the density of the heaviest fluid.
    pub(crate) fn set_heaviest(&mut self, density: f64) {
        self.heaviest = density;
    }

    /// Whether a body is light beside the fluids.
    fn is_light(&self, body: u32) -> bool {
        let view = &self.views()[body as usize];
        let displaced = self.heaviest * view.sample_area * view.samples.len() as f64;
        let met = self.met[body as usize] == Meeting::Samples && self.bodies.elasticity(body as usize).is_none();
        met && self.bodies.is_active(body as usize)
            && self.bodies.is_dynamic(body as usize)
            && view.mass < LIGHT * displaced
    }

    /// The bodies that are light beside the fluids; none is looked at where there is no fluid.
    fn each_light(&self) -> impl Iterator<Item = u32> + '_ {
        let count = if self.heaviest > 0.0 { self.bodies.len() } else { 0 };
        (0..count as u32).filter(|&body| self.is_light(body))
    }

    /// Whether any body is light beside the fluids.
    pub(crate) fn any_light(&self) -> bool {
        self.each_light().next().is_some()
    }

    /// Lists the light bodies where they are predicted to be.
    pub(crate) fn find_light(&mut self) {
        let mut light = std::mem::take(&mut self.light);
        light.clear();
        light.extend(self.each_light().map(|body| LightBody {
            samples: self.sample_ids[body as usize],
            centre: self.bodies.predicted_pose(body).position,
            mobility: self.mobilities.of(body),
        }));
        self.light = light;
    }

    /// The light bodies of this substep.
    pub(crate) fn light(&self) -> &[LightBody] {
        &self.light
    }

    /// Puts outlines where their bodies are, and where they are predicted to be.
    pub(crate) fn place_outlines(&self, outlines: &mut Outlines) {
        let place = |pose: Pose| Place { position: pose.position, axis: direction(pose.angle) };
        outlines.place(|body| [place(self.bodies.pose(body)), place(self.bodies.predicted_pose(body))]);
    }

    /// Adds the forces of the fluid on outlines to their bodies; `loads` are those times dt^2.
    pub(crate) fn take_outline_loads(&mut self, loads: &[OutlineLoad], outlines: &Outlines, dt: f64) {
        let per_square = 1.0 / (dt * dt);
        for (outline, load) in loads.iter().enumerate() {
            if *load != OutlineLoad::default() {
                self.bodies.load(outlines.body(outline), load.force * per_square, load.torque * per_square, dt);
            }
        }
    }

    /// Finds the particles that are inside bodies by their outlines.
    pub(super) fn find_inside(&self, particles: &Particles, outlines: &Outlines, mut visit: impl FnMut(usize, u32)) {
        if outlines.is_empty() {
            return;
        }
        let chunks = particles.position[..particles.awake()].chunks(crate::parallel::CHUNK_ROWS);
        for (number, points) in chunks.enumerate() {
            let first = number * crate::parallel::CHUNK_ROWS;
            outlines.each_inside(points, |k, body| visit(first + k, body));
        }
    }

    /// Visits the places of the samples that bodies met by their outlines do not have: matter in their cells.
    pub(crate) fn each_filled(&self, mut visit: impl FnMut(Vector)) {
        for body in (0..self.bodies.len() as u32).filter(|&body| self.met[body as usize] == Meeting::Outline) {
            let pose = self.bodies.pose(body);
            self.bodies.samples(body).iter().for_each(|&sample| visit(vector(pose.apply(sample))));
        }
    }
}
