//! Scene files as the command line names them.

use service::exit::{Exit, Failure};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::args::ConfigArgs;
use crate::configuration;

/// Reads a text file that a person has written.
///
/// # Errors
/// The file cannot be read, is too large, or is none.
pub fn read_file(path: &Path) -> Result<String, Failure> {
    config::read_file(path).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge | ErrorKind::InvalidData => {
            Failure::new(Exit::Config, format!("{}: {error}", path.display()))
        }
        _ => Failure::file(path, &error),
    })
}

/// Returns whether the text of a scene file is JSON: it begins with a brace.
pub fn is_json(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with('{')
}

/// Returns whether a path is a name without folder and extension.
pub fn is_word(path: &Path) -> bool {
    path.extension().is_none() && path.components().count() == 1
}

/// Resolves a scene: a name without folder and extension is looked up in the configuration.
///
/// # Errors
/// The scene is unknown, or the configuration is missing.
pub fn path_of(named: &Path, args: &ConfigArgs) -> Result<PathBuf, Failure> {
    if named.is_file() || !is_word(named) {
        return Ok(named.to_owned());
    }
    let scenes = configuration::folder(args)?.join("scenes");
    let path = scenes.join(named).with_extension("toml");
    if path.is_file() {
        return Ok(path);
    }
    let (name, folder) = (named.display(), scenes.display());
    let what = format!("{name}: expected a scene file or the name of a scene in {folder}");
    let help = "name a scene file, or a scene without its folder and extension, e.g. bowls";
    Err(Failure::new(Exit::Config, format!("{what}; help: {help}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_file() {
        let trouble = read_file(Path::new("/nowhere/scene.toml")).unwrap_err();
        assert!(trouble.to_string().starts_with("/nowhere/scene.toml: "));
        let device = read_file(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(device.exit, Exit::Config);
        let what = "/dev/zero: expected a regular file, found a pipe, socket or device";
        assert_eq!(device.to_string(), what);
    }
}
