//! Ctrl-C: the first one asks for an orderly end, the second one ends the process at once.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Exit;

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C is noted in [`requested`] and does not end the process.
///
/// A process has one handler. Where the host of this library has its own already, that one stays.
pub fn listen() {
    static HANDLER: OnceLock<()> = OnceLock::new();
    REQUESTED.store(false, Ordering::SeqCst);
    HANDLER.get_or_init(|| {
        let _ = ctrlc::try_set_handler(on_signal);
    });
}

/// Whether Ctrl-C was pressed since [`listen`].
pub fn requested() -> bool {
    REQUESTED.load(Ordering::SeqCst)
}

fn on_signal() {
    if REQUESTED.swap(true, Ordering::SeqCst) {
        std::process::exit(i32::from(Exit::Interrupted.code()));
    }
}
