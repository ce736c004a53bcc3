//! A client's user answers the prompt that the client has shown.

use super::*;

/// An answer that begins at `onset` of a user who was shown the prompt `seen`.
fn yes(key: u8, seen: u64, onset: Time) -> In<'static> {
    said("yes", key, seen, onset)
}

fn said(text: &str, key: u8, seen: u64, onset: Time) -> In<'static> {
    In::Injection(Injection {
        key: RequestKey([key; 16]),
        onset_ns: onset.ns(),
        end_ns: 0,
        seen_prompt: seen,
        from: String::new(),
        sound: Sound::Text(text.to_owned()),
    })
}

/// Presents a question completely.
fn put(speech: &mut Speech, prompt: u64) {
    let playback = speech.take(0.1, ask(prompt)).spoken().unwrap().playback;
    speech.playback(0.1, playback, PlaybackState::Started);
    speech.playback(1.0, playback, PlaybackState::Ended);
}

#[test]
fn words_answer_the_question_that_their_client_has_shown_and_no_other() {
    let mut speech = Speech::new();
    put(&mut speech, 7);
    put(&mut speech, 8);
    for (key, seen, asked) in [
        (1, 7, vec![(7, 1, 1)]),
        (2, 6, vec![]),
        (3, 8, vec![(8, 1, 1)]),
        (4, 0, vec![(8, 1, 1), (7, 1, 1)]),
    ] {
        let onset = speech.now;
        assert_eq!(speech.take(1.0, yes(key, seen, onset)).asked(), asked, "{seen}");
    }
}

#[test]
fn words_after_a_remark_answer_the_questions_before_it() {
    let mut speech = Speech::new();
    put(&mut speech, 7);
    let text = FixedText::truncated("All right.");
    let remark = RobotAct { act: 8, prompt: 8, presentation: 1, text, ..RobotAct::default() };
    let remark = RobotAct { kind: ActKind::Say.code(), ..remark };
    speech.take(0.5, In::Act(MessageRef::from(remark)));
    let onset = speech.now;
    assert_eq!(speech.take(0.1, yes(1, 8, onset)).asked(), [(7, 1, 1)]);
}

/// Before the voice has begun, while it begins, and by a client with words after its start.
#[test]
fn question_is_answered_as_soon_as_it_is_shown() {
    for after_s in [0.0, 0.05, 0.2] {
        for sounds_meanwhile in [false, true] {
            let mut speech = Speech::new();
            put(&mut speech, 7);
            assert!(speech.take(0.5, ask(8)).spoken().is_some());
            let onset = speech.now + Span::from_s(after_s);
            if sounds_meanwhile {
                speech.playback(after_s + 0.01, 2, PlaybackState::Started);
            }
            let outputs = speech.take(after_s, yes(1, 8, onset));
            assert_eq!(outputs.asked(), [(8, 1, 0)], "{after_s} s, {sounds_meanwhile}");
            let utterance = outputs.utterance().unwrap();
            assert!(utterance.asked().unwrap()[0].began_ns <= utterance.onset_ns);
        }
    }
}

#[test]
fn question_that_waits_for_the_arm_or_the_speaker_may_be_answered() {
    let mut speech = Speech::new();
    let onset = speech.now;
    speech.take(0.1, began(onset, true));
    assert!(speech.take(0.2, ask(8)).spoken().is_none(), "a user speaks");
    let onset = speech.now;
    assert_eq!(speech.take(0.0, yes(1, 8, onset)).asked(), [(8, 1, 0)]);
}

/// The client hears of the question before the speech service does.
#[test]
fn words_wait_for_the_question_that_they_answer() {
    let mut speech = Speech::new();
    put(&mut speech, 7);
    let onset = speech.now;
    assert!(speech.take(0.0, yes(1, 8, onset)).utterance().is_none());
    assert!(speech.take(0.1, yes(1, 8, onset)).utterance().is_none(), "sent again");
    assert_eq!(speech.take(0.1, ask(8)).asked(), [(8, 1, 0)]);
    assert!(speech.take(0.1, yes(1, 8, onset)).utterance().is_none(), "once");
}

#[test]
fn words_wait_no_longer_for_a_question_that_does_not_come() {
    let mut speech = Speech::new();
    put(&mut speech, 7);
    let onset = speech.now;
    assert!(speech.take(0.0, yes(1, u64::MAX, onset)).utterance().is_none());
    let mut effects = Effects::default();
    speech.node.on(Event::Tick, speech.now + Span::from_s(1.1), &mut effects);
    assert_eq!(Outputs(effects.take_outputs()).asked(), [(7, 1, 1)]);
}

#[test]
fn stop_waits_for_no_question() {
    let mut speech = Speech::new();
    let onset = speech.now;
    assert!(speech.take(0.1, said("stop", 1, 9, onset)).stops_motion());
}

/// Kills between a question and its sound.
#[test]
fn answers_outlive_kills_of_the_service() {
    let (mut speech, mut journal) = (Speech::new(), Vec::new());
    let mut kill = |speech: &mut Speech| {
        journal.append(&mut speech.records);
        speech.node = SpeechNode::recover(Speech::config(), journal.clone()).unwrap();
    };
    for (at, prompt) in (0..).zip([7, 8, 9]) {
        kill(&mut speech);
        let (key, onset, applied) = (prompt as u8, speech.now, 2 * at);
        assert!(speech.take(0.1, yes(key, prompt, onset)).utterance().is_none(), "not ready");
        speech.take(0.1, In::Mark(AppliedMark { seq: applied }));
        assert!(speech.take(0.1, yes(key, prompt, onset)).utterance().is_none(), "unknown");
        assert_eq!(speech.take(0.1, ask(prompt)).asked(), [(prompt, 1, 0)]);
        kill(&mut speech);
        speech.take(0.1, In::Mark(AppliedMark { seq: applied + 1 }));
        speech.take(0.1, ask(prompt + 1));
        let onset = speech.now;
        let again = speech.take(0.1, yes(key + 100, prompt, onset));
        assert_eq!(again.asked(), [(prompt, 1, 0)], "known, though it never sounded");
        speech.take(0.1, In::Mark(AppliedMark { seq: applied + 2 }));
    }
}

#[test]
fn checkpoint_keeps_what_waits_for_its_question() {
    let mut speech = Speech::new();
    put(&mut speech, 7);
    let onset = speech.now;
    speech.take(0.0, yes(1, 8, onset));
    let checkpoint = speech.node.checkpoint().unwrap();
    speech.node = SpeechNode::resume(Speech::config(), &checkpoint).unwrap();
    assert_eq!(speech.node.checkpoint().unwrap(), checkpoint);
    assert_eq!(speech.take(0.1, ask(8)).asked(), [(8, 1, 0)]);
}
