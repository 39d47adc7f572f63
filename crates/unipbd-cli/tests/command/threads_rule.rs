//! One rule for numbers of threads.

use crate::support::Place;

#[test]
fn an_empty_variable_is_as_if_it_were_not_set() {
    let place = Place::new();
    for empty in ["", " "] {
        for arguments in [&["run", "drop.toml", "-q", "--no-record"][..], &["check", "drop.toml"]] {
            let output = place.command(arguments).env("UNIPBD_THREADS", empty).output().unwrap();
            assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        }
    }
}

#[test]
fn wrong_numbers_are_refused_from_the_argument_and_the_environment_alike() {
    let place = Place::new();
    for wrong in ["0", "-1", "4097", "1000000000", "99999999999999999999", "1.5", "many"] {
        let ended = place.run(&["run", "drop.toml", "--threads", wrong]).exits(2);
        assert!(ended.stderr().contains("must be a whole number from 1 to 4096, found"), "{}", ended.stderr());
        let output = place.command(&["run", "drop.toml"]).env("UNIPBD_THREADS", wrong).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains("UNIPBD_THREADS must be a whole number from 1 to 4096, found"), "{message}");
    }
    assert_eq!(place.files(), ["drop.toml"]);
}

#[test]
fn an_argument_wins_over_the_environment() {
    let place = Place::new();
    let mut command = place.command(&["run", "drop.toml", "-q", "--no-record", "--threads", "1"]);
    assert!(command.env("UNIPBD_THREADS", "many").output().unwrap().status.success());
}
