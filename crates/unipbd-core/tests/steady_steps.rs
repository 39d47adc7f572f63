//! A step that has nothing new to hold allocates nothing, whatever is in the scene; and particles are small.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use unipbd_core::scene::{
    Block, BodyDescription, Emitter, Gas, Liquid, PressureGridUse, Profile, Scene, Smoke, SmokeSource, SolverSettings,
    Substeps, Tank,
};
use unipbd_core::{BuildOptions, Solver};

/// Counts the allocations of its own thread.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: as the caller vouches.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller vouches.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn build(scene: &Scene) -> Solver {
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn fixed(substeps: u32) -> SolverSettings {
    SolverSettings { substeps: Substeps::Fixed(substeps), ..SolverSettings::default() }
}

/// Allocations of `frames` frames, once this many others are done.
fn allocations(scene: &Scene, before: u64, frames: u64) -> u64 {
    let mut solver = build(scene);
    let mut step = |frames| {
        (0..frames).for_each(|_| {
            solver.step_frame().expect("the scene is calm");
        })
    };
    step(before);
    let start = ALLOCATIONS.with(Cell::get);
    assert!(start > 0);
    step(frames);
    ALLOCATIONS.with(Cell::get) - start
}

fn pool() -> Scene {
    Scene {
        liquid: vec![Liquid { xsph: 0.01, ..Liquid::new("water", 1000.0) }],
        block: vec![Block::new("water", [0.0, 0.0], [3.0, 2.0])],
        tank: vec![Tank::new([0.0, 0.0], [3.0, 4.0])],
        solver: fixed(8),
        ..Scene::default()
    }
}

fn floating_box(x: f64) -> BodyDescription {
    BodyDescription { density: 500.0, ..BodyDescription::rectangle([0.6, 0.6], [x, 2.4]) }
}

#[test]
fn a_pool_steps_without_allocating() {
    assert_eq!(allocations(&pool(), 60, 20), 0);
}

#[test]
fn a_pool_with_the_pressure_grid_steps_without_allocating() {
    let scene = Scene { solver: SolverSettings { pressure_grid: PressureGridUse::On, ..fixed(4) }, ..pool() };
    assert_eq!(allocations(&scene, 60, 20), 0);
}

#[test]
fn gas_with_smoke_steps_without_allocating() {
    let gas = Gas {
        name: "air".into(),
        density: 1.2,
        gravity_factor: -0.1,
        drag: 10.0,
        vorticity: 1.0,
        conductivity: 0.001,
        xsph: 0.01,
        keep_radius: Some(20.0),
        lifetime: Some(50.0),
        ..Gas::default()
    };
    // A short puff with smoke in it: nothing is emitted any more when the counting begins.
    let puff = Emitter {
        profile: Profile::Uniform,
        temperature: 1.0,
        jitter: 0.1,
        stop: Some(0.5),
        throttle: false,
        smoke: Some(SmokeSource { material: "smoke".into(), per_particle: 2 }),
        ..Emitter::new("air", [0.0, 0.0], 2.0, 3.0)
    };
    let scene = Scene {
        gas: vec![gas],
        smoke: vec![Smoke::new("smoke")],
        emitter: vec![puff],
        solver: fixed(4),
        ..Scene::default()
    };
    assert_eq!(allocations(&scene, 120, 20), 0);
}

#[test]
fn floating_bodies_allocate_only_where_contacts_are_searched() {
    let scene = Scene { body: vec![floating_box(0.8), floating_box(2.2)], ..pool() };
    let found = allocations(&scene, 120, 20);
    // Contacts are searched once per frame.
    assert!(found <= 2 * 20, "{found} allocations in 20 frames");
}

#[test]
fn a_heap_of_bodies_allocates_only_where_contacts_are_searched() {
    let bodies = (0..40).map(|k| BodyDescription {
        restitution: 0.1,
        ..BodyDescription::rectangle([0.3, 0.3], [0.4 + 0.35 * f64::from(k % 7), 0.2 + 0.35 * f64::from(k / 7)])
    });
    let scene = Scene { liquid: Vec::new(), block: Vec::new(), body: bodies.collect(), ..pool() };
    let found = allocations(&scene, 240, 20);
    // Contacts are searched once per frame.
    assert!(found <= 2 * 20, "{found} allocations in 20 frames");
}

#[test]
fn a_pool_that_sleeps_and_one_that_waits_for_it_step_without_allocating() {
    let sleepy = |xsph| Scene {
        liquid: vec![Liquid { xsph, ..Liquid::new("water", 1000.0) }],
        solver: SolverSettings { sleep: true, ..fixed(8) },
        ..pool()
    };
    assert_eq!(allocations(&sleepy(0.0), 60, 20), 0);
    assert_eq!(allocations(&sleepy(0.05), 900, 20), 0);
}

#[test]
fn a_liquid_particle_takes_less_than_280_bytes_all_counted() {
    let scene = Scene { spacing: 0.01, ..pool() };
    let mut solver = build(&Scene { solver: fixed(2), fps: 600.0, ..scene });
    solver.step_frame().expect("the scene is calm");
    let bytes = solver.memory_bytes() as f64 / solver.positions().len() as f64;
    assert!(bytes < 280.0, "{bytes} bytes a particle");
}
