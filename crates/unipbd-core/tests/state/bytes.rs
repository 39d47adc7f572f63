use crate::scenes::{all, build, mixed, run};
use proptest::prelude::*;
use std::sync::LazyLock;
use unipbd_core::{State, StateError};

static BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let mut solver = build(&mixed());
    run(&mut solver, 3);
    solver.save().to_bytes()
});

#[test]
fn bytes_give_the_same_state_back() {
    for (name, scene) in all() {
        let mut solver = build(&scene);
        run(&mut solver, 5);
        let bytes = solver.save().to_bytes();
        let state = State::from_bytes(&bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(state.to_bytes(), bytes);
        assert_eq!((state.frame(), state.particles()), (5, solver.ids().len()));
    }
}

#[test]
fn foreign_bytes_and_other_versions_are_named_as_such() {
    assert_eq!(State::from_bytes(b"").unwrap_err(), StateError::NotAState);
    assert_eq!(State::from_bytes(b"PK\x03\x04 not at all").unwrap_err(), StateError::NotAState);
    for other in [0, 5, 6, 99] {
        let mut bytes = BYTES.clone();
        bytes[8] = other;
        let refused = State::from_bytes(&bytes).unwrap_err();
        assert_eq!(refused, StateError::Version { found: u32::from(other), expected: 11 });
        assert!(
            refused
                .to_string()
                .contains(&format!("has format version {other}, this version of unipbd reads version 11"))
        );
    }
}

#[test]
fn every_cut_is_noticed() {
    for end in (0..BYTES.len()).step_by(97) {
        assert!(State::from_bytes(&BYTES[..end]).is_err(), "cut at {end}");
    }
}

proptest! {
    #[test]
    fn every_flipped_bit_is_noticed(position in 0..BYTES.len(), bit in 0..8) {
        let mut bytes = BYTES.clone();
        bytes[position] ^= 1_u8 << bit;
        prop_assert!(State::from_bytes(&bytes).is_err());
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let mut forged = b"unipbd\0S\x01\0\0\0".to_vec();
        forged.extend(bytes);
        prop_assert!(State::from_bytes(&forged).is_err());
    }
}
