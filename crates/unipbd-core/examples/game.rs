//! A small game loop: bodies are dropped into a pit, a bar sweeps them, every second the one on top is taken away, and
//! the pit is drawn in the terminal.
//!
//! `cargo run --release -p unipbd-core --example game`

use std::error::Error;
use std::fmt::Write;
use unipbd_core::edit::Edit;
use unipbd_core::rng::Rng;
use unipbd_core::scene::{BodyDescription, BodyKind, MotionDescription, Obstacle, Scene};
use unipbd_core::step::Solid;
use unipbd_core::{BuildOptions, Solver, Vector64};

/// Columns and rows of the picture, and what it shows: from the lower left to the upper right corner \[m].
const PICTURE: (usize, usize) = (72, 24);
const VIEW: ([f64; 2], [f64; 2]) = ([-3.0, -0.3], [3.0, 3.7]);

/// A pit with a bar that swings in it.
fn pit() -> Scene {
    let bar = BodyDescription {
        name: "bar".into(),
        kind: BodyKind::Kinematic,
        motion: Some(MotionDescription { amplitude: [1.6, 0.0], frequency: 0.25, ..MotionDescription::default() }),
        ..BodyDescription::rectangle([0.2, 1.0], [0.0, 0.5])
    };
    let walls = [([-3.0, -0.3], [3.0, 0.0]), ([-3.0, 0.0], [-2.7, 2.5]), ([2.7, 0.0], [3.0, 2.5])];
    let obstacle = walls.map(|(min, max)| Obstacle::new(min, max)).to_vec();
    Scene { spacing: 0.05, body: vec![bar], obstacle, ..Scene::default() }
}

/// A body above the pit, of a shape and at a place drawn by lot.
fn next_body(number: usize, random: &mut Rng) -> BodyDescription {
    let place = [1.8 * random.signed_unit(), 3.5];
    let size = 0.18 + 0.06 * random.signed_unit();
    let body = match number % 3 {
        0 => BodyDescription::disc(size, place),
        1 => BodyDescription::rectangle([3.0 * size, 1.5 * size], place),
        _ => BodyDescription::polygon(vec![[-size, -size], [size, -size], [0.0, size]], place),
    };
    BodyDescription { name: format!("body {number}"), restitution: 0.2, spin_deg: 200.0 * random.signed_unit(), ..body }
}

/// The highest body in the pit: what a ray from above meets first.
fn top(solver: &Solver) -> Option<u32> {
    let rays = (0..50).map(|k| -2.6 + 5.2 * f64::from(k) / 49.0);
    let hits = rays.filter_map(|x| {
        let query = solver.query().without_walls();
        query.ray_cast(Vector64::new(x, 3.0), Vector64::new(x, 0.0))
    });
    let loose = hits.filter(|hit| hit.solid != Solid::Body(0));
    let highest = loose.max_by(|a, b| a.point.y.total_cmp(&b.point.y))?;
    match highest.solid {
        Solid::Body(body) => Some(body),
        Solid::Wall(_) => None,
    }
}

/// The pit in letters: `#` for walls, `=` for the bar, a letter for each body.
fn draw(solver: &Solver) -> String {
    let (columns, rows) = PICTURE;
    let ([left, low], [right, high]) = VIEW;
    let mut picture = String::new();
    for row in 0..rows {
        let y = high - (high - low) * (row as f64 + 0.5) / rows as f64;
        for column in 0..columns {
            let x = left + (right - left) * (column as f64 + 0.5) / columns as f64;
            picture.push(match solver.query().at(Vector64::new(x, y)).first() {
                None => ' ',
                Some(Solid::Wall(_)) => '#',
                Some(Solid::Body(0)) => '=',
                Some(Solid::Body(body)) => char::from(b'a' + (body % 26) as u8),
            });
        }
        picture.push('\n');
    }
    picture
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut solver = pit().build(BuildOptions::default())?;
    solver.watch_contacts(true);
    let (mut random, mut hits) = (Rng::new(7, 0), 0);
    for frame in 0..900usize {
        if frame % 20 == 0 {
            solver.apply(&Edit::new().add_body(next_body(frame / 20, &mut random)))?;
        }
        if frame % 60 == 59
            && let Some(body) = top(&solver)
        {
            solver.apply(&Edit::new().remove_body(body))?;
        }
        solver.step_frame()?;
        let events = solver.take_contact_events();
        hits += events.iter().filter(|event| event.began && (event.body == 0 || event.other == Some(0))).count();
        if frame % 180 == 179 {
            let there = solver.bodies().iter().filter(|body| !body.removed).count() - 1;
            let mut text = draw(&solver);
            write!(text, "{:.0} s: {there} bodies in the pit, the bar has hit {hits} times", solver.time())?;
            println!("{text}\n");
        }
    }
    Ok(())
}
