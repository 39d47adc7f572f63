//! Pictures have the right colours in the right places.

use std::sync::LazyLock;

use unipbd_cli::render::color::Rgb;
use unipbd_cli::render::{
    Background, ColorBy, Image, Range, RenderError, RenderOptions, Renderer, Style, Survey, TimeStamp, Vectors, View,
};
use unipbd_cli::snapshot::{Setting, Snapshot};
use unipbd_core::math::Vector64;
use unipbd_core::observe::{Material, WallOutline};
use unipbd_core::phase::Phase;
use unipbd_core::rigid::{Body, BodyKind};

const WATER: Rgb = [40, 120, 220];
const OIL: Rgb = [220, 150, 40];

fn material(name: &str, phase: Phase, color: Rgb) -> Material {
    Material { name: name.to_owned(), phase, density: 1.0, color }
}

/// A square metre, 400 pixels wide: the point (x, y) is the pixel (400 x, 400 - 400 y).
fn setting() -> Setting {
    let materials = vec![
        material("water", Phase::Liquid, WATER),
        material("oil", Phase::Liquid, OIL),
        material("smoke", Phase::Smoke, [240, 240, 240]),
        material("air", Phase::Gas, [120, 150, 180]),
    ];
    Setting { name: "test".into(), spacing: 0.05, materials, walls: vec![], view: Some(([0.0; 2], [1.0; 2])) }
}

fn options() -> RenderOptions {
    RenderOptions { width: 400, time_stamp: TimeStamp::Hidden, ..RenderOptions::default() }
}

fn particles(rows: &[([f32; 2], Phase, u16)]) -> Snapshot {
    Snapshot {
        positions: rows.iter().map(|row| row.0).collect(),
        ids: (0..rows.len() as u32).collect(),
        phases: rows.iter().map(|row| row.1).collect(),
        materials: rows.iter().map(|row| row.2).collect(),
        ..Snapshot::default()
    }
}

fn draw(setting: &Setting, options: RenderOptions, frame: &Snapshot) -> Image {
    Renderer::new(setting, options).draw(frame).unwrap().clone()
}

fn at(image: &Image, x: f64, y: f64) -> Rgb {
    image.pixel((x * 400.0) as u32, 399 - (y * 400.0) as u32).unwrap()
}

/// The colour of a place where nothing is.
fn empty() -> Rgb {
    static EMPTY: LazyLock<Rgb> =
        LazyLock::new(|| draw(&setting(), options(), &Snapshot::default()).pixel(0, 0).unwrap());
    *EMPTY
}

fn close(a: Rgb, b: Rgb, tolerance: u8) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= tolerance)
}

#[test]
fn a_particle_is_a_disc_of_its_materials_colour_and_y_points_up() {
    let frame = particles(&[([0.25, 0.75], Phase::Liquid, 0), ([0.5, 0.25], Phase::Liquid, 1)]);
    let image = draw(&setting(), RenderOptions { style: Style::Discs, ..options() }, &frame);
    assert_eq!([image.width(), image.height()], [400, 400]);
    assert_eq!(at(&image, 0.25, 0.75), WATER);
    assert_eq!(at(&image, 0.5, 0.25), OIL);
    // The radius is 0.55 spacings, 0.0275 m.
    assert_eq!(at(&image, 0.25 + 0.022, 0.75), WATER);
    for (x, y) in [(0.25 + 0.032, 0.75), (0.25, 0.25), (0.5, 0.75)] {
        assert_eq!(at(&image, x, y), empty());
    }
}

#[test]
fn a_lattice_is_a_closed_surface_and_a_lone_particle_keeps_its_size() {
    let lattice = (0..64).map(|k| ([0.2 + 0.05 * (k % 8) as f32, 0.2 + 0.05 * (k / 8) as f32], Phase::Liquid, 0));
    let rows: Vec<_> = lattice.chain([([0.8, 0.8], Phase::Liquid, 0)]).collect();
    let image = draw(&setting(), options(), &particles(&rows));
    for k in 0..200 {
        let inside = at(&image, 0.24 + 0.0014 * f64::from(k), 0.24 + 0.0013 * f64::from(k));
        assert!(close(inside, WATER, 1), "hole at step {k}: {inside:?}");
    }
    let covered = (0..400).filter(|x| image.pixel(*x, 399 - 320).unwrap() != empty()).count();
    let diameter = covered as f64 / 20.0;
    assert!((0.9..=1.3).contains(&diameter), "a lone particle is {diameter} spacings wide");
}

#[test]
fn two_liquids_meet_in_a_line() {
    let rows: Vec<_> = (0..400)
        .map(|k| ([0.025 + 0.05 * (k % 20) as f32, 0.025 + 0.05 * (k / 20) as f32], Phase::Liquid, (k / 200) as u16))
        .collect();
    let image = draw(&setting(), options(), &particles(&rows));
    assert!(close(at(&image, 0.5, 0.45), WATER, 8), "{:?}", at(&image, 0.5, 0.45));
    assert!(close(at(&image, 0.5, 0.55), OIL, 8), "{:?}", at(&image, 0.5, 0.55));
    let mixed = (150..250)
        .filter(|y| {
            let color = image.pixel(200, *y).unwrap();
            !close(color, WATER, 20) && !close(color, OIL, 20)
        })
        .count();
    assert!(mixed <= 8, "{mixed} of 20 pixels in a spacing are mixed");
}

#[test]
fn particles_outside_the_view_or_not_finite_leave_no_trace() {
    let far = [[-0.2, 0.5], [1.2, 0.5], [0.5, -3.0], [0.5, 1e30], [f32::NAN, 0.5], [0.5, f32::INFINITY]];
    for phase in [Phase::Liquid, Phase::Gas, Phase::Smoke, Phase::Solid, Phase::Rigid] {
        let rows: Vec<_> = far.iter().map(|position| (*position, phase, 0)).collect();
        for style in [Style::Surface, Style::Discs] {
            let image = draw(&setting(), RenderOptions { style, ..options() }, &particles(&rows));
            assert!((0..400).all(|y| (0..400).all(|x| image.pixel(x, y).unwrap() == empty())));
        }
    }
}

#[test]
fn gas_and_smoke_end_at_a_closed_wall_and_go_on_past_an_open_one() {
    let corners = [[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]].map(Vector64::from).to_vec();
    let reaches = |phase: Phase, closed: bool| {
        let walls = vec![WallOutline { points: corners.clone(), closed, endless: false }];
        let rows = vec![([0.255, 0.5], phase, if phase == Phase::Gas { 3 } else { 2 }); 5];
        let image = draw(&Setting { walls, ..setting() }, options(), &particles(&rows));
        assert_ne!(at(&image, 0.27, 0.5), empty(), "it shows inside");
        at(&image, 0.225, 0.5) != empty()
    };
    for phase in [Phase::Gas, Phase::Smoke] {
        // The last of four corners is open to the first: nothing is known of what it surrounds.
        assert_eq!((reaches(phase, true), reaches(phase, false)), (false, true), "{phase:?}");
    }
}

#[test]
fn arrows_point_where_particles_go_and_the_longest_is_what_was_asked_for() {
    let mut frame = particles(&[([0.5, 0.5], Phase::Liquid, 0)]);
    frame.velocities = Some(vec![[2.0, 0.0]]);
    let arrows = |longest: f64| {
        let options = RenderOptions { longest_vector: Some(longest), ..options() };
        let plain = draw(&setting(), options.clone(), &frame);
        let image = draw(&setting(), RenderOptions { vectors: Some(Vectors::Velocity), ..options }, &frame);
        // Columns in the row of the particle that the arrow changes.
        let changed = (0..400).filter(|x| image.pixel(*x, 200) != plain.pixel(*x, 200)).collect::<Vec<_>>();
        (changed[0], changed[changed.len() - 1])
    };
    let (from, to) = arrows(2.0);
    let (_, half) = arrows(4.0);
    // A square with one arrow is two spacings wide here, 40 pixels; the longest arrow is 1.5 of that.
    assert!((196..=201).contains(&from) && (257..=262).contains(&to), "{from} to {to}");
    assert!((227..=232).contains(&half), "{half}");
}

#[test]
fn arrows_without_their_numbers_are_refused() {
    let refused = |vectors| {
        let options = RenderOptions { vectors: Some(vectors), ..options() };
        Renderer::new(&setting(), options).draw(&particles(&[])).unwrap_err().to_string()
    };
    assert!(refused(Vectors::Velocity).contains("--fields velocity"));
    assert!(refused(Vectors::Force).contains("bodies"));
}

#[test]
fn smoke_fades_outwards_without_an_edge_and_more_smoke_is_brighter() {
    let level = |count: usize, x: f64| {
        let rows = vec![([0.5, 0.5], Phase::Smoke, 2); count];
        i32::from(at(&draw(&setting(), options(), &particles(&rows)), x, 0.5)[0])
    };
    let profile: Vec<i32> = (0..40).map(|k| level(3, 0.5 + 0.005 * f64::from(k))).collect();
    assert!(profile.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] <= 12), "{profile:?}");
    assert!(level(9, 0.5) > level(3, 0.5) + 10 && level(3, 0.5) > level(1, 0.5) + 10);
    assert_eq!(level(3, 0.5 + 0.2), i32::from(empty()[0]));
}

#[test]
fn gas_is_faint_and_lets_smoke_show() {
    let gas: Vec<_> = (0..400).map(|k| ([0.05 * (k % 20) as f32, 0.05 * (k / 20) as f32], Phase::Gas, 3)).collect();
    let mut both = gas.clone();
    both.extend(vec![([0.5, 0.5], Phase::Smoke, 2); 20]);
    let [veil, smoke] = [gas, both].map(|rows| at(&draw(&setting(), options(), &particles(&rows)), 0.5, 0.5));
    assert!(veil[0] > empty()[0] + 5 && veil[0] < empty()[0] + 40, "{veil:?}");
    assert!(smoke[0] > veil[0] + 80, "{smoke:?}");
}

#[test]
fn the_open_side_of_a_tank_has_no_line() {
    let points = [[0.1, 0.9], [0.1, 0.1], [0.9, 0.1], [0.9, 0.9]].map(Vector64::from).to_vec();
    let wall = WallOutline { points, closed: false, endless: false };
    let mut closed = setting();
    closed.walls = vec![WallOutline { closed: true, ..wall.clone() }];
    let mut open = setting();
    open.walls = vec![wall];
    let [open, closed] = [open, closed].map(|setting| draw(&setting, options(), &Snapshot::default()));
    for (x, y) in [(0.1, 0.5), (0.9, 0.5), (0.5, 0.1)] {
        assert_ne!(at(&open, x, y), empty());
        assert_ne!(at(&closed, x, y), empty());
    }
    // Nothing crosses the middle of the open tank from its floor to the top of the picture.
    assert!((0..350).all(|y| open.pixel(200, y).unwrap() == empty()));
    assert_ne!(at(&closed, 0.5, 0.9), empty());
    assert_eq!(at(&open, 0.5, 0.9), empty());
    // Both keep their inside free, and have their band outside.
    for image in [&open, &closed] {
        assert_eq!(at(image, 0.5, 0.5), empty());
        assert_ne!(at(image, 0.09, 0.5), empty());
        assert_eq!(at(image, 0.115, 0.5), empty());
    }
}

#[test]
fn a_box_of_wall_and_the_far_side_of_a_half_plane_are_filled() {
    let square = [[0.4, 0.4], [0.4, 0.6], [0.6, 0.6], [0.6, 0.4]].map(Vector64::from).to_vec();
    // A floor at 0.2 m, whose points lie far to the left: the solid side is below.
    let floor = [[901.0, 0.2], [900.0, 0.2]].map(Vector64::from).into_iter().rev().collect();
    let mut setting = setting();
    setting.walls = vec![
        WallOutline { points: square, closed: true, endless: false },
        WallOutline { points: floor, closed: false, endless: true },
    ];
    let image = draw(&setting, options(), &Snapshot::default());
    assert_ne!(at(&image, 0.5, 0.5), empty());
    for x in [0.01, 0.5, 0.99] {
        assert_ne!(at(&image, x, 0.1), empty());
        assert_eq!(at(&image, x, 0.3), empty());
    }
}

#[test]
fn the_mark_on_a_disc_turns_with_it() {
    let disc = |angle: f64| Body {
        name: "wheel".into(),
        kind: BodyKind::Dynamic,
        position: Vector64::new(0.5, 0.5),
        angle,
        velocity: Vector64::ZERO,
        mass: 1.0,
        inertia: 1.0,
        radius: 0.3,
        ..Body::default()
    };
    let picture = |angle| draw(&setting(), options(), &Snapshot { bodies: vec![disc(angle)], ..Snapshot::default() });
    let [east, north] = [picture(0.0), picture(std::f64::consts::FRAC_PI_2)];
    assert_eq!(at(&east, 0.65, 0.5), at(&north, 0.5, 0.65));
    assert_eq!(at(&east, 0.5, 0.65), at(&north, 0.65, 0.5));
    assert_ne!(at(&east, 0.65, 0.5), at(&east, 0.5, 0.65));
    assert_eq!(at(&east, 0.5, 0.85), empty());
}

#[test]
fn speed_colours_run_from_the_low_to_the_high_end_above_a_colour_bar() {
    let mut frame = particles(&[([0.25, 0.5], Phase::Liquid, 0), ([0.75, 0.5], Phase::Liquid, 0)]);
    frame.velocities = Some(vec![[0.0, 0.0], [3.0, 4.0]]);
    let options = RenderOptions { color_by: ColorBy::Speed, range: Range::Fixed { min: 0.0, max: 5.0 }, ..options() };
    let image = draw(&setting(), options, &frame);
    assert!(image.height() > 400 && image.height().is_multiple_of(2));
    let [slow, fast] = [at(&image, 0.25, 0.5), at(&image, 0.75, 0.5)];
    let bar = |x: u32| image.pixel(x, 400 + 12).unwrap();
    assert!(close(bar(121), slow, 6), "{:?} {slow:?}", bar(121));
    assert!(close(bar(278), fast, 6), "{:?} {fast:?}", bar(278));
}

#[test]
fn a_missing_column_is_an_error_that_names_the_flag() {
    let frame = particles(&[([0.5, 0.5], Phase::Liquid, 0)]);
    for (color_by, flag) in [
        (ColorBy::Speed, "--fields velocity"),
        (ColorBy::Density, "--fields density"),
        (ColorBy::Temperature, "--fields temperature"),
    ] {
        let error = Renderer::new(&setting(), RenderOptions { color_by, ..options() }).draw(&frame).unwrap_err();
        assert!(matches!(error, RenderError::MissingColumn(by) if by == color_by));
        assert!(error.to_string().ends_with(flag), "{error}");
    }
}

#[test]
fn an_empty_view_and_a_reversed_range_are_errors() {
    let empty = View { min: [1.0, 0.0], max: [1.0, 1.0] };
    let mut renderer = Renderer::new(&setting(), RenderOptions { view: Some(empty), ..options() });
    assert!(matches!(renderer.draw(&Snapshot::default()), Err(RenderError::View)));
    let range = Range::Fixed { min: 2.0, max: 1.0 };
    let mut frame = particles(&[([0.5, 0.5], Phase::Liquid, 0)]);
    frame.velocities = Some(vec![[0.0; 2]]);
    let options = RenderOptions { color_by: ColorBy::Speed, range, ..options() };
    assert!(matches!(Renderer::new(&setting(), options).draw(&frame), Err(RenderError::Range)));
}

#[test]
fn a_view_fits_all_frames_and_a_survey_settles_view_and_range() {
    let mut setting = setting();
    setting.view = None;
    let mut frames = [[0.0, 0.0], [4.0, 1.0], [2.0, 3.0]].map(|place| particles(&[(place, Phase::Liquid, 0)]));
    let view = View::fit(&setting, &frames);
    assert_eq!(view, View { min: [-0.1, -0.1], max: [4.1, 3.1] });
    let options = RenderOptions { color_by: ColorBy::Speed, ..options() };
    assert!(Survey::is_needed(&setting, &options));
    let mut survey = Survey::new(&setting, options);
    for (frame, speed) in frames.iter_mut().zip([1.0, 2.9, 0.5]) {
        frame.velocities = Some(vec![[speed, 0.0]]);
        survey.include(frame).unwrap();
    }
    let settled = survey.finish();
    assert_eq!(settled.view, Some(view));
    assert_eq!(settled.range, Range::Fixed { min: 0.0, max: 3.0 });
    assert!(!Survey::is_needed(&setting, &settled));
}

#[test]
fn the_same_frame_gives_the_same_picture_whatever_was_drawn_before() {
    let rows: Vec<_> = (0..50).map(|k| ([0.02 * k as f32, 0.5], Phase::ALL[k % 3], [0, 3, 2][k % 3])).collect();
    let frame = particles(&rows);
    let other = particles(&rows[..20]);
    let options = RenderOptions { background: Background::Light, time_stamp: TimeStamp::Shown, ..options() };
    let mut renderer = Renderer::new(&setting(), options.clone());
    renderer.draw(&other).unwrap();
    assert_eq!(*renderer.draw(&frame).unwrap(), draw(&setting(), options, &frame));
}
