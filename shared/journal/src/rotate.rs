//! Replacement of a journal's file; the old ones are kept as `<name>.1` (the latest) to `<name>.N`.

use std::fs::{self, File};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::Path;

use safe_files::{absent_is_fine, make_room, suffixed};

/// Number of old journals kept.
pub const KEPT: u32 = 4;

/// Steps of a replacement, in order. A crash before any of them leaves either the old or the new
/// journal intact under its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    WriteNew,
    ShiftOld,
    LinkOld,
    Replace,
    SyncFolder,
}

impl Step {
    #[cfg(test)]
    pub(crate) const ALL: [Self; 5] =
        [Self::WriteNew, Self::ShiftOld, Self::LinkOld, Self::Replace, Self::SyncFolder];

    pub(crate) fn doing(self) -> &'static str {
        match self {
            Self::WriteNew => "write the new journal",
            Self::ShiftOld => "number the old journals",
            Self::LinkOld => "keep the old journal",
            Self::Replace => "put the new journal in place",
            Self::SyncFolder => "sync the journal's folder",
        }
    }
}

/// Puts a file with `bytes` in the place of `path`; the old one, if any, becomes `<name>.1`.
/// Returns the new file, open for writing.
///
/// `before` is called before each step and may fail in its stead: tests crash there.
///
/// # Errors
/// The step that failed. Only after a failed [`Step::SyncFolder`] is it unknown which of the two
/// files a power loss leaves.
pub(crate) fn replace(
    path: &Path,
    bytes: &[u8],
    keep: u32,
    mut before: impl FnMut(Step) -> io::Result<()>,
) -> Result<File, (Step, io::Error)> {
    let new = suffixed(path, "new");
    let at = |step| move |error| (step, error);
    let mut enter = |step| before(step).map_err(at(step));

    enter(Step::WriteNew)?;
    let file = write_new(&new, bytes).inspect_err(|_| {
        // On a full disk a part of it would only take space.
        let _ = fs::remove_file(&new);
    });
    let file = file.map_err(at(Step::WriteNew))?;
    enter(Step::ShiftOld)?;
    make_room(keep, |number| suffixed(path, number)).map_err(at(Step::ShiftOld))?;
    enter(Step::LinkOld)?;
    link(path, keep).map_err(at(Step::LinkOld))?;
    enter(Step::Replace)?;
    fs::rename(&new, path).map_err(at(Step::Replace))?;
    enter(Step::SyncFolder)?;
    sync_folder(path).map_err(at(Step::SyncFolder))?;
    Ok(file)
}

/// Removes files left by an unfinished replacement.
pub(crate) fn clear_unfinished(path: &Path) -> io::Result<()> {
    absent_is_fine(fs::remove_file(suffixed(path, "new")))?;
    let old = suffixed(path, "1");
    // A crash between linking and replacing: both names mean the journal that is still in use.
    match (fs::metadata(path), fs::metadata(&old)) {
        (Ok(now), Ok(then)) if now.ino() == then.ino() && now.dev() == then.dev() => {
            fs::remove_file(old)
        }
        _ => Ok(()),
    }
}

/// Removes the old journals.
pub(crate) fn remove_old(path: &Path) -> io::Result<()> {
    (1..=KEPT).try_for_each(|n| absent_is_fine(fs::remove_file(suffixed(path, n))))?;
    sync_folder(path)
}

fn write_new(new: &Path, bytes: &[u8]) -> io::Result<File> {
    absent_is_fine(fs::remove_file(new))?;
    let mut file = File::create_new(new)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    Ok(file)
}

/// Gives the old journal its second name. A copy will do if the file system has no links.
fn link(path: &Path, keep: u32) -> io::Result<()> {
    if keep == 0 {
        return Ok(());
    }
    let old = suffixed(path, "1");
    absent_is_fine(fs::hard_link(path, &old).or_else(|_| fs::copy(path, &old).map(drop)))
}

/// A renamed or new file is only found again after a power loss once its folder is synced.
pub(crate) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    File::open(folder)?.sync_all()
}
