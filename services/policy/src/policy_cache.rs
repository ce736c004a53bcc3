//! The planner's decisions, kept on disk between runs.
//!
//! They are a cache and nothing more: a file that is missing, torn or of another problem is worked
//! out again, and what is decided is the same with and without it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use dialogue::PolicyTable;

use crate::mind::Mind;

/// Has the planner work ahead from a dialogue's usual beginning, or takes what an earlier run
/// worked out for the same scene and settings. Keeps the result in `folder`.
pub(crate) fn work_ahead(mind: &mut Mind, folder: &Path) {
    let path = file(folder, mind.problem().key());
    if let Some(table) = read(&path)
        && mind.adopt(table)
    {
        return;
    }
    if let Some(table) = mind.prepare()
        && let Err(error) = write(&path, table)
    {
        tracing::warn!(path = %path.display(), %error, "the policy is not kept on disk");
    }
}

fn file(folder: &Path, problem: u64) -> PathBuf {
    folder.join(format!("{problem:016x}.policy"))
}

fn read(path: &Path) -> Option<PolicyTable> {
    let bytes = fs::read(path).ok()?;
    let (body, sum) = bytes.split_last_chunk::<4>()?;
    (crc32c::crc32c(body) == u32::from_le_bytes(*sum)).then_some(())?;
    postcard::from_bytes(body).ok()
}

/// Writes beside and renames, so that nobody ever reads half a file. A group has one scene at a
/// time, so the tables of others are removed.
fn write(path: &Path, table: &PolicyTable) -> io::Result<()> {
    let mut bytes = postcard::to_stdvec(table).map_err(io::Error::other)?;
    bytes.extend(crc32c::crc32c(&bytes).to_le_bytes());
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
        for entry in fs::read_dir(folder)?.flatten() {
            fs::remove_file(entry.path())?;
        }
    }
    let beside = path.with_extension("new");
    fs::write(&beside, bytes)?;
    fs::rename(beside, path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::mind_of;

    #[test]
    fn what_is_kept_is_taken_and_nonsense_is_worked_out_again() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("policies");
        let mut first = mind_of("optimal");
        work_ahead(&mut first, &folder);
        let path = file(&folder, first.problem().key());
        let kept = read(&path).unwrap();
        assert!(kept.len() > 5);
        let mut second = mind_of("optimal");
        work_ahead(&mut second, &folder);
        assert_eq!(second.table(), Some(&kept));
        let mut bytes = fs::read(&path).unwrap();
        bytes[20] ^= 1;
        fs::write(&path, bytes).unwrap();
        assert_eq!(read(&path), None);
        work_ahead(&mut second, &folder);
        assert_eq!(read(&path), Some(kept));
    }

    #[test]
    fn planners_without_a_table_leave_no_file() {
        let folder = tempfile::tempdir().unwrap();
        work_ahead(&mut mind_of("lookahead"), folder.path());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
