//! The files of a report, written as an archive or a folder.

use std::io::{self, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use safe_files::{OutputFolder, Readers, check_new_output, write_new_output};
use service::exit::{Exit, Failure};

/// List of the files, in the report itself.
const CONTENTS: &str = "CONTENTS.txt";

/// Most bytes of all files together.
const BYTES_MAX: usize = 256 << 20;

/// Bytes of a header and of a block of a tar archive.
const BLOCK: usize = 512;

/// Files in memory, and the omissions with their reasons.
#[derive(Debug, Default)]
pub(crate) struct Bundle {
    files: Vec<(String, Vec<u8>)>,
    left_out: Vec<(String, String)>,
}

impl Bundle {
    /// Adds a file, or leaves it out if the report would become too large.
    pub(crate) fn add(&mut self, name: impl Into<String>, content: impl Into<Vec<u8>>) {
        let (name, content) = (name.into(), content.into());
        let bytes: usize = self.files.iter().map(|(_, content)| content.len()).sum();
        if bytes.saturating_add(content.len()) > BYTES_MAX {
            let why = format!("{} bytes more would exceed {} MiB", content.len(), BYTES_MAX >> 20);
            return self.leave_out(name, why);
        }
        self.files.push((name, content));
    }

    /// Notes an omission and its reason.
    pub(crate) fn leave_out(&mut self, what: impl Into<String>, why: impl Into<String>) {
        self.left_out.push((what.into(), why.into()));
    }

    /// Names and sizes of the files.
    pub(crate) fn files(&self) -> impl Iterator<Item = (&str, usize)> {
        self.files.iter().map(|(name, content)| (name.as_str(), content.len()))
    }

    /// What is left out, each with its reason.
    pub(crate) fn left_out(&self) -> impl Iterator<Item = (&str, &str)> {
        self.left_out.iter().map(|(what, why)| (what.as_str(), why.as_str()))
    }

    /// Writes an archive if the path ends in `.tar.gz` or `.tgz`, else a folder.
    ///
    /// # Errors
    /// The path exists, or it cannot be written.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Failure> {
        let written = match is_archive(path) {
            true => {
                self.archive(path).and_then(|bytes| write_new_output(path, &bytes, Readers::Owner))
            }
            false => self.write_folder(path),
        };
        written.map_err(|error| Failure::file(path, &error))
    }

    fn contents(&self) -> String {
        let files = self.files().map(|(name, bytes)| format!("{bytes:>9}  {name}\n"));
        let left = self.left_out().map(|(what, why)| format!(" left out  {what}: {why}\n"));
        files.chain(left).collect()
    }

    fn write_folder(&self, path: &Path) -> io::Result<()> {
        let all = self.files.iter().map(|(name, content)| (name.as_str(), content.as_slice()));
        let contents = self.contents();
        for (name, content) in all.chain([(CONTENTS, contents.as_bytes())]) {
            let file = path.join(name);
            let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else { continue };
            OutputFolder::open(folder)?.write_new(name, content, Readers::Owner)?;
        }
        Ok(())
    }

    /// A compressed archive, with everything in one folder of the archive's name.
    fn archive(&self, path: &Path) -> io::Result<Vec<u8>> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let folder = name.trim_end_matches(".gz").trim_end_matches(".tar").trim_end_matches(".tgz");
        let mut packed = GzEncoder::new(Vec::new(), Compression::default());
        let contents = self.contents();
        let all = self.files.iter().map(|(name, content)| (name.as_str(), content.as_slice()));
        for (name, content) in all.chain([(CONTENTS, contents.as_bytes())]) {
            packed.write_all(&header(&format!("{folder}/{name}"), content.len())?)?;
            packed.write_all(content)?;
            packed.write_all(&vec![0; content.len().next_multiple_of(BLOCK) - content.len()])?;
        }
        packed.write_all(&[0; 2 * BLOCK])?;
        packed.finish()
    }
}

fn is_archive(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    [".tar.gz", ".tgz"].iter().any(|ending| name.ends_with(ending))
}

/// Refuses an output that exists: nothing is replaced, and nothing is mixed.
///
/// # Errors
/// It exists, or its folder does not.
pub(crate) fn check_free(path: &Path) -> Result<(), Failure> {
    if path.symlink_metadata().is_ok() {
        let what =
            format!("{}: expected a new file or folder, found one that exists", path.display());
        return Err(Failure::new(
            Exit::Usage,
            format!("{what}; help: name another one with --out"),
        ));
    }
    check_new_output(path).map_err(|error| Failure::file(path, &error))
}

/// The header of a regular file in the format of POSIX (ustar), readable for its owner alone.
fn header(name: &str, len: usize) -> io::Result<[u8; BLOCK]> {
    let mut block = [0_u8; BLOCK];
    let mut put =
        |at: usize, text: &str| block[at..at + text.len()].copy_from_slice(text.as_bytes());
    // Names of more than 100 bytes are divided at a slash.
    let divided = || {
        name.match_indices('/').map(|(at, _)| name.split_at(at)).find(|(_, rest)| rest.len() <= 101)
    };
    let (prefix, rest) = match name.len() {
        0..=100 => ("", name),
        _ => divided().map_or(("", ""), |(prefix, rest)| (prefix, &rest[1..])),
    };
    if rest.is_empty() || prefix.len() > 155 {
        return Err(io::Error::new(
            io::ErrorKind::InvalidFilename,
            format!("{name}: too long a name"),
        ));
    }
    put(0, rest);
    put(100, "0000600\0");
    put(108, "0000000\0");
    put(116, "0000000\0");
    put(124, &format!("{len:011o}\0"));
    put(136, "00000000000\0");
    put(148, "        ");
    put(156, "0");
    put(257, "ustar\x0000");
    put(345, prefix);
    let sum: u32 = block.iter().map(|byte| u32::from(*byte)).sum();
    block[148..156].copy_from_slice(format!("{sum:06o}\0 ").as_bytes());
    Ok(block)
}
