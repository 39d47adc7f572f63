//! Particles that a pointer pours.

use std::collections::HashSet;

use unipbd_core::edit::Points;
use unipbd_core::phase::Phase;
use unipbd_core::{Edit, Solver, Vector64};

/// Most particles that one call adds.
const MOST: f64 = 4096.0;
/// Least distance to what is there \[spacings].
const CLEARANCE: f64 = 0.97;

/// Fills the free places of a lattice within a disc; returns the number of particles.
pub fn disc(solver: &mut Solver, material: usize, center: Vector64, radius: f64) -> Result<u32, String> {
    let known = solver.materials().get(material).filter(|known| known.phase != Phase::Rigid);
    let name = known.ok_or_else(|| format!("there is no material {material} to pour"))?.name.clone();
    let spacing = solver.spacing();
    let cells = (radius / spacing).ceil();
    if !(center.is_finite() && cells * cells < MOST) {
        return Err("a disc to pour is at most 64 spacings in radius".to_owned());
    }
    let taken = taken(solver, center, radius + spacing);
    let (steps, least) = (cells as i32, CLEARANCE * spacing);
    let lattice = (-steps..=steps).flat_map(|row| (-steps..=steps).map(move |column| (column, row)));
    let places = lattice.map(|(column, row)| center + Vector64::new(f64::from(column), f64::from(row)) * spacing);
    let free = |place: &Vector64| {
        place.distance(center) <= radius
            && taken.iter().all(|other| other.distance(*place) >= least)
            && solver.query().nearest(*place, 0.5 * spacing).is_none()
    };
    let positions: Vec<Vector64> = places.filter(free).collect();
    let count = positions.len() as u32;
    if count > 0 {
        solver.apply(&Edit::new().add_points(Points::new(&name, positions))).map_err(|error| error.to_string())?;
    }
    Ok(count)
}

/// The particles that are near: samples of bodies are not, their outlines keep places free.
fn taken(solver: &Solver, center: Vector64, reach: f64) -> Vec<Vector64> {
    let corner = Vector64::splat(reach);
    let near: HashSet<u32> = solver.particles_in(center - corner, center + corner).into_iter().collect();
    let rows = solver.ids().iter().zip(solver.positions()).filter(|(id, _)| near.contains(id));
    rows.map(|(_, place)| Vector64::new(f64::from(place.x), f64::from(place.y))).collect()
}
