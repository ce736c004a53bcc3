//! Questions that cost the robot's own seconds.

use super::{answer, first, reply, settings_with};
use config::Settings;
use dialogue::Answer;
use messages::ActKind;
use scene::{ObjectId, Question, Reading, Response};
use setup::DialogueSettings;

const ROBOT: (&str, &str) = ("dialogue.costs.from", "robot");
pub(super) const POINTING: [(&str, &str); 3] =
    [ROBOT, ("dialogue.mode", "present"), ("dialogue.planner", "no-attribute")];

/// The promises that hold with the written costs hold with the robot's own.
#[test]
fn truthful_users_are_asked_as_few_questions() {
    for (over, questions_max) in [(&[ROBOT][..], 3), (&POINTING[..], 5)] {
        let mut manager = settings_with(over).manager().unwrap();
        let model = manager.model().clone();
        for wanted in (0..6).map(ObjectId::from) {
            let mut state = first(&mut manager, Reading::default());
            while state.act.kind == ActKind::Ask {
                let said = Answer::truthful(&model, state.act.question, wanted);
                state = reply(&mut manager, &state, said.reading(&model));
            }
            let open = state.open.as_ref().unwrap();
            assert_eq!(open.pick.map(|(_, object)| object), Some(wanted));
            assert!(open.questions <= questions_max, "{wanted:?}: {}", open.questions);
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
    let mut state = first(&mut manager, Reading::default());
    for object in left.iter().take(4) {
        assert_eq!(state.act.question, Question::Point(ObjectId::from(*object)), "{seconds:?}");
        state = reply(&mut manager, &state, answer(Response::No));
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
