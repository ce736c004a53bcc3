//! Values read by each service: a reload restarts services whose values it changes.

use messages::Service;

use crate::Settings;
use crate::part::{self, DURATIONS, Reads};

/// Services of the core. Speech rejects utterances that the dialogue would not understand. The
/// console has the sections that its pages show, and its live view has sound if recordings have.
const CORE: [(Service, Reads); 5] = [
    (Service::Speech, &["speech", "dialogue"]),
    (Service::Grounding, &["dialogue"]),
    (Service::Policy, &["dialogue", DURATIONS]),
    (Service::Arm, &["arm"]),
    (Service::Console, &["dialogue", "speech", "arm", "console", "study", "group.recorder.sound"]),
];

/// A service of which nothing is known.
const ANY: Reads = &["speech", "dialogue", "arm", DURATIONS];

impl Settings {
    /// The text of everything that a service reads: it differs exactly if a restart is needed.
    pub fn read_by(&self, service: &str) -> String {
        let core = CORE.iter().find(|(core, _)| core.name() == service).map(|(_, reads)| *reads);
        let reads = core.or_else(|| Some(part::part_service(service)?.reads)).unwrap_or(ANY);
        let everywhere =
            [self.scene_file().text.clone(), self.resolved.value_text("group.perception")];
        // Services that distinguish objects by place.
        let view = ["dialogue.language", "dialogue.gesture"];
        let everywhere =
            everywhere.into_iter().chain(view.map(|key| self.resolved.value_text(key)));
        reads.iter().map(|key| self.text_at(key)).chain(everywhere).collect()
    }

    fn text_at(&self, key: &str) -> String {
        match key {
            "*" => crate::sections().map(|(name, _)| self.section_text(name)).collect(),
            DURATIONS => self.durations_text(),
            key if key.contains('.') => self.resolved.value_text(key),
            section => self.section_text(section),
        }
    }
}
