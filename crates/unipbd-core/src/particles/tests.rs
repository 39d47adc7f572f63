//! Rows, ids and phases stay together through all additions and removals.

use super::*;

fn particle(phase: Phase, x: Real) -> NewParticle {
    NewParticle {
        position: Vector64::new(f64::from(x), 0.0),
        velocity: Vector::ZERO,
        inverse_mass: 1.0,
        material: 0,
        phase,
        temperature: 0.0,
    }
}

fn mixed(count: u32) -> Particles {
    let mut particles = Particles::new(OptionalColumns { temperature: true, ..OptionalColumns::default() });
    for i in 0..count {
        let phase = if i % 3 == 0 { Phase::Smoke } else { Phase::Gas };
        particles.push(particle(phase, i as Real));
    }
    particles
}

fn assert_consistent(particles: &Particles) {
    for row in 0..particles.len() {
        assert_eq!(particles.phase[row].is_dense(), row < particles.dense());
        assert_eq!(particles.position[row].x, particles.id[row] as Real);
    }
    assert_eq!(particles.temperature.len(), particles.len());
    assert!(particles.age.is_empty());
}

#[test]
fn dense_rows_come_first_whatever_the_order_of_adding() {
    assert_consistent(&mixed(20));
}

#[test]
fn removal_keeps_rows_and_ids_together() {
    let mut particles = mixed(20);
    particles.remove_rows(&[0, 3, 12, 13, 18, 19]);
    assert_eq!(particles.len(), 14);
    assert_consistent(&particles);
    let fresh = particles.push(particle(Phase::Gas, 20.0));
    assert_eq!(fresh, 20, "ids are never reused");
    assert_consistent(&particles);
}

#[test]
fn sleeping_rows_stay_the_last_dense_ones() {
    let mut particles = mixed(30);
    particles.set_asleep(8, 5);
    let asleep = |particles: &Particles| particles.id[particles.awake()..particles.dense()].to_vec();
    let mut expected = asleep(&particles);
    particles.push(particle(Phase::Gas, 30.0));
    particles.push(particle(Phase::Smoke, 31.0));
    let (awake, asleep_row) = (particles.awake() as u32, particles.awake() as u32 + 3);
    let gone = particles.id[asleep_row as usize];
    particles.remove_rows(&[2, awake - 1, asleep_row]);
    expected.retain(|&id| id != gone);
    let mut found = asleep(&particles);
    found.sort_unstable();
    expected.sort_unstable();
    assert_eq!(found, expected);
    assert_consistent(&particles);
}

#[test]
fn reordering_moves_whole_rows() {
    let mut particles = mixed(9);
    let (dense, len) = (particles.dense() as u32, particles.len() as u32);
    let order: Vec<u32> = (0..dense).rev().chain((dense..len).rev()).collect();
    let before = particles.id.clone();
    particles.reorder(0, &order, Parallelism::Serial, &mut Scratch::default());
    assert_eq!(particles.id[0], before[dense as usize - 1]);
    assert_consistent(&particles);
}
