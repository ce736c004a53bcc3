//! Rules of hearing and speaking, without devices.

mod endings;
mod fair_share;
mod prompts;
mod seen;
mod set_aside;
mod stop_order;

use crate::hearing::Rejected;
use crate::record::Record;
use crate::{
    Config, Device, Endpointing, Hypothesis, In, Out, PlaybackEvent, PlaybackRequest,
    PlaybackState, PreparedJudge, Recognised, RecognisedSegment, SpeechNode,
};
use messages::{
    ActKind, Activity, AppliedMark, FixedText, GateVerdict, Injection, MessageRef,
    PresentationState, Receipt, ReceiptStatus, RequestKey, RobotAct, Sound, Source, Utterance,
    WireCode,
};
use scene::{AttributeId, Question, ValueId};
use service::{Effects, Event, Node, Span, Time};
use speech_engines::stream::{Began, LIVE_FROM, SpeechSegment, StreamEvent};
use speech_engines::testing;

const WHITE: Question = Question::Attribute(AttributeId(0), ValueId(0));

/// A speech service with a simulated clock.
struct Speech {
    node: SpeechNode,
    now: Time,
    records: Vec<Record>,
}

impl Speech {
    /// Makes a ready service, with the policy's mark.
    fn new() -> Self {
        let mut speech = Self::before_mark();
        speech.take(1.0, In::Mark(AppliedMark::default()));
        speech
    }

    fn before_mark() -> Self {
        let node = SpeechNode::recover(Self::config(), Vec::new()).unwrap();
        Self { node, now: Time(0), records: Vec::new() }
    }

    fn config() -> Config {
        let ms = std::time::Duration::from_millis;
        let endpointing = Endpointing {
            judge: PreparedJudge::new(&testing::bowls()),
            complete: ms(120),
            closing: ms(500),
            open: ms(900),
        };
        Config { endpointing, utterance_bytes_max: 4000, gestures: false }
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
        self.take(after_s, In::Injection(Injection::new(key, sound)))
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
        self.find(|out| matches!(out, Out::Stop(_)).then_some(())).is_some()
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

/// Returns a result with these hypotheses, or one that the gate rejects.
fn result(words: Result<Vec<Hypothesis>, &str>, snr_db: f32) -> RecognisedSegment {
    let (reason, score) = (GateVerdict::OtherTalk, 0.1);
    let rejected = |text: &str| Rejected { text: text.to_owned(), reason, score };
    let accepted = RecognisedSegment::accepted((0.2, 0.7), snr_db, Vec::new());
    RecognisedSegment { hypotheses: words.map_err(rejected), ..accepted }
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

/// Returns the receipt of a text heard some seconds after the robot has asked "Is it white?".
fn heard_after_a_question(after_s: f64, text: &str) -> (Receipt, Outputs) {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.playback(0.1, 1, PlaybackState::Started);
    speech.playback(1.0, 1, PlaybackState::Ended);
    let onset = speech.now + Span::from_s(after_s);
    speech.take(after_s, began(onset, false));
    speech.take(0.4, ended(onset));
    let outputs = speech.take(0.1, recognised(SOUND, Some(vec![Hypothesis::certain(text)])));
    (outputs.receipt().unwrap(), outputs)
}

#[test]
fn own_line_heard_back_is_no_evidence() {
    let (receipt, echo) = heard_after_a_question(0.1, "is it white");
    assert_eq!(receipt.status.get(), ReceiptStatus::NotForMe);
    assert_eq!(receipt.verdict.get(), GateVerdict::Echo);
    assert_eq!(receipt.note.as_str().unwrap(), "is it white");
    assert!(echo.utterance().is_none());
    for (after_s, text) in
        [(0.1, "it is white"), (0.1, "yes"), (0.1, "stop"), (16.0, "is it white")]
    {
        let (receipt, outputs) = heard_after_a_question(after_s, text);
        assert_eq!(receipt.status.get(), ReceiptStatus::Accepted, "{text}");
        assert_eq!(outputs.stops_motion(), text == "stop");
    }
}

#[test]
fn status_names_what_stands_in_the_place_of_each_server() {
    let mut speech = Speech::new();
    let note = |text: &str| Some(text.to_owned());
    for (of, note, expected) in [
        (Device::Voice, note("v"), Some("v")),
        (Device::Recogniser, note("r"), Some("r; v")),
        (Device::Voice, None, Some("r")),
        (Device::Recogniser, None, None),
    ] {
        speech.take(0.1, In::Server { of, note });
        assert_eq!(speech.node.status(), expected);
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
