use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;

use super::super::error::RenderError;
use super::super::image::Image;
use super::{partial_path, write_error};

/// Pipes frames into `ffmpeg`, which writes an MP4 file.
pub struct Mp4Writer {
    path: PathBuf,
    size: (u32, u32),
    child: Child,
    /// Reads what `ffmpeg` complains about, lest it wait for us.
    complaints: Option<JoinHandle<String>>,
}

impl Mp4Writer {
    /// Starts the program (normally `ffmpeg`) for frames of the size of `first`; adds no frame yet.
    pub fn new(path: &Path, fps: f64, first: &Image, program: &Path) -> Result<Mp4Writer, RenderError> {
        let size = (first.width(), first.height());
        let mut child = Command::new(program)
            .args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pixel_format", "rgba"])
            .args(["-video_size", &format!("{}x{}", size.0, size.1), "-framerate", &format!("{fps:.6}")])
            .args(["-i", "-", "-an", "-c:v", "libx264", "-preset", "medium", "-crf", "18"])
            .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"])
            .arg(partial_path(path))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| match error.kind() {
                std::io::ErrorKind::NotFound => RenderError::NoFfmpeg(program.to_owned()),
                _ => RenderError::Write { path: program.to_owned(), source: error },
            })?;
        let complaints = child.stderr.take().map(|mut pipe| {
            std::thread::spawn(move || {
                let mut text = Vec::new();
                // A broken pipe ends the text; there is nothing else to do about it.
                let _ = pipe.read_to_end(&mut text);
                String::from_utf8_lossy(&text).trim().to_owned()
            })
        });
        Ok(Mp4Writer { path: path.to_owned(), size, child, complaints })
    }

    /// Adds a frame; all must have the same size.
    pub fn push(&mut self, image: &Image) -> Result<(), RenderError> {
        if (image.width(), image.height()) != self.size {
            return Err(RenderError::PictureSize { width: image.width(), height: image.height() });
        }
        let Some(pipe) = &mut self.child.stdin else { return Err(self.failure()) };
        pipe.write_all(image.rgba()).map_err(|_| self.failure())
    }

    /// Waits until the file is complete.
    pub fn finish(mut self) -> Result<(), RenderError> {
        drop(self.child.stdin.take());
        let status = self.child.wait().map_err(write_error(&self.path))?;
        if !status.success() {
            return Err(self.failure());
        }
        std::fs::rename(partial_path(&self.path), &self.path).map_err(write_error(&self.path))
    }

    fn failure(&mut self) -> RenderError {
        drop(self.child.stdin.take());
        let status = self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
        let said = self.complaints.take().and_then(|thread| thread.join().ok()).unwrap_or_default();
        RenderError::Ffmpeg(if said.is_empty() { status } else { said })
    }
}

impl Drop for Mp4Writer {
    fn drop(&mut self) {
        // After `finish` this finds nothing to do; after a failure it leaves no half film behind.
        drop(self.child.stdin.take());
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_file(partial_path(&self.path));
    }
}
