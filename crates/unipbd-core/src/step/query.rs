//! Questions to a world between two frames: rays, places, neighbours, contacts.

use super::Solver;
use crate::math::{Vector64, wide};
use crate::phase::Phase;
use crate::rigid::{Body, ContactEvent, ContactPair, ContactPoint, Outline, Pose, box_outline};

/// A body or a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// A body, by its place in [`Solver::bodies`].
    Body(u32),
    /// A wall, in the order of the scene: half-planes, closed sides of tanks (left, right, bottom, top), obstacles.
    Wall(u32),
}

/// Where a ray meets a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The solid that it meets.
    pub solid: Solid,
    /// Where \[m].
    pub point: Vector64,
    /// Outward normal there, of length 1.
    pub normal: Vector64,
    /// Part of the way from the start of the ray to its end, 0 to 1.
    pub fraction: f64,
}

/// The outline nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestSolid {
    /// The solid to which it belongs.
    pub solid: Solid,
    /// Distance, negative inside \[m].
    pub distance: f64,
    /// The nearest point of the outline \[m].
    pub point: Vector64,
    /// Outward normal there, of length 1.
    pub normal: Vector64,
}

/// Which solids a question is about: all but sensors at first.
#[derive(Clone, Copy)]
pub struct Query<'a> {
    solver: &'a Solver,
    layers: u32,
    sensors: bool,
    walls: bool,
}

impl Solver {
    /// Asks about bodies and walls where they are now.
    ///
    /// ```no_run
    /// # use unipbd_core::{Solver, Vector64};
    /// # fn look(solver: &Solver) {
    /// let below = solver.query().ray_cast(Vector64::new(0.5, 2.0), Vector64::new(0.5, -2.0));
    /// let picked = solver.query().without_walls().at(Vector64::new(1.0, 1.0));
    /// # }
    /// ```
    pub fn query(&self) -> Query<'_> {
        Query { solver: self, layers: u32::MAX, sensors: false, walls: true }
    }

    /// Contact points of the last substep, those of sleeping bodies too.
    pub fn contacts(&self) -> Vec<ContactPoint> {
        self.world.parts.rigid.as_ref().map_or_else(Vec::new, |rigid| rigid.contacts.all_points(&rigid.bodies))
    }

    /// From now on notes which bodies touch in each frame, and when that begins and ends; a saved state does not hold
    /// this.
    pub fn watch_contacts(&mut self, watch: bool) {
        let parts = &mut self.world.parts;
        parts.no_bodies.contacts.watch(watch);
        parts.rigid.iter_mut().for_each(|rigid| rigid.contacts.watch(watch));
    }

    /// Pairs that touched in the last frame, with the impulse between them; empty unless contacts are
    /// [watched](Solver::watch_contacts).
    pub fn contact_pairs(&self) -> Vec<ContactPair> {
        self.world.parts.rigid.as_ref().map_or_else(Vec::new, |rigid| rigid.contacts.watched_pairs())
    }

    /// Takes the contacts that began and ended since the last call, sensors included; empty unless contacts are
    /// [watched](Solver::watch_contacts).
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # let scene = Scene {
    /// #     spacing: 0.1,
    /// #     half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])],
    /// #     body: vec![BodyDescription::rectangle([1.0, 1.0], [0.0, 1.0])],
    /// #     ..Scene::default()
    /// # };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// solver.watch_contacts(true);
    /// while solver.time() < 1.0 {
    ///     solver.step_frame()?;
    /// }
    /// let landed = solver.take_contact_events();
    /// assert!(landed.iter().any(|event| event.began && event.body == 0 && event.other.is_none()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn take_contact_events(&mut self) -> Vec<ContactEvent> {
        self.world.parts.rigid.as_mut().map_or_else(Vec::new, |rigid| rigid.contacts.take_events())
    }

    /// Poses of the centres of mass of all bodies between the last two frames, to draw more pictures than frames:
    /// `part` is 0 at the start of the last frame and 1 at its end.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # let scene = Scene {
    /// #     spacing: 0.1,
    /// #     half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])],
    /// #     body: vec![BodyDescription::rectangle([1.0, 1.0], [0.0, 1.0])],
    /// #     ..Scene::default()
    /// # };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// solver.step_frame()?;
    /// // Half of the way from the frame before to the last one, for a display of another rate.
    /// let between = solver.interpolated_poses(0.5);
    /// assert!(between[0].position.y > solver.bodies()[0].position.y);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn interpolated_poses(&self, part: f64) -> Vec<Pose> {
        self.world.parts.rigid.as_ref().map_or_else(Vec::new, |rigid| rigid.bodies.interpolated(part))
    }

    /// Ids of the particles in a box \[m], in ascending order, without the samples of bodies.
    pub fn particles_in(&self, low: Vector64, high: Vector64) -> Vec<u32> {
        let inside = |row: &usize| {
            let place = wide(self.positions()[*row]);
            place.cmpge(low).all() && place.cmple(high).all() && self.phases()[*row] != Phase::Rigid
        };
        let mut ids: Vec<u32> = (0..self.ids().len()).filter(inside).map(|row| self.ids()[row]).collect();
        ids.sort_unstable();
        ids
    }
}

impl<'a> Query<'a> {
    /// Only bodies in one of these collision layers, one bit each.
    #[must_use]
    pub fn in_layers(self, layers: u32) -> Self {
        Query { layers, ..self }
    }

    /// Sensors too.
    #[must_use]
    pub fn with_sensors(self) -> Self {
        Query { sensors: true, ..self }
    }

    /// Only bodies.
    #[must_use]
    pub fn without_walls(self) -> Self {
        Query { walls: false, ..self }
    }

    fn asks_for(&self, body: &Body) -> bool {
        body.filter.layers & self.layers != 0 && (self.sensors || !body.sensor)
    }

    fn solids(self) -> impl Iterator<Item = (Solid, Outline)> + 'a {
        let bodies = self.solver.bodies().iter().zip(0u32..).filter(move |(body, _)| self.asks_for(body));
        let bodies = bodies.filter_map(|(body, id)| Some((Solid::Body(id), body.placed()?)));
        let walls = if self.walls { &self.solver.world.parts.solid_walls[..] } else { &[] };
        bodies.chain(walls.iter().zip(0u32..).map(|(wall, id)| (Solid::Wall(id), wall.placed())))
    }

    /// All solids that a ray enters on its way, the nearest first. Solids that it starts in are left out.
    pub fn ray_cast_all(self, from: Vector64, to: Vector64) -> Vec<RayHit> {
        let hit = |(solid, outline): (Solid, Outline)| {
            let entry = outline.entered(from, to)?;
            let (fraction, normal) = (entry.fraction, entry.normal);
            Some(RayHit { solid, point: from + (to - from) * fraction, normal, fraction })
        };
        let mut hits: Vec<RayHit> = self.solids().filter_map(hit).collect();
        hits.sort_by(|a, b| a.fraction.total_cmp(&b.fraction));
        hits
    }

    /// The first solid that a ray enters on its way.
    pub fn ray_cast(self, from: Vector64, to: Vector64) -> Option<RayHit> {
        self.ray_cast_all(from, to).into_iter().next()
    }

    /// The solids that hold a point \[m].
    pub fn at(self, point: Vector64) -> Vec<Solid> {
        self.solids().filter(|(_, outline)| outline.nearest(point).distance <= 0.0).map(|(solid, _)| solid).collect()
    }

    /// The solids that overlap a box \[m].
    pub fn in_box(self, low: Vector64, high: Vector64) -> Vec<Solid> {
        let area = box_outline(low, high);
        self.solids().filter(|(_, outline)| outline.overlaps(&area)).map(|(solid, _)| solid).collect()
    }

    /// The solids that overlap a body.
    pub fn overlapping(self, body: u32) -> Vec<Solid> {
        let Some(outline) = self.solver.bodies().get(body as usize).and_then(Body::placed) else { return Vec::new() };
        let other = |(solid, of): &(Solid, Outline)| *solid != Solid::Body(body) && of.overlaps(&outline);
        self.solids().filter(other).map(|(solid, _)| solid).collect()
    }

    /// The solid whose outline is nearest to a point, no farther than `within` \[m]; one that holds the point counts as
    /// nearest.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # use unipbd_core::Vector64;
    /// # let scene = Scene {
    /// #     spacing: 0.1,
    /// #     half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])],
    /// #     body: vec![BodyDescription::rectangle([1.0, 1.0], [0.0, 1.0])],
    /// #     ..Scene::default()
    /// # };
    /// let solver = scene.build(BuildOptions::default())?;
    /// let found = solver.query().without_walls().nearest(Vector64::new(3.0, 1.0), 5.0).expect("a box");
    /// assert!((found.distance - 2.5).abs() < 1e-6);
    /// assert!(solver.query().nearest(Vector64::new(3.0, 9.0), 0.5).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nearest(self, point: Vector64, within: f64) -> Option<NearestSolid> {
        let near = |(solid, outline): (Solid, Outline)| {
            let found = outline.nearest(point);
            let (distance, normal) = (found.distance, found.normal);
            NearestSolid { solid, distance, point: point - normal * distance, normal }
        };
        let all = self.solids().map(near).filter(|near| near.distance <= within);
        all.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}
