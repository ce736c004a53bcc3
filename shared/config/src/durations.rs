//! How long this robot takes for each question and pick: measured when the files are read, and part
//! of the snapshot from then on, so that no service plans motions before it is ready, and what a
//! journal was decided by can be read again.

use dialogue::{Durations, Model};
use preflight::{Extent, MotionError, Motions, Pace, Voice, measure};
use scene::Scene;
use toml::Value;

use crate::dialogue::CostsFrom;
use crate::layer::{Node, Source, Table};
use crate::problems::Report;
use crate::resolved::to_toml;
use crate::text_file::TextFile;
use crate::{Arm, Dialogue, Settings, Speech};

/// The table that holds them in a snapshot.
pub(crate) const TABLE: &str = "durations";

impl Settings {
    /// The seconds of every question and pick in a scene, as these settings have the robot speak
    /// and move. Those of the arm are missing where objects have no place, and those of pointing
    /// where it is not `pointing`.
    ///
    /// # Errors
    /// An object that the arm cannot reach or point at.
    pub fn measure(&self, scene: &Scene, pointing: bool) -> Result<Durations, MotionError> {
        of_robot(scene, &self.speech, &self.arm, pointing)
    }

    /// The durations in force as TOML: what whoever decides by them depends on. Empty where
    /// questions cost what is written down.
    pub fn durations_text(&self) -> String {
        let written = self.durations.as_ref().map(toml::to_string);
        written.transpose().ok().flatten().unwrap_or_default()
    }
}

/// Measures, if the robot's own seconds are the costs of its questions.
pub(crate) fn find(
    scene: &Scene,
    file: &TextFile,
    (dialogue, speech, arm): (&Dialogue, &Speech, &Arm),
    report: &mut Report,
) -> Option<Durations> {
    if dialogue.costs_from == CostsFrom::Config {
        return None;
    }
    let measured = of_robot(scene, speech, arm, dialogue.actions.point());
    let told = |error: MotionError| {
        let cure = "move it, or set costs.from of the dialogue to \"config\"";
        let problem = scene::Problem::new(&*file.label, "objects", error.to_string(), cure);
        report.add(problem);
    };
    measured.map_err(told).ok()
}

/// Takes what was measured before from a snapshot.
pub(crate) fn read(
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
    let model = Model::new(scene, dialogue.params);
    let fits = read.filter(|durations| durations.check(&model).is_empty());
    if fits.is_none() {
        let what = "the durations of this scene are missing";
        let cure = "stop the group and start it again";
        report.add(source.problem(&[TABLE.to_owned()], what.to_owned(), cure));
    }
    fits
}

/// Adds them to a snapshot.
pub(crate) fn write(durations: &Durations, tree: &mut Table) {
    let Ok(Value::Table(lists)) = Value::try_from(durations) else { return };
    let mut table = Table::empty(tree.source.clone());
    let leaves = lists.into_iter().map(|(key, list)| (key, Node::Leaf(list, tree.source.clone())));
    table.entries.extend(leaves);
    tree.entries.push((TABLE.to_owned(), Node::Table(table)));
}

fn of_robot(
    scene: &Scene,
    speech: &Speech,
    arm: &Arm,
    pointing: bool,
) -> Result<Durations, MotionError> {
    let extent = if pointing { Extent::FromRest } else { Extent::Picks };
    let placed = scene.objects().iter().all(|object| object.placement.is_some());
    let motions = placed
        .then(|| Motions::plan(&arm.robot, scene, arm.limb, &arm.plan, extent))
        .transpose()?;
    let voice = Voice { words_per_minute: f64::from(speech.voice_words_per_minute) };
    Ok(measure(scene, &voice, &Pace::default(), motions.as_ref()))
}
