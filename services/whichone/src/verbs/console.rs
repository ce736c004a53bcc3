//! `whichone console`: address of the group's page.

use service::group::GroupPaths;

/// The address of the console's page, while one is served.
pub(super) fn url(paths: &GroupPaths) -> Option<String> {
    let text = std::fs::read_to_string(paths.console_url()).ok()?;
    let url = text.trim();
    (!url.is_empty()).then(|| url.to_owned())
}
