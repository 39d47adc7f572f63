//! Values by which a run would diverge within a few frames.

use super::{is_refused, problems};
use unipbd_core::scene::{BodyDescription, Gas, Heater, Region, Scene};

fn gas(scene: &mut Scene) -> &mut Gas {
    scene.liquid.clear();
    scene.gas = vec![Gas { name: "water".into(), ..Gas::default() }];
    &mut scene.gas[0]
}

#[test]
fn gales_and_whirls() {
    is_refused("environment.gusts", "1000 spacings per frame", |scene| scene.environment.gusts = 1e5);
    is_refused("gas[0].vorticity", "must be from -1000 to 1000", |scene| gas(scene).vorticity = 1e6);
    is_refused("gas[0].baroclinic", "must be from -1000 to 1000", |scene| gas(scene).baroclinic = -1e9);
}

#[test]
fn densities_and_masses_at_the_ends_of_single_precision() {
    for density in [1e-30, 1e-9, 1e12, 1e30] {
        is_refused("liquid[0].density", "must be from 1e-6 to 1e9", |scene| scene.liquid[0].density = density);
        is_refused("gas[0].density", "must be from 1e-6 to 1e9", |scene| gas(scene).density = density);
        is_refused("body[0].density", "must be from 1e-6 to 1e9", |scene| {
            scene.body.push(BodyDescription { density, ..BodyDescription::disc(0.2, [1.5, 0.5]) });
        });
    }
    is_refused("liquid[0].particle_mass", "must be from 1e-12 to 1e15", |scene| {
        scene.liquid[0].particle_mass = Some(1e-40)
    });
    is_refused("body[0].mass", "must be from 1e-12 to 1e15", |scene| {
        scene.body.push(BodyDescription { mass: Some(1e300), ..BodyDescription::disc(0.2, [1.5, 0.5]) });
    });
}

#[test]
fn temperatures_and_gravity_factors() {
    is_refused("block[0].temperature", "must be from -10000 to 10000", |scene| {
        gas(scene);
        scene.block[0].temperature = 1e9;
    });
    is_refused("heater[0].temperature", "must be from -10000 to 10000", |scene| {
        gas(scene);
        let region = Region { center: Some([0.0, 0.0]), radius: Some(1.0), ..Region::default() };
        scene.heater.push(Heater { region, temperature: 1e30, rate: 1.0 });
    });
    is_refused("liquid[0].gravity_factor", "the limit is", |scene| scene.liquid[0].gravity_factor = -1e12);
    is_refused("liquid[0].surface_tension", "the limit is", |scene| scene.liquid[0].surface_tension = 1e25);
    is_refused("body[0].gravity_factor", "the limit is", |scene| {
        scene.body.push(BodyDescription { gravity_factor: 1e9, ..BodyDescription::disc(0.2, [1.5, 0.5]) });
    });
}

#[test]
fn strong_but_sensible_values_are_none_of_these() {
    let found = problems(|scene| {
        let gas = gas(scene);
        (gas.vorticity, gas.baroclinic, gas.gravity_factor, gas.density) = (50.0, 20.0, -30.0, 1e-3);
        scene.environment.gusts = 60.0;
        scene.block[0].temperature = 300.0;
    });
    assert_eq!(found, [""; 0]);
}
