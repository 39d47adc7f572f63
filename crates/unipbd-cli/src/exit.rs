//! How a command ends: its exit code and, when it failed, the message for standard error.

use std::process::ExitCode;

/// Exit codes of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// The command did what it was asked to do.
    Success = 0,
    /// A file could not be read or written.
    Io = 1,
    /// The arguments make no sense.
    Usage = 2,
    /// The scene file has errors.
    InvalidScene = 3,
    /// The simulation diverged.
    Diverged = 4,
    /// A `--stop-on` condition was met, or an expectation of a scene does not hold.
    ConditionMet = 5,
    /// The terminal was closed: SIGHUP.
    HungUp = 129,
    /// Ctrl-C.
    Interrupted = 130,
    /// The reader of standard output has seen enough: SIGPIPE.
    PipeClosed = 141,
    /// The system or a person asked the process to end: SIGTERM.
    Terminated = 143,
}

impl Exit {
    /// The number given to the operating system.
    pub const fn code(self) -> u8 {
        self as u8
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit.code())
    }
}

/// Why a command ended before its work was done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The exit code.
    pub exit: Exit,
    /// The message for the user.
    pub message: String,
    /// Whether the message is to be introduced.
    pub label: Label,
}

/// How a message begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Label {
    /// "error:" is put before it.
    Error,
    /// It says itself what it is.
    Own,
    /// There is nothing to say.
    None,
}

impl Failure {
    /// A failure with this exit code and message.
    pub fn new(exit: Exit, message: impl Into<String>) -> Self {
        Failure { exit, message: message.into(), label: Label::Error }
    }

    /// A file could not be read or written.
    pub fn io(message: impl Into<String>) -> Self {
        Failure::new(Exit::Io, message)
    }

    /// The arguments make no sense.
    pub fn usage(message: impl Into<String>) -> Self {
        Failure::new(Exit::Usage, message)
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

/// A closed or failing standard output; the reader of a pipe that has seen enough is no fault to report.
impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        match error.kind() {
            std::io::ErrorKind::BrokenPipe => Failure { label: Label::None, ..Failure::new(Exit::PipeClosed, "") },
            _ => Failure::io(format!("cannot write to standard output: {error}")),
        }
    }
}
