//! Makes a failing scene small: what can go without the failure going too, goes (delta debugging, Zeller &
//! Hildebrandt 2002, one change at a time).

use unipbd_core::scene::{LiquidSurface, Scene, Slip, Substeps};

/// A change that makes a scene simpler; false where there is nothing to change.
type Change = fn(&mut Scene, usize) -> bool;

/// In the order in which they are tried: what takes most away comes first. A change is tried at every index
/// until there is none.
const CHANGES: &[Change] = &[
    |scene, index| remove(&mut scene.body, index),
    |scene, index| remove(&mut scene.emitter, index),
    without_material,
    |scene, index| remove(&mut scene.block, index),
    |scene, index| scene.block.get_mut(index).is_some_and(|block| change(&mut block.jitter, 0.0)),
    |scene, index| scene.block.get_mut(index).is_some_and(|block| change(&mut block.velocity, [0.0; 2])),
    |scene, index| scene.liquid.get_mut(index).is_some_and(|liquid| change(&mut liquid.kinematic_viscosity, 0.0)),
    |scene, index| scene.gas.get_mut(index).is_some_and(|gas| change(&mut gas.kinematic_viscosity, 0.0)),
    |scene, index| scene.liquid.get_mut(index).is_some_and(|liquid| change(&mut liquid.surface, LiquidSurface::Free)),
    |scene, index| scene.liquid.get_mut(index).is_some_and(|liquid| change(&mut liquid.density, 1000.0)),
    |scene, index| scene.tank.get_mut(index).is_some_and(|tank| change(&mut tank.friction, None)),
    |scene, index| scene.tank.get_mut(index).is_some_and(|tank| change(&mut tank.slip, Slip::Free)),
    |scene, index| scene.body.get_mut(index).is_some_and(|body| change(&mut body.angle_deg, 0.0)),
    |scene, index| index == 0 && change(&mut scene.fps, 60.0),
    |scene, index| index == 0 && change(&mut scene.solver.substeps, Substeps::Auto),
    |scene, index| halve(scene, index, 0),
    |scene, index| halve(scene, index, 1),
];

fn remove<T>(items: &mut Vec<T>, index: usize) -> bool {
    let there = index < items.len();
    if there {
        items.remove(index);
    }
    there
}

fn change<T: PartialEq>(value: &mut T, to: T) -> bool {
    let differs = *value != to;
    *value = to;
    differs
}

/// A material goes with its blocks and emitters.
fn without_material(scene: &mut Scene, index: usize) -> bool {
    let Some(name) = scene.materials().nth(index).map(|material| material.name().to_owned()) else { return false };
    let named = |scene: &Scene| scene.liquid.iter().any(|l| l.name == name) || scene.gas.iter().any(|g| g.name == name);
    if !named(scene) {
        return false;
    }
    scene.liquid.retain(|liquid| liquid.name != name);
    scene.gas.retain(|gas| gas.name != name);
    scene.block.retain(|block| block.material != name);
    scene.emitter.retain(|emitter| emitter.material != name);
    true
}

/// A block loses the half that is farther from the origin, in whole spacings.
fn halve(scene: &mut Scene, index: usize, axis: usize) -> bool {
    let spacing = scene.spacing;
    let Some(block) = scene.block.get_mut(index) else { return false };
    let cells = ((block.max[axis] - block.min[axis]) / spacing).round();
    if cells < 2.0 {
        return false;
    }
    block.max[axis] = block.min[axis] + (0.5 * cells).floor() * spacing;
    true
}

/// The smallest scene that still fails and that no single change makes smaller.
pub fn shrink(scene: &Scene, mut fails: impl FnMut(&Scene) -> bool) -> Scene {
    let mut smallest = scene.clone();
    loop {
        let mut shrunk = false;
        for change in CHANGES {
            let mut index = 0;
            while index < places(&smallest) {
                let mut candidate = smallest.clone();
                if change(&mut candidate, index) && fails(&candidate) {
                    // The next element has moved to this index, or this one may be changed once more.
                    (smallest, shrunk) = (candidate, true);
                } else {
                    index += 1;
                }
            }
        }
        if !shrunk {
            return smallest;
        }
    }
}

/// The longest of the lists that changes go through.
fn places(scene: &Scene) -> usize {
    let lists = [scene.body.len(), scene.emitter.len(), scene.block.len(), scene.tank.len(), scene.materials().count()];
    lists.into_iter().fold(1, usize::max)
}

#[cfg(test)]
mod tests {
    use super::super::random_scene;
    use super::*;

    /// A random scene with a body, an emitter, two materials, viscosity and jitter.
    fn rich() -> Scene {
        let rich = |scene: &Scene| {
            !scene.body.is_empty()
                && !scene.emitter.is_empty()
                && scene.liquid.len() == 2
                && scene.liquid[1].kinematic_viscosity > 0.0
                && scene.block.iter().any(|block| block.jitter > 0.0)
        };
        (0..10_000).map(random_scene).find(rich).expect("one of them has it all")
    }

    #[test]
    fn what_the_failure_does_not_need_goes_and_what_it_needs_stays() {
        let scene = rich();
        let name = scene.liquid[1].name.clone();
        let fails = |scene: &Scene| scene.liquid.iter().any(|l| l.name == name && l.kinematic_viscosity > 0.0);
        let small = shrink(&scene, fails);
        assert!(fails(&small));
        assert_eq!((small.body.len(), small.emitter.len(), small.liquid.len(), small.block.len()), (0, 0, 1, 0));
        assert_eq!((small.fps, small.solver.substeps), (60.0, Substeps::Auto));
    }

    #[test]
    fn two_things_that_fail_together_both_stay() {
        let small = shrink(&rich(), |scene| !scene.body.is_empty() && !scene.block.is_empty());
        assert_eq!((small.body.len(), small.emitter.len(), small.block.len()), (1, 0, 1));
        let cells = |axis: usize| ((small.block[0].max[axis] - small.block[0].min[axis]) / small.spacing).round();
        assert_eq!((cells(0), cells(1)), (1.0, 1.0));
        assert_eq!((small.block[0].jitter, small.block[0].velocity), (0.0, [0.0; 2]));
    }

    #[test]
    fn a_scene_that_cannot_lose_anything_stays_as_it_is() {
        let scene = rich();
        assert_eq!(shrink(&scene, |candidate| *candidate == scene), scene);
    }
}
