//! Mutated inputs by the number: as many as `UNIPBD_FUZZ_CASES` says, from the seed `UNIPBD_FUZZ_SEED`.
//!
//! A target runs a case and must come back: with a result or with an error, without a panic and without holding more than
//! a gigabyte. An input that breaks this is left in the folder `UNIPBD_FUZZ_KEEP`, and its number is printed.

use std::alloc::{GlobalAlloc, Layout, System};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use unipbd_core::rng::Rng;

/// Most memory that a case may hold beside what was held before \[bytes].
const MOST_MEMORY: usize = 1 << 30;

/// Counts what is held.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(held, Relaxed);
        // SAFETY: as the caller vouches.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller vouches.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Random choices of a case.
pub struct Dice(Rng);

impl Dice {
    pub fn below(&mut self, count: usize) -> usize {
        (self.0.next_u64() % count.max(1) as u64) as usize
    }

    #[allow(dead_code)] // Not every target needs it.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    pub fn word(&mut self) -> u64 {
        self.0.next_u64()
    }

    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    /// A number that programs stumble over.
    pub fn edge(&mut self) -> u64 {
        let bits = self.below(65) as u32;
        let power = 1_u64.checked_shl(bits).unwrap_or(0);
        match self.below(8) {
            0 => power.wrapping_sub(1),
            1 => power,
            2 => power.wrapping_neg(),
            3 => f64::from_bits(self.word()).to_bits(),
            4 => u64::from((1e30_f32).to_bits()) << 32 | u64::from((-1e-30_f32).to_bits()),
            5 => u64::from(f32::MAX.to_bits()) * 0x1_0000_0001,
            6 => self.below(300) as u64,
            _ => self.word(),
        }
    }
}

/// Changes some bytes: single ones, words, stretches that are doubled, moved or left out.
pub fn spoil(bytes: &mut Vec<u8>, dice: &mut Dice) {
    for _ in 0..1 + dice.below(4) {
        if bytes.is_empty() {
            bytes.push(dice.word() as u8);
        }
        let place = dice.below(bytes.len());
        match dice.below(8) {
            0 => bytes[place] ^= 1 << dice.below(8),
            1 => bytes[place] = dice.word() as u8,
            2 => write(bytes, place, &dice.edge().to_le_bytes()),
            3 => write(bytes, place, &(dice.edge() as u32).to_le_bytes()),
            4 => bytes.truncate(place),
            5 => drop(bytes.drain(place..(place + dice.below(16)).min(bytes.len()))),
            6 => {
                let part = bytes[place..(place + 1 + dice.below(64)).min(bytes.len())].to_vec();
                let to = dice.below(bytes.len());
                bytes.splice(to..to, part);
            }
            _ => {
                // Aligned words are more often a number.
                let place = place & !3;
                write(bytes, place, &(dice.edge() as u32).to_le_bytes());
            }
        }
    }
}

fn write(bytes: &mut [u8], place: usize, word: &[u8]) {
    let end = bytes.len().min(place + word.len());
    bytes[place..end].copy_from_slice(&word[..end - place]);
}

/// Runs a target on as many inputs as the environment asks for, from `UNIPBD_FUZZ_FIRST` on, or else on `usual` ones.
pub fn fuzz(target: &str, usual: u64, make: impl Fn(&mut Dice) -> Vec<u8>, run: impl Fn(&[u8])) {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (cases, seed) = (number("UNIPBD_FUZZ_CASES").unwrap_or(usual), number("UNIPBD_FUZZ_SEED").unwrap_or(0));
    let (mut slowest, mut largest, mut failures) = ((Duration::ZERO, 0), 0, Vec::new());
    let first = number("UNIPBD_FUZZ_FIRST").unwrap_or(0);
    for case in first..first + cases {
        let input = make(&mut Dice(Rng::new(seed, case)));
        let before = HELD.load(Relaxed);
        PEAK.store(before, Relaxed);
        let begin = Instant::now();
        let ended = catch_unwind(AssertUnwindSafe(|| run(&input)));
        slowest = slowest.max((begin.elapsed(), case));
        let memory = PEAK.load(Relaxed).saturating_sub(before);
        largest = largest.max(memory);
        if ended.is_err() || memory > MOST_MEMORY {
            let why = if ended.is_err() { "panics" } else { "takes more than a gigabyte" };
            println!("case {case} of seed {seed} {why}");
            keep(target, case, &input);
            failures.push(case);
        }
    }
    println!(
        "{target}: {cases} cases of seed {seed}, {} failed, slowest {:.3} s (case {}), largest {} MB",
        failures.len(),
        slowest.0.as_secs_f64(),
        slowest.1,
        largest >> 20
    );
    assert!(failures.is_empty(), "cases {failures:?} of {target}");
}

fn keep(target: &str, case: u64, input: &[u8]) {
    if let Some(folder) = std::env::var_os("UNIPBD_FUZZ_KEEP") {
        let file = std::path::Path::new(&folder).join(format!("{target}-{case}"));
        let _ = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(file, input));
    }
}
