//! Exact solutions, computed where they are needed.

use std::f64::consts::PI;

use unipbd_core::math::Vector64;

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

/// A solitary wave on water of depth 1 that runs along x (Grimshaw 1971, J. Fluid Mech. 46, 611: third order). Speeds are in
/// units of sqrt(g d).
#[derive(Clone, Copy, Debug)]
pub struct SolitaryWave {
    /// Height of the crest over the depth.
    pub crest: f64,
}

impl SolitaryWave {
    /// Speed of the wave.
    pub fn speed(self) -> f64 {
        let a = self.crest;
        (1.0 + a - a * a / 20.0 - 3.0 / 70.0 * a * a * a).sqrt()
    }

    /// Squares of the hyperbolic secant and the tangent at a distance from the crest, and the latter itself.
    fn shape(self, x: f64) -> [f64; 3] {
        let a = self.crest;
        let t = ((0.75 * a).sqrt() * (1.0 - 0.625 * a + 71.0 / 128.0 * a * a) * x).tanh();
        [1.0 - t * t, t * t, t]
    }

    /// Height over the still level at a distance from the crest.
    pub fn height(self, x: f64) -> f64 {
        let (a, [s, t, _]) = (self.crest, self.shape(x));
        a * (s - 0.75 * a * s * t + a * a * (0.625 * s * t - 101.0 / 80.0 * s * s * t))
    }

    /// Velocity at a place seen from the floor below the crest.
    pub fn velocity(self, place: Vector64) -> Vector64 {
        let (a, [s, _, t]) = (self.crest, self.shape(place.x));
        let (ss, sss, y) = (s * s, s * s * s, place.y);
        let (yy, yyyy) = (y * y, y * y * y * y);
        let along_first = -0.25 * s + ss + yy * (1.5 * s - 2.25 * ss);
        let along_second = 0.475 * s + 0.2 * ss - 1.2 * sss
            + yy * (-1.5 * s - 3.75 * ss + 7.5 * sss)
            + yyyy * (-0.375 * s + 2.8125 * ss - 2.8125 * sss);
        let up_first = 0.375 + 2.0 * s + yy * (0.5 - 1.5 * s);
        let up_second = 49.0 / 640.0 - 0.85 * s - 3.6 * ss
            + yy * (-0.8125 - 1.5625 * s + 7.5 * ss)
            + yyyy * (-0.075 + 1.125 * s - 1.6875 * ss);
        let along = a * (s - a * along_first - a * a * along_second);
        let up = a * (3.0 * a).sqrt() * y * s * t * (1.0 - a * up_first - a * a * up_second);
        Vector64::new(along, up)
    }
}

/// A pair of vortices of opposite circulation in a square box with walls that slip.
#[derive(Clone, Copy, Debug)]
pub struct VortexPair {
    /// Side of the box, from the origin \[m].
    pub side: f64,
    /// Circulation of the left one; the right one has the opposite [m^2/s].
    pub circulation: f64,
}

impl VortexPair {
    /// Velocity that these vortices and their images behind the walls bring about at a place, but for what a vortex just
    /// there brings about itself [m/s].
    pub fn velocity(self, vortices: [Vector64; 2], place: Vector64) -> Vector64 {
        let period = 2.0 * self.side;
        let images = vortices.into_iter().zip([self.circulation, -self.circulation]).flat_map(|(vortex, strength)| {
            let turned = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
            turned.map(|(x, y)| (Vector64::new(vortex.x * x, vortex.y * y), strength * x * y))
        });
        let rows = images.flat_map(|(image, strength)| {
            (-3..=3).map(move |row| (image + Vector64::Y * (period * f64::from(row)), strength))
        });
        rows.map(|(vortex, strength)| of_row(place - vortex, period) * strength).sum()
    }

    /// Where vortices are after this time, by the rule of Runge and Kutta \[m].
    pub fn after(self, vortices: [Vector64; 2], time: f64) -> [Vector64; 2] {
        const STEPS: u32 = 200;
        let step = time / f64::from(STEPS);
        let rate = |at: [Vector64; 2]| at.map(|vortex| self.velocity(at, vortex));
        let moved = |at: [Vector64; 2], rate: [Vector64; 2], step: f64| [0, 1].map(|k| at[k] + rate[k] * step);
        (0..STEPS).fold(vortices, |at, _| {
            let first = rate(at);
            let second = rate(moved(at, first, 0.5 * step));
            let third = rate(moved(at, second, 0.5 * step));
            let fourth = rate(moved(at, third, step));
            [0, 1].map(|k| at[k] + (first[k] + (second[k] + third[k]) * 2.0 + fourth[k]) * (step / 6.0))
        })
    }
}

/// Velocity of a row of vortices of circulation 1, a period apart along x, seen from one of them (Lamb 1932, article 156).
fn of_row(away: Vector64, period: f64) -> Vector64 {
    let (x, y) = (2.0 * PI * away.x / period, 2.0 * PI * away.y / period);
    let below = 2.0 * period * (y.cosh() - x.cos());
    if below == 0.0 { Vector64::ZERO } else { Vector64::new(-y.sinh(), x.sin()) / below }
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

    #[test]
    fn a_solitary_wave_carries_its_water_along() {
        let wave = SolitaryWave { crest: 0.2 };
        for x in [0.0, 0.7, 2.0, 4.0] {
            let height = wave.height(x);
            let flux = (0..1000).map(|k| {
                let y = (f64::from(k) + 0.5) / 1000.0 * (1.0 + height);
                wave.velocity(Vector64::new(x, y)).x * (1.0 + height) / 1000.0
            });
            near(flux.sum::<f64>() / (wave.speed() * height), 1.0, 0.007);
        }
        near(wave.height(0.0), 0.2, 1e-12);
    }

    #[test]
    fn a_pair_of_vortices_runs_at_its_own_speed_far_from_walls_and_no_wall_is_crossed() {
        let pair = VortexPair { side: 1000.0, circulation: 2.0 * PI };
        let start = [Vector64::new(499.5, 500.0), Vector64::new(500.5, 500.0)];
        // The left one turns counter-clockwise and pushes the right one up.
        near(pair.after(start, 2.0)[1].y, 502.0, 1e-4);
        let pair = VortexPair { side: 4.0, circulation: 2.0 * PI };
        let vortices = [Vector64::new(1.0, 1.5), Vector64::new(2.5, 2.0)];
        for along in [0.3, 1.9, 3.3] {
            near(pair.velocity(vortices, Vector64::new(0.0, along)).x, 0.0, 1e-9);
            near(pair.velocity(vortices, Vector64::new(4.0, along)).x, 0.0, 1e-9);
            near(pair.velocity(vortices, Vector64::new(along, 0.0)).y, 0.0, 1e-9);
            near(pair.velocity(vortices, Vector64::new(along, 4.0)).y, 0.0, 1e-9);
        }
    }
}
