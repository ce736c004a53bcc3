//! The reducers of a group that take turns in one thread, as peers of a forged message.

use setup::DialogueSettings;
use std::sync::LazyLock;

use arm::shell::ArmProgram;
use config::Settings;
use grounding::shell::GroundingProgram;
use messages::{
    Activity, AppliedMark, ArmStatus, Injection, MotionOrder, Observation, Presented, RequestKey,
    RobotAct, Sound, Utterance,
};
use policy::shell::PolicyProgram;
use service::lifecycle::Environment;
use service::service_loop::{Program, Record};
use service::stop_socket::{Caller, StopOrder};
use service::{Effects, Event, Node, Span, Time};
use speech::shell::SpeechProgram;
use speech::{PlaybackEvent, PlaybackState};

/// The settings of the tests.
pub(super) static SETTINGS: LazyLock<Settings> = LazyLock::new(|| crate::settings(&[]));

/// Time between two passes.
const STEP: Span = Span::from_ms(20);
/// Steps for which a sentence of the robot sounds.
const SENTENCE_STEPS: u32 = 10;

/// The latest message of each kind.
#[derive(Default)]
pub(super) struct Latest {
    pub(super) utterance: Utterance,
    pub(super) observation: Observation,
    pub(super) mark: AppliedMark,
    pub(super) act: RobotAct,
    pub(super) presented: Presented,
    pub(super) activity: Activity,
    pub(super) status: ArmStatus,
}

/// The configuration that the real program gives its node.
fn configured<P: Program>() -> <P::Node as Node>::Config {
    P::config(&Environment::nowhere(), &SETTINGS).unwrap_or_else(|error| panic!("{error}"))
}

/// A service with its journal; recovers from the journal's bytes.
pub(super) struct Process<P: Program> {
    config: Box<dyn Fn() -> <P::Node as Node>::Config>,
    node: Option<P::Node>,
    pub(super) journal: Vec<Record<P>>,
}

impl<P: Program> Process<P> {
    fn new(config: impl Fn() -> <P::Node as Node>::Config + 'static) -> Self {
        Self { config: Box::new(config), node: None, journal: Vec::new() }
    }

    pub(super) fn kill(&mut self) {
        self.node = None;
    }

    fn start(&mut self, now: Time) -> Vec<<P::Node as Node>::Out> {
        if self.node.is_some() {
            return Vec::new();
        }
        let bytes = postcard::to_stdvec(&self.journal).expect("records encode");
        let records = postcard::from_bytes(&bytes).expect("what was encoded decodes");
        let node = P::Node::recover((self.config)(), records);
        self.node = Some(node.unwrap_or_else(|error| panic!("recovery: {error}")));
        self.pass([Event::Started], now)
    }

    /// One pass of the main loop: what has arrived, and a tick that is due.
    fn wake(
        &mut self,
        inbox: Vec<<P::Node as Node>::In<'static>>,
        now: Time,
    ) -> Vec<<P::Node as Node>::Out> {
        let deadline = self.node.as_ref().and_then(Node::deadline);
        let tick = deadline.is_some_and(|deadline| deadline <= now).then_some(Event::Tick);
        self.pass(inbox.into_iter().map(Event::Message).chain(tick), now)
    }

    fn pass(
        &mut self,
        events: impl IntoIterator<Item = Event<<P::Node as Node>::In<'static>>>,
        now: Time,
    ) -> Vec<<P::Node as Node>::Out> {
        let Some(node) = &mut self.node else { return Vec::new() };
        let mut effects = Effects::default();
        events.into_iter().for_each(|event| node.on(event, now, &mut effects));
        self.journal.extend(effects.take_records());
        node.on_durable();
        effects.take_outputs()
    }
}

pub(super) struct Group {
    pub(super) speech: Process<SpeechProgram>,
    pub(super) grounding: Process<GroundingProgram>,
    pub(super) policy: Process<PolicyProgram>,
    pub(super) arm: Process<ArmProgram<drivers::Shipped>>,
    pub(super) latest: Latest,
    pub(super) to_speech: Vec<speech::In<'static>>,
    pub(super) to_grounding: Vec<grounding::In<'static>>,
    pub(super) to_policy: Vec<policy::In<'static>>,
    pub(super) to_arm: Vec<arm::In<'static>>,
    now: Time,
    said: u8,
    /// The playback that sounds, and its remaining steps.
    saying: Option<(u64, u32)>,
}

impl Group {
    pub(super) fn new() -> Self {
        let mut group = Self {
            speech: Process::new(configured::<SpeechProgram>),
            grounding: Process::new(configured::<GroundingProgram>),
            // Without the precomputed decisions, which take longer than a dialogue.
            policy: Process::new(|| SETTINGS.manager().expect("valid settings").into()),
            arm: Process::new(configured::<ArmProgram<drivers::Shipped>>),
            latest: Latest::default(),
            to_speech: Vec::new(),
            to_grounding: Vec::new(),
            to_policy: Vec::new(),
            to_arm: Vec::new(),
            now: Time(1_000_000_000),
            said: 0,
            saying: None,
        };
        group.start();
        group
    }

    /// Starts what does not run, from its journal.
    pub(super) fn start(&mut self) {
        let now = self.now;
        let speech = self.speech.start(now);
        speech.into_iter().for_each(|output| self.speech_says(output));
        self.grounding.start(now);
        let policy = self.policy.start(now);
        policy.into_iter().for_each(|output| self.policy_says(output));
        let arm = self.arm.start(now);
        arm.into_iter().for_each(|output| self.arm_says(output));
    }

    /// A user types.
    pub(super) fn say(&mut self, text: &str) {
        self.said = self.said.wrapping_add(1);
        let key = RequestKey([self.said; 16]);
        let sound = Sound::Text(text.to_owned());
        let injection = Injection::new(key, sound);
        self.to_speech.push(speech::In::Injection(injection));
    }

    pub(super) fn run(&mut self, steps: u32) {
        (0..steps).for_each(|_| self.step());
    }

    /// One fetch, questions answered with yes.
    pub(super) fn dialogue(&mut self) {
        self.say("the small white bowl in the dishwasher");
        for _ in 0..4 {
            self.run(150);
            self.say("yes");
        }
        self.run(150);
    }

    /// The encoded records of speech, policy and arm.
    pub(super) fn journals(&self) -> [Vec<Vec<u8>>; 3] {
        fn encoded<P: Program>(process: &Process<P>) -> Vec<Vec<u8>> {
            let record = |record| postcard::to_stdvec(record).expect("a record encodes");
            process.journal.iter().map(record).collect()
        }
        [encoded(&self.speech), encoded(&self.policy), encoded(&self.arm)]
    }

    fn step(&mut self) {
        self.now = self.now + STEP;
        let now = self.now;
        if let Some((playback, left)) = self.saying.take() {
            match left {
                0 => self.playback(playback, PlaybackState::Ended),
                _ => self.saying = Some((playback, left - 1)),
            }
        }
        let inbox = std::mem::take(&mut self.to_speech);
        let outputs = self.speech.wake(inbox, now);
        outputs.into_iter().for_each(|output| self.speech_says(output));
        let inbox = std::mem::take(&mut self.to_grounding);
        for output in self.grounding.wake(inbox, now) {
            let grounding::Out::Observation(observation) = output else { continue };
            self.latest.observation = *observation;
            self.to_policy.push(policy::In::Observation(observation.into()));
        }
        let inbox = std::mem::take(&mut self.to_policy);
        let outputs = self.policy.wake(inbox, now);
        outputs.into_iter().for_each(|output| self.policy_says(output));
        let inbox = std::mem::take(&mut self.to_arm);
        let outputs = self.arm.wake(inbox, now);
        outputs.into_iter().for_each(|output| self.arm_says(output));
    }

    fn playback(&mut self, playback: u64, state: PlaybackState) {
        self.to_speech.push(speech::In::Playback(PlaybackEvent { playback, state }));
    }

    fn speech_says(&mut self, output: speech::Out) {
        match output {
            speech::Out::Utterance(utterance) => {
                self.latest.utterance = *utterance;
                self.to_grounding.push(grounding::In::Utterance(utterance.into()));
            }
            speech::Out::Presented(presented) => {
                self.latest.presented = presented;
                self.to_policy.push(policy::In::Presented(presented));
            }
            speech::Out::Activity(activity) => {
                self.latest.activity = activity;
                self.to_policy.push(policy::In::Activity(activity));
            }
            speech::Out::Stop(given) => {
                self.order(MotionOrder::Stop, given.ns());
            }
            speech::Out::Speak(line) => {
                self.saying = Some((line.playback, SENTENCE_STEPS));
                self.playback(line.playback, PlaybackState::Started);
            }
            speech::Out::StopSpeaking => {
                if let Some((playback, _)) = self.saying.take() {
                    self.playback(playback, PlaybackState::Interrupted);
                }
            }
            // To clients, and to a recogniser and a microphone that are not there.
            _ => {}
        }
    }

    /// Gives the arm an order to its motion stop.
    pub(super) fn order(&mut self, order: MotionOrder, given_ns: u64) {
        let order = StopOrder::new(order, Time(given_ns));
        self.to_arm.push(arm::In::StopOrder(order, Caller::named(b"a client")));
    }

    fn policy_says(&mut self, output: policy::Out) {
        match output {
            policy::Out::Mark(mark) => {
                self.latest.mark = mark;
                self.to_speech.push(speech::In::Mark(mark));
            }
            policy::Out::Act(act) => {
                self.latest.act = *act;
                self.to_speech.push(speech::In::Act(act.clone().into()));
                self.to_arm.push(arm::In::Act(act.into()));
            }
            policy::Out::View(_) | policy::Out::Objects(_) => {}
        }
    }

    fn arm_says(&mut self, output: arm::Out) {
        match output {
            arm::Out::Status(status) => {
                self.latest.status = status;
                self.to_policy.push(policy::In::Arm(status));
                self.to_speech.push(speech::In::Arm(status));
            }
            arm::Out::Plan(request) => {
                self.to_arm.push(arm::In::Planned(Box::new(request.solve())));
            }
            _ => {}
        }
    }
}
