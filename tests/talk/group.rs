//! The real reducers of speech, grounding, policy and arm in one thread and simulated time, without
//! faults: time leaps from event to event, so that a minute of dialogue takes milliseconds.

use std::collections::BTreeMap;

use arm::ArmNode;
use config::Settings;
use grounding::GroundingNode;
use messages::{
    ActKind, ArmStatus, Injection, MotionOrder, PickId, PickOutcome, PickPhase, ReceiptStatus,
    RequestKey, RobotAct, Sound,
};
use policy::PolicyNode;
use scene::{ObjectId, Question};
use service::stop_socket::{Caller, StopOrder};
use service::{Node, Span, Time};
use speech::{PlaybackEvent, PlaybackState, SpeechNode};
use whichone_tests::simulated_group::{Faults, Host, RepeatedStop};

/// Duration of a robot's sentence.
const SENTENCE: Span = Span::from_ms(1_500);
/// Time that a message takes from one service to the next.
const STEP: Span = Span::from_ms(1);
/// Longest leap.
const LEAP: Span = Span::from_ms(50);

/// A line that the robot has begun to say.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) at: Time,
    pub(crate) text: String,
    pub(crate) question: Question,
    /// True unless it was broken off.
    pub(crate) is_whole: bool,
}

impl Line {
    /// Returns whether the person takes it for a question.
    pub(crate) fn asks(&self) -> bool {
        self.text.contains('?')
    }
}

/// What a person beside the robot notices.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    pub(crate) lines: Vec<Line>,
    /// End of the latest line.
    pub(crate) quiet_since: Time,
    pub(crate) is_talking: bool,
    /// Announced picks.
    pub(crate) picks: Vec<(Time, PickId, ObjectId)>,
    pub(crate) delivered: Vec<(Time, ObjectId)>,
    /// Objects that are back in their places.
    pub(crate) put_back: Vec<(Time, ObjectId)>,
    pub(crate) is_fetching: bool,
    /// Seconds until what is fetched is let go of, once it is held.
    pub(crate) lets_go_s: Option<f64>,
    pub(crate) is_stopped: bool,
    /// Texts that were refused.
    pub(crate) refused: Vec<String>,
}

/// What the person does to the group.
#[derive(Clone, Debug)]
pub(crate) enum Input {
    Text(String),
    Motion(MotionOrder),
}

struct Saying {
    playback: u64,
    ends: Time,
}

#[derive(Default)]
struct Inboxes {
    speech: Vec<speech::In<'static>>,
    grounding: Vec<grounding::In<'static>>,
    policy: Vec<policy::In<'static>>,
    arm: Vec<arm::In<'static>>,
}

/// A robot that a person talks to.
pub(crate) trait Robot {
    fn now(&self) -> Time;
    fn seen(&self) -> &Seen;
    /// Gives it an input of its user.
    fn put(&mut self, input: Input);
    /// Lets time pass, to its next event at most.
    fn advance(&mut self);
}

/// All services, a voice, and a world.
pub(crate) struct Group {
    speech: Host<SpeechNode>,
    grounding: Host<GroundingNode>,
    policy: Host<PolicyNode>,
    arm: Host<ArmNode>,
    faults: Faults,
    inboxes: Inboxes,
    stop: RepeatedStop,
    saying: Option<Saying>,
    /// The question of each prompt.
    questions: BTreeMap<u64, Question>,
    latest_pick: Option<PickId>,
    latest_delivery: Option<PickId>,
    texts: u64,
    now: Time,
    seen: Seen,
}

impl Robot for Group {
    fn now(&self) -> Time {
        self.now
    }

    fn seen(&self) -> &Seen {
        &self.seen
    }

    fn put(&mut self, input: Input) {
        match input {
            Input::Text(text) => {
                self.texts += 1;
                let mut key = [0; 16];
                key[..8].copy_from_slice(&self.texts.to_le_bytes());
                let (key, sound) = (RequestKey(key), Sound::Text(text));
                let injection = Injection::new(key, sound);
                self.inboxes.speech.push(speech::In::Injection(injection));
            }
            Input::Motion(order) => {
                let order = StopOrder::new(order, self.now);
                self.inboxes.arm.push(arm::In::StopOrder(order, Caller::named(b"an operator")));
            }
        }
    }

    /// Passes all messages on, then leaps to the next event.
    fn advance(&mut self) {
        if let Some(saying) = self.saying.take_if(|saying| saying.ends <= self.now) {
            self.end_line(saying.playback, PlaybackState::Ended);
        }
        self.pass();
        let is_idle = self.inboxes.speech.is_empty()
            && self.inboxes.grounding.is_empty()
            && self.inboxes.policy.is_empty()
            && self.inboxes.arm.is_empty();
        let soonest = self.now + STEP;
        if !is_idle {
            self.now = soonest;
            return;
        }
        let deadlines = [
            self.speech.deadline(),
            self.grounding.deadline(),
            self.policy.deadline(),
            self.arm.deadline(),
            self.saying.as_ref().map(|saying| saying.ends),
        ];
        let next = deadlines.into_iter().flatten().min().unwrap_or(self.now + LEAP);
        self.now = next.clamp(soonest, self.now + LEAP);
    }
}

impl Group {
    pub(crate) fn new(settings: &Settings) -> Self {
        let mut group = Self {
            speech: Host::new::<speech::shell::SpeechProgram>(settings),
            grounding: Host::new::<grounding::shell::GroundingProgram>(settings),
            policy: Host::new::<policy::shell::PolicyProgram>(settings),
            arm: Host::new::<arm::shell::ArmProgram<drivers::Shipped>>(settings),
            faults: Faults::none(),
            inboxes: Inboxes::default(),
            stop: RepeatedStop::default(),
            saying: None,
            questions: BTreeMap::new(),
            latest_pick: None,
            latest_delivery: None,
            texts: 0,
            now: Time(1),
            seen: Seen::default(),
        };
        let outputs = group.arm.start(group.now, &mut group.faults);
        group.route_arm(outputs);
        let outputs = group.policy.start(group.now, &mut group.faults);
        group.route_policy(outputs);
        drop(group.grounding.start(group.now, &mut group.faults));
        let outputs = group.speech.start(group.now, &mut group.faults);
        group.route_speech(outputs);
        group
    }

    fn pass(&mut self) {
        let now = self.now;
        let Inboxes { speech, grounding, policy, arm } = std::mem::take(&mut self.inboxes);
        let outputs = self.speech.wake(speech, now, &mut self.faults);
        self.route_speech(outputs);
        let outputs = self.grounding.wake(grounding, now, &mut self.faults);
        let observations = outputs.into_iter().filter_map(|it| match it {
            grounding::Out::Observation(observation) => Some(observation),
            grounding::Out::Ask(_) => None,
        });
        self.inboxes.policy.extend(observations.map(|it| policy::In::Observation(it.into())));
        let outputs = self.policy.wake(policy, now, &mut self.faults);
        self.route_policy(outputs);
        let arm = arm.into_iter().chain(self.stop.order()).collect();
        let outputs = self.arm.wake(arm, now, &mut self.faults);
        self.route_arm(outputs);
    }

    fn route_speech(&mut self, outputs: Vec<<SpeechNode as Node>::Out>) {
        for output in outputs {
            match output {
                speech::Out::Utterance(utterance) => {
                    self.inboxes.grounding.push(grounding::In::Utterance(utterance.into()));
                }
                speech::Out::Presented(presented) => {
                    self.inboxes.policy.push(policy::In::Presented(presented));
                }
                speech::Out::Activity(activity) => {
                    self.inboxes.policy.push(policy::In::Activity(activity));
                }
                speech::Out::Stop(given) => self.stop.give(given),
                speech::Out::Receipt(receipt) if receipt.status != ReceiptStatus::Accepted => {
                    let note = receipt.note.as_str().unwrap_or_default().to_owned();
                    self.seen.refused.push(note);
                }
                speech::Out::Speak(request) => {
                    self.stop_speaking();
                    let question = self.questions.get(&request.prompt.0).copied();
                    self.seen.lines.push(Line {
                        at: self.now,
                        text: request.text,
                        question: question.unwrap_or_default(),
                        is_whole: true,
                    });
                    self.seen.is_talking = true;
                    let (playback, ends) = (request.playback, self.now + SENTENCE);
                    self.saying = Some(Saying { playback, ends });
                    self.play(playback, PlaybackState::Started);
                }
                speech::Out::StopSpeaking => self.stop_speaking(),
                _ => {}
            }
        }
    }

    fn stop_speaking(&mut self) {
        if let Some(saying) = self.saying.take() {
            if let Some(line) = self.seen.lines.last_mut() {
                line.is_whole = false;
            }
            self.end_line(saying.playback, PlaybackState::Interrupted);
        }
    }

    fn end_line(&mut self, playback: u64, state: PlaybackState) {
        (self.seen.is_talking, self.seen.quiet_since) = (false, self.now);
        self.play(playback, state);
    }

    fn play(&mut self, playback: u64, state: PlaybackState) {
        self.inboxes.speech.push(speech::In::Playback(PlaybackEvent { playback, state }));
    }

    fn route_policy(&mut self, outputs: Vec<<PolicyNode as Node>::Out>) {
        for output in outputs {
            match output {
                policy::Out::Mark(mark) => self.inboxes.speech.push(speech::In::Mark(mark)),
                policy::Out::Act(act) => {
                    self.see_act(&act);
                    self.inboxes.speech.push(speech::In::Act(act.clone().into()));
                    self.inboxes.arm.push(arm::In::Act(act.into()));
                }
                _ => {}
            }
        }
    }

    fn see_act(&mut self, act: &RobotAct) {
        if act.kind == ActKind::Ask
            && let Ok(question) = act.question.try_into()
        {
            self.questions.insert(act.prompt, question);
        }
        if act.kind == ActKind::Cancel {
            self.seen.is_fetching = false;
        }
        if let Some((id, _)) = act.put_back()
            && self.latest_pick < Some(id)
        {
            self.latest_pick = Some(id);
            self.seen.is_fetching = true;
        }
        if let Some((id, object)) = act.pick()
            && self.latest_pick < Some(id)
        {
            self.latest_pick = Some(id);
            self.seen.picks.push((self.now, id, object));
            self.seen.is_fetching = true;
        }
    }

    fn route_arm(&mut self, outputs: Vec<<ArmNode as Node>::Out>) {
        for output in outputs {
            match output {
                arm::Out::Status(status) => {
                    self.see_arm(&status);
                    self.inboxes.policy.push(policy::In::Arm(status));
                    self.inboxes.speech.push(speech::In::Arm(status));
                }
                arm::Out::StopState(_, state) => {
                    self.inboxes.speech.extend(self.stop.on_answer(state, self.now));
                }
                arm::Out::Plan(request) => {
                    self.inboxes.arm.push(arm::In::Planned(Box::new(request.solve())));
                }
                _ => {}
            }
        }
    }

    fn see_arm(&mut self, status: &ArmStatus) {
        self.seen.is_stopped = status.stopped != 0;
        let is_held = status.phase == PickPhase::Holding;
        self.seen.lets_go_s = is_held.then_some(status.remaining_s);
        if status.phase != PickPhase::Done || Some(status.pick()) != self.latest_pick {
            return;
        }
        self.seen.is_fetching = false;
        let is_new = self.latest_delivery < Some(status.pick());
        let Ok(object) = u16::try_from(status.object).map(ObjectId) else { return };
        match status.outcome.get() {
            PickOutcome::Delivered if is_new => self.seen.delivered.push((self.now, object)),
            PickOutcome::PutBack if is_new => self.seen.put_back.push((self.now, object)),
            _ => return,
        }
        self.latest_delivery = Some(status.pick());
    }
}
