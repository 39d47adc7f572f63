use std::path::{Path, PathBuf};

use super::error::RenderError;

/// The kind of output that a path asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// One picture.
    Picture(PathBuf),
    /// A numbered picture per frame.
    Pictures(Numbered),
    /// An animation for web pages.
    Gif(PathBuf),
    /// A film, made by `ffmpeg`.
    Mp4(PathBuf),
    /// One picture of vectors, as SVG.
    Svg(PathBuf),
    /// One picture of vectors, as PDF.
    Pdf(PathBuf),
    /// A page that plays the run in a browser.
    Replay(PathBuf),
}

/// Names of numbered pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbered {
    before: String,
    after: String,
    digits: usize,
}

impl Numbered {
    /// The path of picture number `index`.
    pub fn path(&self, index: u64) -> PathBuf {
        PathBuf::from(format!("{}{index:0digits$}{}", self.before, self.after, digits = self.digits))
    }

    /// Finds the one `%d` or `%04d` in a name.
    fn parse(text: &str) -> Option<Numbered> {
        let (before, rest) = text.split_once('%')?;
        let (digits, after) = rest.split_once('d')?;
        let digits = if digits.is_empty() { 1 } else { digits.parse().ok().filter(|digits| *digits <= 12)? };
        let numbered = Numbered { before: before.to_owned(), after: after.to_owned(), digits };
        (!after.contains('%')).then_some(numbered)
    }
}

/// Tells from a path what to write: `NAME.png`, `.svg` or `.pdf` one picture, `NAME_%04d.png` or a directory (one
/// that exists, or a name with a slash at its end) a picture per frame, `NAME.gif`, `NAME.mp4`, `NAME.html`.
pub fn plan_output(path: &Path) -> Result<Output, RenderError> {
    let unknown = || RenderError::Format(path.to_owned());
    let text = path.to_str().ok_or_else(unknown)?;
    if text.ends_with(['/', std::path::MAIN_SEPARATOR]) || path.is_dir() {
        let before = path.join("frame_").to_str().ok_or_else(unknown)?.to_owned();
        return Ok(Output::Pictures(Numbered { before, after: ".png".to_owned(), digits: 4 }));
    }
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    match extension.to_ascii_lowercase().as_str() {
        "png" if text.contains('%') => Numbered::parse(text).map(Output::Pictures).ok_or_else(unknown),
        "png" => Ok(Output::Picture(path.to_owned())),
        "gif" => Ok(Output::Gif(path.to_owned())),
        "mp4" => Ok(Output::Mp4(path.to_owned())),
        "svg" => Ok(Output::Svg(path.to_owned())),
        "pdf" => Ok(Output::Pdf(path.to_owned())),
        "html" => Ok(Output::Replay(path.to_owned())),
        _ => Err(unknown()),
    }
}
