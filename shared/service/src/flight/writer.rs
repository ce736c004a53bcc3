//! The thread that compresses and writes a flight, and the bounded space of a service's flights.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crossbeam_channel::Receiver;
use flate2::{Compress, Compression, FlushCompress};

use super::reader::Flight;
use super::{FORMAT, FRAME_HEAD, MAGIC, file_name, is_of};
use crate::exit::Failure;
use crate::storage;

/// Share of the space of all flights at which another file may begin.
const FILES_MIN: u64 = 8;
/// Growth between two looks at the space, bytes.
const LOOK_EVERY_BYTES: u64 = 1 << 20;

/// The space of one service's flights.
#[derive(Clone, Debug)]
pub struct Ring {
    /// Folder of the flights.
    pub folder: PathBuf,
    /// Size of all flights of the service together, bytes: the oldest are deleted.
    pub bytes_max: u64,
    /// Space that stays free on the disk, bytes.
    pub free_min: u64,
}

impl Ring {
    /// Creates the file of a flight that starts at this time.
    fn new_file(&self, service: &str, started_wall_ns: u64) -> io::Result<(PathBuf, File)> {
        let path = self.folder.join(file_name(service, started_wall_ns));
        self.make_room(service, &path, 0)?;
        let mut options = OpenOptions::new();
        let mut file = options.write(true).create_new(true).mode(0o600).open(&path)?;
        file.write_all(&start())?;
        Ok((path, file))
    }

    /// Deletes the oldest flights of `service` but `current`, which has `bytes`, until there is
    /// space for it to grow.
    ///
    /// # Errors
    /// There is none.
    fn make_room(&self, service: &str, current: &Path, bytes: u64) -> io::Result<()> {
        let wanted = bytes + LOOK_EVERY_BYTES;
        let mut others = Vec::new();
        for entry in fs::read_dir(&self.folder)?.flatten() {
            let path = entry.path();
            if path != current && is_of(&path, service) {
                others.push((path, entry.metadata()?.len()));
            }
        }
        others.sort();
        let mut total = wanted + others.iter().map(|(_, bytes)| bytes).sum::<u64>();
        for (path, bytes) in others {
            if total <= self.bytes_max {
                break;
            }
            fs::remove_file(path)?;
            total -= bytes;
        }
        if wanted > self.bytes_max {
            let mib = self.bytes_max >> 20;
            return Err(io::Error::other(format!("it has reached flight.mib_max = {mib}")));
        }
        match storage::free_bytes(&self.folder) {
            Some(free) if free < self.free_min => {
                let (free, least) = (free >> 20, self.free_min >> 20);
                let what = format!("{free} MiB are free, below flight.free_min_mib = {least}");
                Err(io::Error::other(what))
            }
            _ => Ok(()),
        }
    }
}

/// Rewrites a flight in as little space as possible: one frame.
///
/// # Errors
/// The file is not a flight, or cannot be written.
pub fn pack(path: &Path) -> Result<(), Failure> {
    let bytes = file_of(&Flight::open(path)?.content()?);
    let written =
        bytes.and_then(|bytes| safe_files::replace(path, bytes, safe_files::Readers::AsBefore));
    written.map_err(|error| Failure::file(path, &error))
}

/// Returns the file of a stream, as one frame.
///
/// # Errors
/// The stream cannot be compressed.
pub fn file_of(stream: &[u8]) -> io::Result<Vec<u8>> {
    let (mut frame, mut compress) = (Vec::new(), Compress::new(Compression::best(), false));
    seal(&mut compress, stream, &mut frame)?;
    Ok([&start()[..], &frame].concat())
}

/// First bytes of a file.
fn start() -> Vec<u8> {
    [&MAGIC[..], &FORMAT.to_le_bytes()].concat()
}

/// Makes a frame of a part of the stream.
fn seal(compress: &mut Compress, part: &[u8], frame: &mut Vec<u8>) -> io::Result<()> {
    frame.clear();
    frame.resize(FRAME_HEAD, 0);
    let begin = compress.total_in();
    loop {
        let done = (compress.total_in() - begin) as usize;
        frame.reserve(64 + (part.len() - done) / 2);
        compress
            .compress_vec(&part[done..], frame, FlushCompress::Sync)
            .map_err(io::Error::other)?;
        let is_consumed = (compress.total_in() - begin) as usize == part.len();
        if is_consumed && frame.len() < frame.capacity() {
            break;
        }
    }
    let content = &frame[FRAME_HEAD..];
    let (len, crc) = (content.len() as u32, crc32c::crc32c(content));
    frame[..4].copy_from_slice(&len.to_le_bytes());
    frame[4..FRAME_HEAD].copy_from_slice(&crc.to_le_bytes());
    Ok(())
}

/// Work for the writer, in order.
#[derive(Debug)]
pub(super) enum Job {
    /// A part of the stream: whole passes.
    Passes(Vec<u8>),
    /// Another file, which begins at this time, nanoseconds since 1970.
    Begin(u64),
}

/// Writes the flights of one start.
pub(super) struct Writer {
    ring: Ring,
    service: String,
    /// Number of the current file, counted from 0, and the number of long ones.
    files: u64,
    long_files: Arc<AtomicU64>,
    path: PathBuf,
    file: File,
    bytes: u64,
    looked_at: u64,
    compress: Compress,
    frame: Vec<u8>,
}

impl Writer {
    /// Creates the file.
    ///
    /// # Errors
    /// The file cannot be created, or space is short.
    pub(super) fn create(
        ring: Ring,
        service: String,
        started_wall_ns: u64,
        long_files: Arc<AtomicU64>,
    ) -> io::Result<Self> {
        crate::folders::make_private(&ring.folder).map_err(io::Error::other)?;
        let (path, file) = ring.new_file(&service, started_wall_ns)?;
        let bytes = start().len() as u64;
        Ok(Self {
            ring,
            service,
            files: 0,
            long_files,
            path,
            file,
            bytes,
            looked_at: 0,
            compress: Compress::new(Compression::fast(), false),
            frame: Vec::new(),
        })
    }

    /// Writes incoming entries until the flight ends or cannot be written any further.
    pub(super) fn run(mut self, jobs: &Receiver<Job>) {
        while let Ok(job) = jobs.recv() {
            let done = match job {
                Job::Passes(passes) => self.write(&passes),
                Job::Begin(wall_ns) => self.begin(wall_ns),
            };
            if let Err(error) = done {
                let file = self.path.display();
                tracing::warn!(%file, %error, "the recording of this start ends; the service continues");
                return;
            }
        }
    }

    /// Continues in another file.
    fn begin(&mut self, wall_ns: u64) -> io::Result<()> {
        (self.path, self.file) = self.ring.new_file(&self.service, wall_ns)?;
        (self.bytes, self.looked_at) = (start().len() as u64, 0);
        self.files += 1;
        self.compress.reset();
        Ok(())
    }

    fn write(&mut self, passes: &[u8]) -> io::Result<()> {
        seal(&mut self.compress, passes, &mut self.frame)?;
        self.file.write_all(&self.frame)?;
        self.bytes += self.frame.len() as u64;
        if self.bytes >= self.ring.bytes_max / FILES_MIN {
            self.long_files.store(self.files + 1, Ordering::Relaxed);
        }
        if self.bytes - self.looked_at >= LOOK_EVERY_BYTES {
            self.looked_at = self.bytes;
            self.ring.make_room(&self.service, &self.path, self.bytes)?;
        }
        Ok(())
    }
}
