//! Search for the programs of commands.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use rustix::fs::{Access, access};
use thiserror::Error;

use crate::launch;

/// A command has no program that can be run.
#[derive(Debug, Error)]
pub enum ProgramError {
    /// Empty command.
    #[error("the command is empty")]
    Empty,
    /// Program not found.
    #[error("{0}: no such program")]
    Missing(String),
    /// The program may not be run.
    #[error("{}: not an executable file", .0.display())]
    NotExecutable(PathBuf),
}

/// The path of a command's program: searched for next to this program and in `PATH` if it has no
/// slash, else taken as seen from `directory`. If absent, the `whichone` next to it may run it.
///
/// # Errors
/// There is none, or it cannot be executed.
pub fn find_program(command: &[String], directory: &Path) -> Result<PathBuf, ProgramError> {
    let program = command.first().filter(|name| !name.is_empty()).ok_or(ProgramError::Empty)?;
    if program.contains('/') {
        let path = directory.join(program);
        return match path.metadata() {
            Ok(meta) if meta.is_file() && is_executable(&path) => Ok(path),
            Ok(_) => Err(ProgramError::NotExecutable(path)),
            Err(_) if launch::host_of(&path).is_some() => Ok(path),
            Err(_) => Err(ProgramError::Missing(path.display().to_string())),
        };
    }
    let own = std::env::current_exe().ok();
    let beside = own.and_then(|own| Some(own.parent()?.join(program)));
    let path = std::env::var_os("PATH").unwrap_or_default();
    beside
        .filter(|path| is_program(path) || launch::host_of(path).is_some())
        .or_else(|| search(program, &path))
        .ok_or_else(|| ProgramError::Missing(program.clone()))
}

fn search(program: &str, path: &OsStr) -> Option<PathBuf> {
    std::env::split_paths(path)
        .map(|folder| folder.join(program))
        .find(|candidate| is_program(candidate))
}

fn is_program(path: &Path) -> bool {
    path.is_file() && is_executable(path)
}

fn is_executable(path: &Path) -> bool {
    access(path, Access::EXEC_OK).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(command: &[&str], directory: &Path) -> Result<PathBuf, ProgramError> {
        let command: Vec<String> = command.iter().map(|&part| part.into()).collect();
        find_program(&command, directory)
    }

    #[test]
    fn programs_beside_our_own_need_no_path() {
        let own = std::env::current_exe().unwrap();
        let name = own.file_name().unwrap().to_str().unwrap();
        assert_eq!(find(&[name], Path::new("/")).unwrap(), own);
    }

    #[test]
    fn program_lookup_follows_shell_rules() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("plain"), "").unwrap();
        let anywhere = Path::new("/");
        assert_eq!(find(&["/bin/sh"], anywhere).unwrap(), Path::new("/bin/sh"));
        assert_eq!(find(&["bin/sh", "-c"], anywhere).unwrap(), Path::new("/bin/sh"));
        assert!(find(&["sh"], anywhere).unwrap().is_absolute());
        assert!(matches!(find(&[], anywhere), Err(ProgramError::Empty)));
        assert!(matches!(find(&[""], anywhere), Err(ProgramError::Empty)));
        assert!(matches!(find(&["no-such-program"], anywhere), Err(ProgramError::Missing(_))));
        assert!(matches!(find(&["./none"], anywhere), Err(ProgramError::Missing(_))));
        let found = find(&["./plain"], folder.path());
        assert!(matches!(found, Err(ProgramError::NotExecutable(_))), "{found:?}");
        std::fs::write(folder.path().join("whichone"), "").unwrap();
        let hosted = folder.path().join("./whichone-arm");
        assert_eq!(find(&["./whichone-arm"], folder.path()).unwrap(), hosted);
    }
}
