//! The scene that the group names.

use std::path::{Path, PathBuf};

use scene::Scene;

use crate::load::{names, read_text};
use crate::named::Named;
use crate::nearest;
use crate::problems::Report;
use crate::text_file::TextFile;

/// Finds and reads the scene: a path that ends with `.toml` is taken from the configuration
/// folder, anything else is a name in its `scenes/`.
pub(crate) fn find(dir: &Path, named: &Named<'_>, report: &mut Report) -> Option<TextFile> {
    let folder = dir.join("scenes");
    let path: PathBuf = match named.name.ends_with(".toml") {
        true => dir.join(named.name),
        false => folder.join(format!("{}.toml", named.name)),
    };
    if !path.is_file() {
        let names = names(&folder, ".toml");
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let what = format!("there is no scene `{}` ({})", named.name, path.display());
        report.add(named.problem(what, nearest::cure(named.name, &known)));
        return None;
    }
    let text = read_text(&path, report)?;
    Some(TextFile { label: path.display().to_string(), text })
}

/// Reads the scene.
pub(crate) fn read(file: &TextFile, report: &mut Report) -> Option<Scene> {
    Scene::from_toml(&file.label, &file.text).map_err(|problems| report.extend(problems)).ok()
}
