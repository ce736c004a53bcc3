//! Processes that have opened a device.

use std::fmt;
use std::fs;
use std::io;
use std::os::fd::AsFd;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::Path;

/// Another process that has opened the port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Holder {
    id: u32,
    /// Its program, as far as that can be read.
    program: String,
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (process {})", self.program, self.id)
    }
}

/// Returns another process that has opened the same device. Those of other users cannot be seen without root's rights,
/// nor those of other PID namespaces: `/proc` does not show their files.
///
/// # Errors
/// The device's state cannot be read.
pub(crate) fn holder_of(device: impl AsFd) -> io::Result<Option<Holder>> {
    let own = rustix::fs::fstat(device)?.st_rdev;
    let this = std::process::id();
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    let ids = processes.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let mut others = ids.filter(|id| *id != this);
    Ok(others.find(|id| has_opened(*id, own)).map(|id| Holder { id, program: program_of(id) }))
}

/// Processes may end meanwhile, and those of other users cannot be looked into: neither has opened it.
fn has_opened(process: u32, device: u64) -> bool {
    let files = fs::read_dir(format!("/proc/{process}/fd")).into_iter().flatten().flatten();
    files.map(|file| file.path()).any(|file| is_of(&file, device))
}

fn is_of(file: &Path, device: u64) -> bool {
    // A file elsewhere may be on a network that does not answer.
    let is_device = fs::read_link(file).is_ok_and(|path| path.starts_with("/dev"));
    is_device
        && fs::metadata(file).is_ok_and(|it| it.file_type().is_char_device() && it.rdev() == device)
}

fn program_of(process: u32) -> String {
    let name = fs::read_to_string(format!("/proc/{process}/comm")).unwrap_or_default();
    if name.trim().is_empty() { "unknown".to_owned() } else { name.trim().to_owned() }
}
