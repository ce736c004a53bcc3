//! From a folder of files to settings.

use std::fs;
use std::io;
use std::path::Path;

use scene::Problem;
use toml::Value;

use crate::fields::Fields;
use crate::layer::{Node, Source, Table};
use crate::named::Named;
use crate::problems::{Problems, Report};
use crate::resolved::{self, Resolved, Section};
use crate::robot_files::{self, RobotFiles};
use crate::scene_file;
use crate::text_file::TextFile;
use crate::{
    Settings, arm, console, dialogue, durations, gesture, group, nearest, services, speech, study,
};

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
    let files = find_files(dir, &tree, &mut report);
    check(tree, report, files, None)
}

/// The files that the settings name; none where there was a problem with one.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    pub(crate) scene: Option<TextFile>,
    pub(crate) robot: Option<RobotFiles>,
}

fn find_files(dir: &Path, tree: &Table, report: &mut Report) -> Files {
    let scene = Named::find(tree, ["group", "scene"]);
    let robot = Named::find(tree, ["arm", "robot"]);
    Files {
        scene: scene.and_then(|named| scene_file::find(dir, &named, report)),
        robot: robot.and_then(|named| robot_files::find(dir, &named, report)),
    }
}

/// Durations as a snapshot holds them, and the snapshot.
pub(crate) type Measured = (Option<Node>, Source);

/// Checks the merged layers and the files that they name. `measured` are the durations of a
/// snapshot; a configuration folder has none yet.
pub(crate) fn check(
    mut tree: Table,
    mut report: Report,
    files: Files,
    measured: Option<Measured>,
) -> Result<Settings, Problems> {
    services::complete(tree.table_at("group"), &mut report);
    let mut fields = Fields::new(&tree, Vec::new(), &mut report);
    let group = fields.table("group", group::read);
    let dialogue = fields.table("dialogue", dialogue::read);
    let speech = fields.table("speech", speech::read);
    let arm = fields.table("arm", arm::read);
    let study = fields.table("study", |f| study::read(f, &dialogue.planner));
    let console = fields.table("console", console::read);
    fields.finish();
    let Files { scene: file, robot } = files;
    let scene = file.as_ref().and_then(|file| scene_file::read(file, &mut report));
    if let Some(scene) = &scene {
        gesture::check(scene, &dialogue.gesture, &tree, &mut report);
    }
    let settings = file.zip(scene).zip(robot).map(|((file, scene), robot)| {
        // Other problems would be reported again as missing durations.
        let durations = measured.filter(|_| report.is_empty()).and_then(|(node, source)| {
            durations::read(node, &dialogue, &scene, &source, &mut report)
        });
        let resolved = Resolved { tree, scene: file, robot };
        Settings { group, dialogue, speech, arm, study, console, scene, durations, resolved }
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

/// Names of the files in a folder with an ending, sorted, without it.
pub(crate) fn names(folder: &Path, ending: &str) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(ending)?.to_owned()))
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
    let names = names(&folder, ".toml");
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
