//! A lost journal, of speech itself or of another service.

use service::SetAside;

use super::*;

const OVER: u64 = service::journal_set::NUMBERS_SKIPPED;

fn start(speech: &mut Speech, is_own: bool) -> Outputs {
    let mut effects = Effects::default();
    speech.node.on(Event::SetAside(SetAside { over: OVER, is_own }), speech.now, &mut effects);
    speech.node.on(Event::Started, speech.now, &mut effects);
    Outputs(effects.take_outputs())
}

#[test]
fn utterances_from_before_a_journal_was_set_aside_are_not_sent_again() {
    let mut speech = Speech::new();
    assert_eq!(speech.type_in(1.0, "the bowl").utterance().unwrap().seq, 1);
    assert!(start(&mut speech, false).utterance().is_none());
    speech.take(0.1, In::Mark(AppliedMark { seq: OVER }));
    let next = speech.type_in(1.0, "the white bowl");
    assert_eq!(next.utterance().unwrap().seq, OVER + 1);
    assert_eq!(next.receipt().unwrap().seq, OVER + 1);
}

#[test]
fn speech_without_memory_numbers_above_everything_that_the_policy_may_know() {
    let mut speech = Speech::new();
    start(&mut speech, true);
    speech.take(0.1, In::Mark(AppliedMark { seq: OVER }));
    assert_eq!(speech.type_in(1.0, "the bowl").utterance().unwrap().seq, OVER + 1);
}

/// The robot fell silent for good: a policy without memory gave its prompts the numbers of those
/// that speech had said before.
#[test]
fn prompts_of_a_policy_without_memory_are_said() {
    let mut speech = Speech::new();
    let act = |prompt| RobotAct {
        act: prompt,
        kind: ActKind::Say.code(),
        prompt,
        presentation: 1,
        text: FixedText::truncated("All right."),
        ..RobotAct::default()
    };
    let said = speech.take(1.0, In::Act(MessageRef::from(act(9)))).spoken().expect("it is said");
    speech.playback(1.0, said.playback, PlaybackState::Started);
    speech.playback(1.0, said.playback, PlaybackState::Ended);
    assert!(speech.take(1.0, In::Act(MessageRef::from(act(9)))).spoken().is_none(), "it was said");
    assert!(speech.take(1.0, In::Act(MessageRef::from(act(OVER + 1)))).spoken().is_some());
}
