//! The configuration of a group: parsed, checked as a whole, and equal for every service. Checks
//! that need the robot's kinematics are in `preflight`.
//!
//! Invariant: a [`Settings`] is complete and consistent. Loading returns one, or every problem at
//! once with its file, line, key and help; no service ever meets an invalid value.
//!
//! Values come in layers, each over the one before: the defaults (the files of `config/` at build
//! time), the files of the configuration folder, a profile, and overrides from the command line.
//! The supervisor resolves them when the group starts or reloads, and writes a snapshot; services
//! read only that, so that edited files take effect with a reload.

mod arm;
mod console;
mod dialogue;
mod driver;
mod files;
mod group;
mod load;
mod part;
mod reads;
mod resolved;
mod schema;
mod services;
mod snapshot;
mod speech;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use diagnostics::{Diagnostic, Diagnostics, Report, Source, Table, TextFile};
use messages::Service;
use scene::{Scene, StableHash};
use vocabulary::Durations;

pub use crate::arm::{Arm, Grasps, Motion};
pub use crate::console::{Access, Camera, Console};
pub use crate::dialogue::{CostsFrom, Dialogue, Gesture};
pub use crate::driver::{Driver, KINEMATIC};
pub use crate::files::{RobotFiles, one_of, read_file};
pub use crate::group::{Flight, Group, Log, Perception, RestartLimits};
pub use crate::load::Examined;
pub use crate::part::{
    Check, EVERYTHING, Part, PartService, Reads, Registered, Section, part_service, register,
    sections,
};
pub use crate::resolved::Origin;
pub use crate::schema::{SectionSchema, schemas};
pub use crate::services::{Restart, ServiceConfig};
pub use crate::snapshot::{SNAPSHOT_FILE, WORDS_FILE};
pub use crate::speech::{Microphone, MicrophoneMode, Recogniser, Speech, Voice};

use crate::resolved::Resolved;

/// All settings of a group. Two are equal when their snapshots are.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Scene, services and restart policy.
    pub group: Group,
    /// Understanding, belief and decisions.
    pub dialogue: Dialogue,
    /// Recognition and voice.
    pub speech: Speech,
    /// The arm.
    pub arm: Arm,
    /// The web page.
    pub console: Console,
    /// The scene; after `preflight`, every object has a place that the arm can reach.
    pub scene: Scene,
    /// Measured seconds of every question and pick, under [`CostsFrom::Robot`]; set by
    /// `preflight`, read from a snapshot.
    pub durations: Option<Durations>,
    resolved: Resolved,
}

impl Settings {
    /// Reads the configuration folder `dir` with a profile (`profiles/NAME.toml`) and overrides
    /// (`("arm.time_scale", "50")`; a value that is not TOML is a string).
    ///
    /// # Errors
    /// Every problem of every file at once.
    pub fn load(
        dir: &Path,
        profile: Option<&str>,
        overrides: &[(String, String)],
    ) -> Result<Self, Diagnostics> {
        let examined = load::examine(dir, profile, overrides, None);
        examined.report.verdict(examined.settings)
    }

    /// Reads a configuration as [`Settings::load`] does, without a verdict; with `scene` in place
    /// of the scene that it names.
    pub fn examine(
        dir: &Path,
        profile: Option<&str>,
        overrides: &[(String, String)],
        scene: Option<TextFile>,
    ) -> Examined {
        load::examine(dir, profile, overrides, scene)
    }

    /// The merged values of one section as TOML, with the files that it names.
    pub fn section_text(&self, section: &str) -> String {
        self.resolved.section_text(section)
    }

    /// The section of an optional part. It was checked when the configuration was loaded if the
    /// program knows the part; a snapshot was checked by the program that wrote it.
    ///
    /// # Errors
    /// Every problem at once; checked settings have none.
    pub fn part<S: Section>(&self) -> Result<S, Diagnostics> {
        part::read(&self.resolved.tree)
    }

    /// Returns the identity of everything that the dialogue manager decides by, with that planner.
    pub fn manager_key(&self, planner: &str) -> u64 {
        let mut hash = StableHash::default();
        if planner != self.dialogue.planner {
            hash.text(planner);
        }
        hash.text(&self.resolved.decision_text());
        hash.text(&self.scene_file().text);
        if self.durations.is_some() {
            hash.text(&self.durations_text());
        }
        if self.group.perception.enabled {
            hash.text("objects from perception");
        }
        hash.value()
    }

    /// The scene file.
    pub fn scene_file(&self) -> &TextFile {
        &self.resolved.scene
    }

    /// A problem with the value at a dotted key of the scene file.
    pub fn scene_diagnostic(
        &self,
        key: impl Into<String>,
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        let TextFile { label, text } = self.scene_file();
        let table = Table::parse(text, &Source::new(label.as_str(), 0), &mut Report::default());
        let table = table.unwrap_or_else(|| Table::empty(Source::new(label.as_str(), 0)));
        table.diagnostic(key, what, help)
    }

    /// The files that describe the robot.
    pub fn robot_files(&self) -> &RobotFiles {
        &self.resolved.robot
    }

    /// A problem with the value at a key, located in the file that it came from.
    pub fn diagnostic(
        &self,
        key: &[&str],
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        let path: Vec<String> = key.iter().map(|part| (*part).to_owned()).collect();
        self.resolved.tree.source_of(key).diagnostic(&path, what, help)
    }

    /// Folder of the sound of the robot's latest sentences, if any: the configured one, else one in
    /// the group's run folder `run` if there is a console that plays them elsewhere.
    pub fn voice_dir(&self, run: &Path) -> Option<PathBuf> {
        let console = Service::Console.name();
        let has_console = self.group.services.iter().any(|service| service.name == console);
        let own = has_console.then(|| run.join("said"));
        self.speech.voice_dir.clone().or(own)
    }

    /// Keys of earlier versions, with their replacements, and values without effect.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.resolved.warnings
    }

    /// Every value with the file that it came from, in the order of the files.
    pub fn origins(&self) -> Vec<Origin> {
        self.resolved.origins()
    }
}

impl PartialEq for Settings {
    fn eq(&self, other: &Self) -> bool {
        self.snapshot() == other.snapshot()
    }
}
