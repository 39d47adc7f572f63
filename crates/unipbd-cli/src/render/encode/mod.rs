//! Pictures to files: PNG, GIF, and MP4 through `ffmpeg`.

mod gif;
mod mp4;
mod palette;
mod png;

pub use gif::{GifOptions, GifWriter};
pub use mp4::Mp4Writer;
pub use png::{png_bytes, write_png};

use std::path::{Path, PathBuf};

use super::error::RenderError;

/// The name under which a film grows, until it is complete and takes its real name.
fn partial_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".partial");
    path.with_file_name(name)
}

fn write_error(path: &Path) -> impl FnOnce(std::io::Error) -> RenderError {
    let path = path.to_owned();
    move |source| RenderError::Write { path, source }
}
