use std::fmt;
use std::str::FromStr;

/// Where a live run listens unless it is told otherwise.
pub const DEFAULT_ADDRESS: &str = "127.0.0.1:8765";

/// Simulated seconds per second beyond which a pace makes no difference.
const FASTEST: f64 = 1000.0;

/// Where a live run listens and how it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveOptions {
    /// Name or number of an interface of this machine.
    pub host: String,
    /// The port; 0 takes one that is free.
    pub port: u16,
    /// Simulated seconds per second of the clock; 0 is as fast as it can.
    pub speed: f64,
    /// Whether the run waits for a viewer to start it.
    pub paused: bool,
}

impl Default for LiveOptions {
    fn default() -> Self {
        LiveOptions { host: "127.0.0.1".to_owned(), port: 8765, speed: 1.0, paused: false }
    }
}

/// A text that is no address to listen at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidAddress(String);

impl fmt::Display for InvalidAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\" is no address: expected HOST:PORT such as {DEFAULT_ADDRESS}, or a port", self.0)?;
        if self.0.ends_with(".toml") { f.write_str("; put --live behind the scene") } else { Ok(()) }
    }
}

impl std::error::Error for InvalidAddress {}

impl FromStr for LiveOptions {
    type Err = InvalidAddress;

    /// Reads `HOST:PORT`, `[IPV6]:PORT` or a port of this machine.
    fn from_str(text: &str) -> Result<Self, InvalidAddress> {
        let invalid = || InvalidAddress(text.to_owned());
        let (host, port) = text.rsplit_once(':').unwrap_or(("127.0.0.1", text));
        let in_brackets = host.starts_with('[') && host.ends_with(']');
        if host.is_empty() || host.contains(['/', ' ']) || (host.contains(':') && !in_brackets) {
            return Err(invalid());
        }
        let port = port.parse().map_err(|_| invalid())?;
        Ok(LiveOptions { host: host.to_owned(), port, ..LiveOptions::default() })
    }
}

/// A pace, from a number that a viewer or a command line gives.
pub fn speed(value: f64) -> Result<f64, String> {
    if (0.0..=FASTEST).contains(&value) {
        Ok(value)
    } else {
        Err(format!("expected a number from 0 (as fast as it can) to {FASTEST}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_a_host_and_a_port_or_a_port() {
        let at = |text: &str| text.parse::<LiveOptions>().map(|found| (found.host, found.port));
        assert_eq!(at(DEFAULT_ADDRESS), Ok(("127.0.0.1".into(), 8765)));
        assert_eq!(at("9000"), Ok(("127.0.0.1".into(), 9000)));
        assert_eq!(at("[::1]:0"), Ok(("[::1]".into(), 0)));
        for wrong in ["", "localhost", "::1", "localhost:99999", ":80", "ws://localhost:80"] {
            assert!(at(wrong).is_err(), "{wrong}");
        }
        assert!(at("scenes/rope.toml").unwrap_err().to_string().contains("behind the scene"));
    }
}
