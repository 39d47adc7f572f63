//! Ctrl-C, and the signals by which a terminal or a system asks a process to end: the first one asks for an orderly
//! end, the second one ends the process at once.

use crate::exit::Exit;

#[cfg(not(unix))]
use elsewhere as signals;
#[cfg(unix)]
use unix as signals;

/// From now on these signals are noted in [`requested`] and do not end the process. One that was ignored when the
/// process started, as in a background job of a script or under `nohup`, stays ignored.
pub fn listen() {
    signals::listen();
}

/// The exit code of the signal that came since [`listen`]; `None` while there was none.
pub fn requested() -> Option<Exit> {
    signals::requested()
}

#[cfg(unix)]
mod unix {
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    use std::sync::{Arc, OnceLock};

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag;

    use super::Exit;

    /// Notes of the handlers.
    struct Noted {
        signal: Arc<AtomicUsize>,
        /// Whether the next signal ends the process.
        armed: Arc<AtomicBool>,
    }

    fn noted() -> &'static Noted {
        static NOTED: OnceLock<Noted> = OnceLock::new();
        NOTED.get_or_init(|| {
            let noted = Noted { signal: Arc::default(), armed: Arc::default() };
            let ignored = ignored();
            for signal in [SIGINT, SIGTERM, SIGHUP] {
                if ignored & (1 << (signal - 1)) == 0 {
                    // In this order: the first signal must not find the flag that it sets itself.
                    let _ = flag::register_conditional_shutdown(signal, 128 + signal, noted.armed.clone());
                    let _ = flag::register_usize(signal, noted.signal.clone(), signal as usize);
                    let _ = flag::register(signal, noted.armed.clone());
                }
            }
            noted
        })
    }

    /// The signals that this process ignores, as the system lists them; none where it does not.
    fn ignored() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
    }

    pub fn listen() {
        let noted = noted();
        noted.signal.store(0, Ordering::SeqCst);
        noted.armed.store(false, Ordering::SeqCst);
    }

    pub fn requested() -> Option<Exit> {
        match noted().signal.load(Ordering::SeqCst) as i32 {
            0 => None,
            SIGTERM => Some(Exit::Terminated),
            SIGHUP => Some(Exit::HungUp),
            _ => Some(Exit::Interrupted),
        }
    }
}

#[cfg(not(unix))]
mod elsewhere {
    use std::sync::OnceLock;
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::Exit;

    static REQUESTED: AtomicBool = AtomicBool::new(false);

    pub fn listen() {
        static HANDLER: OnceLock<()> = OnceLock::new();
        REQUESTED.store(false, Ordering::SeqCst);
        // A process has one handler. Where the host of this library has its own already, that one stays.
        HANDLER.get_or_init(|| {
            let _ = ctrlc::try_set_handler(|| {
                if REQUESTED.swap(true, Ordering::SeqCst) {
                    std::process::exit(i32::from(Exit::Interrupted.code()));
                }
            });
        });
    }

    pub fn requested() -> Option<Exit> {
        REQUESTED.load(Ordering::SeqCst).then_some(Exit::Interrupted)
    }
}
