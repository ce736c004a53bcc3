//! The settings in force, as the supervisor hands them to the services: one file, so that a
//! service never sees the scene of one version with the values of another.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use scene::Problem;
use toml::Value;

use crate::Settings;
use crate::layer::{Node, Source, Table};
use crate::load::{self, Reach};
use crate::problems::{Problems, Report};
use crate::resolved::{self, to_toml};
use crate::scene_file::SceneFile;

/// Name of the snapshot in a group's run folder.
pub const SNAPSHOT_FILE: &str = "settings.toml";

/// The table that holds the scene's text in a snapshot.
const SCENE: &str = "scene";

impl Settings {
    /// The snapshot's text: every value of every section, and the scene file as it was read.
    pub fn snapshot(&self) -> String {
        let source = &self.resolved.tree.source;
        let mut scene = Table::empty(source.clone());
        let SceneFile { label, text } = &self.resolved.scene;
        for (key, text) in [("file", label), ("text", text)] {
            let leaf = Node::Leaf(Value::String(text.clone()), source.clone());
            scene.entries.push((key.to_owned(), leaf));
        }
        let mut tree = self.resolved.tree.clone();
        tree.entries.push((SCENE.to_owned(), Node::Table(scene)));
        to_toml(&tree)
    }

    /// Writes the snapshot into a group's run folder; readers see the old one or the new one.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn write_snapshot(&self, run_dir: &Path) -> io::Result<()> {
        let path = run_dir.join(SNAPSHOT_FILE);
        let new = run_dir.join(format!("{SNAPSHOT_FILE}.new"));
        let header =
            "# The settings in force. Edit the files of the configuration folder instead.\n";
        let mut file = fs::File::create(&new)?;
        file.write_all(header.as_bytes())?;
        file.write_all(self.snapshot().as_bytes())?;
        drop(file);
        fs::rename(new, path)
    }

    /// Reads the snapshot in a group's run folder, checked as the files were but for the arm's
    /// reach: that was found out before it was written, and a service must be quick to start.
    ///
    /// # Errors
    /// Every problem at once; there are none in a snapshot of the same version.
    pub fn load_snapshot(run_dir: &Path) -> Result<Self, Problems> {
        let path = run_dir.join(SNAPSHOT_FILE);
        let label = path.display().to_string();
        let mut report = Report::default();
        let Some(text) = load::read_text(&path, &mut report) else {
            report.add(Problem::new(label, "", "is missing", "start the group"));
            return report.verdict(None);
        };
        let source = Source::new(label.as_str(), 0);
        let Some(mut layer) = Table::parse(&text, &source, &mut report) else {
            return report.verdict(None);
        };
        let scene = take_scene(&mut layer);
        if scene.is_none() {
            let cure = "stop the group and start it again";
            report.add(Problem::new(label, SCENE, "the scene is missing", cure));
        }
        let mut tree = resolved::defaults();
        tree.merge(layer, &mut Vec::new(), &mut report);
        load::check(tree, report, |_, _| scene, Reach::Known)
    }
}

fn take_scene(layer: &mut Table) -> Option<SceneFile> {
    let at = layer.entries.iter().position(|(key, _)| key == SCENE)?;
    let (_, node) = layer.entries.remove(at);
    let text = |key| match node.as_table()?.get(key)? {
        Node::Leaf(Value::String(text), _) => Some(text.clone()),
        _ => None,
    };
    Some(SceneFile { label: text("file")?, text: text("text")? })
}
