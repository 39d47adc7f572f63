//! Logs of killed runs, made complete.

use crate::support::Place;

fn recorded(place: &Place) -> Vec<u8> {
    place.run(&["drop.toml", "-q", "--fields", "velocity", "-o", "whole.mcap"]).exits(0);
    std::fs::read(place.path("whole.mcap")).unwrap()
}

#[test]
fn a_log_that_was_cut_off_becomes_complete_with_all_its_whole_frames() {
    let place = Place::new();
    let whole = recorded(&place);
    for part in [0.4, 0.6, 0.97] {
        std::fs::write(place.path("cut.mcap"), &whole[..(part * whole.len() as f64) as usize]).unwrap();
        let before = place.run(&["info", "cut.mcap", "--json"]).exits(0).object();
        place.run(&["recover", "cut.mcap"]).exits(0);
        let after = place.run(&["info", "cut.mcap", "--json"]).exits(0).object();
        assert_eq!(after["frames"], before["frames"], "{part}");
        assert_eq!(after["last"], before["last"], "{part}");
        assert_eq!(after["truncated"], false, "{part}");
        assert!(place.run(&["recover", "cut.mcap"]).exits(0).stderr().contains("nothing to do"));
    }
}

#[test]
fn a_complete_log_is_copied_byte_by_byte() {
    let place = Place::new();
    let whole = recorded(&place);
    place.run(&["recover", "whole.mcap", "-o", "copy.mcap"]).exits(0);
    assert!(std::fs::read(place.path("copy.mcap")).unwrap() == whole);
    assert!(place.run(&["recover", "whole.mcap", "-o", "copy.mcap"]).exits(2).stderr().contains("--force"));
    assert!(place.run(&["recover", "whole.mcap", "-o", "whole.mcap", "--force"]).exits(2).stderr().contains("input"));
}

#[test]
fn a_damaged_log_is_left_alone_and_what_is_before_the_damage_goes_to_a_new_one() {
    let place = Place::new();
    let mut bytes = recorded(&place);
    let end = bytes.len() / 2;
    bytes.truncate(end);
    // A bit inside the compressed frames.
    bytes[end * 9 / 10] ^= 4;
    std::fs::write(place.path("bad.mcap"), &bytes).unwrap();
    let said = place.run(&["recover", "bad.mcap"]).exits(1).stderr();
    assert!(said.contains("damaged") && said.contains("-o NEW.mcap"), "{said}");
    assert!(std::fs::read(place.path("bad.mcap")).unwrap() == bytes);
    let said = place.run(&["recover", "bad.mcap", "-o", "good.mcap"]).exits(0).stderr();
    assert!(said.contains("damaged"), "{said}");
    let info = place.run(&["info", "good.mcap", "--json"]).exits(0).object();
    assert!(info["frames"].as_u64().unwrap() > 0 && info["truncated"] == false);
    assert_eq!(place.files(), ["bad.mcap", "drop.toml", "good.mcap", "whole.mcap"]);
}
