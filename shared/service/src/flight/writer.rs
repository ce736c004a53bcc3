//! The thread that compresses and writes a flight, and the bounded space of a service's flights.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use crossbeam_channel::Receiver;
use flate2::{Compress, Compression, FlushCompress};

use super::reader::Flight;
use super::{FORMAT, FRAME_HEAD, Head, MAGIC, file_name, is_of};
use crate::exit::Failure;
use crate::storage;

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
    /// Deletes the oldest flights of `service` but `current`, which has `bytes`, until there is space for it
    /// to grow.
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

/// Writes a flight anew in as little space as possible: one frame.
///
/// # Errors
/// The file is no flight, or cannot be written.
pub fn pack(path: &Path) -> Result<(), Failure> {
    let content = Flight::open(path)?.content()?;
    let (mut frame, mut compress) = (Vec::new(), Compress::new(Compression::best(), false));
    let sealed = seal(&mut compress, &content, &mut frame);
    let bytes = sealed.map(|()| [&start()[..], &frame].concat());
    let written = bytes.and_then(|bytes| journal::replace_file(path, bytes));
    written.map_err(|error| Failure::file(path, &error))
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

/// Writes one flight.
pub(super) struct Writer {
    ring: Ring,
    service: String,
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
    /// It cannot be created, or there is no space for it.
    pub(super) fn create(ring: Ring, head: &Head) -> io::Result<Self> {
        crate::folders::make_private(&ring.folder).map_err(io::Error::other)?;
        let path = ring.folder.join(file_name(&head.service, head.started_wall_ns));
        ring.make_room(&head.service, &path, 0)?;
        let mut options = OpenOptions::new();
        let mut file = options.write(true).create_new(true).mode(0o600).open(&path)?;
        file.write_all(&start())?;
        let bytes = start().len() as u64;
        Ok(Self {
            ring,
            service: head.service.clone(),
            path,
            file,
            bytes,
            looked_at: 0,
            compress: Compress::new(Compression::fast(), false),
            frame: Vec::new(),
        })
    }

    /// Writes what comes until the flight ends or cannot be written any further.
    pub(super) fn run(mut self, passes: &Receiver<Vec<u8>>) {
        while let Ok(pass) = passes.recv() {
            if let Err(error) = self.write(&pass) {
                let file = self.path.display();
                tracing::warn!(%file, %error, "the recording of this start ends; the service continues");
                return;
            }
        }
    }

    fn write(&mut self, pass: &[u8]) -> io::Result<()> {
        seal(&mut self.compress, pass, &mut self.frame)?;
        self.file.write_all(&self.frame)?;
        self.bytes += self.frame.len() as u64;
        if self.bytes - self.looked_at >= LOOK_EVERY_BYTES {
            self.looked_at = self.bytes;
            self.ring.make_room(&self.service, &self.path, self.bytes)?;
        }
        Ok(())
    }
}
