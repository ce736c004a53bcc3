//! Scenes for the tests of this crate.

use scene::Scene;

/// The paper's six bowls, with places.
pub(crate) fn bowls() -> Scene {
    Scene::from_toml("bowls.toml", include_str!("../../../config/scenes/bowls.toml"))
        .unwrap_or_else(|problems| panic!("{problems:?}"))
}
