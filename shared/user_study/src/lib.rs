//! Studies with people: protocol, events and results.
//!
//! A participant's data is a journal: one JSON object a line, only ever appended to. Everything
//! else is a fold of it ([`Participant`]), so that the page that conducts the study, the export and
//! the report of the command line cannot disagree, and a killed program resumes.
//!
//! This crate is pure: no IO, no clock, no threads; it knows no planner and no reader, so that the
//! page, which conducts studies, is not built again with these.
//!
//! | contents | file |
//! |---|---|
//! | protocol of the lab: texts, design, questionnaire | `protocol.rs`, `item.rs` |
//! | section of the configuration | `settings.rs` |
//! | order of policies and choice of objects | `plan.rs` |
//! | events, as lines of a journal | `event.rs` |
//! | a participant and one interaction, folded | `participant.rs`, `trial.rs` |
//! | rows for statistics programs, and their data dictionary | `rows.rs`, `dictionary.rs` |
//! | success, seconds and questions by policy, with intervals | `report.rs`, `paired.rs` |
//! | charts of the results, and charts in general | `pictures.rs`, [`charts`] |
//! | means, intervals; the verdict on an interaction, also for simulated users | `stats.rs`, `verdict.rs` |

pub mod charts;
mod dictionary;
mod event;
mod item;
mod paired;
mod participant;
mod pictures;
mod plan;
mod protocol;
mod report;
mod rows;
mod settings;
mod stats;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod trial;
mod verdict;

pub use dictionary::{Column, INTERACTIONS, PARTICIPANTS, dictionary};
pub use event::{
    Asked, Begun, Drawn, Ending, Entry, Event, FILE_ENDING, Fault, FormatError, Heard, Source,
    VERSION, parse,
};
pub use item::{Item, Kind};
pub use paired::{Paired, paired};
pub use participant::{Participant, Stage, Status, people};
pub use pictures::pictures;
pub use plan::{Counts, Step, draw, new_id, plan};
pub use protocol::{Design, Objects, Order, Protocol};
pub use report::{Answers, Group, Report, report};
pub use rows::{Tables, tables, to_json};
pub use settings::{PART, Study};
pub use stats::{Interval, Mean, wilson};
pub use trial::{End, Trial};
pub use verdict::Verdict;

/// Returns the items in order of appearance, each once.
pub fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    for item in items {
        if !list.contains(&item) {
            list.push(item);
        }
    }
    list
}
