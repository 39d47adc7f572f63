//! How bodies that contacts and hinges hold answer to a load: the pressure of a fluid moves them only where they are
//! free to go.
//!
//! A row J of a constraint that holds takes its direction out of the inverse mass: W - W J^T (J W J^T)^-1 J W.

use super::InverseMass;

/// A row of a constraint that holds two bodies: for each its index and the change of the constraint by a displacement
/// along x, along y and by a rotation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldRow {
    pub sides: [(u32, [f64; 3]); 2],
}

impl HeldRow {
    /// The side of the world; that of a wall has an index without a body too.
    pub const WORLD: (u32, [f64; 3]) = (u32::MAX, [0.0; 3]);
}

/// Change of the velocity of a body by a force and a torque: the inverse mass, as far as nothing holds the body.
pub(crate) type Mobility = [[f64; 3]; 3];

/// What a body presses on holds it if its mobility along the contact is this part of that of the body.
const HOLDS: f64 = 0.05;
/// A body whose mobility along a contact is this part of that of the free body is held: what is left is rounding, and
/// taking out its direction would take out any other.
const ROUNDING: f64 = 1e-9;
/// Rounds over all rows: the bodies of a stack are held from the ground up.
const ROUNDS: usize = 8;

/// Mobilities of the bodies that something holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mobilities {
    of_bodies: Vec<Mobility>,
    rows: Vec<HeldRow>,
}

impl Mobilities {
    /// Finds the mobility of each body from the rows of contacts and hinges.
    pub fn find(&mut self, free: &[InverseMass], rows: impl Iterator<Item = HeldRow>) {
        self.of_bodies.clear();
        self.of_bodies.extend(free.iter().map(|body| of_free(*body)));
        self.rows.clear();
        self.rows.extend(rows);
        for _ in 0..ROUNDS {
            let left = self.rows.len();
            let mobilities = &mut self.of_bodies;
            self.rows.retain(|row| !hold(mobilities, free, row));
            if self.rows.is_empty() || self.rows.len() == left {
                break;
            }
        }
    }

    /// The mobility of a body.
    pub fn of(&self, body: u32) -> Mobility {
        self.of_bodies[body as usize]
    }
}

/// Takes the direction of a row from the mobility of one body, if the other one holds it.
fn hold(mobilities: &mut [Mobility], free: &[InverseMass], row: &HeldRow) -> bool {
    let [(a, along_a), (b, along_b)] = row.sides;
    let along = |mobilities: &[Mobility], body: u32, way: [f64; 3]| match mobilities.get(body as usize) {
        Some(mobility) => {
            let [found, most] = [*mobility, of_free(free[body as usize])].map(|of| dot(times(&of, way), way));
            if found > ROUNDING * most { found } else { 0.0 }
        }
        None => 0.0,
    };
    let (of_a, of_b) = (along(mobilities, a, along_a), along(mobilities, b, along_b));
    let (held, way) = if of_b <= HOLDS * of_a { (a, along_a) } else { (b, along_b) };
    let least = HOLDS * of_a.max(of_b);
    let holds = of_a.min(of_b) <= least && least > 0.0;
    if let Some(mobility) = mobilities.get_mut(held as usize).filter(|_| holds) {
        take(mobility, way);
    }
    holds
}

/// Takes a direction from a mobility.
fn take(mobility: &mut Mobility, way: [f64; 3]) {
    let moved = times(mobility, way);
    let along = dot(moved, way);
    for (row, a) in mobility.iter_mut().zip(moved) {
        row.iter_mut().zip(moved).for_each(|(entry, b)| *entry -= a * b / along);
    }
}

fn times(mobility: &Mobility, way: [f64; 3]) -> [f64; 3] {
    mobility.map(|row| dot(row, way))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn of_free(body: InverseMass) -> Mobility {
    [[body.linear, 0.0, 0.0], [0.0, body.linear, 0.0], [0.0, 0.0, body.angular]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: u32 = u32::MAX;
    const FREE: InverseMass = InverseMass { linear: 2.0, angular: 3.0 };

    fn row(a: u32, on_a: [f64; 3], b: u32, on_b: [f64; 3]) -> HeldRow {
        HeldRow { sides: [(a, on_a), (b, on_b)] }
    }

    fn found(free: &[InverseMass], rows: &[HeldRow]) -> Mobilities {
        let mut mobilities = Mobilities::default();
        mobilities.find(free, rows.iter().copied());
        mobilities
    }

    #[test]
    fn a_box_on_two_points_slides_alone() {
        let points = [-0.5, 0.5].map(|arm| row(0, [0.0, 1.0, arm], WALL, [0.0, -1.0, 0.0]));
        let [x, y, turn] = found(&[FREE], &points).of(0);
        assert_eq!(x, [2.0, 0.0, 0.0]);
        assert!(y.into_iter().chain(turn).all(|entry| entry.abs() < 1e-12), "{y:?} {turn:?}");
    }

    #[test]
    fn more_contacts_than_a_body_has_freedoms_leave_it_without_mobility() {
        // A box flush in a corner, with arms that no binary fraction holds.
        let floor = [-0.3, 0.3, 0.1].map(|arm| row(0, [0.0, 1.0, arm], WALL, [0.0; 3]));
        let side = [-0.3, 0.3, 0.7].map(|arm| row(0, [1.0, 0.0, arm / 3.0], WALL, [0.0; 3]));
        let slanted = [0.1, 0.2].map(|arm| row(0, [0.6, 0.8, arm], WALL, [0.0; 3]));
        let rows: Vec<HeldRow> = floor.into_iter().chain(side).chain(slanted).collect();
        for first in 0..rows.len() {
            let turned: Vec<HeldRow> = rows.iter().cycle().skip(first).take(rows.len()).copied().collect();
            let mobility = found(&[InverseMass { linear: 1.0 / 27.4, angular: 1.0 / 0.36 }], &turned).of(0);
            assert!(mobility.iter().flatten().all(|entry| entry.abs() < 1e-9), "{first}: {mobility:?}");
        }
    }

    #[test]
    fn a_hinge_leaves_the_rotation_about_it() {
        let arm = 0.5;
        let hinge = [row(0, [1.0, 0.0, 0.0], WALL, [0.0; 3]), row(0, [0.0, 1.0, arm], WALL, [0.0; 3])];
        let [_, y, turn] = found(&[FREE], &hinge).of(0);
        let inertia = 1.0 / 3.0 + arm * arm / 2.0;
        assert!((turn[2] - 1.0 / inertia).abs() < 1e-12);
        assert!((y[2] + arm / inertia).abs() < 1e-12, "the hinge stays where it is");
    }

    #[test]
    fn a_stack_is_held_from_the_ground_up_in_any_order() {
        let (up, down) = ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
        let stack = [row(2, up, 1, down), row(1, up, 0, down), row(0, up, WALL, down)];
        let mobilities = found(&[FREE; 3], &stack);
        assert!((0..3).all(|body| mobilities.of(body)[1][1].abs() < 1e-12));
    }

    #[test]
    fn two_bodies_of_like_mass_do_not_hold_each_other_and_a_heavy_one_holds_a_light_one() {
        let heavy = InverseMass { linear: 0.02, angular: 0.03 };
        let touch = [row(0, [1.0, 0.0, 0.0], 1, [-1.0, 0.0, 0.0])];
        assert_eq!(found(&[FREE; 2], &touch).of(0)[0][0], 2.0);
        let mobilities = found(&[FREE, heavy], &touch);
        assert_eq!((mobilities.of(0)[0][0], mobilities.of(1)[0][0]), (0.0, 0.02));
    }
}
