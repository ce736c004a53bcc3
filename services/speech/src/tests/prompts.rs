//! When a prompt sounds, and which one an utterance answers.

use super::*;

#[test]
fn utterance_names_the_questions_that_had_begun() {
    let mut speech = Speech::new();
    assert!(speech.take(0.0, ask(7)).spoken().is_some());
    speech.playback(0.1, 1, PlaybackState::Started);
    speech.playback(1.5, 1, PlaybackState::Ended);
    let outputs = speech.type_in(0.8, "yes");
    assert_eq!(outputs.asked(), [(7, 1, 1)]);
    let utterance = outputs.utterance().unwrap();
    let only = utterance.asked().unwrap()[0];
    assert_eq!(only.ended_ns - only.began_ns, Span::from_s(1.5).0);
}

#[test]
fn player_waits_while_a_user_speaks_or_an_utterance_is_processed() {
    let mut speech = Speech::new();
    let onset = speech.now;
    let outputs = speech.take(0.1, began(onset, true));
    assert_eq!(outputs.activity().map(|a| a.onset_ns), Some(onset.ns()), "published at once");
    assert!(speech.take(0.2, ask(7)).spoken().is_none());
    let outputs = speech.take(0.5, ended(onset));
    assert!(outputs.spoken().is_none(), "the utterance is being recognised");
    assert_eq!(outputs.recognises(), Some(SOUND));
    assert_eq!(outputs.activity().map(|a| (a.onset_ns, a.pending)), Some((onset.ns(), 1)));
    let outputs = speech.take(0.2, recognised(SOUND, None));
    assert!(outputs.spoken().is_some(), "no speech found: {outputs:?}");
    assert_eq!(outputs.activity().map(|a| a.onset_ns), Some(0));
}

#[test]
fn player_waits_until_typed_text_is_applied() {
    let mut speech = Speech::new();
    speech.type_in(0.0, "get me the bowl");
    assert!(speech.take(0.1, ask(7)).spoken().is_none(), "not applied yet");
    assert!(speech.take(0.1, In::Mark(AppliedMark { seq: 1 })).spoken().is_some());
}

#[test]
fn player_does_not_wait_forever_for_the_recogniser() {
    let mut speech = Speech::new();
    let onset = speech.now;
    speech.take(0.0, began(onset, true));
    assert!(speech.take(5.0, ask(7)).spoken().is_none());
    assert!(speech.take(6.0, ask(7)).spoken().is_some());
}

#[test]
fn player_repeats_an_interrupted_question() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.playback(0.1, 1, PlaybackState::Started);
    let onset = speech.now + Span::from_s(0.6);
    let outputs = speech.take(0.7, began(onset, true));
    assert!(outputs.stops_speaking(), "{outputs:?}");
    let Some(Record::Presented(interrupted)) = speech.records.last() else { panic!() };
    assert!(!interrupted.complete && interrupted.question == WHITE);
    let presented = outputs.find(|out| match out {
        Out::Presented(presented) => Some((presented.prompt, presented.state)),
        _ => None,
    });
    assert_eq!(presented, Some((7, PresentationState::Interrupted.code())));
    assert!(speech.take(0.1, ask(7)).spoken().is_none(), "the user is still speaking");
    speech.take(0.5, ended(onset));
    let outputs = speech.take(0.5, recognised(SOUND, None));
    assert_eq!(outputs.spoken().map(|request| request.playback), Some(2), "{outputs:?}");
    // The interrupting utterance may answer the question.
    let outputs = speech.type_in(0.1, "yes");
    let utterance = outputs.utterance().unwrap();
    let asked = utterance.asked().unwrap();
    assert!(asked.iter().any(|a| (a.prompt, a.whole) == (7, 0) && a.ended_ns > 0), "{asked:?}");
}

#[test]
fn prompt_that_has_not_sounded_yet_waits_for_a_user_who_begins_to_speak() {
    let mut speech = Speech::new();
    assert!(speech.take(0.0, ask(7)).spoken().is_some());
    let onset = speech.now;
    assert!(speech.take(0.1, began(onset, false)).stops_speaking(), "nothing was heard of it");
    speech.playback(0.0, 1, PlaybackState::Interrupted);
    assert!(speech.take(0.1, ask(7)).spoken().is_none(), "the user is still speaking");
    speech.take(0.5, ended(onset));
    assert!(speech.take(0.1, recognised(SOUND, None)).spoken().is_some());
}

#[test]
fn half_duplex_microphone_does_not_interrupt_but_typed_text_does() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.playback(0.1, 1, PlaybackState::Started);
    let at = speech.now;
    assert!(!speech.take(0.2, began(at, false)).stops_speaking());
    assert!(speech.type_in(0.2, "the white one").stops_speaking());
}

#[test]
fn superseded_question_may_still_be_answered() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.playback(0.1, 1, PlaybackState::Started);
    speech.take(0.5, ask(8));
    speech.playback(0.1, 2, PlaybackState::Started);
    let outputs = speech.type_in(0.3, "yes");
    assert_eq!(outputs.asked(), [(8, 1, 0), (7, 1, 0)], "newest first");
    let utterance = outputs.utterance().unwrap();
    assert_eq!(utterance.asked().unwrap()[0].ended_ns, 0, "it is being spoken");
}

#[test]
fn utterance_names_who_typed_it_and_a_name_that_cannot_be_printed_is_refused() {
    let said = |from: &str| {
        In::Injection(Injection {
            key: RequestKey([1; 16]),
            onset_ns: 0,
            end_ns: 0,
            seen_prompt: 0,
            from: from.to_owned(),
            sound: Sound::Text("yes".to_owned()),
        })
    };
    for (from, expected) in [(" Ann ", "Ann"), ("", ""), ("guest", "")] {
        let utterance = Speech::new().take(1.0, said(from)).utterance().unwrap();
        assert_eq!(utterance.from.as_str(), Ok(expected), "{from:?}");
    }
    for (from, reason) in [(&*"n".repeat(65), "at most 64 bytes"), ("a\tb", "printable")] {
        let outputs = Speech::new().take(1.0, said(from));
        let receipt = outputs.receipt().unwrap();
        assert_eq!(receipt.status, ReceiptStatus::Refused.code());
        assert!(receipt.note.as_str().unwrap().contains(reason), "{receipt:?}");
        assert!(outputs.utterance().is_none());
    }
}
