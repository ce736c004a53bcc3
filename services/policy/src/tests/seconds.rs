//! Questions that cost the robot's own seconds.

use super::{answer, at, heard, settings_with};
use dialogue::manager::Record;
use dialogue::manager::{Manager, refold};

use config::Settings;
use dialogue::Answer;
use messages::{ActKind, PromptId};
use scene::{ObjectId, Question, Reading, Response};

const ROBOT: (&str, &str) = ("dialogue.costs.from", "robot");
const POINTING: [(&str, &str); 3] =
    [ROBOT, ("dialogue.mode", "present"), ("dialogue.planner", "no-attribute")];

/// A dialogue with a truthful user, until the pick.
fn dialogue(manager: &mut Manager, wanted: ObjectId) -> Vec<Record> {
    let (mut state, mut records) = (manager.first(), Vec::new());
    let mut cause = heard(1, PromptId(0), Reading::default());
    for turn in 1..20 {
        state = manager.next(&state, &cause, at(turn));
        records.push(Record { cause, at: at(turn), state: state.clone() });
        if state.act.kind != ActKind::Ask {
            break;
        }
        let problem = manager.problem();
        let said = Answer::truthful(problem.model, state.act.question, wanted);
        cause = heard(turn + 1, state.act.prompt, said.reading(problem.model));
    }
    records
}

/// The promises that hold with the written costs hold with the robot's own.
#[test]
fn everybody_is_understood_in_as_few_questions() {
    for (over, questions_max) in [(&[ROBOT][..], 3), (&POINTING[..], 5)] {
        let settings = settings_with(over);
        let mut manager = settings.manager().unwrap();
        for wanted in (0..6).map(ObjectId::from) {
            let records = dialogue(&mut manager, wanted);
            let open = records.last().unwrap().state.open.as_ref().unwrap();
            assert_eq!(open.pick.map(|(_, object)| object), Some(wanted));
            assert!(open.questions() <= questions_max, "{wanted:?}: {}", open.questions());
            let again = &mut settings.manager().unwrap();
            refold(again, &records).unwrap_or_else(|e| panic!("{wanted:?}: {e}"));
        }
    }
}

#[test]
fn the_nearest_is_pointed_at_first() {
    let settings = settings_with(&POINTING);
    let mut manager = settings.manager().unwrap();
    let seconds = &settings.durations.as_ref().unwrap().point;
    let mut left: Vec<usize> = (0..6).collect();
    left.sort_by(|a, b| seconds[*a].total_cmp(&seconds[*b]));
    let mut state =
        manager.next(&manager.first(), &heard(1, PromptId(0), Reading::default()), at(1));
    for (n, object) in left.iter().take(4).enumerate() {
        assert_eq!(state.act.question, Question::Point(ObjectId::from(*object)), "{seconds:?}");
        let no = heard(n as u64 + 2, state.act.prompt, answer(Response::No));
        state = manager.next(&state, &no, at(n as u64 + 2));
    }
}

#[test]
fn other_seconds_are_other_settings() {
    let key = |over: &[(&str, &str)]| settings_with(over).manager().unwrap().key();
    let slow = ("speech.voice_words_per_minute", "100");
    assert_eq!(key(&[]), key(&[slow]), "the voice decides nothing where costs are written");
    assert_ne!(key(&[ROBOT]), key(&[ROBOT, slow]));
}

/// A service reads the durations; it does not plan them again.
#[test]
fn the_snapshot_holds_them() {
    let settings = settings_with(&POINTING);
    let run = tempfile::tempdir().unwrap();
    settings.write_snapshot(run.path()).unwrap();
    let read = Settings::load_snapshot(run.path()).unwrap();
    assert_eq!(read.durations, settings.durations);
    let key = |settings: &Settings| settings.manager().unwrap().key();
    assert_eq!(key(&read), key(&settings));
}
