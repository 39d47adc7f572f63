//! Numbers for people.

use std::time::Duration;

/// A whole number with thousands separated: `1,234,567`.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A fraction as a percentage with two digits: `0.30 %`.
pub fn percent(fraction: f64) -> String {
    format!("{:.2} %", 100.0 * fraction)
}

/// A number of bytes: `17 B`, `1.5 MB`.
pub fn bytes(value: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    if value < 1000 {
        return format!("{value} B");
    }
    let mut scaled = value as f64 / 1000.0;
    let mut unit = 0;
    while scaled >= 999.5 && unit + 1 < UNITS.len() {
        scaled /= 1000.0;
        unit += 1;
    }
    let digits = if scaled < 9.95 { 1 } else { 0 };
    format!("{scaled:.digits$} {}", UNITS[unit])
}

/// A length of wall-clock time: `2.5 ms`, `0.42 s`, `12.3 s`, `3 min 05 s`, `2 h 10 min`.
pub fn duration(value: Duration) -> String {
    let seconds = value.as_secs_f64();
    if seconds < 0.0995 {
        let digits = if seconds < 0.00995 { 1 } else { 0 };
        return format!("{:.digits$} ms", 1000.0 * seconds);
    }
    if seconds < 9.995 {
        return format!("{seconds:.2} s");
    }
    if seconds < 59.95 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    match whole / 3600 {
        0 => format!("{} min {:02} s", whole / 60, whole % 60),
        hours => format!("{hours} h {:02} min", whole % 3600 / 60),
    }
}

/// `1 frame`, `2 frames`.
pub fn plural(value: u64, noun: &str) -> String {
    format!("{} {noun}{}", count(value), if value == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_separated() {
        assert_eq!([0, 999, 1000, 1234567].map(count), ["0", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn bytes_have_two_or_three_digits() {
        assert_eq!(
            [17, 1500, 99_960, 999_600, 2_000_000_000].map(bytes),
            ["17 B", "1.5 kB", "100 kB", "1.0 MB", "2.0 GB"]
        );
    }

    #[test]
    fn durations_choose_their_unit() {
        let texts =
            [0.0025, 0.421, 12.34, 59.97, 185.0, 7805.0].map(|seconds| duration(Duration::from_secs_f64(seconds)));
        assert_eq!(texts, ["2.5 ms", "0.42 s", "12.3 s", "1 min 00 s", "3 min 05 s", "2 h 10 min"]);
    }
}
