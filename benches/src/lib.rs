//! Particle sets, scenes and measurements that benchmarks share.

pub mod growth;
mod lattice;
pub mod roofline;
mod scenes;
pub mod sleep;
pub mod steps;
mod whole;

pub use lattice::Lattice;
pub use scenes::{dam_break, pool, solver};

/// Runs `work` on a pool of two threads.
///
/// # Panics
/// Where the system gives no threads.
pub fn on_two_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("two threads").install(work)
}
