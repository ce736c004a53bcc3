//! What a replay reports: a changed output by its field, changed settings by the decisions that differ, and
//! flights that are torn or of another build.

use std::fs;
use std::path::{Path, PathBuf};

use grounding::shell::GroundingProgram;
use grounding::{GroundingNode, In, Out};
use messages::{Hypothesis, Observation, Utterance};
use service::exit::Exit;
use service::flight::{Head, Ring, Tap, list, replay};
use service::lifecycle::Environment;
use service::service_loop::Program;
use service::{Effects, Event, Never, Node, Time};
use tempfile::TempDir;
use whichone_tests::settings;
use whichone_tests::simulated_group::{Faults, GroupUser, SimulatedGroup};

use crate::replayed;

/// Records grounding as it reads these texts, one a pass; `distort` changes what it states.
fn flight_of_grounding(
    folder: &Path,
    texts: &[&str],
    mut distort: impl FnMut(usize, &mut Observation),
) -> PathBuf {
    let settings = settings(&[]);
    let environment = Environment::nowhere();
    let head = Head::of::<GroundingProgram>(&environment, &settings, Time(1), 1);
    let ring = Ring { folder: folder.to_owned(), bytes_max: 1 << 30, free_min: 0 };
    let mut tap = Tap::start(ring, &head, &[] as &[Never]);
    let config = GroundingProgram::config(&environment, &settings).unwrap();
    let mut node = GroundingNode::recover(config, Vec::new()).unwrap();
    for (pass, text) in texts.iter().enumerate() {
        let now = Time(1_000_000_000 * (pass as u64 + 1));
        let mut utterance = Utterance { seq: pass as u64 + 1, ..Utterance::default() };
        utterance.set_hypotheses(&[Hypothesis::certain((*text).to_owned())]).unwrap();
        let event = Event::Message(In::Utterance(utterance.into()));
        tap.event(&event, now);
        let mut honest = Effects::default();
        let mut stated: Effects<_, Never> = Effects::default();
        node.on(event, now, &mut honest);
        for mut output in honest.take_outputs() {
            if let Out::Observation(observation) = &mut output {
                distort(pass, observation);
            }
            stated.publish(output);
        }
        tap.stated(&stated);
        tap.end_pass();
    }
    drop(tap);
    list(folder).unwrap().pop().unwrap()
}

const TEXTS: [&str; 3] = ["the white bowl", "yes", "not the metal one"];

#[test]
fn changed_output_is_reported_with_its_field_and_what_came_before() {
    let folder = tempfile::tempdir().unwrap();
    let file = flight_of_grounding(folder.path(), &TEXTS, |_, _| {});
    let report = replayed(&file, &[]);
    assert_eq!((report.difference, report.passes, report.events), (None, 3, 3));

    let folder = tempfile::tempdir().unwrap();
    let distort = |pass, observation: &mut Observation| {
        if pass == 1 {
            observation.readings[0].weight = 0.125;
        }
    };
    let file = flight_of_grounding(folder.path(), &TEXTS, distort);
    let difference = replayed(&file, &[]).difference.unwrap();
    assert_eq!((difference.pass, difference.at_ns), (2, 2_000_000_000));
    assert_eq!(difference.path, "outputs[0].Observation.readings[0].weight");
    assert_eq!(difference.recorded, 0.125);
    assert_eq!(difference.recomputed, 1.0);
    assert_eq!(difference.before.len(), 2);
    let last = &difference.before[1]["event"]["Message"]["Utterance"];
    assert_eq!(last["seq"], 2);
    assert!(last.to_string().contains("\"yes\""), "{last}");
}

/// A flight of each service of a dialogue.
fn flights() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let group = SimulatedGroup::new(settings(&[]), GroupUser::typing(3), Faults::none());
    group.recorded(folder.path(), u64::MAX).run();
    folder
}

fn flight_of(folder: &Path, service: &str) -> PathBuf {
    let flights = list(folder).unwrap();
    let is_of = |path: &PathBuf| path.file_name().unwrap().to_str().unwrap().starts_with(service);
    flights.into_iter().find(is_of).unwrap()
}

#[test]
fn other_settings_are_answered_with_the_decisions_that_differ() {
    let folder = flights();
    let file = flight_of(folder.path(), "policy");
    let same = replayed(&file, &[("dialogue.planner", "lookahead")]);
    assert_eq!((same.decisions.as_slice(), same.other_passes), (&[][..], 0));
    let others =
        dialogue::registry::names().map(|name| replayed(&file, &[("dialogue.planner", name)]));
    assert!(others.iter().all(|report| report.difference.is_none()));
    let mut changed = others.iter().flat_map(|report| &report.decisions);
    let changed = changed.find(|it| it.recorded.is_some() && it.recomputed.is_some());
    let changed = changed.unwrap_or_else(|| panic!("{others:?}"));
    let (recorded, recomputed) = (changed.recorded.as_ref(), changed.recomputed.as_ref());
    assert_ne!(recorded.map(|it| &it.what), recomputed.map(|it| &it.what));
    assert!(recorded.is_some_and(|it| it.interaction == 1 && it.value.is_some()), "{changed:?}");

    let changes = [("dialogue.plannner".to_owned(), "entropy".to_owned())];
    let failure = replay::<policy::shell::PolicyProgram>(&file, &changes).unwrap_err();
    assert_eq!(failure.exit, Exit::Config);
    assert!(failure.to_string().contains("planner"), "{failure}");
    let changes = [("group.scene".to_owned(), "tools".to_owned())];
    let failure = replay::<policy::shell::PolicyProgram>(&file, &changes).unwrap_err();
    assert_eq!(failure.exit, Exit::Usage);
}

#[test]
fn torn_flight_replays_up_to_its_last_whole_frame() {
    let folder = flights();
    let file = flight_of(folder.path(), "speech");
    let whole = replayed(&file, &[]);
    assert!(!whole.torn && whole.passes > 20, "{whole:?}");
    let bytes = fs::read(&file).unwrap();
    let mut passes = whole.passes;
    // The settings, in the first frame, are most of it.
    for len in [bytes.len() - 1, bytes.len() - 300, bytes.len() - 1_000] {
        fs::write(&file, &bytes[..len]).unwrap();
        let torn = replayed(&file, &[]);
        assert_eq!(torn.difference, None);
        assert!(torn.torn && torn.passes <= passes, "{len}: {torn:?}");
        passes = torn.passes;
    }
    assert!(passes < whole.passes && passes > 0, "{passes}");
    // What follows a damaged frame cannot be read.
    let mut damaged = bytes.clone();
    damaged[bytes.len() - 500] ^= 0x10;
    fs::write(&file, &damaged).unwrap();
    let damaged = replayed(&file, &[]);
    assert!(damaged.torn && damaged.difference.is_none(), "{damaged:?}");
    assert!(damaged.damaged_at.is_some_and(|at| at < bytes.len() as u64 - 500), "{damaged:?}");
}

#[test]
fn flight_of_another_build_or_service_is_refused() {
    let folder = flights();
    let file = flight_of(folder.path(), "grounding");
    let failure = replay::<policy::shell::PolicyProgram>(&file, &[]).unwrap_err();
    assert_eq!(failure.exit, Exit::Config);
    assert!(failure.to_string().contains("grounding"), "{failure}");
    let bytes = fs::read(&file).unwrap();
    let mut other = bytes.clone();
    other[8] = 77;
    let refusals = [
        (other, "found 77"),
        (b"not a flight".to_vec(), "found another file"),
        (bytes[..40].to_vec(), "first frame"),
    ];
    for (content, part) in refusals {
        fs::write(&file, content).unwrap();
        let failure = replay::<GroundingProgram>(&file, &[]).unwrap_err();
        assert_eq!(failure.exit, Exit::Config);
        assert!(failure.to_string().contains(part), "{failure}");
    }
}
