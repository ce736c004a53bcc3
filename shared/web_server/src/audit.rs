//! An audit: who ordered what, one JSON object a line, on the disk before the order is passed on.
//!
//! A thread of its own writes and syncs; what waits meanwhile is synced with one call. A stop is passed on first and
//! recorded then: nothing may delay it.

use std::fmt::Debug;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

use serde::Serialize;
use tokio::sync::oneshot;

/// Size at which a file is full, bytes.
const FILE_BYTES_MAX: u64 = 16 << 20;
/// Files that are kept: together at most 128 MiB, some 600,000 entries.
const FILES_MAX: u32 = 8;
/// Entries that wait for the thread.
const QUEUE: usize = 1_024;

type Job = (Vec<u8>, Option<oneshot::Sender<io::Result<()>>>);

/// The way to the thread that writes.
#[derive(Clone, Debug)]
pub struct Audit(SyncSender<Job>);

impl Audit {
    /// Opens the audit `NAME.jsonl` in a folder; full files become `NAME.1.jsonl` and so on, newest first.
    ///
    /// # Errors
    /// The file or the thread cannot be made.
    pub fn open(folder: &Path, name: &'static str) -> io::Result<Self> {
        let mut log = Log::open(folder, name, FILE_BYTES_MAX)?;
        let (sender, jobs) = sync_channel(QUEUE);
        let write = move || write_all(&mut log, &jobs);
        std::thread::Builder::new().name("audit".into()).spawn(write)?;
        Ok(Self(sender))
    }

    /// Writes an entry; returns once it is on the disk.
    ///
    /// # Errors
    /// It cannot be written: the disk is full, or too much waits.
    pub async fn record(&self, entry: &impl Serialize) -> io::Result<()> {
        let (done, answer) = oneshot::channel();
        self.send(entry, Some(done))?;
        answer.await.map_err(|_| io::Error::other("the audit has ended"))?
    }

    /// Writes an entry soon; returns whether it is on its way. What cannot be written is in the server's log.
    pub fn note(&self, entry: &(impl Serialize + Debug)) -> bool {
        let sent = self.send(entry, None);
        if let Err(error) = &sent {
            tracing::error!(%error, ?entry, "not in the audit");
        }
        sent.is_ok()
    }

    fn send(
        &self,
        entry: &impl Serialize,
        done: Option<oneshot::Sender<io::Result<()>>>,
    ) -> io::Result<()> {
        let mut line = serde_json::to_vec(entry).map_err(io::Error::other)?;
        line.push(b'\n');
        self.0.try_send((line, done)).map_err(|error| match error {
            TrySendError::Full(_) => io::Error::other("too many entries wait for the disk"),
            TrySendError::Disconnected(_) => io::Error::other("the audit has ended"),
        })
    }
}

fn write_all(log: &mut Log, jobs: &Receiver<Job>) {
    while let Ok(first) = jobs.recv() {
        let batch: Vec<Job> = std::iter::once(first).chain(jobs.try_iter()).collect();
        let lines: Vec<u8> = batch.iter().flat_map(|(line, _)| line).copied().collect();
        let written = log.append(&lines);
        if let Err(error) = &written {
            let text = String::from_utf8_lossy(&lines);
            tracing::error!(%error, %text, "not in the audit");
        }
        for done in batch.into_iter().filter_map(|(_, done)| done) {
            let result =
                written.as_ref().map(|_| ()).map_err(|e| io::Error::new(e.kind(), e.to_string()));
            // Its connection may be gone.
            let _ = done.send(result);
        }
    }
}

/// The files.
struct Log {
    name: &'static str,
    path: PathBuf,
    file: File,
    bytes: u64,
    bytes_max: u64,
}

impl Log {
    fn open(folder: &Path, name: &'static str, bytes_max: u64) -> io::Result<Self> {
        let path = folder.join(format!("{name}.jsonl"));
        let (file, bytes) = open(&path)?;
        Ok(Self { name, path, file, bytes, bytes_max })
    }

    fn append(&mut self, lines: &[u8]) -> io::Result<()> {
        if !self.is_in_place()? {
            (self.file, self.bytes) = open(&self.path)?;
        }
        if self.bytes > 0 && self.bytes + lines.len() as u64 > self.bytes_max {
            self.rotate()?;
        }
        let written = self.file.write_all(lines).and_then(|()| self.file.sync_data());
        match written {
            Ok(()) => self.bytes += lines.len() as u64,
            // Half a line would spoil the next one.
            Err(_) => self.file.set_len(self.bytes)?,
        }
        written
    }

    /// Returns whether the open file is the one of this name: someone may have removed or replaced it.
    fn is_in_place(&self) -> io::Result<bool> {
        let identity = |file: fs::Metadata| (file.dev(), file.ino());
        match fs::metadata(&self.path) {
            Ok(found) => Ok(identity(found) == identity(self.file.metadata()?)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }

    fn rotate(&mut self) -> io::Result<()> {
        let name = |number: u32| self.path.with_file_name(format!("{}.{number}.jsonl", self.name));
        safe_files::make_room(FILES_MAX - 1, name)?;
        fs::rename(&self.path, name(1))?;
        (self.file, self.bytes) = open(&self.path)?;
        Ok(())
    }
}

/// Opens a file for its end; a line that a crash has torn is ended.
fn open(path: &Path) -> io::Result<(File, u64)> {
    let mut options = OpenOptions::new();
    let mut file = options.read(true).append(true).create(true).mode(0o600).open(path)?;
    let mut bytes = file.seek(SeekFrom::End(0))?;
    if bytes > 0 {
        let mut last = [0];
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)?;
        if last != *b"\n" {
            file.write_all(b"\n")?;
            bytes += 1;
        }
    }
    Ok((file, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "audit.jsonl";

    #[test]
    fn files_are_rotated_and_torn_lines_ended() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(FILE), "torn").unwrap();
        let mut log = Log::open(folder.path(), "audit", 20).unwrap();
        for number in 0..40 {
            log.append(format!("line {number:04}\n").as_bytes()).unwrap();
        }
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(read(FILE), "line 0039\n");
        assert_eq!(read("audit.1.jsonl"), "line 0037\nline 0038\n");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), FILES_MAX as usize);
        drop(log);
        fs::write(folder.path().join(FILE), "torn").unwrap();
        Log::open(folder.path(), "audit", 20).unwrap().append(b"whole\n").unwrap();
        assert_eq!(read(FILE), "torn\nwhole\n");
    }

    #[test]
    fn file_that_was_removed_or_replaced_is_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(FILE);
        let mut log = Log::open(folder.path(), "audit", 100).unwrap();
        log.append(b"one\n").unwrap();
        fs::remove_file(&path).unwrap();
        log.append(b"two\n").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two\n");
        fs::rename(&path, folder.path().join("moved")).unwrap();
        fs::write(&path, "torn").unwrap();
        log.append(b"three\n").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "torn\nthree\n");
    }

    #[tokio::test]
    async fn recorded_entry_is_in_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let audit = Audit::open(folder.path(), "audit").unwrap();
        for what in ["stop", "resume"] {
            audit.record(&what).await.unwrap();
        }
        let text = fs::read_to_string(folder.path().join(FILE)).unwrap();
        assert_eq!(text.lines().count(), 2);
    }
}
