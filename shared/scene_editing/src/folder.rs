//! The scene files of a configuration: read and replaced by name, only within the folder.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use diagnostics::TextFile;
use safe_files::{Draft, Readers};
use scene::StableHash;
use thiserror::Error;

/// Ending of scene files.
const ENDING: &str = "toml";

/// Most letters of a name.
const NAME_MAX: usize = 64;

/// A scene file that is not read or written.
#[derive(Debug, Error)]
pub enum FileError {
    /// The name cannot be that of a file of the folder.
    #[error(
        "scene: `{0}` is not a name; help: use up to {NAME_MAX} letters a to z, digits, `-` and `_`, and begin with a letter or digit"
    )]
    Name(String),
    /// The folder has no scene of the given name.
    #[error("scene: no scene `{0}` in {folder}", folder = .1.display())]
    Missing(String, PathBuf),
    /// There is a scene of this name, which was to be a new one.
    #[error("scene: there is a scene `{0}` already; help: choose another name")]
    Exists(String),
    /// The file is not the one that was read.
    #[error(
        "scene: {file} has changed since it was read; help: open it again, or save under another name", file = .0.display()
    )]
    Changed(PathBuf),
    /// A link or a folder, which is not replaced.
    #[error("scene: {file}: expected a file, found a link, folder or device", file = .0.display())]
    Kind(PathBuf),
    /// The file cannot be read or written.
    #[error("{file}: {1}", file = .0.display())]
    Io(PathBuf, #[source] io::Error),
}

/// Returns a fingerprint of a file's content.
pub fn fingerprint(text: &str) -> String {
    let mut hash = StableHash::default();
    hash.text(text);
    format!("{:016x}", hash.value())
}

/// The folder `scenes` of a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenesFolder(PathBuf);

impl ScenesFolder {
    /// The folder of a configuration folder.
    pub fn of(configuration: &Path) -> Self {
        Self(configuration.join("scenes"))
    }

    /// Returns the folder's path.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Returns the names of its scenes, sorted: those that [`ScenesFolder::file`] accepts.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn names(&self) -> Result<Vec<String>, FileError> {
        let failed = |error| FileError::Io(self.0.clone(), error);
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.0).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let is_scene = path.extension().is_some_and(|ending| ending == ENDING);
            let name = path.file_stem().and_then(|name| name.to_str()).filter(|_| is_scene);
            names.extend(name.filter(|name| is_name(name)).map(str::to_owned));
        }
        names.sort();
        Ok(names)
    }

    /// Returns the path of a scene, whether it exists or not.
    ///
    /// # Errors
    /// The name is not one.
    pub fn file(&self, name: &str) -> Result<PathBuf, FileError> {
        if is_name(name) {
            Ok(self.0.join(name).with_extension(ENDING))
        } else {
            Err(FileError::Name(name.chars().take(NAME_MAX).collect()))
        }
    }

    /// Reads a scene.
    ///
    /// # Errors
    /// The name is invalid, the scene is missing, or it cannot be read.
    pub fn read(&self, name: &str) -> Result<TextFile, FileError> {
        let path = self.file(name)?;
        match config::read_file(&path) {
            Ok(text) => Ok(TextFile::new(path.display().to_string(), text)),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(FileError::Missing(name.to_owned(), self.0.clone()))
            }
            Err(error) => Err(FileError::Io(path, error)),
        }
    }

    /// Writes a scene whole or not at all. `known` is the [`fingerprint`] of the text that it
    /// replaces, `None` for a new scene.
    ///
    /// # Errors
    /// The name is invalid; the file is not that of `known`; it cannot be written and is unchanged.
    pub fn write(&self, name: &str, text: &str, known: Option<&str>) -> Result<(), FileError> {
        let path = self.file(name)?;
        let mode = match fs::symlink_metadata(&path) {
            Ok(found) if !found.is_file() => return Err(FileError::Kind(path)),
            Ok(found) => Some(found.permissions().mode()),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(FileError::Io(path, error)),
        };
        match (mode, known) {
            (Some(_), None) => return Err(FileError::Exists(name.to_owned())),
            (None, Some(_)) => return Err(FileError::Changed(path)),
            (Some(_), Some(known)) if fingerprint(&self.read(name)?.text) != known => {
                return Err(FileError::Changed(path));
            }
            _ => {}
        }
        // A new file may be read by those who may read the folder.
        let folder = || fs::metadata(&self.0).map_or(0o700, |folder| folder.permissions().mode());
        let mode = mode.unwrap_or_else(|| folder() & 0o666);
        let write = || {
            let mut draft = Draft::of(&path, Readers::Mode(mode))?;
            draft.write_all(text.as_bytes())?;
            draft.sync()?;
            // Another program may have made a new one meanwhile: that one stays.
            if known.is_some() { draft.replace() } else { draft.put_if_absent() }
        };
        write().map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => FileError::Exists(name.to_owned()),
            _ => FileError::Io(path, error),
        })
    }
}

fn is_name(name: &str) -> bool {
    let is_letter = |b: u8| b.is_ascii_alphanumeric();
    (1..=NAME_MAX).contains(&name.len())
        && name.bytes().all(|b| is_letter(b) || b == b'-' || b == b'_')
        && name.bytes().next().is_some_and(is_letter)
}

#[cfg(test)]
mod tests {
    use std::fs::Permissions;
    use std::os::unix::fs::symlink;

    use super::*;

    fn folder() -> (tempfile::TempDir, ScenesFolder) {
        let config = tempfile::tempdir().unwrap();
        let folder = ScenesFolder::of(config.path());
        fs::create_dir(folder.path()).unwrap();
        (config, folder)
    }

    #[test]
    fn names_lead_nowhere_else() {
        let (config, folder) = folder();
        for name in ["", ".", "..", "../x", "a/b", "/etc/x", ".x", "-x", "a.b", "a b", "ä", "a\0"]
        {
            assert!(matches!(folder.file(name), Err(FileError::Name(_))), "{name}");
            assert!(folder.write(name, "x", None).is_err(), "{name}");
            assert!(folder.read(name).is_err(), "{name}");
        }
        assert!(folder.file(&"x".repeat(65)).is_err());
        assert_eq!(fs::read_dir(config.path()).unwrap().count(), 1);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn file_is_replaced_by_those_who_know_it() {
        let (_config, folder) = folder();
        folder.write("a-1", "one", None).unwrap();
        fs::set_permissions(folder.file("a-1").unwrap(), Permissions::from_mode(0o640)).unwrap();
        assert!(matches!(folder.write("a-1", "two", None), Err(FileError::Exists(_))));
        folder.write("a-1", "two", Some(&fingerprint("one"))).unwrap();
        let stale = folder.write("a-1", "three", Some(&fingerprint("one")));
        assert!(matches!(stale, Err(FileError::Changed(_))));
        let gone = folder.write("b", "three", Some(&fingerprint("one")));
        assert!(matches!(gone, Err(FileError::Changed(_))));
        assert_eq!(folder.read("a-1").unwrap().text, "two");
        assert!(matches!(folder.read("b"), Err(FileError::Missing(..))));
        let mode = fs::metadata(folder.file("a-1").unwrap()).unwrap().permissions().mode();
        assert_eq!((folder.names().unwrap(), mode & 0o777), (vec!["a-1".to_owned()], 0o640));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn links_and_folders_are_not_replaced() {
        let (config, folder) = folder();
        let other = config.path().join("other.toml");
        fs::write(&other, "other").unwrap();
        symlink(&other, folder.file("link").unwrap()).unwrap();
        fs::create_dir(folder.file("sub").unwrap()).unwrap();
        for name in ["link", "sub"] {
            let refused = folder.write(name, "x", Some(&fingerprint("other")));
            assert!(matches!(refused, Err(FileError::Kind(_))), "{name}: {refused:?}");
        }
        assert_eq!(fs::read_to_string(&other).unwrap(), "other");
    }
}
