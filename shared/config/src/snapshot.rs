//! The settings in force, as the supervisor hands them to the services: one file, so that a
//! service never sees the scene or the robot of one version with the values of another.

use std::io;
use std::path::Path;

use diagnostics::Diagnostic;

use crate::files::{Files, RobotFiles, read_text};
use crate::load;
use crate::resolved::{self, Resolved, to_toml};
use crate::{Settings, durations};
use diagnostics::TextFile;
use diagnostics::{Diagnostics, Report};
use diagnostics::{Node, Source, Table};

/// Name of the snapshot in a group's run folder.
pub const SNAPSHOT_FILE: &str = "settings.toml";

/// The tables that hold the texts of the named files in a snapshot.
const SCENE: &str = "scene";
const URDF: &str = "robot_urdf";
const SRDF: &str = "robot_srdf";

impl Settings {
    /// The snapshot's text: every value of every section, the scene's and the robot's files as
    /// they were read, and how long the robot takes for what it does.
    pub fn snapshot(&self) -> String {
        let Resolved { tree, scene, robot } = &self.resolved;
        let mut tree = tree.clone();
        put_file(&mut tree, SCENE, scene);
        put_file(&mut tree, URDF, &robot.urdf);
        if let Some(srdf) = &robot.srdf {
            put_file(&mut tree, SRDF, srdf);
        }
        self.durations.iter().for_each(|durations| durations::write(durations, &mut tree));
        to_toml(&tree)
    }

    /// Writes the snapshot into a group's run folder; readers see the old one or the new one.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn write_snapshot(&self, run_dir: &Path) -> io::Result<()> {
        let header = "# The settings in force. Edit the configuration folder instead.\n";
        let text = format!("{header}{}", self.snapshot());
        journal::replace_file(&run_dir.join(SNAPSHOT_FILE), text)
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
        let Some(text) = read_text(&path, &mut report) else {
            report.add(Diagnostic::new(label, "", "no such file", "start the group"));
            return report.verdict(None);
        };
        let source = Source::new(label.as_str(), 0);
        let Some(mut layer) = Table::parse(&text, &source, &mut report) else {
            return report.verdict(None);
        };
        let measured = layer.take(durations::TABLE);
        let scene = take_file(&mut layer, SCENE);
        let urdf = take_file(&mut layer, URDF);
        let srdf = take_file(&mut layer, SRDF);
        for (key, what, file) in [(SCENE, "the scene", &scene), (URDF, "the robot", &urdf)] {
            if file.is_none() {
                let help = "stop the group and start it again";
                report.add(Diagnostic::new(&*label, key, format!("{what} is missing"), help));
            }
        }
        let files = Files { scene, robot: urdf.map(|urdf| RobotFiles { urdf, srdf }) };
        let mut tree = resolved::defaults();
        tree.merge(layer, &mut Vec::new(), &mut report);
        load::check(tree, report, files, Some((measured, source)))
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
