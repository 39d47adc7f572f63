//! Ropes of solid points.

use unipbd_core::Solver;

use crate::support::{run_until, solver};

fn rope(keys: &str) -> Solver {
    solver(&format!(
        r#"
        spacing = 0.05
        [solver]
        substeps = 32
        [[solid]]
        name = "cord"
        [[rope]]
        material = "cord"
        {keys}
        "#
    ))
}

/// Positions in the order of the rope.
fn places(rope: &Solver) -> Vec<[f64; 2]> {
    let mut rows: Vec<usize> = (0..rope.ids().len()).collect();
    rows.sort_by_key(|&row| rope.ids()[row]);
    rows.into_iter().map(|row| rope.positions()[row]).map(|x| [x.x.into(), x.y.into()]).collect()
}

fn length(places: &[[f64; 2]]) -> f64 {
    places.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
}

#[test]
fn a_hanging_rope_keeps_its_length() {
    let mut rope = rope("from = [0.0, 0.0]\nto = [0.0, -1.0]");
    run_until(&mut rope, 2.0);
    let places = places(&rope);
    assert_eq!(places.len(), 21);
    assert_eq!(places[0], [0.0, 0.0], "the held end stays");
    println!("stretch {:.4}", length(&places) - 1.0);
    assert!((length(&places) - 1.0).abs() < 0.01, "stretched to {} m", length(&places));
}

#[test]
fn a_rope_between_two_nails_hangs_as_a_catenary() {
    let mut rope = rope("from = [0.0, 0.0]\nto = [1.5, 0.0]\nlength = 2.0\nheld = \"both\"");
    run_until(&mut rope, 8.0);
    let (mut sag, frames) = (0.0, 120);
    for _ in 0..frames {
        rope.step_frame().unwrap();
        sag -= places(&rope).iter().map(|place| place[1]).fold(f64::INFINITY, f64::min) / f64::from(frames);
    }
    // sinh(z)/z = length/span; the sag is a (cosh z - 1) with a = span/(2 z).
    let (mut low, mut high) = (1e-3_f64, 10.0_f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle.sinh() / middle < 2.0 / 1.5 { low = middle } else { high = middle }
    }
    let expected = 0.75 / low * (low.cosh() - 1.0);
    println!("sag {sag:.4} m, catenary {expected:.4} m");
    assert!((sag / expected - 1.0).abs() < 0.03, "sags {sag} m instead of {expected} m");
}

#[test]
fn a_compliant_rope_stretches_by_its_weight_times_its_compliance() {
    let compliance = 2e-5;
    for link in ["rope", "rod"] {
        let keys = format!("from = [0.0, 0.0]\nto = [0.0, -1.0]\ncompliance = {compliance}\nlink = \"{link}\"");
        let mut rope = rope(&keys);
        run_until(&mut rope, 8.0);
        let (mut stretch, frames) = (0.0, 120);
        for _ in 0..frames {
            rope.step_frame().unwrap();
            stretch += (length(&places(&rope)) - 1.0) / f64::from(frames);
        }
        // Piece k of 20 carries the points below it: the sum of 20, 19, ..., 1 weights of one point.
        let weight = 1000.0 * 0.05 * 0.05 * 9.81;
        let expected = compliance * weight * 210.0;
        println!("{link}: stretch {stretch:.4} m, expected {expected:.4} m");
        assert!((stretch / expected - 1.0).abs() < 0.05, "{stretch} m instead of {expected} m");
    }
}

#[test]
fn tethers_keep_a_long_rope_from_stretching_at_few_substeps() {
    let hanging = |tethers: &str| {
        let mut rope = solver(&format!(
            r#"
            spacing = 0.05
            [solver]
            substeps = 4
            [[solid]]
            name = "cord"
            [[rope]]
            material = "cord"
            from = [0.0, 0.0]
            to = [0.0, -3.0]
            tethers = "{tethers}"
            "#
        ));
        run_until(&mut rope, 4.0);
        length(&places(&rope)) / 3.0 - 1.0
    };
    let (loose, tethered) = (hanging("none"), hanging("all"));
    println!("stretched by {:.1} % without tethers, {:.2} % with them", 100.0 * loose, 100.0 * tethered);
    assert!(loose > 0.02, "at four substeps a long rope stretches: {loose}");
    assert!(tethered < 0.5 * loose, "tethers hold it: {tethered}");
}

#[test]
fn a_rope_holds_a_body_and_its_end_goes_with_it() {
    let mut weight = solver(
        r#"
        spacing = 0.05
        [solver]
        substeps = 16
        [[solid]]
        name = "cord"
        density = 100.0
        [[rope]]
        material = "cord"
        from = [0.0, 0.0]
        to = [1.0, 0.0]
        body = "bob"
        [[body]]
        name = "bob"
        radius = 0.1
        position = [1.1, 0.0]
        "#,
    );
    let mut lowest = f64::INFINITY;
    for _ in 0..180 {
        weight.step_frame().unwrap();
        let bob = weight.bodies()[0].position;
        lowest = lowest.min(bob.y);
        let end = places(&weight)[20];
        let gap = ((end[0] - bob.x).hypot(end[1] - bob.y) - 0.1).abs();
        assert!(gap < 1e-4, "the end of the rope is {gap} m off its place on the body");
        let reach = end[0].hypot(end[1]);
        assert!(reach < 1.01, "the rope is {reach} m long");
    }
    assert!(lowest < -0.95 && lowest > -1.12, "it swings down on the rope to {lowest} m");
    let slack = length(&places(&weight));
    assert!(slack < 1.05, "the points lie along the rope: {slack} m");
}

#[test]
fn a_rope_of_a_light_liquid_floats_on_water() {
    let mut pool = solver(
        r#"
        spacing = 0.05
        [[liquid]]
        name = "water"
        xsph = 0.05
        [[liquid]]
        name = "cork"
        density = 300.0
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [2.0, 0.8]
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        open = ["top"]
        [[rope]]
        material = "cork"
        from = [0.5, 0.95]
        to = [1.5, 0.95]
        held = "neither"
        link = "rod"
        "#,
    );
    run_until(&mut pool, 4.0);
    let mut cork: Vec<usize> = (0..pool.ids().len()).filter(|&row| pool.material_indices()[row] == 1).collect();
    cork.sort_by_key(|&row| pool.ids()[row]);
    let at = |row: usize| pool.positions()[row].as_dvec2();
    let long: f64 = cork.windows(2).map(|pair| (at(pair[1]) - at(pair[0])).length()).sum();
    let height = cork.iter().map(|&row| at(row).y).sum::<f64>() / cork.len() as f64;
    println!("the rope floats at {height:.3} m and is {long:.3} m long");
    assert!((long - 1.0).abs() < 0.03, "{long} m");
    assert!(height > 0.72 && height < 0.9, "it lies on the water, at {height} m");
}
