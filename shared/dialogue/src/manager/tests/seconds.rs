//! Questions that cost the robot's own seconds.

use super::fixture::{Change, Settings, answer, first, reply, settings_with};
use crate::Answer;
use scene::{ObjectId, Question, Reading, Response};
use vocabulary::{ActKind, Durations, Mode};

/// Roughly as Baxter takes them: questions by their length, bowls by their distance.
fn with_durations(settings: &mut Settings) {
    let of_values = |count: usize| (0..count).map(|v| 3.6 + 0.2 * v as f64).collect();
    settings.durations = Some(Durations {
        attribute: [3, 2, 2, 1, 3].into_iter().map(of_values).collect(),
        which: vec![4.1, 4.2, 3.9, 4.0, 3.8],
        point: vec![7.4, 6.1, 8.3, 6.6, 9.2, 7.9],
        pick: vec![14.0, 12.5, 15.2, 13.1, 16.4, 14.7],
    });
}

pub(super) fn pointing(settings: &mut Settings) {
    with_durations(settings);
    settings.mode = Mode::Present;
    settings.planner = "no-attribute";
}

/// The promises that hold with the written costs hold with the robot's own.
#[test]
fn truthful_users_are_asked_as_few_questions() {
    let cases: [(Change, u32); 2] = [(with_durations, 3), (pointing, 5)];
    for (change, questions_max) in cases {
        let settings = Settings { misperception: 0.0, ..settings_with(change) };
        let mut manager = settings.manager();
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
    let settings = settings_with(pointing);
    let mut manager = settings.manager();
    let seconds = &settings.durations.as_ref().unwrap().point;
    let mut left: Vec<usize> = (0..6).collect();
    left.sort_by(|a, b| seconds[*a].total_cmp(&seconds[*b]));
    let mut state = first(&mut manager, Reading::default());
    for object in left.iter().take(4) {
        assert_eq!(state.act.question, Question::Point(ObjectId::from(*object)), "{seconds:?}");
        state = reply(&mut manager, &state, answer(Response::No));
    }
}
