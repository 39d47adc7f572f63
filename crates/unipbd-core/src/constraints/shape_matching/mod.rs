//! Shape matching (Müller et al. 2005; Macklin et al. 2014, section 5): bodies as particles that are drawn back
//! to a shape, stiff or soft.
//!
//! Every lattice sample is a particle with a mass of its own, seen by the density of fluids and by the contacts of
//! particles. An iteration first takes overlap out ([`contacts`]), then moves the samples of each
//! body towards the best rigid fit of its shape, by a part of the way that follows from its compliance. Both keep momentum;
//! the spin that the fit takes by moving samples along chords is given back to the velocities.

mod contacts;
mod member;

pub use member::Member;

use super::{ConstraintGroup, Corrections, Needs, Substep};
use crate::math::{Real, Vector, Vector64, vector, wide};
use crate::scene::FrictionRule;
use contacts::Touch;
use member::Fit;

/// Rounds of contacts and fit in one iteration.
const ROUNDS: usize = 2;

/// The group of all bodies whose shape is matched, and of the samples of other bodies that they touch.
pub struct ShapeMatching {
    members: Vec<Member>,
    spacing: f64,
    /// How far the springs of the samples have moved them in this substep, member by member \[m].
    pulled: Vec<Vec<Vector64>>,
    /// Whether the substep has only begun.
    begun: bool,
    /// How friction coefficients combine.
    rule: FrictionRule,
    /// Rows of the samples, member by member.
    rows: Vec<Vec<u32>>,
    /// Where the samples are in this iteration \[m].
    places: Vec<Vec<Vector64>>,
    fits: Vec<Fit>,
    touches: Vec<Touch>,
    /// Angular momentum over dt that the fits took in this substep, by member [kg m^2].
    taken: Vec<f64>,
}

impl ShapeMatching {
    /// A group of these bodies, in ascending order of their samples' ids.
    pub fn new(members: Vec<Member>, spacing: f64, rule: FrictionRule) -> Self {
        let count = members.len();
        ShapeMatching {
            members,
            spacing,
            pulled: vec![Vec::new(); count],
            begun: false,
            rule,
            rows: vec![Vec::new(); count],
            places: vec![Vec::new(); count],
            fits: vec![Fit::default(); count],
            touches: Vec::new(),
            taken: vec![0.0; count],
        }
    }

    fn place_all(&mut self, now: Substep<'_>) {
        for (places, rows) in self.places.iter_mut().zip(&self.rows) {
            places.clear();
            places.extend(rows.iter().map(|&row| wide(now.particles.positions()[row as usize])));
        }
    }

    fn fit_all(&mut self) {
        for ((fit, member), places) in self.fits.iter_mut().zip(&self.members).zip(&self.places) {
            *fit = member.fit(places);
        }
    }

    /// Lets the springs of soft bodies act as at the start of the substep.
    fn begin_pull(&mut self, now: Substep<'_>) {
        for (k, member) in self.members.iter().enumerate().filter(|(_, member)| member.is_matched()) {
            let starts: Vec<Vector64> =
                self.rows[k].iter().map(|&row| wide(now.particles.starts()[row as usize])).collect();
            member.begin(&mut self.places[k], &starts, &mut self.pulled[k], f64::from(now.dt));
        }
    }

    /// Moves the samples of soft and stiff bodies towards their shapes.
    fn pull_to_shape(&mut self, now: Substep<'_>) {
        for k in (0..self.members.len()).filter(|&k| self.members[k].is_matched()) {
            let starts = |row: u32| wide(now.particles.starts()[row as usize]);
            let spin = |places: &[Vector64], rows: &[u32]| -> f64 {
                let center = places.iter().sum::<Vector64>() / places.len() as f64;
                places.iter().zip(rows).map(|(x, &row)| (*x - center).perp_dot(*x - starts(row))).sum()
            };
            let before = spin(&self.places[k], &self.rows[k]);
            let member = &self.members[k];
            member.pull_to_shape(&mut self.places[k], &mut self.pulled[k], f64::from(now.dt));
            self.taken[k] += (before - spin(&self.places[k], &self.rows[k])) / member.inverse_mass;
        }
    }
}

impl ConstraintGroup for ShapeMatching {
    fn name(&self) -> &str {
        "shape_matching"
    }

    fn needs(&self) -> Needs {
        Needs::NEIGHBORS | Needs::ROWS | Needs::VELOCITY_PASS
    }

    fn begin_substep(&mut self, now: Substep<'_>) {
        self.taken.fill(0.0);
        self.begun = true;
        for (rows, member) in self.rows.iter_mut().zip(&self.members) {
            rows.clear();
            rows.extend(member.ids().filter_map(|id| now.rows.row(id)));
        }
        for (pulled, rows) in self.pulled.iter_mut().zip(&self.rows) {
            pulled.clear();
            pulled.resize(rows.len(), Vector64::ZERO);
        }
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.place_all(now);
        if std::mem::take(&mut self.begun) {
            self.begin_pull(now);
        }
        self.fit_all();
        self.find_touches(now);
        for _ in 0..ROUNDS {
            self.part(now, out);
            self.pull_to_shape(now);
        }
        for (k, member) in self.members.iter().enumerate().filter(|(_, member)| member.is_matched()) {
            for (&row, place) in self.rows[k].iter().zip(&self.places[k]) {
                let moved = *place - wide(now.particles.positions()[row as usize]);
                // A kinematic body has no member here that may move.
                debug_assert!(member.inverse_mass > 0.0);
                out.add(row as usize, vector(moved));
            }
        }
    }

    /// Gives back the spin that the fits took, and damps the motion of samples relative to their body.
    fn finish_velocities(&mut self, now: Substep<'_>, velocities: &mut [Vector]) {
        for (k, member) in self.members.iter().enumerate().filter(|(_, member)| member.is_matched()) {
            let (rows, dt) = (&self.rows[k], f64::from(now.dt));
            let place = |row: u32| wide(now.particles.positions()[row as usize]);
            let count = rows.len().max(1) as f64;
            let center = rows.iter().map(|&row| place(row)).sum::<Vector64>() / count;
            let mean = rows.iter().map(|&row| wide(velocities[row as usize])).sum::<Vector64>() / count;
            let (mut inertia, mut spin) = (0.0, 0.0);
            for &row in rows {
                let arm = place(row) - center;
                inertia += arm.length_squared();
                spin += arm.perp_dot(wide(velocities[row as usize]));
            }
            if inertia > 0.0 {
                let given = self.taken[k] * member.inverse_mass / (inertia * dt);
                let (whole, part) = (spin / inertia, member.damped(dt));
                for &row in rows {
                    let (arm, velocity) = ((place(row) - center).perp(), &mut velocities[row as usize]);
                    let wobble = wide(*velocity) - mean - arm * whole;
                    *velocity += vector(arm * given - wobble * part);
                }
            }
        }
    }
}

/// Radius at which samples and walls touch \[m].
fn radius(spacing: f64) -> Real {
    (0.5 * spacing) as Real
}
