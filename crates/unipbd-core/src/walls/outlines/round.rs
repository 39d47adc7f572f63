//! A disc that a fluid touches: the part of a kernel inside it is a function of the distance alone.

use super::super::coverage::simpson;
use super::super::edges::EdgeTables;
use super::polygon::Seen;
use crate::kernel::{Kernel, Shape};
use crate::math::{Real, Vector, real};
use std::f64::consts::PI;

const CELLS: usize = 128;
/// Steps of the distance between the surface of the kernel touching the disc and its leaving it.
const STEPS: usize = 512;
/// Pieces of an arc.
const PIECES: usize = 128;

/// A disc and its tables.
#[derive(Clone, Debug)]
pub(super) struct Round {
    radius: Real,
    scale: Real,
    reach: Real,
    /// Part of the kernel inside and its derivative by the distance from the surface [1/m], at equal steps of that
    /// distance from minus to plus the kernel radius.
    nodes: Vec<[Real; 2]>,
}

impl Round {
    /// A disc of this radius \[m].
    pub fn new<K: Shape>(radius: f64, kernel: &Kernel<K>, tables: &EdgeTables) -> Round {
        let reach = f64::from(kernel.radius());
        // From the farthest distance of the centres inwards, the part grows by its derivative.
        let (far, step) = (radius + reach, (2.0 * reach).min(radius + reach) / STEPS as f64);
        let mut parts = vec![[0.0; 2]; STEPS + 1];
        for k in 1..=STEPS {
            let centre = far - step * k as f64;
            let slope = |centre: f64| -flux(kernel, radius, centre.max(0.0));
            let grown = simpson(centre, centre + step, slope);
            parts[k] = [parts[k - 1][0] + grown, -slope(centre)];
        }
        let at = |distance: f64| {
            let place = ((reach - distance) / step).clamp(0.0, STEPS as f64);
            let cell = (place as usize).min(STEPS - 1);
            let t = place - cell as f64;
            [0, 1].map(|k| parts[cell][k] + t * (parts[cell + 1][k] - parts[cell][k]))
        };
        let node = |k: usize| {
            let (seen, grown) = tables.stretch.at(reach * (2.0 * k as f64 / CELLS as f64 - 1.0));
            let [part, slope] = at(seen);
            [real(part), real(slope * grown)]
        };
        Round {
            radius: real(radius),
            scale: real(CELLS as f64 / (2.0 * reach)),
            reach: real(reach),
            nodes: (0..=CELLS).map(node).collect(),
        }
    }

    pub fn distance(&self, x: Vector) -> Real {
        x.length() - self.radius
    }

    /// The part of the kernel about a point that lies inside, and its gradient.
    pub fn seen(&self, x: Vector) -> Option<Seen> {
        let length = x.length();
        let distance = length - self.radius;
        if distance >= self.reach {
            return None;
        }
        let place = ((distance + self.reach) * self.scale).max(0.0);
        let cell = (place as usize).min(CELLS - 1);
        let t = place - cell as Real;
        let [part, slope] = [0, 1].map(|k| self.nodes[cell][k] + t * (self.nodes[cell + 1][k] - self.nodes[cell][k]));
        let out = if length > 0.0 { x / length } else { Vector::Y };
        Some(Seen { part, gradient: out * slope })
    }

    pub fn memory_bytes(&self) -> usize {
        crate::bytes::held(&self.nodes)
    }
}

/// Derivative of the part of a kernel inside a disc by the distance of their centres [1/m]: minus the integral of W
/// times the component of the normal along the line of the centres, over the circle.
fn flux<K: Shape>(kernel: &Kernel<K>, radius: f64, centre: f64) -> f64 {
    let reach = f64::from(kernel.radius());
    // Beyond this angle the circle is out of the kernel.
    let cosine = (centre * centre + radius * radius - reach * reach) / (2.0 * radius * centre).max(f64::MIN_POSITIVE);
    let most = if cosine <= -1.0 { PI } else { libm::acos(cosine.min(1.0)) };
    let on_circle = |angle: f64| {
        let square = centre * centre + radius * radius - 2.0 * centre * radius * libm::cos(angle);
        f64::from(kernel.value(real(square.max(0.0).sqrt()))) * libm::cos(angle)
    };
    let piece = most / PIECES as f64;
    let half: f64 = (0..PIECES).map(|k| simpson(piece * k as f64, piece * (k + 1) as f64, on_circle)).sum();
    -2.0 * radius * half
}
