//! The scene that the group names.

use std::path::{Path, PathBuf};

use scene::Scene;

use crate::layer::{Node, Source, Table};
use crate::load::{read_text, toml_names};
use crate::nearest;
use crate::problems::Report;

/// A scene file as it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SceneFile {
    /// The file, as people know it.
    pub(crate) label: String,
    pub(crate) text: String,
}

/// The name of a scene and where it was written.
pub(crate) struct Named<'a> {
    name: &'a str,
    source: &'a Source,
}

impl<'a> Named<'a> {
    /// `group.scene`; `None` where there was a problem with it.
    pub(crate) fn in_group(tree: &'a Table, name: &'a str) -> Option<Self> {
        let Node::Table(group) = tree.get("group")? else { return None };
        let source = group.get("scene")?.source();
        (!name.is_empty()).then_some(Self { name, source })
    }
}

/// Finds and reads the scene: a path that ends with `.toml` is taken from the configuration
/// folder, anything else is a name in its `scenes/`.
pub(crate) fn find(dir: &Path, named: &Named<'_>, report: &mut Report) -> Option<SceneFile> {
    let folder = dir.join("scenes");
    let path: PathBuf = match named.name.ends_with(".toml") {
        true => dir.join(named.name),
        false => folder.join(format!("{}.toml", named.name)),
    };
    if !path.is_file() {
        let names = toml_names(&folder);
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let what = format!("there is no scene `{}` ({})", named.name, path.display());
        let key = ["group", "scene"].map(str::to_owned);
        report.add(named.source.problem(&key, what, nearest::cure(named.name, &known)));
        return None;
    }
    let text = read_text(&path, report)?;
    Some(SceneFile { label: path.display().to_string(), text })
}

/// Reads the scene.
pub(crate) fn read(file: &SceneFile, report: &mut Report) -> Option<Scene> {
    Scene::from_toml(&file.label, &file.text).map_err(|problems| report.extend(problems)).ok()
}
