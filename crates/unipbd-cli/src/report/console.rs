//! Data to standard output, messages to standard error.

use std::fmt::Display;
use std::io::{self, Write};

use anstyle::{AnsiColor, Style};
use serde::Serialize;

use super::clean::clean;
use crate::args::OutputArgs;

/// How many messages are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verbosity {
    /// Errors only.
    Quiet,
    /// Progress, warnings, a summary.
    Normal,
    /// Everything, timings too.
    Verbose,
}

/// The form of the data on standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// For people.
    Text,
    /// One JSON object a line.
    Json,
}

/// Standard output and standard error with the settings of the user.
#[derive(Clone, Copy, Debug)]
pub struct Console {
    /// How many messages are printed.
    pub verbosity: Verbosity,
    /// The form of the data.
    pub form: Form,
}

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();

impl Console {
    /// A console with the settings of the arguments.
    pub fn new(arguments: &OutputArgs) -> Self {
        let verbosity = match (arguments.quiet, arguments.verbose) {
            (true, _) => Verbosity::Quiet,
            (false, true) => Verbosity::Verbose,
            (false, false) => Verbosity::Normal,
        };
        Console { verbosity, form: if arguments.json { Form::Json } else { Form::Text } }
    }

    /// Prints an error, always.
    pub fn error(&self, message: impl Display) {
        to_stderr(format_args!("{ERROR}error:{ERROR:#} {}", shown(message)));
    }

    /// Prints an error that says itself what it is, always.
    pub fn raw(&self, message: impl Display) {
        to_stderr(format_args!("{message}"));
    }

    /// Prints a warning unless quiet.
    pub fn warning(&self, message: impl Display) {
        if self.verbosity > Verbosity::Quiet {
            to_stderr(format_args!("{WARNING}warning:{WARNING:#} {}", shown(message)));
        }
    }

    /// Prints a message unless quiet.
    pub fn note(&self, message: impl Display) {
        if self.verbosity > Verbosity::Quiet {
            to_stderr(format_args!("{}", shown(message)));
        }
    }

    /// Prints a message when verbose.
    pub fn detail(&self, message: impl Display) {
        if self.verbosity == Verbosity::Verbose {
            to_stderr(format_args!("{}", shown(message)));
        }
    }

    /// Prints lines of data.
    pub fn line(&self, text: impl Display) -> io::Result<()> {
        self.print(shown(text))
    }

    fn print(&self, text: impl Display) -> io::Result<()> {
        let mut output = anstream::stdout().lock();
        writeln!(output, "{text}")?;
        output.flush()
    }

    /// Prints an object as one line of JSON; numbers that are not finite become null.
    pub fn object(&self, value: &impl Serialize) -> io::Result<()> {
        self.print(serde_json::to_string(value)?)
    }
}

/// A message without control characters: names come from files.
fn shown(message: impl Display) -> String {
    clean(&message.to_string()).into_owned()
}

/// A closed standard error is no reason to fail: there is nobody left to tell.
fn to_stderr(message: std::fmt::Arguments<'_>) {
    let _ = writeln!(anstream::stderr().lock(), "{message}");
}
