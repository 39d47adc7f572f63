//! Files with thousands of things in them are checked in time that grows with their length.
#![cfg(unix)]

use std::fmt::Write;

use crate::support::Place;

/// Processor time that a check may take [s]: many times what it needs, and a fraction of what its square would.
const LIMIT: u32 = 8;

fn check(place: &Place, scene: &str) -> String {
    place.write("many.toml", scene);
    let command = format!("ulimit -t {LIMIT}; exec {} check many.toml", env!("CARGO_BIN_EXE_unipbd"));
    let output = std::process::Command::new("sh").args(["-c", &command]).current_dir(place.path(".")).output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{:?}: more than {LIMIT} s of processor time?", output.status);
    String::from_utf8(output.stderr).unwrap()
}

const WATER: &str = "spacing = 0.1\nwrong = 1\n[[liquid]]\nname = \"water\"\n";

#[test]
fn thousands_of_blocks_beside_each_other_on_each_other_and_in_one_place() {
    let place = Place::new();
    let row = |x: usize, y: usize| format!("min = [{x}.0, {y}.0]\nmax = [{x}.9, {y}.9]\n");
    let ways: [&dyn Fn(usize) -> String; 3] = [&|k| row(0, k), &|k| row(k % 70, k / 70), &|_| row(0, 0)];
    for (way, said) in ways.into_iter().zip(["1 problem", "1 problem", "5000 problems"]) {
        let mut scene = WATER.to_owned();
        for k in 0..5000 {
            write!(scene, "[[block]]\nmaterial = \"water\"\n{}", way(k)).unwrap();
        }
        let message = check(&place, &scene);
        assert!(message.contains(said), "{}", &message[message.len().saturating_sub(300)..]);
    }
}

#[test]
fn thousands_of_unknown_keys_in_lines_and_in_one_line() {
    let place = Place::new();
    let mut lines = WATER.to_owned();
    (0..20_000).for_each(|k| writeln!(lines, "key_{k} = {k}").unwrap());
    assert!(check(&place, &lines).contains("20001 problems"));
    let keys: Vec<String> = (0..20_000).map(|k| format!("key_{k} = {k}")).collect();
    let line = format!("spacing = 0.1\nview = {{ {} }}\n", keys.join(", "));
    assert!(check(&place, &line).contains("problems"));
}

#[test]
fn hundreds_of_bodies_in_one_place_are_refused() {
    let place = Place::new();
    let mut tables = "spacing = 0.1\n".to_owned();
    (0..500).for_each(|_| tables.push_str("[[body]]\nsize = [0.4, 0.4]\nposition = [0.5, 0.5]\n"));
    assert!(check(&place, &tables).contains("more than 16 bodies of its size lie in one place"));
    let copies = "spacing = 0.1\n[[body]]\nradius = 0.2\nposition = [0.5, 0.5]\ncopies = { columns = 500, step = [1e-6, 1.0] }\n";
    assert!(check(&place, copies).contains("lie in one place"));
}

#[test]
fn thousands_of_joints_of_bodies_that_do_not_exist() {
    let place = Place::new();
    let mut scene = "spacing = 0.1\n".to_owned();
    (0..3000)
        .for_each(|k| writeln!(scene, "[[body]]\nname = \"b{k}\"\nradius = 0.2\nposition = [{k}.0, 0.5]").unwrap());
    (0..3000).for_each(|k| writeln!(scene, "[[joint]]\nkind = \"hinge\"\nbody = \"c{k}\"\nat = [0.0, 0.0]").unwrap());
    assert!(check(&place, &scene).contains("3000 problems"));
}
