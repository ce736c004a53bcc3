//! The settings in force, as the supervisor hands them to the services: one file, so that a
//! service never sees the scene or the robot of one version with the values of another.

use std::io;
use std::path::Path;

use diagnostics::{Diagnostic, Diagnostics, Node, Report, Source, Table, TextFile};
use scene::Scene;
use toml::Value;
use vocabulary::Durations;

use crate::dialogue::CostsFrom;
use crate::files::{FILE_BYTES_MAX, Files, RobotFiles, read_text};
use crate::resolved::{Resolved, to_toml};
use crate::{Dialogue, Settings, load, part};

/// Name of the snapshot in a group's run folder.
pub const SNAPSHOT_FILE: &str = "settings.toml";

/// First line of the file.
const HEADER: &str = "# The settings in force. Edit the configuration folder instead.\n";

/// Name of the file with the scene's key and words, for languages without a TOML reader.
pub const WORDS_FILE: &str = "scene.words";

/// Largest snapshot, bytes: three files and the values of every section, with escapes.
const SNAPSHOT_BYTES_MAX: u64 = 32 * FILE_BYTES_MAX;

/// The tables that hold the texts of the named files in a snapshot.
const SCENE: &str = "scene";
const URDF: &str = "robot_urdf";
const SRDF: &str = "robot_srdf";
/// The table of the durations of every question and pick: measured once by `preflight`, so that no
/// service plans motions before it is ready, and a journal can be read again with the numbers by
/// which its decisions were made.
const DURATIONS: &str = "durations";

/// Settings that snapshots of earlier versions do not state, with the values that they had then:
/// answers of all kinds came through alike, and typed words were doubted by a smoothing alone.
fn unstated(layer: &Table) -> String {
    let dialogue = layer.get("dialogue").and_then(Node::as_table);
    let number = |key| dialogue.and_then(|it| it.get(key)).and_then(Node::as_number);
    let reliability = number("p_l").zip(number("epsilon"));
    let kinds = reliability.iter().flat_map(|(p_l, epsilon)| {
        let table = |kind| format!("[dialogue.{kind}]\np_l = {p_l:?}\nepsilon = {epsilon:?}\n");
        ["open", "choice"].map(table)
    });
    let kinds: String = kinds.collect();
    let words = if number("misperception").is_none() { "alpha_typed = 0.001\n" } else { "" };
    format!("[dialogue]\nmisperception = 0.0\nchoice_questions = false\n{words}{kinds}")
}

impl Settings {
    /// The snapshot's text: every value of every section, the scene's and the robot's files as they
    /// were read, and the durations of the robot's actions.
    pub fn snapshot(&self) -> String {
        let Resolved { tree, scene, robot, snapshot, warnings: _ } = &self.resolved;
        if let Some(text) = snapshot {
            return text.clone();
        }
        let mut tree = tree.clone();
        put_file(&mut tree, SCENE, scene);
        put_file(&mut tree, URDF, &robot.urdf);
        if let Some(srdf) = &robot.srdf {
            put_file(&mut tree, SRDF, srdf);
        }
        self.durations.iter().for_each(|durations| put_durations(durations, &mut tree));
        to_toml(&tree)
    }

    /// Writes the snapshot into a group's run folder; readers see the old one or the new one.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn write_snapshot(&self, run_dir: &Path) -> io::Result<()> {
        let text = format!("{HEADER}{}", self.snapshot());
        safe_files::replace_private(&run_dir.join(SNAPSHOT_FILE), text)
    }

    /// Writes the scene's key (16 hexadecimal digits) and its words into a group's run folder, each
    /// on a line of its own; the number of a word in messages is its place, from 0.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn write_words(&self, run_dir: &Path) -> io::Result<()> {
        let mut text = format!("{:016x}\n", self.scene.key());
        for word in self.scene.words() {
            text += word;
            text.push('\n');
        }
        safe_files::replace_private(&run_dir.join(WORDS_FILE), text)
    }

    /// Reads the snapshot in a group's run folder, checked as the files were but for the arm's
    /// reach and durations: these were found out before it was written, and a service must be quick
    /// to start.
    ///
    /// # Errors
    /// Every problem at once; there are none in a snapshot of the same version.
    pub fn load_snapshot(run_dir: &Path) -> Result<Self, Diagnostics> {
        let path = run_dir.join(SNAPSHOT_FILE);
        let label = path.display().to_string();
        let mut report = Report::default();
        let Some(text) = read_text(&path, SNAPSHOT_BYTES_MAX, &mut report) else {
            report.add(Diagnostic::new(label, "", "no such file", "start the group"));
            return report.verdict(None);
        };
        let mut settings = Self::from_snapshot(&label, &text, ("", &[]))?;
        settings.resolved.snapshot = text.strip_prefix(HEADER).map(str::to_owned);
        Ok(settings)
    }

    /// Reads a snapshot's text, called `label` in problems, with changes as in [`Settings::load`].
    /// The scene, the robot and the durations stay those of the snapshot.
    ///
    /// # Errors
    /// Every problem at once.
    pub fn from_snapshot(
        label: &str,
        text: &str,
        (option, changes): (&str, &[(String, String)]),
    ) -> Result<Self, Diagnostics> {
        let mut report = Report::default();
        let source = Source::new(label, 0);
        let Some(mut layer) = Table::parse(text, &source, &mut report) else {
            return report.verdict(None);
        };
        let measured = layer.take(DURATIONS);
        let scene = take_file(&mut layer, SCENE);
        let urdf = take_file(&mut layer, URDF);
        let srdf = take_file(&mut layer, SRDF);
        for (key, what, file) in [(SCENE, "the scene", &scene), (URDF, "the robot", &urdf)] {
            if file.is_none() {
                let help = "stop the group and start it again";
                report.add(Diagnostic::new(label, key, format!("{what} is missing"), help));
            }
        }
        let files = Files { scene, robot: urdf.map(|urdf| RobotFiles { urdf, srdf }) };
        let mut tree = part::defaults();
        let unstated = Table::parse(&unstated(&layer), &source, &mut report);
        for layer in unstated.into_iter().chain([layer]) {
            tree.merge(layer, &mut Vec::new(), &mut report);
        }
        for (key, value) in changes {
            if let Some(layer) = load::override_layer(option, (key, value), &mut report) {
                tree.merge(layer, &mut Vec::new(), &mut report);
            }
        }
        let examined = load::check(tree, report, files, Some((measured, source)));
        examined.report.verdict(examined.settings)
    }

    /// The durations in force as TOML, a dependency of every service that decides. Empty if the
    /// costs of questions are configured.
    pub fn durations_text(&self) -> String {
        let written = self.durations.as_ref().map(toml::to_string);
        written.transpose().ok().flatten().unwrap_or_default()
    }
}

fn put_file(tree: &mut Table, key: &str, file: &TextFile) {
    let source = &tree.source;
    let entries = [("file", &file.label), ("text", &file.text)]
        .map(|(key, text)| (key.to_owned(), Node::text(text, source)));
    let table = Table { entries: entries.into(), source: source.clone() };
    tree.entries.push((key.to_owned(), Node::Table(table)));
}

fn take_file(layer: &mut Table, key: &str) -> Option<TextFile> {
    let node = layer.take(key)?;
    let text = |key| node.as_table()?.get(key)?.as_text().map(str::to_owned);
    Some(TextFile { label: text("file")?, text: text("text")? })
}

/// Reads the durations from a snapshot.
pub(crate) fn read_durations(
    node: Option<Node>,
    dialogue: &Dialogue,
    scene: &Scene,
    source: &Source,
    report: &mut Report,
) -> Option<Durations> {
    if dialogue.costs_from == CostsFrom::Config {
        return None;
    }
    let text = node.as_ref().and_then(Node::as_table).map(to_toml);
    let read = text.and_then(|text| toml::from_str::<Durations>(&text).ok());
    let fits = read.filter(|durations| durations.check(scene).is_empty());
    if fits.is_none() {
        let what = "the durations of this scene are missing";
        let help = "stop the group and start it again";
        report.add(source.diagnostic(&[DURATIONS.to_owned()], what.to_owned(), help));
    }
    fits
}

/// Adds the durations to a snapshot.
fn put_durations(durations: &Durations, tree: &mut Table) {
    let Ok(values) = Value::try_from(durations) else { return };
    tree.entries.push((DURATIONS.to_owned(), Node::from_toml(values, &tree.source)));
}
