//! Sources against walls and against the ends of the domain.

use super::checker::{Checker, rounded};
use super::geometry::{AXES, Shape, Source, sources};
use crate::scene::{KeySegment, Side, Tank};

/// Depth that counts as touching, in spacings.
const TOUCHING: f64 = 1e-6;

pub(super) fn check(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    let slack = TOUCHING * spacing;
    for source in sources(checker) {
        let finding = behind_half_plane(checker, &source, slack)
            .or_else(|| outside_tanks(checker, &source, slack))
            .or_else(|| in_obstacle(checker, &source, slack))
            .or_else(|| outside_domain(checker, &source, slack));
        if let Some((message, hint)) = finding {
            let path = match source.shape {
                Shape::Segment(_) => source.path.then("position"),
                _ => source.path,
            };
            checker.problem(path, message, hint);
        }
    }
}

type Finding = Option<(String, String)>;

/// "the face" of an emitter, "the block"...
fn subject(source: &Source) -> String {
    match (&source.shape, source.path.0.first()) {
        (Shape::Segment(_), _) => "the face".to_owned(),
        (_, Some(KeySegment::Key(kind))) => format!("the {kind}"),
        _ => "it".to_owned(),
    }
}

fn behind_half_plane(checker: &Checker, source: &Source, slack: f64) -> Finding {
    for (index, wall) in checker.scene.half_plane.iter().enumerate() {
        let length = libm::hypot(wall.normal[0], wall.normal[1]);
        let into = wall.normal.map(|value| -value / length);
        let level = into[0] * wall.point[0] + into[1] * wall.point[1];
        let depth = source.shape.reach(into) - level;
        let nearest = -source.shape.reach(into.map(|value| -value)) - level;
        if !(depth.is_finite() && depth > slack) {
            continue;
        }
        let message = if nearest > 0.0 {
            format!("{} lies behind half_plane[{index}]", subject(source))
        } else {
            format!("{} reaches {} m behind half_plane[{index}]", subject(source), rounded(depth))
        };
        return Some((message, "particles belong on the side the wall's normal points to".to_owned()));
    }
    None
}

const SIDES: [(Side, &str, [f64; 2]); 4] = [
    (Side::Left, "left", [-1.0, 0.0]),
    (Side::Right, "right", [1.0, 0.0]),
    (Side::Bottom, "bottom", [0.0, -1.0]),
    (Side::Top, "top", [0.0, 1.0]),
];

/// Where a side of a box lies along its outward normal \[m].
fn side_level(outward: [f64; 2], min: [f64; 2], max: [f64; 2]) -> f64 {
    let axis = usize::from(outward[0] == 0.0);
    if outward[axis] > 0.0 { max[axis] } else { -min[axis] }
}

/// What to do where a tank keeps something out that lies in another one.
pub(super) const SEVERAL_TANKS: &str =
    "the walls of every tank hold all particles and bodies: for two basins put an [[obstacle]] into one tank";

/// The walled side through which a shape reaches farthest, how far, and whether all of it is beyond.
fn escape(tank: &Tank, shape: &Shape) -> (f64, &'static str, bool) {
    let closed = SIDES.iter().filter(|(side, ..)| !tank.open.contains(side));
    let depths = closed.map(|&(_, name, outward)| {
        let level = side_level(outward, tank.min, tank.max);
        let nearest = -shape.reach(outward.map(|value| -value)) - level;
        (shape.reach(outward) - level, name, nearest > 0.0)
    });
    depths.fold((f64::NEG_INFINITY, "", false), |worst, next| if next.0 > worst.0 { next } else { worst })
}

/// A source must fit into every tank: the walls of all tanks hold all particles.
fn outside_tanks(checker: &Checker, source: &Source, slack: f64) -> Finding {
    let tanks = checker.scene.tank.iter().enumerate();
    let escapes = tanks.map(|(index, tank)| (index, escape(tank, &source.shape)));
    let (index, (depth, side, beyond)) = escapes.max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    if !(depth.is_finite() && depth > slack) {
        return None;
    }
    let message = if beyond {
        format!("{} lies outside tank[{index}]", subject(source))
    } else {
        format!("{} reaches {} m through the {side} side of tank[{index}]", subject(source), rounded(depth))
    };
    let hint = match checker.scene.tank.len() {
        1 => format!("move it inside the tank, or open that side: open = [\"{side}\"]"),
        _ => SEVERAL_TANKS.to_owned(),
    };
    Some((message, hint))
}

fn in_obstacle(checker: &Checker, source: &Source, slack: f64) -> Finding {
    for (index, obstacle) in checker.scene.obstacle.iter().enumerate() {
        let (min, max) = (obstacle.min.map(|value| value + slack), obstacle.max.map(|value| value - slack));
        if !source.shape.meets_box(min, max) {
            continue;
        }
        let within = SIDES.iter().all(|&(_, _, outward)| source.shape.reach(outward) <= side_level(outward, min, max));
        let verb = if within { "lies inside" } else { "reaches into" };
        let hint = "particles must start outside obstacles";
        return Some((format!("{} {verb} obstacle[{index}]", subject(source)), hint.to_owned()));
    }
    None
}

fn outside_domain(checker: &Checker, source: &Source, slack: f64) -> Finding {
    let domain = &checker.scene.domain;
    for axis in AXES {
        let index = axis.index();
        let mut unit = [0.0; 2];
        unit[index] = 1.0;
        let (least, most) = (-source.shape.reach(unit.map(|value: f64| -value)), source.shape.reach(unit));
        let ends = axis.extent(domain).filter(|[from, to]| from < to);
        if ends.is_some_and(|[from, to]| least < from - slack || most > to + slack) {
            let message = format!("{} leaves the periodic axis {}", subject(source), axis.name());
            return Some((message, format!("keep it between the ends of `domain.{}`", axis.periodic_key())));
        }
        let below = domain.remove_below.is_some_and(|limit| least < limit[index] - slack);
        let above = domain.remove_above.is_some_and(|limit| most > limit[index] + slack);
        if below || above {
            let key = if below { "remove_below" } else { "remove_above" };
            let message = format!("{} lies where `domain.{key}` removes particles at once", subject(source));
            return Some((message, "move it, or make the region larger".to_owned()));
        }
    }
    None
}
