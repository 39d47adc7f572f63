//! Times the passes over pairs against a scalar loop and a loop of square roots.
//!
//! `cargo run --release -p unipbd-benches --bin roofline [particles ...] [levels]`

use unipbd_benches::{on_two_threads, roofline};
use unipbd_core::simd::Level;

fn main() {
    let sizes: Vec<usize> = std::env::args().skip(1).filter_map(|size| size.parse().ok()).collect();
    let all = std::env::args().any(|argument| argument == "levels");
    let levels = if all { Level::available() } else { vec![Level::best()] };
    on_two_threads(|| {
        for &rows in if sizes.is_empty() { &[10_000, 100_000][..] } else { &sizes } {
            println!("{}", roofline::report(rows, &levels));
        }
    });
}
