//! The grid, the neighbour list and its skin against brute force.

use proptest::prelude::*;
use unipbd_core::neighbors::{Entries, Grid, NeighborList, SkinList};
use unipbd_core::parallel::{CHUNK_ROWS, Parallelism};
use unipbd_core::periodic::{Periodic, PeriodicAxis};
use unipbd_core::simd::LANES;
use unipbd_core::{Real, Vector};

const PARALLEL_ROWS: usize = 6000;

fn in_pool<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn permuted(positions: &[Vector], order: &[u32]) -> Vec<Vector> {
    order.iter().map(|&row| positions[row as usize]).collect()
}

/// Sorts, lists, and gives back the sorted positions and each row's neighbours in list order.
fn lists(
    points: &[Vector],
    periodic: Periodic,
    radius: Real,
    parallelism: Parallelism,
) -> (Vec<Vector>, Vec<Vec<usize>>) {
    let mut grid = Grid::new(periodic);
    let sorted = permuted(points, grid.order(points, points.len(), radius, parallelism));
    let mut list = NeighborList::default();
    list.build(&grid, &sorted, radius, parallelism);
    let rows = (0..sorted.len()).map(|row| {
        let mut found = Vec::new();
        list.for_each(row, |j| found.push(j));
        assert_eq!(found.len(), list.count(row));
        found
    });
    let rows = rows.collect();
    (sorted, rows)
}

fn brute_force(points: &[Vector], periodic: Periodic, radius: Real) -> Vec<Vec<usize>> {
    let near = |i: usize, j: usize| periodic.min_image(points[i] - points[j]).length_squared() < radius * radius;
    (0..points.len()).map(|i| (0..points.len()).filter(|&j| j != i && near(i, j)).collect()).collect()
}

fn assert_lists_match_brute_force(points: &[Vector], periodic: Periodic, radius: Real) {
    let (sorted, mut found) = lists(points, periodic, radius, Parallelism::Serial);
    found.iter_mut().for_each(|list| list.sort_unstable());
    assert_eq!(found, brute_force(&sorted, periodic, radius));
}

fn box_of(x: bool, y: bool, from: Real, length: Real) -> Periodic {
    let axis = PeriodicAxis { from, length };
    Periodic { x: x.then_some(axis), y: y.then_some(axis) }
}

/// Points of the kinds that break neighbour searches, in [-10, 10)^2 unless far away.
fn points() -> impl Strategy<Value = Vec<Vector>> {
    let coordinate = || prop_oneof![4 => -10.0..10.0, 1 => (-10i32..10).prop_map(f64::from)];
    let anywhere = (coordinate(), coordinate()).prop_map(|(x, y)| Vector::new(x as Real, y as Real));
    let on_cell_border = (-6i32..6, -6i32..6).prop_map(|(x, y)| Vector::new(x as Real * 1.5, y as Real * 1.5));
    let coincident = Just(Vector::new(0.25, -3.5));
    prop::collection::vec(prop_oneof![6 => anywhere, 2 => on_cell_border, 1 => coincident], 0..200)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn list_holds_exactly_the_pairs_within_the_radius(points in points(), radius in 0.1..4.0) {
        assert_lists_match_brute_force(&points, Periodic::NONE, radius as Real);
    }

    #[test]
    fn list_sees_across_periodic_borders(points in points(), radius in 0.1..9.9, x: bool, y: bool) {
        assert_lists_match_brute_force(&points, box_of(x, y, -10.0, 20.0), radius as Real);
    }

    #[test]
    fn list_sees_points_that_left_the_period(points in points(), shift in -5.0..5.0, radius in 0.1..4.0) {
        let moved: Vec<_> = points.iter().map(|&x| x + Vector::splat(shift as Real)).collect();
        assert_lists_match_brute_force(&moved, box_of(true, true, -10.0, 20.0), radius as Real);
    }

    #[test]
    fn list_is_exact_far_from_the_origin(points in points(), far in -1.0e5..1.0e5, radius in 0.5..4.0) {
        let moved: Vec<_> = points.iter().map(|&x| x + Vector::new(far as Real, 1.0e5)).collect();
        assert_lists_match_brute_force(&moved, Periodic::NONE, radius as Real);
    }

    #[test]
    fn list_survives_outliers_and_nonsense(
        points in points(),
        outliers in prop::collection::vec(prop_oneof![
            Just(1.0e30), Just(-1.0e30), Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), -1.0e7..1.0e7
        ], 1..12),
        x: bool,
    ) {
        let mut points = points;
        points.extend(outliers.windows(2).map(|o| Vector::new(o[0] as Real, o[1] as Real)));
        assert_lists_match_brute_force(&points, Periodic::NONE, 1.5);
        // With a period, points must be near it, but what is not must do no harm.
        let _ = lists(&points, box_of(x, !x, -10.0, 20.0), 1.5, Parallelism::Serial);
    }

    #[test]
    fn order_is_a_stable_permutation_that_keeps_passive_rows_last(points in points(), passive in 0usize..100) {
        let dense = points.len().saturating_sub(passive);
        let mut grid = Grid::new(Periodic::NONE);
        let order = grid.order(&points, dense, 1.0, Parallelism::Serial).to_vec();
        prop_assert!(order[..dense].iter().all(|&row| (row as usize) < dense));
        let mut rows = order.clone();
        rows.sort_unstable();
        prop_assert!(rows.iter().enumerate().all(|(k, &row)| k == row as usize));
        // Sorting what is sorted changes nothing: rows of one cell keep their order.
        let sorted = permuted(&points, &order);
        let again = grid.order(&sorted, dense, 1.0, Parallelism::Serial);
        prop_assert!(again.iter().enumerate().all(|(k, &row)| k == row as usize));
    }

    #[test]
    fn search_by_point_finds_every_row_within_reach_once(
        points in points(), x in -12.0..12.0, y in -12.0..12.0, radius in 0.1..3.0, period: bool
    ) {
        let periodic = box_of(period, period, -10.0, 20.0);
        let mut grid = Grid::new(periodic);
        let sorted = permuted(&points, grid.order(&points, points.len(), 1.0, Parallelism::Serial));
        let (point, radius) = (Vector::new(x as Real, y as Real), radius as Real);
        let mut seen = vec![0; sorted.len()];
        grid.for_each_near(point, radius, |row| seen[row] += 1);
        for (row, &position) in sorted.iter().enumerate() {
            let near = periodic.min_image(point - position).length() < radius;
            prop_assert!(seen[row] <= 1 && (seen[row] == 1 || !near));
        }
    }

    #[test]
    fn skin_list_never_misses_a_pair(
        points in points(),
        walk in prop::collection::vec((-0.2..0.2, -0.2..0.2, 0u64..1000), 1..30),
        skin in 0.05..0.6,
        period: bool,
    ) {
        walk_with_skin(points, &walk, skin as Real, box_of(period, period, -10.0, 20.0));
    }
}

/// Random walks on top of a common drift; after each step the list, rebuilt when it says so, must hold every pair.
fn walk_with_skin(points: Vec<Vector>, walk: &[(f64, f64, u64)], skin: Real, periodic: Periodic) {
    const RADIUS: Real = 1.2;
    let mut positions: Vec<_> = points.iter().map(|&x| periodic.wrap(x)).collect();
    let (mut grid, mut list) = (Grid::new(periodic), SkinList::default());
    for &(drift_x, drift_y, seed) in walk {
        for (row, x) in positions.iter_mut().enumerate() {
            let noise = |k: u64| ((row as u64 * 7919 + seed * 104_729 + k) % 101) as Real / 101.0 - 0.5;
            *x += Vector::new(drift_x as Real + 0.1 * noise(0), drift_y as Real + 0.1 * noise(50));
            *x = periodic.wrap(*x);
        }
        if list.needs_rebuild(&grid, &positions, positions.len(), Parallelism::Serial) {
            let radius = SkinList::list_radius(RADIUS, skin);
            positions = permuted(&positions, grid.order(&positions, positions.len(), radius, Parallelism::Serial));
            list.build(&grid, &positions, RADIUS, skin, Parallelism::Serial);
        }
        let motion = list.motion(&grid, &positions, Parallelism::Serial);
        assert!(list.covers(&motion));
        for (row, wanted) in brute_force(&positions, periodic, RADIUS).into_iter().enumerate() {
            let mut listed = Vec::new();
            list.list().for_each(row, |j| listed.push(j));
            assert!(wanted.iter().all(|j| listed.contains(j)), "row {row} misses one of {wanted:?}");
            let mut near = Vec::new();
            list.for_each_near(&grid, &motion, positions[row], RADIUS, |j| near.push(j));
            assert!(wanted.iter().all(|j| near.contains(j)), "search around row {row} misses one of {wanted:?}");
        }
    }
}

fn scattered(count: usize, side: Real) -> Vec<Vector> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as Real / (1u64 << 24) as Real * side
    };
    (0..count).map(|_| Vector::new(next(), next())).collect()
}

#[test]
fn small_sets_of_every_size_around_a_block_match_brute_force() {
    for count in [0, 1, 2, 7, 8, 9, 15, 16, 17, CHUNK_ROWS - 1, CHUNK_ROWS, CHUNK_ROWS + 1] {
        let points = scattered(count, (count as Real).sqrt());
        assert_lists_match_brute_force(&points, Periodic::NONE, 1.7);
    }
}

#[test]
fn coincident_particles_are_all_neighbours() {
    let points = vec![Vector::new(0.3, 0.7); 20];
    let (_, found) = lists(&points, Periodic::NONE, 1.0, Parallelism::Serial);
    assert!(found.iter().all(|list| list.len() == 19));
}

#[test]
fn thread_counts_change_neither_order_nor_lists() {
    let mut compact = scattered(PARALLEL_ROWS, 80.0);
    compact[17].y = 79.5;
    let mut open = compact.clone();
    open[4000] = Vector::new(1.0e6, -3.0e6);
    for (points, periodic) in
        [(&compact, Periodic::NONE), (&compact, box_of(true, true, 0.0, 80.0)), (&open, Periodic::NONE)]
    {
        let serial = lists(points, periodic, 1.5, Parallelism::Serial);
        for threads in [1, 2, 3, 8] {
            let parallel = in_pool(threads, || lists(points, periodic, 1.5, Parallelism::Pool));
            assert!(parallel == serial, "{threads} threads");
        }
    }
}

#[test]
fn sparse_and_dense_indices_give_one_order() {
    let near = scattered(PARALLEL_ROWS, 80.0);
    let mut far = near.clone();
    far.push(Vector::new(1.0e6, 1.0e6));
    let (mut dense, mut sparse) = (Grid::new(Periodic::NONE), Grid::new(Periodic::NONE));
    let dense_order = dense.order(&near, near.len(), 1.5, Parallelism::Serial).to_vec();
    let sparse_order = sparse.order(&far, far.len(), 1.5, Parallelism::Serial).to_vec();
    assert!(dense.is_dense() && !sparse.is_dense());
    assert_eq!(dense_order, sparse_order[..near.len()]);
    let (_, dense_lists) = lists(&near, Periodic::NONE, 1.5, Parallelism::Serial);
    let (_, sparse_lists) = lists(&far, Periodic::NONE, 1.5, Parallelism::Serial);
    assert_eq!(dense_lists, sparse_lists[..near.len()]);
}

#[test]
fn memory_follows_the_particles_not_the_extent() {
    let mut grid = Grid::new(Periodic::NONE);
    let far_apart = [Vector::new(0.0, 0.0), Vector::new(1.0e6, -1.0e6)];
    grid.order(&far_apart, 2, 1.0, Parallelism::Serial);
    assert!(grid.memory_bytes() < 20_000, "{} bytes", grid.memory_bytes());
    let scattered: Vec<_> = scattered(10_000, 1.0).iter().map(|&x| x * 1.0e7).collect();
    grid.order(&scattered, scattered.len(), 1.0, Parallelism::Serial);
    assert!(grid.memory_bytes() < 10_000 * 60, "{} bytes", grid.memory_bytes());
}

#[test]
fn offsets_beyond_sixteen_bits_are_stored_wide() {
    // A row of cells with 40,000 particles: the row above starts more than 2^15 rows further on.
    let points: Vec<_> =
        (0..80_000).map(|k| Vector::new((k % 40_000) as Real, (k / 40_000) as Real * 1.2 + 0.5)).collect();
    let radius = 1.3;
    let mut grid = Grid::new(Periodic::NONE);
    let sorted = permuted(&points, grid.order(&points, points.len(), radius, Parallelism::Serial));
    let mut list = NeighborList::default();
    list.build(&grid, &sorted, radius, Parallelism::Serial);
    let wide = list.chunks().iter().any(|c| c.blocks().iter().any(|b| matches!(c.entries(b), Entries::Wide(_))));
    assert!(wide);
    for (row, &x) in sorted.iter().enumerate() {
        let at_an_end = x.x == 0.0 || x.x == 39_999.0;
        assert_eq!(list.count(row), if at_an_end { 2 } else { 3 });
        list.for_each(row, |j| assert!(j != row && (x - sorted[j]).length() < radius));
    }
}

#[test]
fn padding_is_the_lanes_own_row() {
    let points = scattered(203, 14.0);
    let mut grid = Grid::new(Periodic::NONE);
    let sorted = permuted(&points, grid.order(&points, points.len(), 1.5, Parallelism::Serial));
    let mut list = NeighborList::default();
    list.build(&grid, &sorted, 1.5, Parallelism::Serial);
    let mut padded = 0;
    for (b, block) in list.chunks()[0].blocks().iter().enumerate() {
        let Entries::Narrow(columns) = list.chunks()[0].entries(block) else { panic!("203 rows fit in 16 bits") };
        assert_eq!(columns.len(), block.depth as usize);
        for (k, column) in columns.iter().enumerate() {
            for lane in (0..LANES).filter(|&lane| k >= block.counts[lane] as usize) {
                assert_eq!(column[lane] as usize, lane.min(202 - b * LANES));
                padded += 1;
            }
        }
    }
    assert!(padded > 0);
    assert_eq!(list.slots() - list.pairs(), padded);
}

#[test]
fn travelling_together_needs_no_new_list() {
    let mut positions = scattered(500, 20.0);
    let (mut grid, mut list) = (Grid::new(Periodic::NONE), SkinList::default());
    positions = permuted(&positions, grid.order(&positions, 500, SkinList::list_radius(1.0, 0.2), Parallelism::Serial));
    list.build(&grid, &positions, 1.0, 0.2, Parallelism::Serial);
    positions.iter_mut().for_each(|x| *x += Vector::new(50.0, -30.0));
    assert!(!list.needs_rebuild(&grid, &positions, 500, Parallelism::Serial));
    positions[0].x += 0.25;
    assert!(list.needs_rebuild(&grid, &positions, 500, Parallelism::Serial));
    assert!(list.needs_rebuild(&grid, &positions, 499, Parallelism::Serial), "the number of rows changed");
}

#[test]
fn a_second_set_of_positions_is_covered_by_the_skin_it_needs() {
    use unipbd_core::neighbors::Motion;
    let start = scattered(400, 18.0);
    let predicted: Vec<_> =
        start.iter().enumerate().map(|(k, &x)| x + Vector::new((k % 7) as Real * 0.3, 0.1)).collect();
    let middle: Vec<_> = start.iter().zip(&predicted).map(|(&a, &b)| (a + b) * 0.5).collect();
    let mut grid = Grid::new(Periodic::NONE);
    let skin = Motion::between(&middle, &predicted, &grid, Parallelism::Serial)
        .needed_skin()
        .max(Motion::between(&middle, &start, &grid, Parallelism::Serial).needed_skin());
    let order = grid.order(&middle, 400, SkinList::list_radius(1.0, skin), Parallelism::Serial).to_vec();
    let mut list = SkinList::default();
    list.build(&grid, &permuted(&middle, &order), 1.0, skin, Parallelism::Serial);
    for positions in [permuted(&start, &order), permuted(&predicted, &order)] {
        let motion = list.motion(&grid, &positions, Parallelism::Serial);
        assert!(list.covers(&motion), "{motion:?} against a skin of {skin}");
        for (row, wanted) in brute_force(&positions, Periodic::NONE, 1.0).into_iter().enumerate() {
            let mut listed = Vec::new();
            list.list().for_each(row, |j| listed.push(j));
            assert!(wanted.iter().all(|j| listed.contains(j)));
        }
    }
}
