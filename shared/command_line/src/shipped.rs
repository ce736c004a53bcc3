//! The configuration that is built in: written out on request, and if no other one is found.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use safe_files::{OutputFolder, Readers, TemporaryFolder};
use scene::StableHash;
use service::exit::{Exit, Failure};
use service::folders::make_private;

/// Files by their path in the folder of the configuration, and their text.
pub type Files = &'static [(&'static str, &'static str)];

static FILES: OnceLock<Files> = OnceLock::new();

/// Prefix of the built-in configuration's folder; a group's name has no dot.
const FOLDER: &str = "built-in.";

/// Makes the files known to the verbs; the first call counts.
pub fn provide(files: Files) {
    let _ = FILES.set(files);
}

fn files() -> Files {
    FILES.get().copied().unwrap_or_default()
}

/// Writes the built-in configuration into a folder, which is created; returns the number of files.
///
/// # Errors
/// One of the files is there already, and nothing is written; or one cannot be written.
pub fn write_into(folder: &Path) -> Result<usize, Failure> {
    write_files(files(), folder)
}

fn write_files(files: Files, folder: &Path) -> Result<usize, Failure> {
    if let Some((there, _)) = files.iter().find(|(path, _)| folder.join(path).exists()) {
        let what = format!("{}: expected a folder without it", folder.join(there).display());
        let help = "nothing was written; name another folder, or move this one away first";
        return Err(Failure::new(Exit::Usage, format!("{what}; help: {help}")));
    }
    for (path, text) in files {
        let file = folder.join(path);
        let (Some(parent), Some(name)) = (file.parent(), file.file_name()) else { continue };
        OutputFolder::open(parent)
            .and_then(|folder| folder.write_new(name, text.as_bytes(), Readers::AsBefore))
            .map_err(|error| Failure::file(&file, &error))?;
    }
    Ok(files.len())
}

/// Returns the folder of the built-in configuration below the folder of the groups, `home`; it is
/// written at the first request. Each build has a folder of its own, so that user changes in one
/// are never replaced. `None` if nothing is built in.
///
/// # Errors
/// It cannot be written.
pub fn folder(home: &Path) -> Result<Option<PathBuf>, Failure> {
    folder_of(files(), home)
}

fn folder_of(files: Files, home: &Path) -> Result<Option<PathBuf>, Failure> {
    if files.is_empty() {
        return Ok(None);
    }
    let mut hash = StableHash::default();
    for (path, text) in files {
        hash.text(path);
        hash.text(text);
    }
    let version = build_info::VERSION;
    let folder = home.join(format!("{FOLDER}{version}-{:08x}", hash.value() >> 32));
    if folder.is_dir() {
        return Ok(Some(folder));
    }
    make_private(home).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
    // Whole or not at all, and only once if several processes start.
    let failed = |error: io::Error| Failure::file(&folder, &error);
    let part = TemporaryFolder::within(home).map_err(failed)?;
    write_files(files, part.path())?;
    match part.keep_as(&folder) {
        Err(error) if was_first(&error) && folder.is_dir() => {}
        kept => kept.map_err(failed)?,
    }
    Ok(Some(folder))
}

/// Another process has put the folder in place.
fn was_first(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::AlreadyExists | ErrorKind::DirectoryNotEmpty)
}

/// Returns true for the folder of a built-in configuration, where new files would be hidden.
pub fn is_built_in(folder: &Path) -> bool {
    let name = folder.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| name.starts_with(FOLDER))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const TWO: Files = &[("group.toml", "scene = 'x'"), ("scenes/x.toml", "name = 'x'")];

    #[test]
    fn files_are_written_once_and_never_over_others() {
        let top = tempfile::tempdir().unwrap();
        let folder = top.path().join("a/mine");
        assert_eq!(write_files(TWO, &folder).unwrap(), 2);
        assert_eq!(fs::read_to_string(folder.join("scenes/x.toml")).unwrap(), "name = 'x'");
        fs::remove_file(folder.join("group.toml")).unwrap();
        fs::write(folder.join("scenes/x.toml"), "mine").unwrap();
        let refused = write_files(TWO, &folder).unwrap_err();
        assert_eq!(refused.exit, Exit::Usage);
        assert!(refused.to_string().contains("scenes/x.toml"), "{refused}");
        assert!(!folder.join("group.toml").exists(), "nothing was written");
        assert_eq!(fs::read_to_string(folder.join("scenes/x.toml")).unwrap(), "mine");
    }

    #[test]
    fn folder_of_a_build_is_written_once_and_kept_as_it_is() {
        let home = tempfile::tempdir().unwrap();
        let folder = folder_of(TWO, home.path()).unwrap().unwrap();
        assert!(is_built_in(&folder) && !is_built_in(home.path()));
        fs::write(folder.join("group.toml"), "changed").unwrap();
        assert_eq!(folder_of(TWO, home.path()).unwrap().unwrap(), folder);
        assert_eq!(fs::read_to_string(folder.join("group.toml")).unwrap(), "changed");
        let other = folder_of(&[("group.toml", "scene = 'y'")], home.path()).unwrap().unwrap();
        assert_ne!(other, folder);
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 2, "no parts are left");
        assert_eq!(folder_of(&[], home.path()).unwrap(), None);
    }
}
