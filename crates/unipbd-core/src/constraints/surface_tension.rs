//! Surface tension and contact angles, from an energy of the surface.

use super::{ConstraintGroup, Corrections, Needs, Substep};
use crate::bytes::held;
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real, wide};
use crate::phase::Phase;
use crate::scene::{Liquid, Scene, TENSION_RADIUS};
use crate::walls::Coverage;

/// |n| dx/s^3 up to which a particle is within the liquid, and from which on it is wholly at the surface.
const EDGE: [f64; 2] = [0.05, 0.15];
/// c over sigma, measured: the force along a surface is more than its energy per length, since surfaces that are drawn
/// out become thinner.
const LINE: f64 = 0.495;
/// k dx over sigma.
const HOLD: f64 = 40.0;
/// Strength of the attraction of walls that are wetted: measured, as for [`LINE`].
const WETTING: f64 = 0.8;
/// Part of a wall that the cosine of an obtuse contact angle takes away: measured.
const PEARLING: f64 = 0.5;

/// With s the part of the kernel that the liquid covers at a particle, and n its gradient, the energy is
///
/// E = sum_i V (c f(m_i) + k (1 - s_i)_+^2 / 2), m = |n|/s^3.
///
/// The first term measures the surface: the integral of |n| across it is half the step of the density, and f(m) = m
/// but for small m, where the disorder within a liquid would count. By the power of s the force stays the same where
/// particles of the surface move apart. The second term holds the liquid together: alone it has no tension, since
/// particles at the surface crowd until it vanishes. Within the liquid both vanish, so nothing stiffens it there.
///
/// Walls and bodies count as liquid, wholly for a contact angle theta of 90 degrees and less. Below, they attract too,
/// by -sigma cos theta per length.
///
/// In equilibrium the particles of the surface are a skin of twice the spacing in thickness and of the density of the
/// liquid, which hardly stretches: measured, a drop sheared with its skin takes more than ten times the energy of the
/// tension. That slows waves, and the tension depends on how the skin came to be.
///
/// All forces are gradients of E, equal and opposite: momentum is kept and nothing is pumped. A group, not an effect:
/// the density constraint acts against it in the same substep.
pub struct SurfaceTension {
    kernel: Kernel,
    coverage: Coverage,
    /// Volume of a particle [m^2].
    volume: Real,
    spacing: Real,
    /// By material; `None` without tension.
    liquids: Vec<Option<Tension>>,
    /// Whether this substep's force has been applied: more iterations do not pull harder.
    applied: bool,
    pulls: Vec<Pull>,
}

/// Derivatives of the energy of a particle over its volume.
#[derive(Clone, Copy, Default)]
struct Pull {
    /// By n \[N].
    along: Vector,
    /// By the covered part s [N/m].
    inward: Real,
    /// By the gradient of the part that bodies cover, beside what they have as liquid \[N].
    wetting: Vector,
}

/// A liquid with a tension.
#[derive(Clone, Copy)]
struct Tension {
    /// c times the spacing \[N].
    line: Real,
    /// k [N/m].
    hold: Real,
    /// As how much liquid walls and bodies count.
    solid: Real,
    /// Energy of a wetted wall per length, doubled: half of it lies within the wall \[N].
    wetting: Real,
}

impl SurfaceTension {
    /// The tension of a scene; `None` where no liquid has any.
    pub fn new(scene: &Scene) -> Option<Self> {
        if scene.liquid.iter().all(|liquid| liquid.surface_tension <= 0.0) {
            return None;
        }
        let kernel = Kernel::new(TENSION_RADIUS * scene.spacing);
        let volume = 1.0 / (kernel.lattice(scene.spacing).value + f64::from(kernel.value(0.0)));
        let flat = energy_of_flat(&kernel, scene.spacing, volume);
        let of = |liquid: &Liquid| (liquid.surface_tension > 0.0).then(|| Tension::new(liquid, scene.spacing, flat));
        let mut liquids: Vec<Option<Tension>> = scene.liquid.iter().map(of).collect();
        liquids.resize(scene.materials().count(), None);
        Some(SurfaceTension {
            coverage: Coverage::new(&kernel),
            kernel,
            volume: real(volume),
            spacing: real(scene.spacing),
            liquids,
            applied: false,
            pulls: Vec::new(),
        })
    }

    fn find_pulls(&mut self, now: Substep<'_>) {
        let mut pulls = std::mem::take(&mut self.pulls);
        self.fill(now, &mut pulls);
        self.pulls = pulls;
    }

    fn fill(&self, now: Substep<'_>, pulls: &mut Vec<Pull>) {
        pulls.resize(now.particles.dense(), Pull::default());
        now.parallelism.fill(pulls, |row| self.pull(now, row));
    }

    fn pull(&self, now: Substep<'_>, row: usize) -> Pull {
        let particles = now.particles;
        let (positions, materials, phases) = (particles.positions(), particles.materials(), particles.phases());
        let own = materials[row];
        let Some(tension) = self.liquids[usize::from(own)] else { return Pull::default() };
        let (kernel, periodic) = (self.kernel, now.neighbors.periodic());
        let (mut s, mut n, mut bodies) = (kernel.value(0.0), Vector::ZERO, Vector::ZERO);
        now.neighbors.for_each(row, |other| {
            let apart = periodic.min_image(positions[row] - positions[other]);
            let distance = apart.length();
            if materials[other] == own {
                s += kernel.value(distance);
                n += apart * kernel.slope(distance);
            } else if phases[other] == Phase::Rigid {
                s += kernel.value(distance) * tension.solid;
                bodies += apart * kernel.slope(distance);
            }
        });
        let (part, slope) = now.walls.coverage(positions[row], &self.coverage);
        let s = s * self.volume + part * tension.solid;
        let n = (n + bodies * tension.solid) * self.volume + slope * tension.solid;
        let wetting = bodies.normalize_or_zero() * tension.wetting;
        Pull { wetting, ..tension.pull(s, n, self.spacing) }
    }

    /// -dE/dx of a pair, over the squares of the volume, for a distance `apart` that ends at this row.
    fn pair(&self, apart: Vector, along: Vector, inward: Real) -> Vector {
        let (distance, radius) = (apart.length(), self.kernel.radius());
        if distance >= radius || distance == 0.0 {
            return Vector::ZERO;
        }
        let slope = self.kernel.slope(distance);
        // grad W = g x with g proportional to (1 - q)^3: the derivative of g over the distance.
        let bend = -3.0 * slope / ((radius - distance) * distance);
        -(along * slope + apart * (bend * apart.dot(along) + slope * inward))
    }

    /// The force of a particle on another over the square of the volume: on liquid, or on a sample of a body.
    fn force(&self, now: Substep<'_>, pulls: &[Pull], row: usize, other: usize) -> Vector {
        let particles = now.particles;
        let (positions, materials, phases) = (particles.positions(), particles.materials(), particles.phases());
        let solid = |of: usize| self.liquids[usize::from(materials[of])].map_or(0.0, |tension| tension.solid);
        let (own, pull) = (pulls[row], pulls[other]);
        let (along, inward) = if materials[other] == materials[row] && phases[row] != Phase::Rigid {
            (own.along - pull.along, own.inward + pull.inward)
        } else if phases[row] == Phase::Rigid {
            (pull.wetting - pull.along * solid(other), pull.inward * solid(other))
        } else if phases[other] == Phase::Rigid {
            (own.along * solid(row) - own.wetting, own.inward * solid(row))
        } else {
            return Vector::ZERO;
        };
        if along == Vector::ZERO && inward == 0.0 {
            return Vector::ZERO;
        }
        self.pair(now.neighbors.periodic().min_image(positions[row] - positions[other]), along, inward)
    }

    /// The force of all particles around over the square of the volume.
    fn force_of_neighbors(&self, now: Substep<'_>, row: usize) -> Vector {
        let mut force = Vector::ZERO;
        now.neighbors.for_each(row, |other| force += self.force(now, &self.pulls, row, other));
        force
    }

    /// The pressure over density of the forces between particles [m^2/s^2] (Irving & Kirkwood 1950).
    fn pressure(&self, now: Substep<'_>, pulls: &[Pull], row: usize) -> Real {
        let (positions, periodic) = (now.particles.positions(), now.neighbors.periodic());
        let mut virial = 0.0;
        for other in now.neighbors.runs_near(positions[row]).iter().flatten().filter(|other| *other != row) {
            let apart = periodic.min_image(positions[row] - positions[other]);
            virial += self.force(now, pulls, row, other).dot(apart);
        }
        0.25 * virial * self.volume * self.volume * now.particles.inverse_masses()[row]
    }

    /// The force of the walls on a liquid particle over the volume, and the gradient of the covered part.
    fn force_of_walls(&self, now: Substep<'_>, row: usize, tension: Tension) -> (Vector, Vector) {
        let x = now.particles.positions()[row];
        let (part, slope) = now.walls.coverage(x, &self.coverage);
        if part <= 0.0 || slope == Vector::ZERO {
            return (Vector::ZERO, Vector::ZERO);
        }
        let (own, into, step) = (self.pulls[row], slope.normalize_or_zero(), DIFFERENCE * self.coverage.radius());
        let at = |x: Vector| now.walls.coverage(x, &self.coverage).1.dot(into);
        let bend = (at(x + into * step) - at(x - into * step)) / (2.0 * step);
        let along = own.along.dot(into) * tension.solid - tension.wetting;
        (-(slope * (own.inward * tension.solid) + into * (bend * along)), slope)
    }

    fn push(&self, now: Substep<'_>, out: &mut Corrections) {
        let particles = now.particles;
        let (materials, inverse_masses) = (particles.materials(), particles.inverse_masses());
        let (rows, square) = (particles.listed(), now.dt * now.dt);
        now.parallelism.update(&mut out.displacements_mut()[..rows], |row, displacement| {
            let Some(tension) = self.liquids[usize::from(materials[row])] else { return };
            if inverse_masses[row] > 0.0 {
                let mut force = self.force_of_neighbors(now, row) * self.volume;
                if !now.walls.is_empty() {
                    force += self.force_of_walls(now, row, tension).0;
                }
                *displacement += force * (self.volume * inverse_masses[row] * square);
            }
        });
        let scale = self.volume * self.volume * square;
        now.parallelism.update(out.loads_mut(), |row, load| {
            if particles.phases()[row] == Phase::Rigid {
                *load += self.force_of_neighbors(now, row) * scale;
            }
        });
    }

    fn load_walls(&self, now: Substep<'_>, out: &mut Corrections) {
        if out.wall_loads().is_empty() {
            return;
        }
        let particles = now.particles;
        let scale = self.volume * now.dt * now.dt;
        for row in 0..particles.dense() {
            let tension = self.liquids[usize::from(particles.materials()[row])];
            let Some(tension) = tension.filter(|_| particles.inverse_masses()[row] > 0.0) else { continue };
            let (force, slope) = self.force_of_walls(now, row, tension);
            let per_slope = force.dot(slope) / slope.length_squared().max(Real::MIN_POSITIVE) * scale;
            if per_slope != 0.0 {
                now.walls.shares(particles.positions()[row], &self.coverage, |wall, slope| {
                    out.wall_loads_mut()[usize::from(wall)] -= wide(slope * per_slope);
                });
            }
        }
    }
}

/// Half the length of a difference across walls [kernel radii].
const DIFFERENCE: Real = 0.02;

impl Tension {
    /// The tension of a liquid, where c = 1 gives a flat surface this energy per length.
    fn new(liquid: &Liquid, spacing: f64, flat: f64) -> Self {
        let (sigma, cosine) = (liquid.surface_tension, libm::cos(liquid.contact_angle.to_radians()));
        Tension {
            line: real(LINE * sigma / flat),
            hold: real(HOLD * sigma / spacing),
            solid: real(1.0 - PEARLING * (-cosine).max(0.0)),
            wetting: real(2.0 * WETTING * sigma * cosine.max(0.0)),
        }
    }

    /// The derivatives of the energy of a particle that is covered to this part.
    fn pull(self, s: Real, n: Vector, spacing: Real) -> Pull {
        let (size, over) = (n.length(), 1.0 / (s * s * s));
        let rate = self.line * over * edge(f64::from(size * spacing * over)).1;
        let along = if size > 0.0 { n * (rate / size) } else { Vector::ZERO };
        let inward = -3.0 * rate * size / s - self.hold * (1.0 - s).max(0.0);
        Pull { along, inward, wetting: Vector::ZERO }
    }
}

/// f and its derivative.
fn edge(m: f64) -> (f64, Real) {
    let ([none, whole], over) = (EDGE, (m - EDGE[0]).max(0.0));
    let way = whole - none;
    if over < way { (0.5 * over * over / way, real(over / way)) } else { (over - 0.5 * way, 1.0) }
}

/// The sum of f over the rows of a lattice below a flat surface.
fn energy_of_flat(kernel: &Kernel, spacing: f64, volume: f64) -> f64 {
    let reach = TENSION_RADIUS.ceil() as i32;
    let at = |column: i32, row: i32| real(f64::from(column * column + row * row).sqrt() * spacing);
    let depths = 0..reach;
    let of_depth = |depth: i32| {
        let (mut s, mut n) = (0.0, 0.0);
        for (column, row) in (-reach..=reach).flat_map(|column| (-reach..=depth).map(move |row| (column, row))) {
            s += volume * f64::from(kernel.value(at(column, row)));
            n -= volume * f64::from(row) * spacing * f64::from(kernel.slope(at(column, row)));
        }
        edge(n.abs() * spacing / (s * s * s)).0
    };
    depths.map(of_depth).sum()
}

impl ConstraintGroup for SurfaceTension {
    fn name(&self) -> &str {
        "surface_tension"
    }

    fn needs(&self) -> Needs {
        Needs::NEIGHBORS
    }

    fn memory_bytes(&self) -> usize {
        held(&self.pulls)
    }

    fn add_pressures(&self, now: Substep<'_>, pressures: &mut [Real]) {
        // Read at the places of now, which a restored state has too.
        let mut pulls = Vec::new();
        self.fill(now, &mut pulls);
        let rows = pulls.len();
        now.parallelism.update(&mut pressures[..rows], |row, pressure| {
            if self.liquids[usize::from(now.particles.materials()[row])].is_some() {
                *pressure += self.pressure(now, &pulls, row);
            }
        });
    }

    fn begin_substep(&mut self, _: Substep<'_>) {
        self.applied = false;
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        // A start is settled for its density alone.
        if std::mem::replace(&mut self.applied, true) || now.settling {
            return;
        }
        self.find_pulls(now);
        self.push(now, out);
        self.load_walls(now, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_surface_has_the_known_energy_and_its_edge_is_smooth() {
        let kernel = Kernel::new(TENSION_RADIUS);
        let volume = 1.0 / (kernel.lattice(1.0).value + f64::from(kernel.value(0.0)));
        let flat = energy_of_flat(&kernel, 1.0, volume);
        assert!((flat - 0.9).abs() < 0.05, "{flat}");
        assert_eq!(edge(EDGE[0]), (0.0, 0.0));
        let (below, above) = (edge(EDGE[1] - 1e-9), edge(EDGE[1] + 1e-9));
        assert!((below.0 - above.0).abs() < 1e-8 && (below.1 - above.1).abs() < 1e-6);
    }
}
