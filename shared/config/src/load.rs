//! Loading: layers of files into checked settings.

use std::path::Path;

use diagnostics::{
    Diagnostic, Diagnostics, Fields, Node, Report, Source, Table, TextFile, suggestion,
};
use messages::Service;
use scene::Scene;
use toml::Value;

use crate::files::{FILE_BYTES_MAX, Files, names, one_of, read_text};
use crate::part::{self, Check, sections};
use crate::resolved::Resolved;
use crate::{Settings, arm, console, dialogue, group, services, snapshot, speech};

/// Result of examining a configuration, before a verdict: further checks may add to the report.
#[derive(Debug)]
pub struct Examined {
    /// The settings without the wrong parts of the scene; `None` without a scene or a robot.
    pub settings: Option<Settings>,
    /// Every problem so far.
    pub report: Report,
    /// The arm's settings are right, so that its reach can be checked in the same round.
    pub arm_is_right: bool,
}

impl Examined {
    /// Returns the settings.
    ///
    /// # Errors
    /// Every problem of the report.
    pub fn verdict(self) -> Result<Settings, Diagnostics> {
        self.report.verdict(self.settings)
    }
}

pub(crate) fn examine(
    dir: &Path,
    profile: Option<&str>,
    overrides: &[(String, String)],
    scene: Option<TextFile>,
) -> Examined {
    let mut report = Report::default();
    if !dir.is_dir() {
        let help = "name a folder that contains group.toml";
        report.add(Diagnostic::new(dir.display().to_string(), "", "not a folder", help));
        return Examined { settings: None, report, arm_is_right: false };
    }
    let mut layers = Vec::new();
    for (section, _) in sections() {
        layers.extend(section_file(dir, section, &mut report));
    }
    layers.extend(profile.and_then(|name| profile_file(dir, name, &mut report)));
    for (key, value) in overrides {
        layers.extend(override_layer("--set", (key, value), &mut report));
    }
    let mut tree = part::defaults();
    let mut warnings = Vec::new();
    for mut layer in layers {
        warnings.extend(dialogue::replace_former_key(&mut layer, &tree));
        tree.merge(layer, &mut Vec::new(), &mut report);
    }
    let files = Files::find(dir, &tree, scene, &mut report);
    let mut examined = check(tree, report, files, None);
    if let Some(settings) = &mut examined.settings {
        let (key, port) = (["console", "discovery"], settings.console.listen.port());
        let help = format!("set console.listen = \"0.0.0.0:{port}\", or console.discovery = false");
        let warning = |what| settings.diagnostic(&key, what, help);
        warnings.extend(settings.console.unannounced().map(warning));
        settings.resolved.warnings = warnings;
    }
    examined
}

/// Durations as a snapshot holds them, and the snapshot.
pub(crate) type Measured = (Option<Node>, Source);

/// Checks the merged layers and the files that they name. `measured` are the durations of a snapshot, if it is one.
pub(crate) fn check(
    mut tree: Table,
    mut report: Report,
    files: Files,
    measured: Option<Measured>,
) -> Examined {
    let before = report.count();
    services::complete(tree.table_at("group"), &mut report);
    let mut arm_is_right = before == 0;
    let mut fields = Fields::new(&tree, Vec::new(), &mut report);
    let group = fields.table("group", |f| part::with_tables("group", f, group::read));
    let dialogue = fields.table("dialogue", |f| part::with_tables("dialogue", f, dialogue::read));
    let speech = fields.table("speech", |f| part::with_tables("speech", f, speech::read));
    let own_arm = group.has_command(Service::Arm.name());
    let arm = fields.table("arm", |f| {
        let arm = part::with_tables("arm", f, |f| arm::read(f, own_arm));
        arm_is_right &= f.is_right();
        arm
    });
    let console = fields.table("console", |f| part::with_tables("console", f, console::read));
    part::read_sections(&mut fields, measured.is_some());
    fields.finish();
    let Files { scene: file, robot } = files;
    let scene =
        file.as_ref().and_then(|TextFile { label, text }| Scene::examine(label, text, &mut report));
    let scene = scene.map(|scene| dialogue.by_place(scene));
    if let Some(scene) = &scene {
        dialogue::check_person(scene, &dialogue.gesture, &tree, &mut report);
    }
    let scene_found = scene.as_ref();
    part::check(&mut Check {
        group: &group,
        arm: &arm,
        scene: scene_found,
        tree: &tree,
        report: &mut report,
    });
    let settings = file.zip(scene).zip(robot).map(|((file, scene), robot)| {
        // Other problems would be reported again as missing durations.
        let durations = measured.filter(|_| report.count() == 0).and_then(|(node, source)| {
            snapshot::read_durations(node, &dialogue, &scene, &source, &mut report)
        });
        let resolved = Resolved { tree, scene: file, robot, snapshot: None, warnings: Vec::new() };
        Settings { group, dialogue, speech, arm, console, scene, durations, resolved }
    });
    Examined { settings, report, arm_is_right }
}

fn section_file(dir: &Path, section: &str, report: &mut Report) -> Option<Table> {
    let path = dir.join(format!("{section}.toml"));
    let text = read_text(&path, FILE_BYTES_MAX, report)?;
    let source = Source::new(path.display().to_string(), 1);
    let table = Table::parse(&text, &source, report)?;
    Some(wrapped(section, Node::Table(table)))
}

fn profile_file(dir: &Path, name: &str, report: &mut Report) -> Option<Table> {
    let folder = dir.join("profiles");
    let names = names(&folder, ".toml");
    if !names.iter().any(|known| known == name) {
        let known = names.iter().map(String::as_str);
        let help = suggestion(name, known.clone(), || one_of(known));
        let what = format!("no profile `{name}`");
        report.add(Diagnostic::new(folder.display().to_string(), "", what, help));
        return None;
    }
    let path = folder.join(format!("{name}.toml"));
    let text = read_text(&path, FILE_BYTES_MAX, report)?;
    Table::parse(&text, &Source::new(path.display().to_string(), 0), report)
}

/// The layer of one value from the command line, given with `option`.
pub(crate) fn override_layer(
    option: &str,
    (key, value): (&str, &str),
    report: &mut Report,
) -> Option<Table> {
    let mut parts: Vec<&str> = key.split('.').collect();
    if parts.len() < 2 || parts.iter().any(|part| part.trim().is_empty()) {
        let what = "not a key with its section";
        let help = "write SECTION.KEY=VALUE, e.g. arm.speed_ratio=0.4";
        report.add(Diagnostic::new(option, key, what, help));
        return None;
    }
    let last = parts.pop().unwrap_or_default();
    let leaf = Node::from_toml(value_of(value), &Source::new(option, 0));
    let mut layer = wrapped(last, leaf);
    for part in parts.into_iter().rev() {
        layer = wrapped(part, Node::Table(layer));
    }
    Some(layer)
}

/// The value as TOML reads it; anything else is a string, so that a shell needs no quotes.
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
