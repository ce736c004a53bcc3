//! From a folder of files to settings.

use std::fs;
use std::io;
use std::path::Path;

use scene::Problem;
use toml::Value;

use crate::fields::Fields;
use crate::layer::{Node, Source, Table};
use crate::problems::{Problems, Report};
use crate::resolved::{self, Resolved, Section};
use crate::scene_file::{self, Named, SceneFile};
use crate::{Settings, arm, dialogue, gesture, group, nearest, reach, services, speech};

pub(crate) fn load(
    dir: &Path,
    profile: Option<&str>,
    overrides: &[(String, String)],
) -> Result<Settings, Problems> {
    let mut report = Report::default();
    if !dir.is_dir() {
        let cure = "name a folder with group.toml and its neighbours";
        report.add(Problem::new(dir.display().to_string(), "", "is not a folder", cure));
        return report.verdict(None);
    }
    let mut layers = Vec::new();
    for section in Section::ALL {
        layers.extend(section_file(dir, section, &mut report));
    }
    layers.extend(profile.and_then(|name| profile_file(dir, name, &mut report)));
    for (key, value) in overrides {
        layers.extend(override_layer(key, value, &mut report));
    }
    let mut tree = resolved::defaults();
    for layer in layers {
        tree.merge(layer, &mut Vec::new(), &mut report);
    }
    let find_scene = |named: &Named<'_>, report: &mut Report| scene_file::find(dir, named, report);
    check(tree, report, find_scene, Reach::Check)
}

/// Whether it is still to be found out that the arm can fetch every object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    Check,
    /// Known, and too slow to find out again whenever a service starts.
    Known,
}

/// Checks the merged layers. `find_scene` reads the scene that the group names.
pub(crate) fn check(
    mut tree: Table,
    mut report: Report,
    find_scene: impl FnOnce(&Named<'_>, &mut Report) -> Option<SceneFile>,
    reach: Reach,
) -> Result<Settings, Problems> {
    services::complete(tree.table_at("group"), &mut report);
    let mut fields = Fields::new(&tree, Vec::new(), &mut report);
    let group = fields.table("group", group::read);
    let dialogue = fields.table("dialogue", dialogue::read);
    let speech = fields.table("speech", speech::read);
    let (arm, arm_is_sound) = fields.table("arm", |f| (arm::read(f), f.is_sound()));
    fields.finish();
    let named = Named::in_group(&tree, &group.scene);
    let file = named.and_then(|named| find_scene(&named, &mut report));
    let scene = file.as_ref().and_then(|file| scene_file::read(file, &mut report));
    if let (Some(file), Some(scene), Reach::Check, true) = (&file, &scene, reach, arm_is_sound) {
        reach::check(scene, file, &arm, &tree, &mut report);
    }
    if let Some(scene) = &scene {
        gesture::check(scene, &dialogue.gesture, &tree, &mut report);
    }
    let settings = file.zip(scene).map(|(file, scene)| {
        let resolved = Resolved { tree, scene: file };
        Settings { group, dialogue, speech, arm, scene, resolved }
    });
    report.verdict(settings)
}

/// A text file; an absent one is `None` without a problem.
pub(crate) fn read_text(path: &Path, report: &mut Report) -> Option<String> {
    match fs::read_to_string(path) {
        Ok(text) => Some(text),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => {
            let what = format!("cannot be read: {error}");
            report.add(Problem::new(path.display().to_string(), "", what, "mend or remove it"));
            None
        }
    }
}

/// Names of the TOML files in a folder, sorted, without their endings.
pub(crate) fn toml_names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".toml")?.to_owned()))
        .collect();
    names.sort();
    names
}

fn section_file(dir: &Path, section: Section, report: &mut Report) -> Option<Table> {
    let path = dir.join(section.file());
    let text = read_text(&path, report)?;
    let source = Source::new(path.display().to_string(), 1);
    let table = Table::parse(&text, &source, report)?;
    Some(wrapped(section.name(), Node::Table(table)))
}

fn profile_file(dir: &Path, name: &str, report: &mut Report) -> Option<Table> {
    let folder = dir.join("profiles");
    let names = toml_names(&folder);
    if !names.iter().any(|known| known == name) {
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let what = format!("there is no profile `{name}`");
        let file = folder.display().to_string();
        report.add(Problem::new(file, "", what, nearest::cure(name, &known)));
        return None;
    }
    let path = folder.join(format!("{name}.toml"));
    let text = read_text(&path, report)?;
    Table::parse(&text, &Source::new(path.display().to_string(), 0), report)
}

fn override_layer(key: &str, value: &str, report: &mut Report) -> Option<Table> {
    let mut parts: Vec<&str> = key.split('.').collect();
    if parts.len() < 2 || parts.iter().any(|part| part.trim().is_empty()) {
        let what = "is not a key with its section";
        let cure = "write SECTION.KEY=VALUE, e.g. arm.speed_ratio=0.4";
        report.add(Problem::new("--set", key, what, cure));
        return None;
    }
    let last = parts.pop().unwrap_or_default();
    let leaf = Node::Leaf(value_of(value), Source::new("--set", 0));
    let mut layer = wrapped(last, leaf);
    for part in parts.into_iter().rev() {
        layer = wrapped(part, Node::Table(layer));
    }
    Some(layer)
}

/// The value as TOML reads it; anything else is a text, so that no quotes are needed in a shell.
fn value_of(text: &str) -> Value {
    let table = toml::from_str::<toml::Table>(&format!("v = {text}"));
    match table.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("v")) {
        Some(value) if !value.is_table() => value,
        _ => Value::String(text.to_owned()),
    }
}

fn wrapped(key: &str, node: Node) -> Table {
    let source = node.source().clone();
    Table { entries: vec![(key.to_owned(), node)], source }
}
