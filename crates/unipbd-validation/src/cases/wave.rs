//! A standing wave in a tank.

use std::f64::consts::PI;

use unipbd_core::Solver;
use unipbd_core::math::Vector64;

use crate::case::{Band, Case, Figure, Measured, TARGETS, Trial};
use crate::exact::wave_viscosity;
use crate::runner::{Failure, points};
use crate::scenes::{GRAVITY, SPACING, pool};

/// The fundamental of a tank half as deep as long.
pub const STANDING_WAVE: Case = Case {
    name: "standing_wave",
    truth: "omega^2 = g k tanh(k d); no decay (what there is, is numerical viscosity: Prosperetti 1976)",
    quick: 24,
    full: &[32, 64, 128, 200],
    targets: TARGETS,
    run: standing_wave,
};

/// From this resolution on the period is judged more strictly.
const FINE: f64 = 200.0;

/// Slope k a of the wave at the start.
const STEEPNESS: f64 = 0.05;

fn standing_wave(trial: &Trial) -> Result<Measured, Failure> {
    let cells = f64::from(trial.resolution);
    let mut run = trial.start(&pool((cells, 0.5 * cells), cells, trial))?;
    let (length, depth) = (cells * SPACING, 0.5 * cells * SPACING);
    let k = PI / length;
    let omega = (GRAVITY * k * (k * depth).tanh()).sqrt();
    let a = STEEPNESS / k;
    // Let the level pool take up its pressure first.
    run.frames(30, |_| ())?;
    run.displace(|x| {
        let size = a / (k * depth).sinh();
        let (along, up) = (-(k * x.x).sin() * (k * x.y).cosh(), (k * x.x).cos() * (k * x.y).sinh());
        Vector64::new(along, up) * size
    })?;
    run.stir(|_| Vector64::ZERO)?;
    let mut curve = vec![(run.solver.time(), amplitude(&run.solver, k, length))];
    let mut compression = Vec::new();
    let frames = (60.0 * 3.3 * 2.0 * PI / omega).ceil() as u32;
    run.frames(frames, |solver| {
        curve.push((solver.time(), amplitude(solver, k, length)));
        compression.push(solver.diagnostics().density_error_mean);
    })?;
    let (period, decay) = period_and_decay(&curve);
    let error = period * omega / (2.0 * PI) - 1.0;
    let viscosity = wave_viscosity(decay, omega, k);
    let figures = vec![
        Figure::new("decay per period", decay, Band::between(-0.01, 0.17)),
        Figure::new("period error", error, Band::within(if cells < FINE { 0.045 } else { 0.01 })),
        Figure::new("numerical viscosity over sqrt(g L^3)", viscosity / (GRAVITY * length.powi(3)).sqrt(), Band::OPEN),
        Figure::new("mean C", compression.iter().sum::<f64>() / compression.len() as f64, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Amplitude of the fundamental: the sum of V cos(k x) is the integral of eta cos(k x) \[m].
fn amplitude(solver: &Solver, k: f64, length: f64) -> f64 {
    points(solver).map(|x| (k * x.x).cos()).sum::<f64>() * SPACING * SPACING * 2.0 / length
}

/// Period from the crossings of zero, and mean ln(A_k/A_(k+1)) from the extremes.
fn period_and_decay(curve: &[(f64, f64)]) -> (f64, f64) {
    let crossings: Vec<f64> = curve
        .windows(2)
        .filter(|pair| pair[0].1.signum() != pair[1].1.signum())
        .map(|pair| pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1))
        .collect();
    let halves = crossings.len().saturating_sub(1) as f64;
    let period = 2.0 * (crossings.last().unwrap_or(&f64::NAN) - crossings.first().unwrap_or(&f64::NAN)) / halves;
    // One extreme between every two crossings; a period has two.
    let extreme = |span: &[f64]| {
        let inside = curve.iter().filter(|(time, _)| *time >= span[0] && *time <= span[1]);
        inside.map(|(_, value)| value.abs()).fold(0.0, f64::max)
    };
    let extremes: Vec<f64> = crossings.windows(2).map(extreme).collect();
    let spans = extremes.len().saturating_sub(1) as f64;
    let decay = 2.0 * (extremes.first().unwrap_or(&f64::NAN) / extremes.last().unwrap_or(&f64::NAN)).ln() / spans;
    (period, decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damped_oscillation_gives_its_period_and_decay() {
        let curve: Vec<(f64, f64)> = (0..2000)
            .map(|step| 0.005 * f64::from(step))
            .map(|t| (t, (2.0 * PI * t / 3.0).cos() * (-0.1 * t / 3.0).exp()))
            .collect();
        let (period, decay) = period_and_decay(&curve);
        assert!((period - 3.0).abs() < 1e-3 && (decay - 0.1).abs() < 2e-3, "{period} {decay}");
    }
}
