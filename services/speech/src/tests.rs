//! The rules of hearing and speaking, without devices.

use crate::devices::stream::Cut;
use crate::live::{Began, LIVE_FROM, Live};
use crate::record::{Hypothesis, Record};
use crate::{Config, In, Line, Out, Recognised, Segment, SpeechNode, Spoken, VoiceEvent};
use language::{Language, Reader};
use messages::WireCode;
use messages::{
    ActKind, Activity, AppliedMark, FixedText, Injection, PresentationState, RequestKey, RobotAct,
    Sound, Source, Utterance,
};
use scene::{AttributeId, Question, Scene, ValueId};
use service::{Effects, Event, Node, Span, Time};

const WHITE: Question = Question::Attribute(AttributeId(0), ValueId(0));

fn config() -> Config {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/scenes/bowls.toml");
    let scene = Scene::from_toml("bowls.toml", &std::fs::read_to_string(scene).unwrap()).unwrap();
    let reader = Reader::new(&scene, Language::Careful);
    Config { reader, utterance_bytes_max: 4000, gestures: false }
}

/// A speech service with its clock.
struct Speech {
    node: SpeechNode,
    now: Time,
    records: Vec<Record>,
}

impl Speech {
    fn new() -> Self {
        let node = SpeechNode::recover(config(), Vec::new()).unwrap();
        let mut speech = Self { node, now: Time(0), records: Vec::new() };
        speech.take(1.0, In::Mark(AppliedMark::default()));
        speech
    }

    /// Something arrives so many seconds after what came before.
    fn take(&mut self, after_s: f64, message: In) -> Vec<Out> {
        self.now = self.now + Span::from_s(after_s);
        let mut effects = Effects::default();
        self.node.on(Event::Message(message), self.now, &mut effects);
        self.records.extend(effects.take_records());
        effects.take_outputs()
    }

    fn type_in(&mut self, after_s: f64, text: &str) -> Vec<Out> {
        let key = RequestKey([self.records.len() as u8 + 1; 16]);
        let sound = Sound::Text(text.to_owned());
        self.take(after_s, In::Injection(Injection { key, sound, ..injection() }))
    }

    fn voice(&mut self, after_s: f64, line: u64, what: Spoken) -> Vec<Out> {
        self.take(after_s, In::Voice(VoiceEvent { line, what }))
    }
}

fn injection() -> Injection {
    let (key, sound) = (RequestKey([0; 16]), Sound::Text(String::new()));
    Injection { key, onset_ns: 0, end_ns: 0, sound }
}

const SOUND: u64 = LIVE_FROM;

/// Somebody whom the microphone tells from the robot begins to speak.
fn began(at: Time) -> In {
    In::Live(Live::Began(Began {
        sound: SOUND,
        at,
        stream: RequestKey([7; 16]),
        segment: None,
        source: Source::Microphone,
        interrupts: true,
    }))
}

fn ended(onset: Time) -> In {
    let end = onset + Span::from_s(0.3);
    let cut = Cut { onset, end, samples: vec![0; 4_800], speech: 0..4_800 };
    In::Live(Live::Ended { sound: SOUND, cut })
}

fn nothing() -> In {
    In::Recognised(Recognised { sound: SOUND, segments: Ok(Vec::new()) })
}

fn ask(prompt: u64) -> In {
    let text = FixedText::truncated("Is it white?");
    let (kind, question) = (ActKind::Ask.code(), WHITE.into());
    let act = RobotAct {
        act: prompt,
        prompt,
        presentation: 1,
        kind,
        question,
        text,
        ..RobotAct::default()
    };
    In::Act(Box::new(act))
}

fn spoken(outputs: &[Out]) -> Option<&Line> {
    outputs.iter().find_map(|out| match out {
        Out::Speak(line) => Some(line),
        _ => None,
    })
}

fn uttered(outputs: &[Out]) -> Option<&Utterance> {
    outputs.iter().find_map(|out| match out {
        Out::Utterance(utterance) => Some(&**utterance),
        _ => None,
    })
}

fn activity(outputs: &[Out]) -> Option<&Activity> {
    outputs.iter().rev().find_map(|out| match out {
        Out::Activity(activity) => Some(activity),
        _ => None,
    })
}

#[test]
fn an_utterance_names_the_questions_that_had_begun() {
    let mut speech = Speech::new();
    assert!(spoken(&speech.take(0.0, ask(7))).is_some());
    speech.voice(0.1, 1, Spoken::Started);
    speech.voice(1.5, 1, Spoken::Ended);
    let outputs = speech.type_in(0.8, "yes");
    let asked = uttered(&outputs).unwrap().asked().unwrap();
    let [only] = asked else { panic!("{asked:?}") };
    assert_eq!((only.prompt, only.presentation, only.whole), (7, 1, 1));
    assert_eq!((only.ended_ns - only.began_ns), Span::from_s(1.5).0);
}

#[test]
fn the_robot_holds_its_tongue_while_a_person_speaks_or_is_being_understood() {
    let mut speech = Speech::new();
    let onset = speech.now;
    let outputs = speech.take(0.1, began(onset));
    assert_eq!(activity(&outputs).map(|a| a.onset_ns), Some(onset.ns()), "published at once");
    assert!(spoken(&speech.take(0.2, ask(7))).is_none());
    let outputs = speech.take(0.5, ended(onset));
    assert!(spoken(&outputs).is_none(), "what was said is being recognised");
    assert!(outputs.iter().any(|out| matches!(out, Out::Recognise(SOUND, _))), "{outputs:?}");
    assert_eq!(activity(&outputs).map(|a| (a.onset_ns, a.pending)), Some((onset.ns(), 1)));
    let outputs = speech.take(0.2, nothing());
    assert!(spoken(&outputs).is_some(), "nothing was understood and nobody speaks: {outputs:?}");
    assert_eq!(activity(&outputs).map(|a| a.onset_ns), Some(0));
}

#[test]
fn what_was_typed_is_taken_in_before_the_robot_speaks() {
    let mut speech = Speech::new();
    speech.type_in(0.0, "get me the bowl");
    assert!(spoken(&speech.take(0.1, ask(7))).is_none(), "it is not applied yet");
    let outputs = speech.take(0.1, In::Mark(AppliedMark { seq: 1 }));
    assert!(spoken(&outputs).is_some());
}

/// A recogniser that never answers does not silence the robot for ever.
#[test]
fn the_robot_does_not_wait_for_ever() {
    let mut speech = Speech::new();
    let onset = speech.now;
    speech.take(0.0, began(onset));
    assert!(spoken(&speech.take(5.0, ask(7))).is_none());
    assert!(spoken(&speech.take(6.0, ask(7))).is_some());
}

#[test]
fn who_interrupts_is_listened_to_and_the_question_is_said_again_if_it_stands() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.voice(0.1, 1, Spoken::Started);
    let onset = speech.now + Span::from_s(0.6);
    let outputs = speech.take(0.7, began(onset));
    assert!(outputs.iter().any(|out| matches!(out, Out::Hush)), "{outputs:?}");
    let Some(Record::Presented(broken)) = speech.records.last() else { panic!() };
    assert!(!broken.whole && broken.question == WHITE);
    let told = outputs.iter().find_map(|out| match out {
        Out::Presented(presented) => Some((presented.prompt, presented.state)),
        _ => None,
    });
    assert_eq!(told, Some((7, PresentationState::Interrupted.code())), "nobody heard it whole");
    assert!(spoken(&speech.take(0.1, ask(7))).is_none(), "the person still speaks");
    speech.take(0.5, ended(onset));
    let outputs = speech.take(0.5, nothing());
    assert_eq!(spoken(&outputs).map(|line| line.number), Some(2), "{outputs:?}");
    // What interrupted it may answer it.
    let outputs = speech.type_in(0.1, "yes");
    let asked = uttered(&outputs).unwrap().asked().unwrap();
    assert!(asked.iter().any(|a| (a.prompt, a.whole) == (7, 0) && a.ended_ns > 0), "{asked:?}");
}

#[test]
fn a_question_that_gives_way_to_another_act_may_still_be_answered() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.voice(0.1, 1, Spoken::Started);
    speech.take(0.5, ask(8));
    speech.voice(0.1, 2, Spoken::Started);
    let outputs = speech.type_in(0.3, "yes");
    let asked = uttered(&outputs).unwrap().asked().unwrap();
    let prompts: Vec<u64> = asked.iter().map(|asked| asked.prompt).collect();
    assert_eq!(prompts, [8, 7], "newest first");
    assert_eq!(asked[0].ended_ns, 0, "it is being said");
}

#[test]
fn all_hypotheses_are_handed_on_with_the_confidence_of_their_words() {
    let mut speech = Speech::new();
    let key = RequestKey([9; 16]);
    let sound = Sound::Wav("/some.wav".to_owned());
    let outputs = speech.take(0.0, In::Injection(Injection { key, sound, ..injection() }));
    let Some(Out::Recognise(number, _)) =
        outputs.iter().find(|out| matches!(out, Out::Recognise(..)))
    else {
        panic!("{outputs:?}")
    };
    let hypothesis = |text: &str, weight, confidence: &[f32]| Hypothesis {
        text: text.to_owned(),
        weight,
        confidence: confidence.to_vec(),
    };
    let heard = vec![
        hypothesis("the clear one", 3.0, &[0.9, 0.6, 1.0]),
        hypothesis("the counter", 1.0, &[]),
    ];
    let segments = Ok(vec![Segment { heard: Ok(heard), ..segment() }]);
    let outputs = speech.take(0.8, In::Recognised(Recognised { sound: *number, segments }));
    let heard = uttered(&outputs).unwrap().hypotheses().unwrap();
    assert_eq!((heard.len(), heard[0].text, heard[0].weight), (2, "the clear one", 0.75));
    let rounded: Vec<f32> = heard[0].confidence.iter().map(|c| (c * 10.0).round()).collect();
    assert_eq!(rounded, [9.0, 6.0]);
}

fn segment() -> Segment {
    Segment { span_s: (0.2, 0.7), snr_db: 30.0, heard: Err(String::new()) }
}

#[test]
fn each_live_utterance_has_one_result_with_its_times() {
    let mut speech = Speech::new();
    let onset = speech.now;
    speech.take(0.1, began(onset));
    speech.take(0.4, ended(onset));
    let heard = Ok(vec![Hypothesis::certain("get me the bowl")]);
    let segments = Ok(vec![Segment { heard, ..segment() }]);
    let result = In::Recognised(Recognised { sound: SOUND, segments });
    let outputs = speech.take(0.2, result.clone());
    let utterance = uttered(&outputs).unwrap();
    assert_eq!(utterance.source, Source::Microphone.code());
    assert_eq!(
        (utterance.onset_ns, utterance.end_ns - utterance.onset_ns),
        (onset.ns(), 300_000_000)
    );
    let receipt = outputs.iter().find_map(|out| match out {
        Out::Receipt(receipt) => Some(**receipt),
        _ => None,
    });
    let receipt = receipt.unwrap();
    assert_eq!((receipt.seq, receipt.snr_db, receipt.onset_ns), (1, 30.0, onset.ns()));
    assert_eq!(activity(&outputs).map(|a| a.onset_ns), Some(0));
    speech.take(0.1, result);
    assert_eq!(speech.records.len(), 1, "a second result is of no sound");
    assert!(speech.take(0.1, ended(onset)).iter().all(|out| !matches!(out, Out::Recognise(..))));
}

#[test]
fn a_microphone_that_hears_the_robot_does_not_interrupt_it_but_typed_words_do() {
    let mut speech = Speech::new();
    speech.take(0.0, ask(7));
    speech.voice(0.1, 1, Spoken::Started);
    let In::Live(Live::Began(heard)) = began(speech.now) else { panic!() };
    let half_duplex = In::Live(Live::Began(Began { interrupts: false, ..heard }));
    let outputs = speech.take(0.2, half_duplex);
    assert!(!outputs.iter().any(|out| matches!(out, Out::Hush)), "{outputs:?}");
    let outputs = speech.type_in(0.2, "the white one");
    assert!(outputs.iter().any(|out| matches!(out, Out::Hush)), "{outputs:?}");
}

#[test]
fn who_asks_to_talk_is_listened_to_and_told_where_nobody_spoke() {
    let mut speech = Speech::new();
    let talk = |longest_s| {
        let sound = Sound::Talk { longest_s };
        In::Injection(Injection { key: RequestKey([3; 16]), sound, ..injection() })
    };
    let outputs = speech.take(0.1, talk(5.0));
    let asked = outputs.iter().find_map(|out| match out {
        Out::Talk(sound, longest) => Some((*sound, *longest)),
        _ => None,
    });
    let (sound, longest) = asked.unwrap();
    assert_eq!(longest, Span::from_s(5.0));
    assert!(speech.take(0.1, talk(5.0)).is_empty(), "the repeated request is the same one");
    let reason = "nobody was heard".to_owned();
    let outputs = speech.take(5.0, In::Live(Live::Silent { sound, reason }));
    let told = |outputs: &[Out]| {
        outputs
            .iter()
            .any(|out| matches!(out, Out::Receipt(r) if r.note.as_str() == Ok("nobody was heard")))
    };
    assert!(told(&outputs));
    assert!(told(&speech.take(0.1, talk(5.0))), "and so is its answer");
}

fn partials(outputs: &[Out]) -> Vec<(&str, u8)> {
    let partial = |out: &'_ Out| matches!(out, Out::Partial(_));
    let told = outputs.iter().filter(|out| partial(out)).map(|out| match out {
        Out::Partial(partial) => (partial.text.as_str().unwrap(), partial.over),
        _ => unreachable!(),
    });
    told.collect()
}

#[test]
fn what_is_being_said_is_told_until_it_has_its_result() {
    let mut speech = Speech::new();
    let onset = speech.now;
    let so_far = |text: &str| In::SoFar { sound: SOUND, text: text.to_owned() };
    assert!(partials(&speech.take(0.1, so_far("nobody"))).is_empty(), "nobody has begun");
    speech.take(0.1, began(onset));
    let piece = In::Live(Live::SoFar { sound: SOUND, samples: vec![0; 5_600] });
    let outputs = speech.take(0.3, piece.clone());
    assert!(matches!(outputs[..], [Out::Overhear(SOUND, _)]), "{outputs:?}");
    let In::Live(Live::Ended { cut, .. }) = ended(onset) else { unreachable!() };
    let outputs = speech.take(0.1, In::Live(Live::Paused { sound: SOUND, cut }));
    assert!(matches!(outputs[..], [Out::Expect(SOUND, _)]), "{outputs:?}");
    let outputs = speech.take(0.1, so_far("the white"));
    let Some(Out::Partial(partial)) = outputs.first() else { panic!("{outputs:?}") };
    assert_eq!((partial.onset_ns, partial.request()), (onset.ns(), RequestKey([7; 16])));
    assert_eq!(partials(&outputs), [("the white", 0)]);
    speech.take(0.1, ended(onset));
    assert!(
        partials(&speech.take(0.1, so_far("the whites"))).is_empty(),
        "it waits for the result"
    );
    assert!(speech.take(0.0, piece).is_empty());
    assert_eq!(partials(&speech.take(0.1, nothing())), [("", 1)]);
    assert!(speech.records.is_empty(), "none of it is kept");
}

#[test]
fn the_end_of_a_stream_that_is_told_again_tells_what_it_told_first() {
    let mut speech = Speech::new();
    let (onset, stream) = (speech.now, RequestKey([7; 16]));
    speech.take(0.1, began(onset));
    speech.take(0.4, ended(onset));
    for utterances in [1, 0] {
        let over = In::Live(Live::Over { stream, utterances, lost: 0 });
        assert!(speech.take(0.1, over).iter().all(|out| !matches!(out, Out::Receipt(_))));
    }
    let outputs = speech.take(0.2, nothing());
    let over = outputs.iter().find_map(|out| match out {
        Out::Receipt(receipt) if receipt.segment == u32::MAX => Some(receipt.segments),
        _ => None,
    });
    assert_eq!(over, Some(1));
}
