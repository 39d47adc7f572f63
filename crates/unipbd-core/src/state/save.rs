use super::error::damaged;
use super::structure::structure;
use super::{Section, State, StateError, bodies};
use crate::coupling::{RigidBodies, Ropes};
use crate::math::{Vector, Vector64, real, wide};
use crate::observe::Material;
use crate::scene::crowd;
use crate::sources::{EmitterSystem, RestoredEmitter};
use crate::step::{Clock, FluidParts, Solver};

const EMITTERS: &str = "emitters";
const SMOKE: &str = "smoke";
const BODIES: &str = "bodies";
const ROPES: &str = "ropes";
const GRAVITY: &str = "gravity";

/// Farthest place that a state may hold \[spacings]: a run that gets there has long been of no use.
const FARTHEST: f64 = 1e9;
/// Longest substep of smoke \[s].
const LONGEST_FRAME: f64 = 1e6;
/// Most substeps of a frame; the settings of a scene allow fewer.
const MOST_SUBSTEPS: u32 = 1_000_000;

impl Solver {
    /// The complete state needed to continue this run. The run is not changed.
    ///
    /// Reports of the run are not included (pending events, timings).
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # let water = vec![Liquid::new("water", 1000.0)];
    /// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
    /// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
    /// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// let start = solver.save();
    /// solver.step_frame()?;
    /// let hash = solver.state_hash();
    /// solver.restore(&start)?;
    /// solver.step_frame()?;
    /// assert_eq!(solver.state_hash(), hash); // bit for bit the same
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn save(&self) -> State {
        let parts = &self.world.parts;
        let mut sections = Vec::new();
        let mut section = |name: &str, words| sections.push(Section { name: name.to_owned(), words });
        if let Some(emitters) = &parts.emitters {
            section(EMITTERS, emitters.save());
        }
        if let Some(smoke) = &parts.smoke {
            section(SMOKE, vec![f64::from(smoke.last_dt()).to_bits()]);
        }
        if let Some(rigid) = &parts.rigid {
            section(BODIES, bodies::to_words(&*rigid.to_save()));
        }
        if parts.ropes.len() > 0 {
            section(ROPES, bodies::to_words(&parts.ropes));
        }
        let gravity = parts.exact_gravity;
        section(GRAVITY, vec![gravity.x.to_bits(), gravity.y.to_bits()]);
        for group in &parts.groups {
            section(group.name(), group.save());
        }
        State {
            structure: structure(self),
            clock: self.world.clock,
            particles: parts.particles.clone(),
            list: parts.neighbors.saved(),
            sections,
            read: false,
        }
    }

    /// Goes to a saved moment: the run then continues bit for bit as the saved one
    /// did, on any number of threads. Works for a state of any run of the same scene and seed.
    /// Constraint groups that were added to the saved run must have been added to this one too.
    ///
    /// # Errors
    /// [`StateError::OtherScene`] if the state is of a scene that is built differently; the run
    /// is not changed in that case.
    pub fn restore(&mut self, state: &State) -> Result<(), StateError> {
        self.accept_structure(state)?;
        let fluids = self.fluids_of(state);
        let rigid = self.saved_bodies(state)?;
        let ropes = self.saved_ropes(state, rigid.as_ref())?;
        self.accept(state, fluids.as_ref(), &ropes)?;
        let emitters = self.saved_emitters(state)?;
        let generation = self.world.clock.generation;
        let with_emitters = emitters.is_some();
        let replanned = self.set_emitters(emitters);
        let world = &mut self.world;
        if let Some(fluids) = fluids {
            world.set_fluid_parts(fluids);
        }
        let mut sections = state.sections.iter();
        let mut next = || sections.next().map_or(&[][..], |section| &section.words);
        if with_emitters {
            next();
        }
        if let Some(smoke) = &mut world.parts.smoke {
            smoke.set_last_dt(real(next().first().copied().map_or(0.0, f64::from_bits)));
        }
        if rigid.is_some() {
            next();
        }
        if ropes.len() > 0 {
            next();
        }
        let replanned = replanned || ropes != world.parts.ropes || rigid.is_some() || world.parts.rigid.is_some();
        world.parts.rigid = rigid;
        if ropes != world.parts.ropes {
            world.set_ropes(ropes);
        }
        if let Some(gravity) = gravity_of(next()).filter(|gravity| *gravity != world.parts.exact_gravity) {
            world.set_gravity(gravity);
        }
        for group in &mut world.parts.groups {
            group.restore(next());
        }
        // Ids may differ from before, so the old generation number must not be reused.
        let generation = generation.max(state.clock.generation) + 1;
        world.clock = Clock { generation, ..state.clock };
        world.shake(world.clock.time);
        world.parts.particles.clone_from(&state.particles);
        self.on_threads(|world| {
            if replanned {
                world.replan();
            }
            world.restore_list(&state.list);
        });
        Ok(())
    }

    /// The bodies of a state, if it has any.
    fn saved_bodies(&self, state: &State) -> Result<Option<RigidBodies>, StateError> {
        let parts = &self.world.parts;
        // Bodies may have been added to a scene without any, or not yet.
        let running = parts.rigid.as_ref().unwrap_or(&parts.no_bodies);
        let Some(section) = state.sections.iter().find(|section| section.name == BODIES) else { return Ok(None) };
        bodies::from_words(&section.words, running, parts.spacing).map(Some)
    }

    /// The ropes of a state, with these bodies.
    fn saved_ropes(&self, state: &State, rigid: Option<&RigidBodies>) -> Result<Ropes, StateError> {
        let of_scene = self.world.parts.scene_ropes;
        let ropes: Ropes = match state.sections.iter().find(|section| section.name == ROPES) {
            Some(section) => bodies::read_words(&section.words, ROPES)?,
            None => Ropes::default(),
        };
        let joints = rigid.map_or(0, |rigid| rigid.contacts.joint_count());
        if !ropes.are_sound(of_scene, state.particles.ids_given(), joints) {
            return Err(damaged("its ropes make no sense"));
        }
        Ok(ropes)
    }

    /// Takes these emitters, or none; tells whether the stages are others then.
    fn set_emitters(&mut self, saved: Option<Vec<RestoredEmitter>>) -> bool {
        let before = self.world.emits();
        let emitters = &mut self.world.parts.emitters;
        match saved {
            None => *emitters = None,
            Some(saved) => emitters.get_or_insert_with(EmitterSystem::none).restore(saved),
        }
        self.world.emits() != before
    }

    /// The emitters of a state, if it has any.
    fn saved_emitters(&self, state: &State) -> Result<Option<Vec<RestoredEmitter>>, StateError> {
        let parts = &self.world.parts;
        let of_scene = parts.scene_emitters.as_deref();
        let Some(section) = state.sections.iter().find(|section| section.name == EMITTERS) else {
            return if of_scene.is_none() { Ok(None) } else { Err(damaged("its emitters are missing")) };
        };
        let saved = EmitterSystem::at_saved(&section.words, &parts.kit, of_scene.unwrap_or_default());
        saved.map(Some).ok_or_else(|| damaged("its emitters make no sense"))
    }

    /// The parts of fluids that meet bodies, or do not, as in the state; `None` if the run has those.
    fn fluids_of(&self, state: &State) -> Option<FluidParts> {
        let with_bodies = has_bodies(state);
        let remake = self.world.parts.remake.as_ref()?;
        (self.world.parts.sample_material.is_some() != with_bodies).then(|| remake(with_bodies))
    }

    /// Whether the state is of a scene that is built like this one.
    fn accept_structure(&self, state: &State) -> Result<(), StateError> {
        let running = structure(self);
        for (index, running) in running.iter().enumerate() {
            let saved = state.structure.get(index).map_or("nothing", |line| line);
            if saved != running {
                return Err(StateError::OtherScene { saved: saved.to_owned(), running: running.clone() });
            }
        }
        Ok(())
    }

    /// Whether the state belongs to a run like this one, with these parts of its fluids and these ropes.
    fn accept(&self, state: &State, fluids: Option<&FluidParts>, ropes: &Ropes) -> Result<(), StateError> {
        self.accept_sections(state, ropes)?;
        self.accept_clock(state)?;
        let materials = fluids.map_or(&self.world.parts.materials, |fluids| &fluids.materials);
        self.accept_particles(state, materials)?;
        // A run that has diverged goes back to where it was.
        if state.read { self.accept_places(state) } else { Ok(()) }
    }

    fn accept_sections(&self, state: &State, ropes: &Ropes) -> Result<(), StateError> {
        let parts = &self.world.parts;
        let with_emitters = state.sections.iter().any(|section| section.name == EMITTERS);
        let names = with_emitters.then_some(EMITTERS).into_iter().chain(parts.smoke.iter().map(|_| SMOKE));
        let with_bodies = has_bodies(state);
        if !with_bodies && parts.scene_bodies > 0 {
            return Err(damaged("its bodies are missing"));
        }
        let names =
            names.chain(with_bodies.then_some(BODIES)).chain((ropes.len() > 0).then_some(ROPES)).chain([GRAVITY]);
        let (before, behind) = (&parts.groups[..parts.rope_groups.start], &parts.groups[parts.rope_groups.end..]);
        let of_ropes = ropes.groups();
        let names = names.chain(before.iter().chain(&of_ropes).chain(behind).map(|group| group.name()));
        if !names.eq(state.sections.iter().map(|section| &section.name[..])) {
            return Err(damaged("it lacks a part of the run"));
        }
        let gravity = state.sections.iter().find(|section| section.name == GRAVITY);
        if gravity.is_none_or(|section| gravity_of(&section.words).is_none()) {
            return Err(damaged("its gravity makes no sense"));
        }
        let smoke = state.sections.iter().find(|section| section.name == SMOKE && parts.smoke.is_some());
        let length = smoke.map(|section| section.words.first().copied().map_or(f64::NAN, f64::from_bits));
        if length.is_some_and(|length| !(0.0..=LONGEST_FRAME).contains(&length)) {
            return Err(damaged("its smoke was moved by no substep"));
        }
        Ok(())
    }

    /// The rest of a frame is stepped as it was begun.
    fn accept_clock(&self, state: &State) -> Result<(), StateError> {
        let (clock, frame_time) = (&state.clock, self.world.parts.frame_time);
        let whole = clock.dt <= frame_time * (1.0 + 1e-9) && clock.substeps <= MOST_SUBSTEPS;
        let begun = clock.done == 0 || (clock.dt * f64::from(clock.substeps) - frame_time).abs() <= 1e-6 * frame_time;
        if whole && begun { Ok(()) } else { Err(damaged("its substeps are not those of a frame of the run")) }
    }

    fn accept_particles(&self, state: &State, materials: &[Material]) -> Result<(), StateError> {
        let parts = &self.world.parts;
        let particles = &state.particles;
        let known = |row: usize| materials.get(usize::from(particles.material[row])).map(|material| material.phase);
        if (0..particles.len()).any(|row| known(row) != Some(particles.phase[row])) {
            return Err(damaged("a particle is of no material of the scene"));
        }
        let optional = parts.particles.optional();
        let rows = |wanted: bool| if wanted { particles.len() } else { 0 };
        let wanted = [optional.temperature, optional.age, optional.rest, optional.rest].map(rows);
        let found = [&particles.temperature, &particles.age, &particles.rest].map(Vec::len);
        let same = found == wanted[..3] && particles.anchor.len() == wanted[3] && particles.optional() == optional;
        if !same || particles.asleep() > rows(optional.rest) {
            return Err(damaged("a column is missing"));
        }
        Ok(())
    }

    /// Places from which the search for neighbours can start.
    fn accept_places(&self, state: &State) -> Result<(), StateError> {
        let (parts, particles) = (&self.world.parts, &state.particles);
        let farthest = FARTHEST * parts.spacing;
        let near = |vector: &Vector| wide(*vector).length() <= farthest;
        let columns = [&particles.position, &particles.start, &particles.remainder];
        let placed = columns.into_iter().flatten().chain(state.list.reference()).all(near);
        // The displacement of smoke is a velocity.
        let moved = particles.displacement[..particles.dense()].iter().all(near);
        if !(placed && moved && state.list.fits(parts.neighbors.radius())) {
            return Err(damaged("a particle is too far away"));
        }
        let reach = f64::from(parts.neighbors.radius());
        let sets = [&particles.position[..particles.dense()], state.list.reference()];
        for places in sets {
            if let Some(crowd) = crowd(places.iter().map(|&place| wide(place)), [], reach) {
                return Err(StateError::Damaged(format!("it has {crowd}")));
            }
        }
        Ok(())
    }
}

fn has_bodies(state: &State) -> bool {
    state.sections.iter().any(|section| section.name == BODIES)
}

/// Gravity from its section [m/s^2]; `None` if it is not finite in single precision.
fn gravity_of(words: &[u64]) -> Option<Vector64> {
    let &[x, y] = words else { return None };
    let gravity = Vector64::new(f64::from_bits(x), f64::from_bits(y));
    [gravity.x, gravity.y].into_iter().all(|value| real(value).is_finite()).then_some(gravity)
}
