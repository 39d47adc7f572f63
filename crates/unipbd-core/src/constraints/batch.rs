use super::projection::multiplier_step;
use super::{ConstraintGroup, Corrections, Needs, Substep};
use crate::math::{Real, Vector, real};

/// One equation C(x) = 0 (or C(x) >= 0) between N particles: pure mathematics.
pub trait Constraint<const N: usize>: Send + Sync {
    /// Name of the kind, in the plural: it names the group.
    const NAME: &'static str;
    /// Whether only C < 0 is a violation.
    const INEQUALITY: bool = false;

    /// Ids of the particles.
    fn particles(&self) -> [u32; N];

    /// Compliance, 0 for a stiff constraint [m/N times the unit of C squared].
    fn compliance(&self) -> Real {
        0.0
    }

    /// C and its gradients at these positions; `None` where it is not defined.
    fn evaluate(&self, positions: [Vector; N]) -> Option<(Real, [Vector; N])>;
}

/// Many constraints of one kind, solved by Jacobi iteration with mass splitting (Tonge et al. 2012): each
/// of the n constraints of a particle sees an n-th of its mass. For equal n this is the averaging of
/// Macklin et al. 2014, section 4.2; unlike that it keeps momentum and leaves a compliance what it is.
pub struct Batch<C, const N: usize> {
    constraints: Vec<C>,
    relaxation: Real,
    lambda: Vec<Real>,
    rows: Vec<Option<[u32; N]>>,
    steps: Vec<[Vector; N]>,
    share: Vec<u32>,
    violation: Real,
}

impl<C: Constraint<N>, const N: usize> Batch<C, N> {
    /// A batch of these constraints.
    pub fn new(constraints: Vec<C>) -> Self {
        let count = constraints.len();
        Batch {
            constraints,
            relaxation: 1.0,
            lambda: vec![0.0; count],
            rows: vec![None; count],
            steps: vec![[Vector::ZERO; N]; count],
            share: Vec::new(),
            violation: 0.0,
        }
    }

    /// Sets the over-relaxation, 1 to 2 (default 1): the number of mass shares of a particle is divided by it.
    #[must_use]
    pub fn with_relaxation(mut self, relaxation: f64) -> Self {
        self.relaxation = real(relaxation);
        self
    }

    /// The constraints.
    pub fn constraints(&self) -> &[C] {
        &self.constraints
    }

    /// The constraints, to be changed between steps.
    pub fn constraints_mut(&mut self) -> &mut [C] {
        &mut self.constraints
    }

    /// First pass: each constraint writes its own slot.
    fn solve(&mut self, now: Substep<'_>) {
        let inverse_dt2 = 1.0 / (now.dt * now.dt);
        self.violation = 0.0;
        for (index, constraint) in self.constraints.iter().enumerate() {
            self.steps[index] = [Vector::ZERO; N];
            let Some(rows) = self.rows[index] else { continue };
            let positions = rows.map(|row| now.particles.positions()[row as usize]);
            let Some((value, gradients)) = constraint.evaluate(positions) else { continue };
            self.violation = self.violation.max(if C::INEQUALITY { -value } else { value.abs() });
            let weights = rows.map(|row| now.particles.inverse_masses()[row as usize]);
            let split = |row: u32| (self.share[row as usize] as Real / self.relaxation).max(1.0);
            let split_weights = std::array::from_fn(|k| weights[k] * split(rows[k]));
            let alpha = constraint.compliance() * inverse_dt2;
            let old = self.lambda[index];
            let mut new = old + multiplier_step(value, &gradients, &split_weights, old, alpha);
            if C::INEQUALITY {
                new = new.max(0.0);
            }
            self.lambda[index] = new;
            for k in 0..N {
                self.steps[index][k] = gradients[k] * (weights[k] * (new - old));
            }
        }
    }
}

impl<C: Constraint<N>, const N: usize> ConstraintGroup for Batch<C, N> {
    fn name(&self) -> &str {
        C::NAME
    }

    fn needs(&self) -> Needs {
        Needs::ROWS
    }

    fn begin_substep(&mut self, now: Substep<'_>) {
        self.lambda.fill(0.0);
        self.share.clear();
        self.share.resize(now.particles.len(), 0);
        for (constraint, rows) in self.constraints.iter().zip(&mut self.rows) {
            let found = constraint.particles().map(|id| now.rows.row(id));
            *rows = found.iter().all(Option::is_some).then(|| found.map(|row| row.unwrap_or(0)));
            for row in rows.iter().flatten() {
                self.share[*row as usize] += 1;
            }
        }
    }

    /// Second pass: gathered in the order of the constraints, so the same on any number of threads.
    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.solve(now);
        for (rows, steps) in self.rows.iter().zip(&self.steps) {
            let Some(rows) = rows else { continue };
            for (&row, &step) in rows.iter().zip(steps) {
                out.add(row as usize, step);
            }
        }
    }

    fn violation(&self) -> Option<f64> {
        Some(f64::from(self.violation.max(0.0)))
    }
}
