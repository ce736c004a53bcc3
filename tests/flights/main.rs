//! Flights: what the reducers were given is given to them again, and they state the same.

#![allow(clippy::unwrap_used, reason = "tests")]

mod changed;
mod corpus;
mod exact;

use std::path::Path;

use service::flight::{Report, head, list, replay};

/// Replays a flight with the program of its service.
fn replayed(file: &Path, changes: &[(&str, &str)]) -> Report {
    let changes: Vec<_> =
        changes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let head = head(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let report = match head.service.as_str() {
        "speech" => replay::<speech::shell::SpeechProgram>(file, &changes),
        "grounding" => replay::<grounding::shell::GroundingProgram>(file, &changes),
        "policy" => replay::<policy::shell::PolicyProgram>(file, &changes),
        "arm" => replay::<arm::shell::ArmProgram<drivers::Shipped>>(file, &changes),
        "baxter" => replay::<baxter::shell::BaxterProgram>(file, &changes),
        other => panic!("{}: a flight of {other}", file.display()),
    };
    report.unwrap_or_else(|e| panic!("{}: {e}", file.display()))
}

/// Replays every flight of a folder, or up to the first difference.
fn replay_all(folder: &Path) -> Result<Vec<Report>, String> {
    let mut reports = Vec::new();
    for file in list(folder).unwrap_or_else(|e| panic!("{e}")) {
        let report = replayed(&file, &[]);
        if let Some(it) = &report.difference {
            let file = file.display();
            let (pass, after_s, path) = (it.pass, it.after_s, &it.path);
            let (recorded, recomputed) = (&it.recorded, &it.recomputed);
            let last = it.before.last();
            return Err(format!(
                "{file}: pass {pass}, {after_s:.3} s after the start: {path}: {recorded} recorded, \
                 {recomputed} recomputed, after {last:?}"
            ));
        }
        reports.push(report);
    }
    Ok(reports)
}
