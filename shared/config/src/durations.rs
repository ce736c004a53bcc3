//! Durations of every question and pick in a snapshot: measured once by `preflight`, so that no
//! service plans motions before it is ready, and a journal can be read again with the numbers by
//! which its decisions were made.

use dialogue::{Durations, Model};
use scene::Scene;
use toml::Value;

use crate::dialogue::CostsFrom;
use crate::resolved::to_toml;
use crate::{Dialogue, Settings};
use diagnostics::Report;
use diagnostics::{Node, Source, Table};

/// Table of the durations in a snapshot.
pub(crate) const TABLE: &str = "durations";

impl Settings {
    /// The durations in force as TOML, a dependency of every service that decides. Empty if the
    /// costs of questions are configured.
    pub fn durations_text(&self) -> String {
        let written = self.durations.as_ref().map(toml::to_string);
        written.transpose().ok().flatten().unwrap_or_default()
    }
}

/// Reads the durations from a snapshot.
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
        let help = "stop the group and start it again";
        report.add(source.diagnostic(&[TABLE.to_owned()], what.to_owned(), help));
    }
    fits
}

/// Adds the durations to a snapshot.
pub(crate) fn write(durations: &Durations, tree: &mut Table) {
    let Ok(values) = Value::try_from(durations) else { return };
    tree.entries.push((TABLE.to_owned(), Node::from_toml(values, &tree.source)));
}
