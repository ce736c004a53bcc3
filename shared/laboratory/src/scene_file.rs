//! Scenes for evaluation, in TOML or JSON.

use std::path::Path;

use command_line::args::ConfigArgs;
use command_line::scene_file::{is_json, path_of, read_file};
use diagnostics::{Diagnostic, Diagnostics};
use scene::Scene;
use service::exit::Failure;

/// Reads a scene file: JSON if the text begins with a brace, else TOML.
///
/// # Errors
/// The file cannot be read, or every problem of its text.
pub fn load(path: &Path) -> Result<Scene, Failure> {
    let text = read_file(path)?;
    Ok(read(&path.display().to_string(), &text)?)
}

/// Reads a scene given by its file or by its name in the configuration.
///
/// # Errors
/// The scene is unknown, the file cannot be read, or every problem of its text.
pub fn load_named(named: &Path, args: &ConfigArgs) -> Result<Scene, Failure> {
    load(&path_of(named, args)?)
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
    fn errors_of_a_scene_name_its_file() {
        let broken = [("{", "invalid JSON"), ("name = ", "s:"), ("{\"objects\":[]}", "s:")];
        for (text, part) in broken {
            let error = Failure::from(read("s", text).unwrap_err()).to_string();
            assert!(error.contains(part) && error.starts_with("s:"), "{text}: {error}");
        }
    }
}
