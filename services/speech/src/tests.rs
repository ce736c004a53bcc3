//! Rules of hearing and speaking, without devices.

mod fair_share;
mod set_aside;

use crate::devices::recogniser::Rejected;
use crate::devices::stream::SpeechSegment;
use crate::devices::testing;
use crate::record::Record;
use crate::stream_events::{Began, LIVE_FROM, StreamEvent};
use crate::{
    Config, Endpointing, Hypothesis, In, Out, PlaybackEvent, PlaybackRequest, PlaybackState,
    Recognised, RecognisedSegment, SpeechNode,
};
use language::{CompletenessJudge, Language, Reader};
use messages::{
    ActKind, Activity, AppliedMark, FixedText, GateVerdict, Injection, MessageRef, MotionOrder,
    PresentationState, Receipt, RequestKey, RobotAct, Sound, Source, Utterance, WireCode,
};
use scene::{AttributeId, Question, ValueId};
use service::{Effects, Event, Node, Span, Time};

const WHITE: Question = Question::Attribute(AttributeId(0), ValueId(0));

/// A speech service with its clock.
struct Speech {
    node: SpeechNode,
    now: Time,
    records: Vec<Record>,
}

impl Speech {
    /// With the policy's mark, as when it is ready.
    fn new() -> Self {
        let mut speech = Self::before_mark();
        speech.take(1.0, In::Mark(AppliedMark::default()));
        speech
    }

    fn before_mark() -> Self {
        let reader = Reader::new(&testing::bowls(), Language::Careful);
        let ms = std::time::Duration::from_millis;
        let endpointing = Endpointing {
            judge: CompletenessJudge::new(&testing::bowls()),
            complete: ms(120),
            closing: ms(500),
            open: ms(900),
        };
        let config = Config { reader, endpointing, utterance_bytes_max: 4000, gestures: false };
        let node = SpeechNode::recover(config, Vec::new()).unwrap();
        Self { node, now: Time(0), records: Vec::new() }
    }

    /// Handles a message after a delay.
    fn take(&mut self, after_s: f64, message: In<'_>) -> Outputs {
        self.now = self.now + Span::from_s(after_s);
        let mut effects = Effects::default();
        self.node.on(Event::Message(message), self.now, &mut effects);
        self.records.extend(effects.take_records());
        Outputs(effects.take_outputs())
    }

    fn inject(&mut self, after_s: f64, key: u8, sound: Sound) -> Outputs {
        let key = RequestKey([key; 16]);
        self.take(
            after_s,
            In::Injection(Injection { key, onset_ns: 0, end_ns: 0, seen_prompt: 0, sound }),
        )
    }

    fn type_in(&mut self, after_s: f64, text: &str) -> Outputs {
        self.inject(after_s, self.records.len() as u8 + 1, Sound::Text(text.to_owned()))
    }

    fn playback(&mut self, after_s: f64, playback: u64, state: PlaybackState) -> Outputs {
        self.take(after_s, In::Playback(PlaybackEvent { playback, state }))
    }
}

#[derive(Debug)]
struct Outputs(Vec<Out>);

impl Outputs {
    fn find<T>(&self, wanted: impl Fn(&Out) -> Option<T>) -> Option<T> {
        self.0.iter().find_map(wanted)
    }

    fn spoken(&self) -> Option<PlaybackRequest> {
        self.find(|out| if let Out::Speak(request) = out { Some(request.clone()) } else { None })
    }

    fn utterance(&self) -> Option<Utterance> {
        self.find(|out| if let Out::Utterance(utterance) = out { Some(**utterance) } else { None })
    }

    /// Returns prompt, presentation and completeness of the questions of the utterance.
    fn asked(&self) -> Vec<(u64, u32, u8)> {
        let utterance = self.utterance().expect("an utterance");
        let asked = utterance.asked().unwrap();
        asked.iter().map(|asked| (asked.prompt, asked.presentation, asked.whole)).collect()
    }

    fn receipt(&self) -> Option<Receipt> {
        self.find(|out| if let Out::Receipt(receipt) = out { Some(**receipt) } else { None })
    }

    fn activity(&self) -> Option<Activity> {
        let latest = self.0.iter().rev();
        latest.clone().find_map(|out| match out {
            Out::Activity(activity) => Some(*activity),
            _ => None,
        })
    }

    fn stops_speaking(&self) -> bool {
        self.find(|out| matches!(out, Out::StopSpeaking).then_some(())).is_some()
    }

    fn stops_motion(&self) -> bool {
        let stop = MotionOrder::Stop.code();
        self.find(|out| matches!(out, Out::Motion(it) if it.order == stop).then_some(())).is_some()
    }

    fn recognises(&self) -> Option<u64> {
        self.find(|out| if let Out::Recognise(sound, _) = out { Some(*sound) } else { None })
    }

    /// Returns the pause that ends an utterance, milliseconds.
    fn closes_ms(&self) -> Option<u32> {
        self.find(|out| match out {
            Out::Close(SOUND, closing) => Some((closing.pause_s * 1e3).round() as u32),
            _ => None,
        })
    }

    fn decodes_early(&self) -> bool {
        self.find(|out| matches!(out, Out::DecodeEarly(SOUND, _)).then_some(())).is_some()
    }

    fn partials(&self) -> Vec<(String, u8)> {
        let partial = |out: &Out| match out {
            Out::Partial(partial) => {
                Some((partial.text.as_str().unwrap().to_owned(), partial.over))
            }
            _ => None,
        };
        self.0.iter().filter_map(partial).collect()
    }
}

const SOUND: u64 = LIVE_FROM;

/// Returns the beginning of an utterance in a microphone that does not record the robot.
fn began(at: Time, interrupts: bool) -> In<'static> {
    In::Stream(StreamEvent::Began(Began { interrupts, ..testing::began(at) }))
}

fn segment(onset: Time) -> SpeechSegment {
    let end = onset + Span::from_s(0.3);
    SpeechSegment { onset, end, samples: vec![0; 4_800], speech: 0..4_800 }
}

fn ended(onset: Time) -> In<'static> {
    In::Stream(StreamEvent::Ended { sound: SOUND, segment: segment(onset) })
}

/// Returns a result of the recogniser with these hypotheses, or without speech.
fn recognised(sound: u64, hypotheses: Option<Vec<Hypothesis>>) -> In<'static> {
    let segment = |hypotheses| RecognisedSegment::accepted((0.2, 0.7), 30.0, hypotheses);
    let segments = Ok(hypotheses.map(segment).into_iter().collect());
    In::Recognised(Recognised { sound, segments })
}

fn ask(prompt: u64) -> In<'static> {
    let text = FixedText::truncated("Is it white?");
    let (kind, question) = (ActKind::Ask.code(), WHITE.into());
    let (act, presentation) = (prompt, 1);
    In::Act(MessageRef::from(RobotAct {
        act,
        prompt,
        presentation,
        kind,
        question,
        text,
        ..RobotAct::default()
    }))
}

#[test]
fn speech_is_ready_once_it_can_accept_an_utterance() {
    let mut speech = Speech::before_mark();
    let text = || Sound::Text("the white bowl".to_owned());
    assert!(speech.inject(1.0, 1, text()).0.is_empty(), "without a mark there are no numbers");
    assert!(!speech.node.is_ready());
    speech.take(1.0, In::Mark(AppliedMark::default()));
    assert!(speech.node.is_ready());
    assert!(!speech.inject(1.0, 1, text()).0.is_empty());
}

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
fn words_answer_no_question_that_their_client_had_not_shown() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.playback(0.1, 1, PlaybackState::Started);
    speech.take(0.5, ask(8));
    speech.playback(0.1, 2, PlaybackState::Started);
    let yes = |seen_prompt: u64| Injection {
        key: RequestKey([seen_prompt as u8 + 1; 16]),
        onset_ns: 0,
        end_ns: 0,
        seen_prompt,
        sound: Sound::Text("yes".to_owned()),
    };
    assert_eq!(speech.take(1.0, In::Injection(yes(7))).asked(), [(7, 1, 0)]);
    assert_eq!(speech.take(1.0, In::Injection(yes(6))).asked(), []);
    assert_eq!(speech.take(1.0, In::Injection(yes(8))).asked(), [(8, 1, 0), (7, 1, 0)]);
    assert_eq!(speech.take(1.0, In::Injection(yes(0))).asked(), [(8, 1, 0), (7, 1, 0)], "unknown");
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
fn utterance_carries_all_hypotheses_with_word_confidences() {
    let mut speech = Speech::new();
    let outputs = speech.inject(0.0, 9, Sound::Wav("/some.wav".to_owned()));
    let sound = outputs.recognises().unwrap();
    let hypothesis = |text: &str, weight, confidence: &[f32]| Hypothesis {
        text: text.to_owned(),
        weight,
        word_confidence: confidence.to_vec(),
    };
    let hypotheses = vec![
        hypothesis("the clear one", 3.0, &[0.9, 0.6, 1.0]),
        hypothesis("the counter", 1.0, &[]),
    ];
    let outputs = speech.take(0.8, recognised(sound, Some(hypotheses)));
    let utterance = outputs.utterance().unwrap();
    let sent = utterance.hypotheses().unwrap();
    assert_eq!((sent.len(), &*sent[0].text, sent[0].weight), (2, "the clear one", 0.75));
    let rounded: Vec<f32> = sent[0].word_confidence.iter().map(|c| (c * 10.0).round()).collect();
    assert_eq!(rounded, [9.0, 6.0]);
}

#[test]
fn live_utterance_has_one_result_with_its_times() {
    let mut speech = Speech::new();
    let onset = speech.now;
    speech.take(0.1, began(onset, true));
    speech.take(0.4, ended(onset));
    let result = recognised(SOUND, Some(vec![Hypothesis::certain("get me the bowl")]));
    let outputs = speech.take(0.2, result.clone());
    let utterance = outputs.utterance().unwrap();
    assert_eq!(utterance.source, Source::Microphone.code());
    let length_ns = utterance.end_ns - utterance.onset_ns;
    assert_eq!((utterance.onset_ns, length_ns), (onset.ns(), 300_000_000));
    let receipt = outputs.receipt().unwrap();
    assert_eq!((receipt.seq, receipt.snr_db, receipt.onset_ns), (1, 30.0, onset.ns()));
    assert_eq!(outputs.activity().map(|a| a.onset_ns), Some(0));
    speech.take(0.1, result);
    assert_eq!(speech.records.len(), 1, "a second result belongs to no sound");
    assert_eq!(speech.take(0.1, ended(onset)).recognises(), None);
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
fn talk_request_opens_the_microphone_and_reports_silence() {
    let mut speech = Speech::new();
    let talk = || Sound::Talk { longest_s: 5.0 };
    let outputs = speech.inject(0.1, 3, talk());
    let opened = outputs.find(|out| match out {
        Out::OpenMicrophone(sound, longest) => Some((*sound, *longest)),
        _ => None,
    });
    let (sound, longest) = opened.unwrap();
    assert_eq!(longest, Span::from_s(5.0));
    assert!(speech.inject(0.1, 3, talk()).0.is_empty(), "a repeated request is the same one");
    let reason = "no speech heard".to_owned();
    let silent = In::Stream(StreamEvent::Silent { sound, reason });
    let note = |outputs: Outputs| outputs.receipt().unwrap().note.as_str().unwrap().to_owned();
    assert_eq!(note(speech.take(5.0, silent)), "no speech heard");
    assert_eq!(note(speech.inject(0.1, 3, talk())), "no speech heard", "and so is its answer");
    let outputs = speech.inject(0.1, 4, Sound::Talk { longest_s: 61.0 });
    assert_eq!(note(outputs), "duration 61 s is out of range (1 to 60 s)");
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

/// Returns a result with these hypotheses, or one that the gate rejects.
fn result(words: Result<Vec<Hypothesis>, &str>, snr_db: f32) -> RecognisedSegment {
    let (reason, score) = (GateVerdict::OtherTalk, 0.1);
    let rejected = |text: &str| Rejected { text: text.to_owned(), reason, score };
    let accepted = RecognisedSegment::accepted((0.2, 0.7), snr_db, Vec::new());
    RecognisedSegment { hypotheses: words.map_err(rejected), ..accepted }
}

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
fn words_whose_beginning_the_robot_covers_are_not_acted_on_and_its_question_is_repeated_once() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.playback(0.1, 1, PlaybackState::Started);
    speech.playback(1.0, 1, PlaybackState::Ended);
    for (text, is_accepted, is_repeated) in
        [("the white one", false, true), ("the white one", false, false), ("stop", true, false)]
    {
        let onset = speech.now;
        speech.take(0.1, began(onset, false));
        speech.take(0.0, In::Stream(StreamEvent::Cut { sound: SOUND }));
        speech.take(0.4, ended(onset));
        let result = recognised(SOUND, Some(vec![Hypothesis::certain(text)]));
        let outputs = speech.take(0.1, result);
        assert_eq!(outputs.utterance().is_some(), is_accepted, "{text}");
        assert_eq!(outputs.stops_motion(), is_accepted, "{text}");
        let receipt = outputs.receipt().unwrap();
        let heard = if is_accepted { text.to_owned() } else { format!("… {text}") };
        assert_eq!(receipt.note.as_str().unwrap(), heard);
        let again = speech.take(0.1, ask(7)).spoken();
        assert_eq!(again.is_some(), is_repeated, "{text}");
        speech.playback(0.1, 2, PlaybackState::Started);
        speech.playback(1.0, 2, PlaybackState::Ended);
    }
}

/// The gate judges by words of the scene, of which a stop has none.
#[test]
fn stop_is_obeyed_though_it_is_not_taken_for_a_request() {
    let mut speech = Speech::new();
    for (text, is_obeyed) in [("the weather today", false), ("stop", true)] {
        let onset = speech.now;
        speech.take(0.1, began(onset, false));
        speech.take(0.4, ended(onset));
        let segment = result(Err(text), 30.0);
        let recognised = Recognised { sound: SOUND, segments: Ok(vec![segment]) };
        let outputs = speech.take(0.1, In::Recognised(recognised));
        assert_eq!(outputs.stops_motion(), is_obeyed, "{text}");
        assert_eq!(outputs.utterance().is_some(), is_obeyed, "{text}");
    }
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
