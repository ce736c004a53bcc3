//! The scenes that ship.

use scene::{Scene, View};

/// Names and files.
const SHIPPED: [(&str, &str); 4] = [
    ("bowls", include_str!("../../../config/scenes/bowls.toml")),
    ("blocks", include_str!("../../../config/scenes/blocks.toml")),
    ("tools", include_str!("../../../config/scenes/tools.toml")),
    ("markers", include_str!("../../../config/scenes/markers.toml")),
];

/// Returns the names of the scenes, the first one to show first.
pub fn names() -> impl Iterator<Item = &'static str> {
    SHIPPED.iter().map(|(name, _)| *name)
}

/// Returns a scene as the robot sees it: objects that are alike are told apart by their places.
///
/// # Errors
/// No scene of that name, with the names that there are.
pub fn scene(name: &str) -> Result<Scene, String> {
    let Some((_, text)) = SHIPPED.iter().find(|(known, _)| *known == name) else {
        let known: Vec<&str> = names().collect();
        return Err(format!("scene: expected one of {}, found {name:?}", known.join(", ")));
    };
    let scene = Scene::from_toml(name, text).map_err(|problems| problems.to_string())?;
    Ok(scene.by_place(View::Robot))
}
