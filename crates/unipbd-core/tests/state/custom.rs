//! The example of constraints of one's own, run as a test.

#[path = "../../examples/custom_constraint.rs"]
mod custom_constraint;

#[test]
fn beads_stay_on_their_ring_and_the_chain_keeps_its_length() {
    let end = custom_constraint::simulate(2.0).unwrap();
    assert!(end.off_ring < 1e-3, "a bead is {} m off the ring", end.off_ring);
    assert!(end.stretch < 0.05, "a link is stretched by {}", end.stretch);
    assert!(end.lowest < -0.4, "the beads have slid down: {}", end.lowest);
    custom_constraint::main();
}
