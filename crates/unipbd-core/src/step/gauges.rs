//! Gauges: readings of the state, made when asked for. They change nothing.

use super::world::World;
use crate::math::{Vector64, vector, wide};
use crate::observe::GaugeReading;
use crate::phase::Phase;
use crate::scene::{ForcePart, Gauge, GaugeKind};

/// A surface is where points have at least this many others within [`COMPANY_RADIUS`]: spray is none.
const COMPANY: usize = 2;
/// In spacings.
const COMPANY_RADIUS: f64 = 2.0;
/// From the top of a disc of one spacing back to the surface: on a lattice at rest, the mean over all lines is right
/// \[spacings].
const BACK: f64 = 0.46;
/// A pressure is averaged over this radius by default \[spacings].
const PRESSURE_RADIUS: f64 = 3.0;
/// Half of the width of the band in which particles count as crossing a line \[spacings].
const BAND: f64 = 2.0;
/// A slope is fitted where points lie this far apart in every direction, as a part of their squared mean distance.
const LEAST_SPREAD: f64 = 0.05;

impl World {
    /// The readings, in the order of the scene.
    pub(super) fn gauges(&self) -> Vec<GaugeReading> {
        let read = |gauge: &Gauge| GaugeReading {
            name: gauge.name.clone(),
            value: self.read_gauge(gauge).unwrap_or(f64::NAN),
            kind: gauge.kind,
        };
        self.parts.gauges.iter().map(read).collect()
    }

    fn read_gauge(&self, gauge: &Gauge) -> Option<f64> {
        let direction = Vector64::from(gauge.direction.unwrap_or([0.0, 1.0])).normalize();
        match gauge.kind {
            GaugeKind::Level => self.farthest(gauge, direction, true),
            GaugeKind::Front => self.farthest(gauge, direction, false),
            GaugeKind::Pressure => self.pressure_at(gauge),
            GaugeKind::Force => {
                let force = self.force_on(gauge)?;
                Some(if gauge.direction.is_some() { force.dot(direction) } else { force.length() })
            }
            GaugeKind::FlowRate => self.flow_rate(gauge),
        }
    }

    /// Rows of the material of a gauge, or of its phases, and where they are seen from a point \[m].
    fn seen<'a>(&'a self, gauge: &'a Gauge, from: Vector64) -> impl Iterator<Item = (usize, Vector64)> + 'a {
        let (particles, materials) = (&self.parts.particles, &self.parts.materials);
        let gases = matches!(gauge.kind, GaugeKind::Pressure | GaugeKind::FlowRate);
        let wanted = gauge.material.as_ref().map(|name| materials.iter().position(|known| known.name == *name));
        let counts = move |row: &usize| match wanted {
            Some(index) => index == Some(usize::from(particles.material[*row])),
            None => particles.phase[*row] == Phase::Liquid || gases && particles.phase[*row] == Phase::Gas,
        };
        let periodic = self.parts.neighbors.periodic();
        let place = move |row: usize| {
            let way = wide(particles.position[row]) - from;
            (row, if periodic.any() { wide(periodic.min_image(vector(way))) } else { way })
        };
        (0..particles.len()).filter(counts).map(place)
    }

    /// The farthest surface along a direction, half a spacing from the points. `beside` looks at the line through the
    /// place of the gauge alone, and at discs of one spacing around the points, so that no gap between them counts.
    fn farthest(&self, gauge: &Gauge, direction: Vector64, beside: bool) -> Option<f64> {
        let (spacing, from) = (self.parts.spacing, Vector64::from(gauge.at.unwrap_or_default()));
        let reach = COMPANY_RADIUS * spacing;
        let along = |(_, way): (usize, Vector64)| [way.dot(direction), direction.perp_dot(way)];
        let near = |point: &[f64; 2]| !beside || point[1].abs() < spacing + reach;
        let mut points: Vec<[f64; 2]> = self.seen(gauge, from).map(along).filter(near).collect();
        points.sort_unstable_by(|a, b| b[0].total_cmp(&a[0]));
        let mut farthest: Option<f64> = None;
        for (k, [ahead, aside]) in points.iter().copied().enumerate() {
            if farthest.is_some_and(|farthest| ahead + (1.0 - BACK) * spacing <= farthest) {
                break;
            }
            let top = match beside {
                true => ahead + (spacing * spacing - aside * aside).sqrt() - BACK * spacing,
                false => ahead + 0.5 * spacing,
            };
            // A point farther aside than a spacing has no top.
            if !top.is_nan() && farthest.is_none_or(|farthest| top > farthest) && has_company(&points, k, reach) {
                farthest = Some(top);
            }
        }
        farthest
    }

    /// Pressure at the place of a gauge: a plane fitted to those of the particles around it by least squares, weighted
    /// by Wendland's kernel, so that it is right beside walls too.
    fn pressure_at(&self, gauge: &Gauge) -> Option<f64> {
        if self.clock.dt == 0.0 {
            return None;
        }
        let radius = gauge.radius.unwrap_or(PRESSURE_RADIUS * self.parts.spacing);
        let (pressures, materials) = (self.pressures(), &self.parts.materials);
        let near = |(row, way): (usize, Vector64)| {
            let q = way.length() / radius;
            let density = materials[usize::from(self.parts.particles.material[row])].density;
            let side = 1.0 - q;
            (q < 1.0).then(|| (side * side * side * side * (1.0 + 4.0 * q), way, density * f64::from(pressures[row])))
        };
        let points: Vec<(f64, Vector64, f64)> =
            self.seen(gauge, Vector64::from(gauge.at.unwrap_or_default())).filter_map(near).collect();
        let total: f64 = points.iter().map(|(weight, ..)| weight).sum();
        (total > 0.0).then(|| fitted(&points, total))
    }

    /// Mean force over the last frame \[N].
    fn force_on(&self, gauge: &Gauge) -> Option<Vector64> {
        let name = gauge.on.as_deref()?;
        let part = |fluids: Vector64, contacts: Vector64| match gauge.of {
            ForcePart::All => fluids + contacts,
            ForcePart::Fluids => fluids,
            ForcePart::Contacts => contacts,
        };
        if self.parts.walls.measured().iter().any(|wall| wall == name) {
            let of = |wall: &crate::observe::WallForce| wall.name == name;
            let wall = self.wall_forces().into_iter().find(of).filter(|_| self.loads_known)?;
            return Some(part(wall.fluid_force, wall.contact_force));
        }
        let bodies = self.parts.rigid.as_ref()?.views();
        let body = bodies.iter().find(|body| body.name == name && !body.removed).filter(|_| self.clock.frame > 0)?;
        Some(part(body.fluid_force, body.contact_force))
    }

    /// Area per time that crosses the line of a gauge [m^2/s]. Rows at a distance of a spacing count as one: the band
    /// has a hat of weights.
    fn flow_rate(&self, gauge: &Gauge) -> Option<f64> {
        let [from, to] = gauge.line?.map(Vector64::from);
        let (length, band) = ((to - from).length(), BAND * self.parts.spacing);
        let along = (to - from) / length;
        let (particles, materials) = (&self.parts.particles, &self.parts.materials);
        let crossing = |(row, way): (usize, Vector64)| {
            let off = along.perp_dot(way).abs();
            let beside = (0.0..=length).contains(&(way.dot(along) + 0.5 * length)) && off < band;
            let mass = 1.0 / f64::from(particles.inverse_mass[row]);
            let area = mass / materials[usize::from(particles.material[row])].density;
            let weight = (1.0 - off / band) / band;
            // Kinematic particles have no finite mass, and do not flow.
            (beside && area.is_finite()).then(|| -along.perp_dot(wide(particles.velocity[row])) * area * weight)
        };
        // The sum begins at +0.0: of nothing, -0.0 would be shown.
        Some(self.seen(gauge, 0.5 * (from + to)).filter_map(crossing).fold(0.0, |sum, part| sum + part))
    }
}

/// Whether enough of the points, which are sorted by their first coordinate, lie near number `k`.
fn has_company(points: &[[f64; 2]], k: usize, reach: f64) -> bool {
    let [ahead, aside] = points[k];
    let within = |point: &&[f64; 2]| (point[0] - ahead).abs() <= reach;
    let near = |point: &&[f64; 2]| {
        let [x, y] = [point[0] - ahead, point[1] - aside];
        x * x + y * y <= reach * reach
    };
    let before = points[..k].iter().rev().take_while(within).filter(near);
    let behind = points[k + 1..].iter().take_while(within).filter(near);
    before.chain(behind).take(COMPANY).count() == COMPANY
}

/// The value at the origin of the plane through weighted points: (weight, place, value).
fn fitted(points: &[(f64, Vector64, f64)], total: f64) -> f64 {
    let mean = points.iter().map(|(weight, _, value)| weight * value).sum::<f64>() / total;
    let center = points.iter().map(|(weight, place, _)| *place * *weight).sum::<Vector64>() / total;
    let (mut xx, mut xy, mut yy, mut rise) = (0.0, 0.0, 0.0, Vector64::ZERO);
    for (weight, place, value) in points {
        let off = *place - center;
        xx += weight * off.x * off.x;
        xy += weight * off.x * off.y;
        yy += weight * off.y * off.y;
        rise += off * (weight * (value - mean));
    }
    let (determinant, trace) = (xx * yy - xy * xy, xx + yy);
    if determinant <= LEAST_SPREAD * trace * trace {
        return mean;
    }
    let slope = Vector64::new(yy * rise.x - xy * rise.y, xx * rise.y - xy * rise.x) / determinant;
    mean - slope.dot(center)
}
