//! Moments of a dialogue, for tests.

use messages::{
    ActKind, Activity, Ended, InteractionId, Outcome, PolicyView, PresentationState, Presented,
    UtteranceSeq,
};
use scene::Question;
use service::view::Latest;

/// Interaction 7 is open, the robot has asked `question` and said it to its end.
pub(in crate::verbs) fn asked(question: Question) -> Latest {
    let view = PolicyView {
        applied: 3,
        interaction: 7,
        question,
        prompt: 5,
        text: "Is it so?".into(),
        decision: ActKind::Ask,
        ..PolicyView::default()
    };
    let state = PresentationState::Ended.into();
    let presented = Presented { prompt: 5, presentation: 1, state, ..Presented::default() };
    let activity = Some(Activity::default());
    Latest { view: Some(view), presented, activity, accepted: 3, ..Latest::default() }
}

/// Interaction `id` has ended, none is open.
pub(in crate::verbs) fn ended(id: u64) -> Latest {
    let last = Ended {
        interaction: InteractionId(id),
        object: Some(1.into()),
        name: Some("clear".into()),
        outcome: Outcome::Delivered,
        questions: 2,
        seconds: 12.5,
        utterances: (UtteranceSeq(1), UtteranceSeq(3)),
    };
    let mut latest = asked(Question::None);
    let view = latest.view.take().map(|view| PolicyView {
        interaction: 0,
        decision: ActKind::Say,
        last: Some(last),
        ..view
    });
    Latest { view, ..latest }
}

/// As `latest`, with one more utterance accepted than applied.
pub(in crate::verbs) fn unapplied(latest: Latest) -> Latest {
    Latest { accepted: latest.accepted + 1, ..latest }
}

/// As `latest`, with a sound that is still being recognised.
pub(in crate::verbs) fn listening(latest: Latest) -> Latest {
    Latest { activity: Some(Activity { pending: 1, ..Activity::default() }), ..latest }
}
