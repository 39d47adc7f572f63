//! Each solver says what it uses, and a run whose settings differ from those asked for is no comparison.

use std::fmt::Display;

/// Largest relative difference of two numbers that mean the same: single precision.
const ROUNDING: f64 = 1e-5;

/// Compares settings by name: what was asked for, and what the solver says.
#[derive(Default)]
pub struct ReadBack {
    differ: Vec<String>,
}

impl ReadBack {
    /// Two numbers that must agree to single precision.
    pub fn number(self, name: &str, asked: f64, found: f64) -> ReadBack {
        let agree = (asked - found).abs() <= ROUNDING * asked.abs();
        self.note(name, agree, asked, found)
    }

    /// Two values that must be the same.
    pub fn same<T: PartialEq + Display>(self, name: &str, asked: T, found: T) -> ReadBack {
        let agree = asked == found;
        self.note(name, agree, asked, found)
    }

    /// Fails with all settings that differ.
    pub fn done(self) -> Result<(), String> {
        if self.differ.is_empty() { Ok(()) } else { Err(format!("settings differ: {}", self.differ.join(", "))) }
    }

    fn note(mut self, name: &str, agree: bool, asked: impl Display, found: impl Display) -> ReadBack {
        if !agree {
            self.differ.push(format!("{name} is {found}, not {asked}"));
        }
        self
    }
}
