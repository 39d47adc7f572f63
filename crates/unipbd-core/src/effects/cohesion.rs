use super::{Changes, Effect, any};
use crate::bytes::held;
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::scene::{MaterialRef, Scene};

/// Range of the cohesion [spacings]: a longer one pushes the next neighbours apart instead of pulling them.
const RANGE: f64 = 2.5;

/// Surface tension by cohesion and by smoothing of the surface (Akinci, Akinci & Teschner 2013,
/// equations 1 to 5), between particles of one liquid:
/// a_i = -strength sum_j K_ij (S(r) x_ij/r + n_i - n_j), n = h sum V grad W, K = 2 rho0/(rho_i + rho_j).
///
/// Forces are equal and opposite, so momentum is kept. S is their spline scaled to a largest value of 1,
/// which makes the strength an acceleration.
pub struct Cohesion {
    kernel: Kernel,
    volume: Real,
    strength: Vec<Real>,
    normal: Vec<Vector>,
}

impl Cohesion {
    /// The cohesion of a scene; `None` where no liquid has any.
    pub fn new(scene: &Scene) -> Option<Self> {
        let of = |material: MaterialRef<'_>| match material {
            MaterialRef::Liquid(liquid) => real(liquid.cohesion),
            _ => 0.0,
        };
        let strength: Vec<Real> = scene.materials().map(of).collect();
        any(&strength).then(|| Cohesion {
            kernel: Kernel::new(scene.solver.kernel_radius.min(RANGE) * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            strength,
            normal: Vec::new(),
        })
    }

    /// n_i = h sum_j V grad W over the same liquid: points into it, 0 inside.
    fn measure_normals(&mut self, now: Substep<'_>) {
        let (positions, materials) = (now.particles.positions(), now.particles.materials());
        let (kernel, periodic) = (self.kernel, now.neighbors.periodic());
        let (factor, strength) = (self.kernel.radius() * self.volume, &self.strength);
        self.normal.resize(now.particles.dense(), Vector::ZERO);
        now.parallelism.fill(&mut self.normal, |i| {
            let mut sum = Vector::ZERO;
            if strength[usize::from(materials[i])] > 0.0 {
                now.neighbors.for_each(i, |j| {
                    if materials[j] == materials[i] {
                        let apart = periodic.min_image(positions[i] - positions[j]);
                        sum += apart * kernel.slope(apart.length());
                    }
                });
            }
            sum * factor
        });
    }
}

impl Effect for Cohesion {
    fn name(&self) -> &'static str {
        "cohesion"
    }

    fn memory_bytes(&self) -> usize {
        held(&self.normal)
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        self.measure_normals(now);
        let (positions, materials) = (now.particles.positions(), now.particles.materials());
        let (errors, periodic) = (now.particles.density_errors(), now.neighbors.periodic());
        let inverse_masses = now.particles.inverse_masses();
        let (normal, radius) = (&self.normal, self.kernel.radius());
        now.parallelism.update(&mut out.velocity, |i, change| {
            let strength = self.strength[usize::from(materials[i])];
            if strength == 0.0 {
                return;
            }
            let mut sum = Vector::ZERO;
            now.neighbors.for_each(i, |j| {
                let apart = periodic.min_image(positions[i] - positions[j]);
                // The list holds pairs beyond the kernel too, and the difference of normals does not end there.
                let near = apart.length_squared() < radius * radius;
                if near && materials[j] == materials[i] && inverse_masses[j] > 0.0 {
                    let density = (2.0 + errors[i] + errors[j]).max(0.5);
                    let pull = apart.normalize_or_zero() * spline(apart.length() / radius) + normal[i] - normal[j];
                    sum += pull * (2.0 / density);
                }
            });
            *change -= sum * (strength * now.dt);
        });
    }
}

/// The cohesion spline over q = r/h, scaled to a largest value of 1 at q = 1/2: it pulls beyond q = 0.3
/// or so and pushes below.
fn spline(q: Real) -> Real {
    let cube = |x: Real| x * x * x;
    let value = cube((1.0 - q).max(0.0)) * cube(q) * 64.0;
    if q > 0.5 { value } else { 2.0 * value - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spline_pulls_far_pushes_near_and_ends_at_the_kernel_radius() {
        assert!((spline(0.5) - 1.0).abs() < 1e-6);
        assert!(spline(0.2) < 0.0 && spline(0.4) > 0.0 && spline(0.9) > 0.0);
        assert_eq!(spline(1.0), 0.0);
        assert_eq!(spline(1.5), 0.0);
    }
}
