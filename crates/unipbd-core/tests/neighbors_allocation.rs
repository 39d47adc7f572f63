//! Sorting, listing and passing over a particle set that has been seen before allocates nothing.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};
use unipbd_core::kernel::WendlandC2;
use unipbd_core::neighbors::{Grid, SkinList};
use unipbd_core::parallel::Parallelism;
use unipbd_core::passes::{Pairs, Records, correction};
use unipbd_core::periodic::Periodic;
use unipbd_core::{Real, Vector};

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
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

#[test]
fn steady_steps_allocate_nothing() {
    let rows = 5000;
    let points: Vec<_> = (0..rows).map(|k| Vector::new((k % 71) as Real * 0.9, (k / 71) as Real * 0.9)).collect();
    let far: Vec<_> = points.iter().map(|&x| if x.x == 0.0 { x - Vector::splat(1e6) } else { x }).collect();
    let (mut grid, mut list) = (Grid::new(Periodic::NONE), SkinList::default());
    let mut sorted = vec![Vector::ZERO; rows];
    let mut records = Records::default();
    let (multipliers, mut out) = (vec![1.0; rows], vec![Vector::ZERO; rows]);
    let mut step = |points: &[Vector], rows: usize| {
        let order = grid.order(points, rows, SkinList::list_radius(2.0, 0.1), Parallelism::Serial);
        Parallelism::Serial.gather(&mut sorted, points, order);
        list.build(&grid, &sorted, 2.0, 0.1, Parallelism::Serial);
        let pairs = Pairs::new(list.list(), Periodic::NONE, Parallelism::Serial);
        correction(pairs, WendlandC2::new(2.0), &sorted, &multipliers, &mut records, &mut out[..rows]);
        assert!(!list.needs_rebuild(&grid, &sorted, rows, Parallelism::Serial));
    };
    let mut all = || {
        step(&points, rows);
        step(&far, rows);
        step(&points, rows - 1000);
    };
    all();
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    assert!(before > 0);
    all();
    assert_eq!(ALLOCATIONS.load(Ordering::Relaxed), before);
}
