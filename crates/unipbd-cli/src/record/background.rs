use std::io::{self, Write};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::encode::EncodedFrame;
use super::error::mcap_cause;
use super::writer::{LogWriter, Totals};

/// Frames that may wait for the writer. None: a frame is handed over once the one before is written, so that a run that
/// is killed loses at most one of those that it has told of.
const WAITING_FRAMES: usize = 0;

/// Compresses and writes frames on a thread of its own, in the order they come.
pub(crate) struct Background {
    frames: Option<SyncSender<EncodedFrame>>,
    spent: Receiver<EncodedFrame>,
    worker: Option<JoinHandle<io::Result<Totals>>>,
}

impl Background {
    pub(crate) fn start<W: Write + Send + 'static>(writer: LogWriter<W>) -> io::Result<Self> {
        let (frames, incoming) = sync_channel(WAITING_FRAMES);
        // Never full: at most one frame being written and one being encoded exist.
        let (done, spent) = sync_channel(WAITING_FRAMES + 2);
        let worker = std::thread::Builder::new()
            .name("log writer".to_owned())
            .spawn(move || write_all(writer, &incoming, &done).map_err(mcap_cause))?;
        Ok(Background { frames: Some(frames), spent, worker: Some(worker) })
    }

    /// Memory for the next frame: that of a written one where there is one.
    pub(crate) fn spare_frame(&self) -> EncodedFrame {
        self.spent.try_recv().unwrap_or_default()
    }

    /// Hands a frame over; where the writer has failed, says why.
    pub(crate) fn send(&mut self, frame: EncodedFrame) -> io::Result<()> {
        let accepted = self.frames.as_ref().is_some_and(|frames| frames.send(frame).is_ok());
        if accepted { Ok(()) } else { self.finish().map(|_| ()) }
    }

    /// Waits until everything is written and the log is closed.
    pub(crate) fn finish(&mut self) -> io::Result<Totals> {
        drop(self.frames.take());
        match self.worker.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(_)) => Err(io::Error::other("the log writer broke down")),
            None => Err(io::Error::other("an earlier error ended the log")),
        }
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        if self.worker.is_some() {
            let _ = self.finish();
        }
    }
}

fn write_all<W: Write>(
    mut writer: LogWriter<W>,
    incoming: &Receiver<EncodedFrame>,
    done: &SyncSender<EncodedFrame>,
) -> mcap::McapResult<Totals> {
    for frame in incoming {
        writer.write(&frame)?;
        let _ = done.try_send(frame);
    }
    writer.finish()
}
