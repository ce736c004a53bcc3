//! What is known of a dialogue at one moment.

use messages::{
    Activity, ArmStatus, Hearing, PolicyView, PresentationState, Presented, Receipt, ReceiptStatus,
};

/// The latest of everything.
#[derive(Clone, Debug, Default)]
pub(in crate::verbs) struct Seen {
    /// What the policy thinks.
    pub(in crate::verbs) view: Option<PolicyView>,
    /// What was said last.
    pub(in crate::verbs) presented: Presented,
    /// What is still to be applied.
    pub(in crate::verbs) activity: Option<Activity>,
    /// How well the robot hears.
    pub(in crate::verbs) hearing: Option<Hearing>,
    /// What the arm does.
    pub(in crate::verbs) arm: Option<ArmStatus>,
    /// Highest utterance that was accepted.
    accepted: u64,
}

/// A prompt and which presentation of it.
pub(in crate::verbs) type Said = (u64, u32);

impl Seen {
    /// Takes note of what became of somebody's words.
    pub(super) fn receipt(&mut self, receipt: &Receipt) {
        if receipt.status == ReceiptStatus::Accepted.code() {
            self.accepted = self.accepted.max(receipt.seq);
        }
    }

    /// Whether the view holds everything that was said: no utterance is accepted and not yet
    /// applied, and no sound is still being recognised.
    pub(in crate::verbs) fn is_settled(&self) -> bool {
        let applied = self.view.as_ref().is_some_and(|view| view.applied >= self.accepted);
        applied && self.activity.is_some_and(|activity| activity.pending == 0)
    }

    /// The standing question, once it has been said to its end.
    pub(in crate::verbs) fn open_question(&self) -> Option<Said> {
        let view = self.view.as_ref()?;
        let Presented { prompt, presentation, state, .. } = self.presented;
        let is_asked = view.interaction != 0
            && view.decision == "ask"
            && prompt == view.prompt
            && state == PresentationState::Ended.code();
        is_asked.then_some((prompt, presentation))
    }

    /// The words that are being said or were said last, if they are still the robot's latest.
    pub(in crate::verbs) fn words(&self) -> Option<(Said, &str)> {
        let view = self.view.as_ref()?;
        let Presented { prompt, presentation, state, .. } = self.presented;
        let has_begun = PresentationState::from_code(state).is_ok_and(PresentationState::has_begun);
        let latest = has_begun && prompt != 0 && prompt == view.prompt && !view.text.is_empty();
        latest.then_some(((prompt, presentation), view.text.as_str()))
    }
}

/// Parts of dialogues, for tests.
#[cfg(test)]
pub(in crate::verbs) mod example {
    use messages::{Ended, Outcome, UtteranceSeq};
    use scene::Question;

    use super::*;

    /// Interaction 7 is open, the robot has asked `question` and said it to its end.
    pub(in crate::verbs) fn asked(question: Question) -> Seen {
        let view = PolicyView {
            applied: 3,
            interaction: 7,
            question,
            prompt: 5,
            text: "Is it so?".into(),
            decision: "ask".into(),
            ..PolicyView::default()
        };
        let state = PresentationState::Ended.code();
        let presented = Presented { prompt: 5, presentation: 1, state, ..Presented::default() };
        let activity = Some(Activity::default());
        Seen { view: Some(view), presented, activity, accepted: 3, ..Seen::default() }
    }

    /// Interaction `id` has ended, none is open.
    pub(in crate::verbs) fn ended(id: u64) -> Seen {
        let last = Ended {
            interaction: dialogue::ids::InteractionId(id),
            object: Some(scene::ObjectId(1)),
            name: Some("clear".into()),
            outcome: Outcome::Delivered,
            questions: 2,
            seconds: 12.5,
            utterances: (UtteranceSeq(1), UtteranceSeq(3)),
        };
        let mut seen = asked(Question::None);
        let view = seen.view.take().map(|view| PolicyView {
            interaction: 0,
            decision: "say".into(),
            last: Some(last),
            ..view
        });
        Seen { view, ..seen }
    }

    /// As `seen`, with one more utterance accepted than applied.
    pub(in crate::verbs) fn unapplied(seen: Seen) -> Seen {
        Seen { accepted: seen.accepted + 1, ..seen }
    }

    /// As `seen`, with a sound that is still being recognised.
    pub(in crate::verbs) fn listening(seen: Seen) -> Seen {
        Seen { activity: Some(Activity { pending: 1, ..Activity::default() }), ..seen }
    }
}

#[cfg(test)]
mod tests {
    use scene::Question;

    use super::*;

    #[test]
    fn a_dialogue_is_settled_once_the_view_holds_every_word() {
        let seen = example::asked(Question::None);
        assert!(seen.is_settled());
        assert!(!example::unapplied(seen.clone()).is_settled());
        assert!(!example::listening(seen.clone()).is_settled());
        assert!(!Seen { activity: None, ..seen.clone() }.is_settled());
        assert!(!Seen { view: None, ..seen }.is_settled());
    }

    #[test]
    fn only_accepted_words_are_waited_for() {
        let mut seen = example::asked(Question::None);
        let refused = ReceiptStatus::Refused.code();
        seen.receipt(&Receipt { seq: 9, status: refused, ..Receipt::default() });
        assert!(seen.is_settled());
        seen.receipt(&Receipt { seq: 4, ..Receipt::default() });
        assert!(!seen.is_settled());
    }

    #[test]
    fn a_question_is_open_from_the_end_of_its_presentation() {
        let mut seen = example::asked(Question::None);
        assert_eq!(seen.open_question(), Some((5, 1)));
        seen.presented.state = PresentationState::Speaking.code();
        assert_eq!(seen.open_question(), None);
        assert_eq!(seen.words(), Some(((5, 1), "Is it so?")));
        seen.presented.prompt = 4;
        assert_eq!(seen.words(), None);
        assert_eq!(example::ended(7).open_question(), None);
    }
}
