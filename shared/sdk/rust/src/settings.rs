//! The scene of a running group, from the settings in force that the supervisor has written for its services.

use std::fs;
use std::path::Path;

use runtime::exit::{Exit, Failure};
use runtime::group::GroupPaths;
use scene::Scene;
use toml::Table;

/// Name of the file in a group's run folder.
const FILE: &str = "settings.toml";

/// Returns the scene of the running group.
///
/// # Errors
/// The group is not running, or its settings are of another version.
pub fn scene(paths: &GroupPaths) -> Result<Scene, Failure> {
    let path = paths.run().join(FILE);
    let text = fs::read_to_string(&path).map_err(|error| {
        let help = format!("help: start the group with `whichone up --group {}`", paths.name());
        Failure::new(Exit::NotReached, format!("{}: {error}; {help}", path.display()))
    })?;
    parse(&path, &text)
}

fn parse(path: &Path, text: &str) -> Result<Scene, Failure> {
    let wrong = |what: String| {
        let help = "help: build this program with the SDK of the group's version";
        Failure::new(Exit::Config, format!("{}: {what}; {help}", path.display()))
    };
    let settings: Table =
        text.parse().map_err(|error: toml::de::Error| wrong(error.to_string()))?;
    let scene = settings.get("scene").and_then(|scene| scene.as_table());
    let text = |key| scene.and_then(|scene| scene.get(key)).and_then(|text| text.as_str());
    let (Some(file), Some(text)) = (text("file"), text("text")) else {
        return Err(wrong(
            "expected `scene.file` and `scene.text`, found no such texts".to_owned(),
        ));
    };
    Ok(Scene::from_toml(file, text)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_is_read_from_the_settings_in_force() {
        let bowls = include_str!("../../../../config/scenes/bowls.toml");
        let mut scene = Table::new();
        scene.insert("file".into(), "bowls.toml".into());
        scene.insert("text".into(), bowls.into());
        let mut settings = Table::new();
        settings.insert("scene".into(), scene.into());
        let path = Path::new("run/settings.toml");
        let read = parse(path, &settings.to_string()).unwrap();
        assert_eq!(read.key(), Scene::from_toml("bowls.toml", bowls).unwrap().key());
        for wrong in ["scene = 1", "[scene]\nfile = 'x'", "= ="] {
            let failure = parse(path, wrong).unwrap_err();
            assert_eq!(failure.exit, Exit::Config, "{wrong}");
            assert!(failure.to_string().starts_with("run/settings.toml: "), "{failure}");
        }
    }
}
