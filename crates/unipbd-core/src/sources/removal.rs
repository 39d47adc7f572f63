//! Removal of particles: after their lifetime, outside the domain, or gas without smoke nearby.

use super::sink::RegionSink;
use crate::math::{Real, Vector, Vector64, real, vector};
use crate::neighbors::{Cursor, Grid};
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::periodic::Periodic;
use crate::phase::Phase;
use crate::scene::{MaterialRef, Scene};

/// The removal rules of a scene, applied once per frame.
pub struct RemovalRules {
    materials: Vec<Rule>,
    region: Option<(Vector, Vector)>,
    keep_radius: Real,
    smoke: Grid,
    /// Positions of the smoke: in row order, and in grid order.
    markers: Vec<Vector>,
    sorted: Vec<Vector>,
    sinks: Vec<RegionSink>,
    frame_time: f64,
}

#[derive(Clone, Copy)]
struct Rule {
    lifetime: Real,
    keep_radius: Option<Real>,
    keep_age: Real,
}

impl Rule {
    fn new(material: MaterialRef<'_>) -> Self {
        let lifetime = |given: Option<f64>| given.map_or(Real::INFINITY, real);
        match material {
            MaterialRef::Gas(gas) => Rule {
                lifetime: lifetime(gas.lifetime),
                keep_radius: gas.keep_radius.map(real),
                keep_age: real(gas.keep_age),
            },
            MaterialRef::Smoke(smoke) => Rule { lifetime: lifetime(smoke.lifetime), ..Rule::never() },
            MaterialRef::Liquid(_) | MaterialRef::Solid(_) | MaterialRef::Rigid => Rule::never(),
        }
    }

    fn never() -> Self {
        Rule { lifetime: Real::INFINITY, keep_radius: None, keep_age: 0.0 }
    }
}

impl RemovalRules {
    /// The removal rules of a scene, or `None` if no particle is ever removed.
    pub fn new(scene: &Scene, periodic: Periodic) -> Option<Self> {
        let materials: Vec<Rule> = scene.materials().map(Rule::new).collect();
        let corner = |given: Option<[f64; 2]>, open: f64| given.map_or(Vector64::splat(open), Vector64::from);
        let domain = &scene.domain;
        let bounded = domain.remove_below.is_some() || domain.remove_above.is_some();
        let region = bounded.then(|| {
            let (low, high) = (corner(domain.remove_below, -f64::INFINITY), corner(domain.remove_above, f64::INFINITY));
            (vector(low), vector(high))
        });
        let keep_radius = materials.iter().filter_map(|rule| rule.keep_radius).fold(0.0, Real::max);
        let any = materials.iter().any(|rule| rule.lifetime.is_finite());
        (any || region.is_some() || keep_radius > 0.0 || !scene.sink.is_empty()).then(|| RemovalRules {
            materials,
            region,
            keep_radius,
            smoke: Grid::new(periodic),
            markers: Vec::new(),
            sorted: Vec::new(),
            sinks: scene.sink.iter().map(|sink| RegionSink::new(sink, scene)).collect(),
            frame_time: 1.0 / scene.fps,
        })
    }

    /// Whether the rules need the age of particles.
    pub fn needs_age(&self) -> bool {
        self.keep_radius > 0.0 || self.materials.iter().any(|rule| rule.lifetime.is_finite())
    }

    /// Collects the rows to remove at this time \[s], in ascending order.
    pub fn find(&mut self, particles: &Particles, time: f64, parallelism: Parallelism, rows: &mut Vec<u32>) {
        rows.clear();
        self.sort_smoke(particles, parallelism);
        let gone = |row: usize| self.is_expired(particles, row) || self.is_abandoned(particles, row);
        rows.extend((0..particles.len() as u32).filter(|&row| gone(row as usize)));
        self.drain(particles, time, rows);
    }

    /// Adds the particles taken by sinks, the lowest ids first.
    fn drain(&self, particles: &Particles, time: f64, rows: &mut Vec<u32>) {
        for sink in &self.sinks {
            let allowance = sink.allowance(time, self.frame_time);
            let taken = |row: &u32| {
                let movable = particles.phase[*row as usize] != Phase::Rigid && !is_kinematic(particles, *row as usize);
                movable && sink.takes(particles, *row as usize) && rows.binary_search(row).is_err()
            };
            let mut found: Vec<u32> = (0..particles.len() as u32).filter(taken).collect();
            found.sort_unstable_by_key(|&row| particles.id[row as usize]);
            found.truncate(allowance);
            rows.extend(found);
            rows.sort_unstable();
        }
    }

    fn is_expired(&self, particles: &Particles, row: usize) -> bool {
        if is_kinematic(particles, row) {
            return false;
        }
        let rule = &self.materials[usize::from(particles.material[row])];
        let old = particles.age.get(row).is_some_and(|&age| age > rule.lifetime);
        let x = particles.position[row];
        old || self.region.is_some_and(|(low, high)| x.cmplt(low).any() || x.cmpgt(high).any())
    }

    /// Gas with no smoke within its keep radius.
    fn is_abandoned(&self, particles: &Particles, row: usize) -> bool {
        let rule = &self.materials[usize::from(particles.material[row])];
        let Some(radius) = rule.keep_radius else { return false };
        if is_kinematic(particles, row) || particles.age[row] < rule.keep_age {
            return false;
        }
        let x = particles.position[row];
        let (periodic, limit) = (self.smoke.periodic(), radius * radius);
        let near = |marker: &Vector| periodic.min_image(x - *marker).length_squared() < limit;
        let mut found = false;
        self.smoke.for_each_run(x, radius, &mut Cursor::default(), |run| {
            found = found || self.sorted[run.start as usize..run.end as usize].iter().any(near);
        });
        !found
    }

    /// Sorts the smoke into its grid, if a rule needs it.
    fn sort_smoke(&mut self, particles: &Particles, parallelism: Parallelism) {
        if self.keep_radius == 0.0 {
            return;
        }
        let loose = particles.dense()..particles.len();
        let smoke = loose.filter(|&row| particles.phase[row] == Phase::Smoke).map(|row| particles.position[row]);
        self.markers.clear();
        self.markers.extend(smoke);
        let order = self.smoke.order(&self.markers, self.markers.len(), self.keep_radius, parallelism);
        self.sorted.clear();
        self.sorted.extend(order.iter().map(|&row| self.markers[row as usize]));
    }
}

/// Whether the particle is kinematic, such as a particle held by an emitter.
fn is_kinematic(particles: &Particles, row: usize) -> bool {
    row < particles.dense() && particles.inverse_mass[row] == 0.0
}
