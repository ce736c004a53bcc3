//! Scenes by path, in either form.

use std::path::Path;

use scene::Scene;

use crate::error::CliError;

/// Reads a scene file: JSON where the text begins with a brace, else TOML.
///
/// # Errors
/// The file cannot be read, or everything that is wrong with it.
pub fn load(path: &Path) -> Result<Scene, CliError> {
    let text = std::fs::read_to_string(path).map_err(|error| CliError::file(path, &error))?;
    Ok(read(&path.display().to_string(), &text)?)
}

fn read(file: &str, text: &str) -> Result<Scene, Vec<scene::Problem>> {
    if !text.trim_start_matches('\u{feff}').trim_start().starts_with('{') {
        return Scene::from_toml(file, text);
    }
    let json = serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|error| {
        vec![scene::Problem::new(file, "", format!("is not JSON: {error}"), "mend it there")]
    })?;
    Scene::from_json(file, &json)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_are_told_apart_by_their_content() {
        let json = r#" {"objects":[{"name":"a","attributes":{"color":"red"}}]}"#;
        let scene = read("s", json).unwrap();
        assert_eq!(scene.objects().len(), 1);
        let toml = "name = 's'\nnoun = 'cup'\n[[attributes]]\nname = 'color'\nvalues = ['red']\n\
                    [[objects]]\nname = 'a'\nattributes = { color = 'red' }\n";
        assert_eq!(read("s.toml", toml).unwrap().noun(), "cup");
    }

    #[test]
    fn every_problem_is_told_with_its_file() {
        let broken = [("{", "is not JSON"), ("name = ", "s:"), ("{\"objects\":[]}", "s:")];
        for (text, part) in broken {
            let told = CliError::from(read("s", text).unwrap_err()).to_string();
            assert!(told.contains(part) && told.starts_with("s:"), "{text}: {told}");
        }
        let trouble = load(Path::new("/nowhere/scene.toml")).unwrap_err();
        assert!(trouble.to_string().starts_with("/nowhere/scene.toml: "));
    }
}
