//! The corpus: flights of a few dialogues, in `tests/flights/corpus`. A change of what a service decides or
//! sends shows here as the first field that differs. Where the change is wanted,
//!
//! ```text
//! WHICHONE_BLESS=1 cargo test -p whichone-tests --test flights corpus
//! ```
//!
//! records the corpus again, and the commit shows which dialogues have changed.

use std::fs;
use std::path::{Path, PathBuf};

use service::Time;
use service::flight::{list, pack};
use whichone_tests::settings;
use whichone_tests::simulated_group::{
    Faults, GroupUser, Happening, SimulatedGroup, before_camera,
};

use crate::replay_all;

/// The name of a dialogue, and a group that holds it.
type Dialogue = (&'static str, fn() -> SimulatedGroup);

/// Dialogues of the corpus: every scene that ships, every kind of user, perception, and services that die.
const DIALOGUES: [Dialogue; 6] = [
    ("bowls", || typing(&[], 3, Faults::none())),
    ("tools-entropy", || {
        typing(&[("group.scene", "tools"), ("dialogue.planner", "entropy")], 4, Faults::none())
    }),
    ("pointing", || {
        let settings = settings(&[("dialogue.gesture.enabled", "true")]);
        SimulatedGroup::new(settings, GroupUser::pointing(1), Faults::none())
    }),
    ("absence-faults", || {
        let absence = [("dialogue.prior.absent", "0.05"), ("dialogue.prior.objects", "history")];
        typing(&absence, 2, Faults::everything(5))
    }),
    ("put-back", || SimulatedGroup::with_client(settings(&[]), &[0, 4], true, Faults::none())),
    // Without the arm, which would move in real time for long.
    ("camera", || {
        let settings = settings(&[("group.perception.enabled", "true"), ("arm.time_scale", "1.0")]);
        let nothing = (Happening::Nothing, Time(0));
        let mut group = before_camera(&settings, 5, nothing, Faults::none(), 3);
        group.arm = None;
        group
    }),
];

fn typing(over: &[(&str, &str)], wanted: usize, faults: Faults) -> SimulatedGroup {
    SimulatedGroup::new(settings(over), GroupUser::typing(wanted), faults)
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("flights/corpus")
}

/// Records a dialogue in place of the one before.
fn record(name: &str, dialogue: fn() -> SimulatedGroup) {
    let folder = corpus().join(name);
    let _ = fs::remove_dir_all(&folder);
    let mut group = dialogue().recorded(&folder, u64::MAX);
    group.run();
    drop(group);
    for file in list(&folder).expect("flights") {
        pack(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    }
}

#[test]
fn flights_of_the_corpus_are_as_recorded() {
    let blesses = std::env::var_os("WHICHONE_BLESS").is_some();
    let mut differences = Vec::new();
    for (name, dialogue) in DIALOGUES {
        if blesses {
            record(name, dialogue);
        }
        match replay_all(&corpus().join(name)) {
            Ok(reports) => {
                let passes: u64 = reports.iter().map(|report| report.passes).sum();
                assert!(reports.len() >= 3 && passes > 100, "{name}: {passes} passes");
            }
            Err(difference) => differences.push(difference),
        }
    }
    let help =
        "help: if the change is wanted, WHICHONE_BLESS=1 records the corpus again (docs/replay.md)";
    assert!(differences.is_empty(), "{}\n{help}", differences.join("\n"));
}
