//! Utterances in progress: interim decoding, and when they end.

use super::*;

/// Returns the result for the pause at the end of [`segment`].
fn early(words: Result<Vec<Hypothesis>, &str>, snr_db: f32) -> In<'static> {
    let result = Some(Box::new(result(words, snr_db)));
    let at = segment(Time(0)).closing(std::time::Duration::ZERO);
    In::EarlyResult { sound: SOUND, at, result }
}

#[test]
fn pause_that_ends_an_utterance_depends_on_what_was_said() {
    let said = |text: &str| Ok(vec![Hypothesis::certain(text)]);
    let either = |best: &str, other: &str, weight: f64| {
        let other = Hypothesis { weight, ..Hypothesis::certain(other) };
        Ok(vec![Hypothesis { weight: 1.0 - weight, ..Hypothesis::certain(best) }, other])
    };
    for (what, interrupts, words, snr_db, expected) in [
        ("complete", false, said("yes"), 30.0, 120),
        ("a correction may follow", false, said("no"), 30.0, 500),
        ("a correction interrupts", true, said("no"), 30.0, 310),
        ("leads on", true, said("no the"), 30.0, 900),
        ("in noise", true, said("yes"), 10.0, 500),
        ("a stop in noise", false, said("stop"), 10.0, 120),
        ("perhaps a stop", false, either("stop", "top", 0.4), 30.0, 120),
        ("a stop that is not meant for the robot", false, Err("stop"), 30.0, 120),
        ("perhaps not complete", true, either("yes", "yes the", 0.3), 30.0, 500),
        ("hardly not complete", true, either("yes", "yes the", 0.1), 30.0, 120),
        ("not meant for the robot", true, Err("yes"), 30.0, 500),
        ("not meant for the robot so far", true, Err("um the"), 30.0, 900),
    ] {
        let mut speech = Speech::new();
        speech.take(0.0, ask(7));
        speech.playback(0.1, 1, PlaybackState::Started);
        speech.playback(1.5, 1, PlaybackState::Ended);
        let onset = speech.now;
        speech.take(0.1, began(onset, interrupts));
        let paused = StreamEvent::Paused { sound: SOUND, segment: segment(onset) };
        assert!(speech.take(0.3, In::Stream(paused)).decodes_early());
        let closes = speech.take(0.1, early(words, snr_db)).closes_ms();
        assert_eq!(closes, Some(expected), "{what}");
    }
}

#[test]
fn later_end_of_the_same_speech_is_decoded_only_if_the_earlier_one_is_not_complete() {
    let said = |text: &str| Ok(vec![Hypothesis::certain(text)]);
    for (text, is_decoded) in [("the clear bowl", false), ("get me the", true)] {
        let mut speech = Speech::new();
        let onset = speech.now;
        speech.take(0.1, began(onset, false));
        let paused = || In::Stream(StreamEvent::Paused { sound: SOUND, segment: segment(onset) });
        assert!(speech.take(0.1, paused()).decodes_early());
        assert!(!speech.take(0.1, paused()).decodes_early(), "it waits for the earlier one");
        assert_eq!(speech.take(0.1, early(said(text), 30.0)).decodes_early(), is_decoded, "{text}");
    }
}

#[test]
fn interim_results_are_published_until_the_result() {
    let mut speech = Speech::new();
    let onset = speech.now;
    let interim = |text: &str| In::InterimResult { sound: SOUND, text: text.to_owned() };
    assert_eq!(speech.take(0.1, interim("unknown")).partials(), [], "no sound has begun");
    speech.take(0.1, began(onset, true));
    let samples = In::Stream(StreamEvent::Samples { sound: SOUND, samples: vec![0; 5_600] });
    let outputs = speech.take(0.3, samples.clone());
    assert!(matches!(outputs.0[..], [Out::InterimSamples(SOUND, _)]), "{outputs:?}");
    let paused = StreamEvent::Paused { sound: SOUND, segment: segment(onset) };
    let outputs = speech.take(0.1, In::Stream(paused));
    assert!(matches!(outputs.0[..], [Out::DecodeEarly(SOUND, _)]), "{outputs:?}");
    let outputs = speech.take(0.1, interim("the white"));
    let Some(Out::Partial(partial)) = outputs.0.first() else { panic!("{outputs:?}") };
    assert_eq!((partial.onset_ns, partial.request()), (onset.ns(), RequestKey([7; 16])));
    assert_eq!(outputs.partials(), [("the white".to_owned(), 0)]);
    speech.take(0.1, ended(onset));
    assert_eq!(speech.take(0.1, interim("the whites")).partials(), [], "the sound has ended");
    assert!(speech.take(0.0, samples).0.is_empty());
    assert_eq!(speech.take(0.1, recognised(SOUND, None)).partials(), [(String::new(), 1)]);
    assert!(speech.records.is_empty(), "interim results are not journaled");
}

#[test]
fn repeated_end_of_a_stream_keeps_the_first_count() {
    let mut speech = Speech::new();
    let (onset, stream) = (speech.now, RequestKey([7; 16]));
    speech.take(0.1, began(onset, true));
    speech.take(0.4, ended(onset));
    for utterances in [1, 0] {
        let closed = In::Stream(StreamEvent::Closed { stream, utterances, lost: 0 });
        assert_eq!(speech.take(0.1, closed).receipt(), None);
    }
    let outputs = speech.take(0.2, recognised(SOUND, None));
    let closed = outputs.find(|out| match out {
        Out::Receipt(receipt) if receipt.segment == u32::MAX => Some(receipt.segments),
        _ => None,
    });
    assert_eq!(closed, Some(1));
}
