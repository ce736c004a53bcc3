//! The processes, the robot's voice and a recogniser in simulated time. The dialogue ends with the
//! decision what to pick: what the arm does then has its own tests.

use dialogue::NamedQuestion;
use std::collections::{BTreeMap, HashSet};

use config::Settings;
use dialogue::manager::{Cause, Interaction, Record};
use dialogue::{Model, Rng};
use grounding::GroundingNode;
use messages::{
    ActKind, Injection, PresentationState, Presented, Receipt, RequestKey, Sound, Source,
    UtteranceSeq,
};
use policy::PolicyNode;
use preflight::log_normal;
use scene::{ObjectId, Question};
use service::{Event, Node, Span, Time};
use speech::devices::stream::SpeechSegment;
use speech::stream_events::{Began, LIVE_FROM, StreamEvent};
use speech::{
    Hypothesis, PlaybackEvent, PlaybackRequest, PlaybackState, Recognised, RecognisedSegment,
    RecognitionInput, SpeechNode,
};

use super::person::{Channel, Heard, Person, Timing, Utterance};
use crate::{Host, configured};

/// Every pass takes as long.
const STEP: Span = Span::from_ms(10);
/// No dialogue takes longer; one that does has failed.
const END: Time = Time(180_000_000_000);
/// How long the robot speaks: median, seconds, and standard deviation of the logarithm.
const LINE_S: (f64, f64) = (1.9, 0.12);
/// From the end of speech to what the recogniser makes of it, seconds.
const RECOGNISER_S: (f64, f64) = (0.5, 1.5);
/// From the first sound to the knowledge that somebody speaks.
const DETECTION: Span = Span::from_ms(100);

/// How a dialogue ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// What was wanted.
    pub wanted: ObjectId,
    /// What was decided to pick; nothing where it came to no decision.
    pub picked: Option<ObjectId>,
    /// Questions asked, each counted once.
    pub questions: u32,
    /// From the request's first sound to that decision, seconds.
    pub seconds: f64,
    /// Of each answer, to which question it was credited.
    pub credits: Vec<Credit>,
    /// What happened when, to be read.
    pub story: Vec<String>,
}

/// How an answer was credited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Credit {
    /// Probability that the robot gave to the question which was answered.
    pub right: f64,
    /// Probability that it gave to other questions.
    pub wrong: f64,
}

impl Ended {
    /// Whether the right object was picked.
    pub fn is_right(&self) -> bool {
        self.picked == Some(self.wanted)
    }
}

/// Holds one dialogue.
///
/// # Panics
/// Where a reducer cannot be made from the settings.
pub fn converse(all: &Settings, channel: Channel, timing: Timing, seed: u64) -> Ended {
    let mut world = World::new(all, channel, timing, seed);
    world.run();
    world.ended()
}

/// A line that the voice is saying.
struct Saying {
    line: u64,
    ends: Time,
}

/// A sound that the recogniser works at.
struct Working {
    at: Time,
    sound: u64,
    utterance: usize,
}

struct World<'a> {
    settings: &'a Settings,
    speech: Host<SpeechNode>,
    grounding: Host<GroundingNode>,
    policy: Host<PolicyNode>,
    to_speech: Vec<speech::In>,
    to_grounding: Vec<Box<messages::Utterance>>,
    to_policy: Vec<policy::In>,
    channel: Channel,
    person: Person,
    rng: Rng,
    now: Time,
    saying: Option<Saying>,
    /// What is asked under each prompt.
    questions: BTreeMap<u64, Question>,
    /// What the person was told of presentations: which, and how far it had come.
    heard: HashSet<(u64, u32, PresentationState)>,
    /// What the person has begun to say, and whether the robot was told that it began and ended.
    said: Vec<(Utterance, bool, bool)>,
    working: Vec<Working>,
    numbers: BTreeMap<u64, usize>,
    picked: Option<ObjectId>,
    story: Vec<String>,
}

impl<'a> World<'a> {
    fn new(settings: &'a Settings, channel: Channel, timing: Timing, seed: u64) -> Self {
        let model = Model::new(&settings.scene, settings.dialogue.params);
        let window_s = settings.dialogue.turns.response_window_s;
        let person = Person::new(&settings.scene, model, channel, timing, window_s, seed);
        let mut world = Self {
            settings,
            speech: Host::new(configured::<speech::shell::SpeechProgram>(settings)),
            grounding: Host::new(configured::<grounding::shell::GroundingProgram>(settings)),
            policy: Host::new(configured::<policy::shell::PolicyProgram>(settings)),
            to_speech: Vec::new(),
            to_grounding: Vec::new(),
            to_policy: Vec::new(),
            channel,
            person,
            rng: Rng::new(seed ^ 0x5eed),
            now: Time(1),
            saying: None,
            questions: BTreeMap::new(),
            heard: HashSet::new(),
            said: Vec::new(),
            working: Vec::new(),
            numbers: BTreeMap::new(),
            picked: None,
            story: Vec::new(),
        };
        let started = world.speech.start(world.now);
        world.route_speech(started);
        world.grounding.start(world.now);
        let started = world.policy.start(world.now);
        world.route_policy(started);
        world
    }

    fn run(&mut self) {
        while self.now < END && self.picked.is_none() {
            self.now = self.now + STEP;
            self.voice_goes_on();
            self.person_goes_on();
            self.recogniser_goes_on();
            let inbox = std::mem::take(&mut self.to_speech);
            let outputs = pass(&mut self.speech, inbox, self.now);
            self.route_speech(outputs);
            let inbox = std::mem::take(&mut self.to_grounding);
            let observations = pass(&mut self.grounding, inbox, self.now);
            self.to_policy.extend(observations.into_iter().map(policy::In::Observation));
            let inbox = std::mem::take(&mut self.to_policy);
            let outputs = pass(&mut self.policy, inbox, self.now);
            self.route_policy(outputs);
        }
    }

    fn voice_goes_on(&mut self) {
        let now = self.now;
        if let Some(saying) = self.saying.take_if(|saying| saying.ends <= now) {
            self.voice(saying.line, PlaybackState::Ended);
        }
    }

    fn voice(&mut self, playback: u64, state: PlaybackState) {
        self.to_speech.push(speech::In::Playback(PlaybackEvent { playback, state }));
    }

    fn fall_silent(&mut self) {
        if let Some(saying) = self.saying.take() {
            self.tell("robot: …");
            self.voice(saying.line, PlaybackState::Interrupted);
        }
    }

    fn speak(&mut self, line: &PlaybackRequest) {
        self.fall_silent();
        let length = Span::from_s(log_normal(&mut self.rng, LINE_S.0, LINE_S.1));
        self.tell(format_args!("robot: {}", line.text));
        self.saying = Some(Saying { line: line.playback, ends: self.now + length });
        self.voice(line.playback, PlaybackState::Started);
    }

    fn person_goes_on(&mut self) {
        while let Some(utterance) = self.person.begins(self.now) {
            self.tell(format_args!("person: {} (to {})", utterance.text, utterance.prompt));
            self.said.push((utterance, false, false));
        }
        for n in 0..self.said.len() {
            let (utterance, began, ended) = self.said[n].clone();
            let live = self.channel == Channel::Live;
            if !began && self.now >= utterance.onset + DETECTION {
                self.said[n].1 = true;
                if live {
                    self.to_speech.push(speech::In::Stream(StreamEvent::Began(began_to_speak(
                        n, &utterance,
                    ))));
                }
            }
            if !ended && self.now >= utterance.end {
                self.said[n].2 = true;
                if live {
                    let (onset, end) = (utterance.onset, utterance.end);
                    let segment = SpeechSegment { onset, end, samples: Vec::new(), speech: 0..0 };
                    let sound = LIVE_FROM + n as u64;
                    self.to_speech.push(speech::In::Stream(StreamEvent::Ended { sound, segment }));
                } else {
                    // The client has it recognised and sends what comes out.
                    let at = self.now + self.recogniser_s();
                    self.working.push(Working { at, sound: 0, utterance: n });
                }
            }
        }
    }

    fn recogniser_s(&mut self) -> Span {
        let (least, most) = RECOGNISER_S;
        Span::from_s(least + (most - least) * self.rng.uniform())
    }

    /// Gives what the client's recogniser made of an utterance to the robot, with its time.
    fn hand_in(&mut self, n: usize) {
        let said = &self.said[n].0;
        let hypotheses = vec![(said.text.clone(), 1.0, Vec::new())];
        let (onset_ns, sound) = (said.onset.ns(), Sound::Transcript { hypotheses });
        let end_ns = said.end.ns();
        let injection = Injection { key: key(n), onset_ns, end_ns, sound };
        self.to_speech.push(speech::In::Injection(injection));
    }

    fn recogniser_goes_on(&mut self) {
        let now = self.now;
        let (due, left) = std::mem::take(&mut self.working).into_iter().partition(|w| w.at <= now);
        self.working = left;
        let due: Vec<Working> = due;
        for Working { sound, utterance, .. } in due {
            if sound == 0 {
                self.hand_in(utterance);
                continue;
            }
            let said = &self.said[utterance].0;
            let span_s = (0.0, said.end.since(said.onset).s());
            let hypotheses = Ok(vec![Hypothesis::certain(said.text.clone())]);
            let segments = Ok(vec![RecognisedSegment { span_s, snr_db: 40.0, hypotheses }]);
            self.to_speech.push(speech::In::Recognised(Recognised { sound, segments }));
        }
    }

    fn route_speech(&mut self, outputs: Vec<speech::Out>) {
        for output in outputs {
            match output {
                speech::Out::Utterance(utterance) => self.to_grounding.push(utterance),
                speech::Out::Receipt(receipt) => self.receipt(&receipt),
                speech::Out::Presented(presented) => {
                    self.present(presented);
                    self.to_policy.push(policy::In::Presented(presented));
                }
                speech::Out::Activity(activity) => {
                    self.to_policy.push(policy::In::Activity(activity));
                }
                speech::Out::Speak(line) => self.speak(&line),
                speech::Out::StopSpeaking => self.fall_silent(),
                speech::Out::Recognise(sound, what) => {
                    debug_assert!(
                        matches!(what, RecognitionInput::Speech(_)),
                        "nobody gives files"
                    );
                    let utterance = (sound - LIVE_FROM) as usize;
                    let at = self.now + self.recogniser_s();
                    self.working.push(Working { at, sound, utterance });
                }
                speech::Out::Motion(_)
                | speech::Out::Hearing(_)
                | speech::Out::Partial(_)
                | speech::Out::InterimSamples(..)
                | speech::Out::DecodeEarly(..) => {}
                speech::Out::OpenMicrophone(..) => unreachable!("nobody asks for the microphone"),
            }
        }
    }

    fn receipt(&mut self, receipt: &Receipt) {
        if let Some(UtteranceSeq(seq)) = receipt.utterance() {
            self.numbers
                .insert(seq, usize::from(receipt.key[0]) + 256 * usize::from(receipt.key[1]));
        }
    }

    /// What the person hears of the robot's questions.
    fn present(&mut self, presented: Presented) {
        let Some(question) = self.questions.get(&presented.prompt).copied() else { return };
        let Presented { prompt, presentation, state, .. } = presented;
        // It is told again and again.
        if !self.heard.insert((prompt, presentation, state.get())) {
            return;
        }
        let began = Time(presented.started_ns);
        if state == PresentationState::Speaking.code() {
            let ends = self.saying.as_ref().map_or(self.now, |saying| saying.ends);
            self.person.hear_begin(Heard { prompt, question, began, ends });
        } else if state == PresentationState::Ended.code() {
            let ends = Time(presented.ended_ns);
            self.person.hear_end(Heard { prompt, question, began, ends }, ends);
        }
    }

    fn route_policy(&mut self, outputs: Vec<policy::Out>) {
        for output in outputs {
            match output {
                policy::Out::Mark(mark) => self.to_speech.push(speech::In::Mark(mark)),
                policy::Out::Act(act) => {
                    if let (Ok(ActKind::Ask), Ok(question)) =
                        (act.kind(), Question::try_from(act.question))
                    {
                        self.questions.insert(act.prompt, question);
                    }
                    self.picked = self.picked.or(act.pick().map(|(_, object)| object));
                    self.to_speech.push(speech::In::Act(act));
                }
                policy::Out::View(_) => {}
            }
        }
    }

    fn tell(&mut self, what: impl std::fmt::Display) {
        self.story.push(format!("{:7.2} s  {what}", self.now.ns() as f64 / 1e9));
    }

    /// How each answer was credited, from the policy's journal.
    fn credits(&self) -> Vec<Credit> {
        let scene = &self.settings.scene;
        let credit = |record: &Record| {
            let Cause::Utterance(heard) = &record.cause else { return None };
            let (said, ..) = self.said.get(*self.numbers.get(&heard.seq.0)?)?;
            let evidence = record.state.open.as_ref()?.evidence.last()?;
            let truth = NamedQuestion::new(scene, said.question);
            if truth == NamedQuestion::None {
                return None;
            }
            let weight = |is: &dyn Fn(&NamedQuestion) -> bool| -> f64 {
                evidence
                    .interpretations
                    .iter()
                    .filter(|(_, asked, _)| is(asked))
                    .map(|(w, ..)| w)
                    .sum()
            };
            let all = weight(&|_| true);
            let right = weight(&|asked| *asked == truth) / all;
            let wrong = weight(&|asked| *asked != truth && *asked != NamedQuestion::None) / all;
            Some(Credit { right, wrong })
        };
        self.policy.journal().iter().filter_map(credit).collect()
    }

    fn ended(self) -> Ended {
        let last = self.policy.journal().last();
        let open = last.and_then(|record| record.state.open.as_ref());
        Ended {
            wanted: self.person.wanted,
            picked: self.picked,
            questions: open.map_or(0, Interaction::questions),
            seconds: self.now.ns() as f64 / 1e9,
            credits: self.credits(),
            story: self.story,
        }
    }
}

fn began_to_speak(n: usize, utterance: &Utterance) -> Began {
    Began {
        sound: LIVE_FROM + n as u64,
        at: utterance.onset,
        stream: key(n),
        segment: None,
        source: Source::Microphone,
        interrupts: true,
    }
}

fn key(n: usize) -> RequestKey {
    let mut key = [7; 16];
    (key[0], key[1]) = ((n % 256) as u8, (n / 256) as u8);
    RequestKey(key)
}

fn pass<N: Node>(host: &mut Host<N>, inbox: Vec<N::In>, now: Time) -> Vec<N::Out>
where
    N::Record: Clone,
{
    let due = host.deadline().is_some_and(|deadline| deadline <= now);
    if inbox.is_empty() && !due {
        return Vec::new();
    }
    let mut events: Vec<Event<N::In>> = inbox.into_iter().map(Event::Message).collect();
    if due {
        events.push(Event::Tick);
    }
    host.pass(events, now, None)
}
