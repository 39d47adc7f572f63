//! Constraints of one's own: beads on a ring, as one equation in a [`Batch`], and a chain of links
//! between them, as a group written out in full.
//!
//! `cargo run -p unipbd-core --example custom_constraint`

use unipbd_core::constraints::{Batch, Constraint, ConstraintGroup, Corrections, Needs, Substep};
use unipbd_core::scene::{PointMotion, Points, Scene, Solid, SolverSettings, Substeps};
use unipbd_core::{BuildOptions, Real, Vector};

const BEADS: u32 = 8;
const RADIUS: f64 = 1.0;
const LINK: f64 = 0.2;

/// C(x) = |x| - radius: the bead stays on a ring about the origin.
struct OnRing {
    bead: u32,
    radius: Real,
}

impl Constraint<1> for OnRing {
    const NAME: &'static str = "ring";

    fn particles(&self) -> [u32; 1] {
        [self.bead]
    }

    fn evaluate(&self, [x]: [Vector; 1]) -> Option<(Real, [Vector; 1])> {
        let distance = x.length();
        (distance > 0.0).then(|| (distance - self.radius, [x / distance]))
    }
}

/// Links between beads that follow each other: each goes half of the way to its length.
struct Chain {
    beads: Vec<u32>,
    length: Real,
    worst: Real,
}

impl ConstraintGroup for Chain {
    fn name(&self) -> &str {
        "chain"
    }

    fn needs(&self) -> Needs {
        Needs::ROWS
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        self.worst = 0.0;
        for pair in self.beads.windows(2) {
            let (Some(a), Some(b)) = (now.rows.row(pair[0]), now.rows.row(pair[1])) else { continue };
            let (a, b) = (a as usize, b as usize);
            let apart = now.particles.positions()[b] - now.particles.positions()[a];
            let (distance, weights) = (apart.length(), now.particles.inverse_masses());
            let sum = weights[a] + weights[b];
            if distance == 0.0 || sum == 0.0 {
                continue;
            }
            let error = distance - self.length;
            self.worst = self.worst.max(error.abs());
            let step = apart * (0.5 * error / (distance * sum));
            out.add(a, step * weights[a]);
            out.add(b, step * -weights[b]);
        }
    }

    fn violation(&self) -> Option<f64> {
        Some(f64::from(self.worst))
    }
}

/// What the run came to.
pub struct End {
    /// Largest distance of a bead from the ring \[m].
    pub off_ring: f64,
    /// Largest relative error of a link.
    pub stretch: f64,
    /// Height of the lowest bead \[m].
    pub lowest: f64,
}

/// Beads side by side on top of a ring slide down on one side, pulled by gravity.
pub fn simulate(seconds: f64) -> Result<End, Box<dyn std::error::Error>> {
    let angle = |bead: u32| 1.5 - f64::from(bead) * 2.0 * (0.5 * LINK / RADIUS).asin();
    let beads = Points {
        material: "beads".into(),
        positions: (0..BEADS).map(|bead| [RADIUS * angle(bead).cos(), RADIUS * angle(bead).sin()]).collect(),
        velocity: [0.0; 2],
        velocities: Vec::new(),
        temperature: 0.0,
        motion: PointMotion::Free,
    };
    let scene = Scene {
        solid: vec![Solid { name: "beads".into(), ..Solid::default() }],
        points: vec![beads],
        solver: SolverSettings { substeps: Substeps::Fixed(40), iterations: 4, ..SolverSettings::default() },
        ..Scene::default()
    };
    let mut solver = scene.build(BuildOptions::default())?;
    let rings = (0..BEADS).map(|bead| OnRing { bead, radius: RADIUS as Real }).collect();
    solver.add_group(Box::new(Chain { beads: (0..BEADS).collect(), length: LINK as Real, worst: 0.0 }));
    solver.add_group(Box::new(Batch::new(rings)));
    while solver.time() < seconds {
        solver.step_frame()?;
    }
    let positions = solver.positions();
    let off_ring = positions.iter().map(|x| (f64::from(x.length()) - RADIUS).abs()).fold(0.0, f64::max);
    let links = solver.diagnostics().groups.iter().find(|group| group.name == "chain").map_or(0.0, |g| g.violation);
    let lowest = positions.iter().map(|x| f64::from(x.y)).fold(f64::INFINITY, f64::min);
    Ok(End { off_ring, stretch: links / LINK, lowest })
}

/// Runs it and says what came of it.
pub fn main() {
    match simulate(2.0) {
        Ok(end) => println!(
            "after 2 s the lowest bead is at {:.2} m, {:.1e} m off the ring; the links are within {:.1}%",
            end.lowest,
            end.off_ring,
            100.0 * end.stretch
        ),
        Err(error) => eprintln!("{error}"),
    }
}
