//! Inputs as a sequence of values, and as a file.

use std::fs::File;
use std::io::Write;
use std::os::fd::AsRawFd;
use std::path::{Path, PathBuf};

/// The unread rest of an input. Beyond its end there are zeros.
pub(super) struct Input<'a>(pub(super) &'a [u8]);

impl<'a> Input<'a> {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn byte(&mut self) -> u8 {
        self.array::<1>()[0]
    }

    pub(super) fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.array())
    }

    pub(super) fn array<const N: usize>(&mut self) -> [u8; N] {
        let mut array = [0; N];
        let taken = self.take(N);
        array[..taken.len()].copy_from_slice(taken);
        array
    }

    /// At most `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(count.min(self.0.len()));
        self.0 = rest;
        taken
    }

    /// Overwrites bytes of `target`: a count, then a place, a length and the bytes for each patch.
    pub(super) fn patch(&mut self, target: &mut [u8]) {
        for _ in 0..self.byte() % 8 {
            let at = usize::from(self.u16()) % target.len().max(1);
            let count = usize::from(self.byte() % 16);
            let patch = self.take(count);
            let end = (at + patch.len()).min(target.len());
            target[at..end].copy_from_slice(&patch[..end - at]);
        }
    }
}

/// A file in memory, for readers that open a path.
pub(super) struct MemoryFile {
    file: File,
}

impl MemoryFile {
    pub(super) fn new(bytes: &[u8]) -> Self {
        let flags = rustix::fs::MemfdFlags::CLOEXEC;
        let file = rustix::fs::memfd_create("fuzz", flags).expect("memory for a file");
        let mut file = File::from(file);
        file.write_all(bytes).expect("memory for a file");
        Self { file }
    }

    pub(super) fn path(&self) -> PathBuf {
        Path::new("/proc/self/fd").join(self.file.as_raw_fd().to_string())
    }
}

/// An input that starts with a choice.
pub(super) fn chosen(choice: u8, rest: impl AsRef<[u8]>) -> Vec<u8> {
    [&[choice], rest.as_ref()].concat()
}

/// A file of the project, by its path from the top.
pub(super) fn project_file(path: &str) -> Vec<u8> {
    let top = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    std::fs::read(top.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}
