//! Exact solutions, computed where they are needed.

use std::f64::consts::PI;

/// Half-axis a/R along x of a free elliptical drop with u = (A0 x, -A0 y) at the time t A0 (Monaghan
/// 1994, J. Comput. Phys. 110, 399).
pub fn elliptical_drop(time: f64) -> f64 {
    let steps = 4000;
    let step = time / f64::from(steps);
    (0..steps).fold([1.0, 1.0], |axis_and_rate, _| strained(axis_and_rate, step, 0.0))[0]
}

/// Period T A0 of a drop with u = (A0 x, -A0 y) under the acceleration -A0^2 x (Monaghan & Rafiee 2013, Int. J. Numer.
/// Methods Fluids 71, 537): four times the time until it stands still for the first time.
pub fn oscillation_period() -> f64 {
    let step = 1e-4;
    let (mut state, mut time) = ([1.0, 1.0], 0.0);
    loop {
        let next = strained(state, step, 1.0);
        if next[1] <= 0.0 {
            return 4.0 * (time + step * state[1] / (state[1] - next[1]));
        }
        (state, time) = (next, time + step);
    }
}

/// A step of the half-axis and strain rate of a drop in a central field of this strength, by the rule of Runge and
/// Kutta: da/dt = a A, dA/dt = -(A^2 + field) (a^4 - 1)/(a^4 + 1).
fn strained([a, r]: [f64; 2], step: f64, field: f64) -> [f64; 2] {
    let rate = |a: f64, rate: f64| {
        let fourth = a.powf(4.0);
        (a * rate, -(rate * rate + field) * (fourth - 1.0) / (fourth + 1.0))
    };
    let k1 = rate(a, r);
    let k2 = rate(a + 0.5 * step * k1.0, r + 0.5 * step * k1.1);
    let k3 = rate(a + 0.5 * step * k2.0, r + 0.5 * step * k2.1);
    let k4 = rate(a + step * k3.0, r + step * k3.1);
    [a + step / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0), r + step / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1)]
}

/// Kinematic viscosity that damps a standing wave by the factor exp(-`decay`) per period: the decay
/// rate is omega0 (2 e - sqrt(2) e^1.5) with e = nu k^2/omega0 (Prosperetti 1976, deep water) [m^2/s].
pub fn wave_viscosity(decay: f64, omega: f64, k: f64) -> f64 {
    let wanted = decay / (2.0 * PI);
    let mut e = 0.5 * wanted;
    for _ in 0..60 {
        e = 0.5 * (wanted + std::f64::consts::SQRT_2 * e.max(0.0).powf(1.5));
    }
    e * omega / (k * k)
}

/// Start-up of plane Couette flow, u/U at y/H and tau = nu t/H^2 (Morris et al. 1997).
pub fn couette(y: f64, tau: f64) -> f64 {
    let term = |n: i32| {
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        let n = f64::from(n);
        2.0 / (n * PI) * sign * (n * PI * y).sin() * (-n * n * PI * PI * tau).exp()
    };
    y + (1..200).map(term).sum::<f64>()
}

/// Start-up of plane Poiseuille flow, u/Umax with Umax = F H^2/(8 nu) (Morris et al. 1997).
pub fn poiseuille(y: f64, tau: f64) -> f64 {
    let term = |n: i32| {
        let a = f64::from(2 * n + 1) * PI;
        32.0 / (a * a * a) * (a * y).sin() * (-a * a * tau).exp()
    };
    4.0 * y * (1.0 - y) - (0..100).map(term).sum::<f64>()
}

/// Period of a pendulum released at `amplitude` over that of small swings: 1/AGM(1, cos(theta0/2)).
pub fn pendulum(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    1.0 / a
}

/// Surge front Z of a collapsing column a x 2a at T = t sqrt(2 g/a): Martin & Moyce 1952, Phil. Trans.
/// R. Soc. A 244, 312, a = 2.25 inches.
pub const MARTIN_MOYCE_FRONT: [(f64, f64); 6] =
    [(0.84, 1.22), (1.19, 1.44), (1.83, 2.11), (2.51, 3.00), (2.98, 3.67), (3.33, 4.11)];

/// Height H/2a left at the wall at tau = t sqrt(g/a), from the same experiment.
pub const MARTIN_MOYCE_HEIGHT: [(f64, f64); 5] = [(0.56, 0.94), (1.08, 0.78), (1.66, 0.61), (2.21, 0.44), (3.06, 0.28)];

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance, "{found} {expected}");
    }

    #[test]
    fn exact_solutions_give_their_known_values() {
        near(elliptical_drop(0.08), 1.083103, 1e-5);
        near(elliptical_drop(0.38), 1.439219, 1e-5);
        near(elliptical_drop(0.76), 1.944517, 1e-5);
        near(oscillation_period(), 4.827, 1e-3);
        near(couette(0.5, 0.02), 0.0124193, 1e-6);
        near(poiseuille(0.25, 0.02), 0.146424, 1e-5);
        near(pendulum(90f64.to_radians()), 1.18034, 1e-5);
        near(pendulum(45f64.to_radians()), 1.03997, 1e-5);
        let e = 0.01_f64;
        let decay = 2.0 * PI * (2.0 * e - 2f64.sqrt() * e.powf(1.5));
        near(wave_viscosity(decay, 3.0, 2.0), e * 3.0 / 4.0, 1e-9);
    }
}
