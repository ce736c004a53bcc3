//! Scene files, in TOML or JSON.

use service::exit::{Exit, Failure};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use diagnostics::{Diagnostic, Diagnostics};
use scene::Scene;

use crate::args::ConfigArgs;
use crate::configuration;

/// Reads a scene file: JSON if the text begins with a brace, else TOML.
///
/// # Errors
/// The file cannot be read, or every problem of its text.
pub fn load(path: &Path) -> Result<Scene, Failure> {
    let text = read_file(path)?;
    Ok(read(&path.display().to_string(), &text)?)
}

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

/// Reads a scene given by its file or by its name in the configuration.
///
/// # Errors
/// The scene is unknown, the file cannot be read, or every problem of its text.
pub fn load_named(named: &Path, args: &ConfigArgs) -> Result<Scene, Failure> {
    load(&path_of(named, args)?)
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

fn read(file: &str, text: &str) -> Result<Scene, Diagnostics> {
    if !is_json(text) {
        return Scene::from_toml(file, text);
    }
    let json = serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|error| {
        let line = u32::try_from(error.line()).ok();
        Diagnostic::new(file, "", format!("invalid JSON: {error}"), "correct it there").at(line)
    })?;
    Scene::from_json(file, &json)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn toml_and_json_are_distinguished_by_content() {
        let json = r#" {"objects":[{"name":"a","attributes":{"color":"red"}}]}"#;
        let scene = read("s", json).unwrap();
        assert_eq!(scene.objects().len(), 1);
        let toml = "name = 's'\nnoun = 'cup'\n[[attributes]]\nname = 'color'\nvalues = ['red']\n\
                    [[objects]]\nname = 'a'\nattributes = { color = 'red' }\n";
        assert_eq!(read("s.toml", toml).unwrap().noun(), "cup");
    }

    #[test]
    fn errors_name_the_file() {
        let broken = [("{", "invalid JSON"), ("name = ", "s:"), ("{\"objects\":[]}", "s:")];
        for (text, part) in broken {
            let error = Failure::from(read("s", text).unwrap_err()).to_string();
            assert!(error.contains(part) && error.starts_with("s:"), "{text}: {error}");
        }
        let trouble = load(Path::new("/nowhere/scene.toml")).unwrap_err();
        assert!(trouble.to_string().starts_with("/nowhere/scene.toml: "));
        let device = load(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(device.exit, Exit::Config);
        let what = "/dev/zero: expected a regular file, found a pipe, socket or device";
        assert_eq!(device.to_string(), what);
    }
}
