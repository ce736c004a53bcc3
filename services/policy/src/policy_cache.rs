//! Cache of the planner's decisions on disk, between runs.
//!
//! Decisions are the same with and without it: a file that is missing, torn or of another problem
//! is computed again.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use dialogue::PolicyTable;
use dialogue::manager::Manager;

/// Lets the planner precompute its decisions from a dialogue's usual beginning, or adopts those
/// that an earlier run left in `folder` for the same scene and settings.
pub(crate) fn precompute(manager: &mut Manager, folder: &Path) {
    let path = file(folder, manager.problem().key());
    if let Some(table) = read(&path)
        && manager.adopt(table)
    {
        return;
    }
    if let Some(table) = manager.precompute()
        && let Err(error) = write(&path, table)
    {
        tracing::warn!(path = %path.display(), %error, "cannot cache the policy on disk");
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

/// Replaces the file atomically. A group has one scene at a time: other tables are removed.
fn write(path: &Path, table: &PolicyTable) -> io::Result<()> {
    let mut bytes = postcard::to_stdvec(table).map_err(io::Error::other)?;
    bytes.extend(crc32c::crc32c(&bytes).to_le_bytes());
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
        for entry in fs::read_dir(folder)?.flatten() {
            fs::remove_file(entry.path())?;
        }
    }
    safe_files::replace_private(path, bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::manager_of;

    #[test]
    fn policy_cache_adopts_its_file_and_replaces_a_damaged_one() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("policies");
        let mut first = manager_of("optimal");
        precompute(&mut first, &folder);
        let path = file(&folder, first.problem().key());
        let kept = read(&path).unwrap();
        assert!(kept.len() > 5);
        let mut second = manager_of("optimal");
        precompute(&mut second, &folder);
        assert_eq!(second.table(), Some(&kept));
        let mut bytes = fs::read(&path).unwrap();
        bytes[20] ^= 1;
        fs::write(&path, bytes).unwrap();
        assert_eq!(read(&path), None);
        precompute(&mut second, &folder);
        assert_eq!(read(&path), Some(kept));
    }

    #[test]
    fn policy_cache_writes_no_file_for_planners_without_a_table() {
        let folder = tempfile::tempdir().unwrap();
        precompute(&mut manager_of("lookahead"), folder.path());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
