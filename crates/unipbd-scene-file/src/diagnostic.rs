//! Problems of a scene file as data and as text.

use std::fmt;
use std::io;
use std::ops::Range;
use std::path::PathBuf;

use anstyle::{AnsiColor, Style};

/// Most problems that are printed; the last line counts the others.
const MOST_PRINTED: usize = 40;
/// Longest stretch of a source line that is printed [characters].
const WIDEST: usize = 110;

/// Where a problem comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The scene file, by name.
    File(String),
    /// An override, as written.
    Override(String),
}

/// One problem of a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file or override it is in.
    pub origin: Origin,
    /// Line, from 1; 1 for a problem of the whole file.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The line as written; empty for a problem of the whole file.
    pub source_line: String,
    /// The characters of the line that are at fault, from 0.
    pub caret: Range<usize>,
    /// Path of the key, such as `emitter[0].position`; empty for the whole file and for syntax errors.
    pub key: String,
    /// Description of the fault.
    pub message: String,
    /// Suggestion for the user.
    pub hint: Option<String>,
}

/// A scene file that cannot be used.
#[derive(Debug)]
pub enum SceneFileError {
    /// The file cannot be read.
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The file can be read, but makes no scene.
    Invalid {
        /// Name of the file.
        file: String,
        /// All its problems, by position: first those of the file, then those of overrides.
        problems: Vec<Diagnostic>,
    },
}

impl std::error::Error for SceneFileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            SceneFileError::Io { error, .. } => Some(error),
            SceneFileError::Invalid { .. } => None,
        }
    }
}

impl fmt::Display for SceneFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.render(f, &Palette::default())
    }
}

impl SceneFileError {
    /// An error about the file as a whole.
    pub(super) fn whole_file(file: &str, message: String, hint: &str) -> Self {
        let problem = Diagnostic {
            origin: Origin::File(file.to_owned()),
            line: 1,
            column: 1,
            source_line: String::new(),
            caret: 0..0,
            key: String::new(),
            message,
            hint: Some(hint.to_owned()),
        };
        SceneFileError::Invalid { file: file.to_owned(), problems: vec![problem] }
    }

    /// The problems; none where the file could not be read.
    pub fn problems(&self) -> &[Diagnostic] {
        match self {
            SceneFileError::Io { .. } => &[],
            SceneFileError::Invalid { problems, .. } => problems,
        }
    }

    /// The same text as `Display`, in colour. Meant for a stream that takes colour out where it is
    /// not wanted, such as those of `anstream`.
    pub fn styled(&self) -> impl fmt::Display {
        Styled(self)
    }

    fn render(&self, f: &mut fmt::Formatter<'_>, palette: &Palette) -> fmt::Result {
        match self {
            SceneFileError::Io { path, error } => {
                palette.label(f, palette.error, "error:")?;
                writeln!(f, " cannot read {}: {error}", path.display())
            }
            SceneFileError::Invalid { file, problems } => {
                for problem in problems.iter().take(MOST_PRINTED) {
                    problem.render(f, palette)?;
                    writeln!(f)?;
                }
                let count = problems.len();
                let noun = if count == 1 { "problem" } else { "problems" };
                let more =
                    if count > MOST_PRINTED { format!(", the first {MOST_PRINTED} shown") } else { String::new() };
                palette.label(f, palette.error, &format!("{count} {noun} in {file}{more}"))?;
                writeln!(f)
            }
        }
    }
}

struct Styled<'a>(&'a SceneFileError);

impl fmt::Display for Styled<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bold = |color: AnsiColor| color.on_default().bold();
        let palette =
            Palette { error: bold(AnsiColor::Red), frame: bold(AnsiColor::Blue), hint: bold(AnsiColor::Green) };
        self.0.render(f, &palette)
    }
}

/// Styles of the parts of a message; the default has none.
#[derive(Default)]
struct Palette {
    error: Style,
    frame: Style,
    hint: Style,
}

impl Palette {
    fn label(&self, f: &mut fmt::Formatter<'_>, style: Style, text: &str) -> fmt::Result {
        write!(f, "{style}{text}{style:#}")
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.render(f, &Palette::default())
    }
}

impl Diagnostic {
    fn render(&self, f: &mut fmt::Formatter<'_>, palette: &Palette) -> fmt::Result {
        palette.label(f, palette.error, "error:")?;
        // An unknown key is named by its message.
        if self.key.is_empty() || self.message.starts_with("unknown key") {
            writeln!(f, " {}", self.message)?;
        } else {
            writeln!(f, " {}: {}", self.key, self.message)?;
        }
        let whole = self.source_line.is_empty() && self.line == 1;
        palette.label(f, palette.frame, "  -->")?;
        match &self.origin {
            Origin::File(name) if whole => writeln!(f, " {name}")?,
            Origin::File(name) => writeln!(f, " {name}:{}:{}", self.line, self.column)?,
            Origin::Override(text) => writeln!(f, " --set {}", printable(text))?,
        }
        if !whole {
            self.render_line(f, palette)?;
        }
        if let Some(hint) = &self.hint {
            palette.label(f, palette.hint, "hint:")?;
            writeln!(f, " {hint}")?;
        }
        Ok(())
    }

    fn render_line(&self, f: &mut fmt::Formatter<'_>, palette: &Palette) -> fmt::Result {
        let number = match self.origin {
            Origin::File(_) => self.line.to_string(),
            Origin::Override(_) => String::new(),
        };
        let margin = " ".repeat(number.len().max(3));
        let (text, caret) = self.window();
        let blank: String =
            text.chars().take(caret.start).map(|letter| if letter == '\t' { '\t' } else { ' ' }).collect();
        let marks = "^".repeat(caret.len().max(1));
        palette.label(f, palette.frame, &format!("{margin} |"))?;
        writeln!(f)?;
        palette.label(f, palette.frame, &format!("{number:>3} |"))?;
        writeln!(f, "{}{text}", if text.is_empty() { "" } else { " " })?;
        palette.label(f, palette.frame, &format!("{margin} |"))?;
        write!(f, " {blank}")?;
        palette.label(f, palette.error, &marks)?;
        writeln!(f)
    }

    /// The part of the line around the caret, and the caret within it.
    fn window(&self) -> (String, Range<usize>) {
        let letters: Vec<char> = printable(&self.source_line).chars().collect();
        if letters.len() <= WIDEST {
            return (letters.into_iter().collect(), self.caret.clone());
        }
        let start = self.caret.start.saturating_sub(WIDEST / 2).min(letters.len() - WIDEST);
        let end = start + WIDEST;
        let part: String = letters[start..end].iter().collect();
        let (before, after) = (if start > 0 { "..." } else { "" }, if end < letters.len() { "..." } else { "" });
        let shift = |place: usize| place.clamp(start, end) - start + before.len();
        (format!("{before}{part}{after}"), shift(self.caret.start)..shift(self.caret.end))
    }
}

/// Control characters would upset a terminal; tabs are kept.
pub(super) fn printable(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() && letter != '\t' { '\u{fffd}' } else { letter }).collect()
}
