//! The simulated machine: a bus that forgets, a voice, a clock, and the processes on it.

use crate::faults::Faults;
use crate::person::Person;
use arm::ArmNode;
use config::Settings;
use dialogue::Model;
use grounding::GroundingNode;
use messages::WireCode;
use messages::{ActKind, Outcome, PolicyView};
use policy::PolicyNode;
use scene::{Question, Scene};
use service::{Event, Node, Span, Time};
use speech::{PlaybackEvent, PlaybackState, SpeechNode};
use whichone_tests::{Host, configured};

/// How long the voice takes for a line.
const LINE: Span = Span::from_ms(400);
/// No dialogue takes longer; one that does is stuck.
const END: Time = Time(240_000_000_000);

/// The machine and what happened on it.
pub(crate) struct World {
    pub(crate) settings: Settings,
    /// The settings before the scene was changed, and how many of the policy's records are theirs.
    pub(crate) before: Option<(Settings, usize)>,
    /// The settings that come into force once the first question is decided; none when they have.
    pub(crate) change: Option<Settings>,
    pub(crate) scene: Scene,
    pub(crate) model: Model,
    pub(crate) speech: Host<SpeechNode>,
    pub(crate) grounding: Host<GroundingNode>,
    pub(crate) policy: Host<PolicyNode>,
    pub(crate) arm: Host<ArmNode>,
    pub(crate) person: Person,
    pub(crate) faults: Faults,
    /// The latest that clients were told.
    pub(crate) view: PolicyView,
    /// Acts that became visible before their decision was durable.
    pub(crate) premature: Vec<String>,
    now: Time,
    inboxes: Inboxes,
    restarts: [Option<Time>; 4],
    voice: Option<(u64, Time)>,
    log: Vec<String>,
}

/// What waits for each process.
#[derive(Default)]
struct Inboxes {
    speech: Vec<speech::In>,
    grounding: Vec<Box<messages::Utterance>>,
    policy: Vec<policy::In>,
    arm: Vec<arm::In>,
}

impl World {
    pub(crate) fn new(all: Settings, person: Person, faults: Faults) -> Self {
        Self {
            model: Model::new(&all.scene, all.dialogue.params),
            scene: all.scene.clone(),
            speech: Host::new(configured::<speech::shell::SpeechProgram>(&all)),
            grounding: Host::new(configured::<grounding::shell::GroundingProgram>(&all)),
            policy: Host::new(configured::<policy::shell::PolicyProgram>(&all)),
            arm: Host::new(configured::<arm::shell::ArmProgram>(&all)),
            settings: all,
            before: None,
            change: None,
            person,
            faults,
            view: PolicyView::default(),
            premature: Vec::new(),
            now: Time(1),
            inboxes: Inboxes::default(),
            restarts: [Some(Time(1)); 4],
            voice: None,
            log: Vec::new(),
        }
    }

    /// Has the scene changed under the dialogue, right after the first question was decided.
    pub(crate) fn with_change(mut self, to: Settings) -> Self {
        self.change = Some(to);
        self
    }

    /// What happened, for a person who has to find out why.
    pub(crate) fn story(&self) -> String {
        self.log.join("\n")
    }

    /// Runs until the interaction is over and everybody knows, or nothing more can come.
    pub(crate) fn run(&mut self) {
        while self.now < END && !self.is_over() {
            self.now = self.now + Span::from_ms(10);
            self.change_the_scene();
            self.restart_the_dead();
            self.person_speaks();
            self.voice_goes_on();
            self.pass_speech();
            self.pass_grounding();
            self.pass_policy();
            self.pass_arm();
        }
    }

    fn is_over(&self) -> bool {
        let up = self.speech.is_up() && self.policy.is_up() && self.arm.is_up();
        up && self.view.last.is_some() && self.view.interaction == 0
    }

    /// How the interaction ended.
    pub(crate) fn outcome(&self) -> Option<(Outcome, Option<scene::ObjectId>)> {
        self.view.last.as_ref().map(|ended| (ended.outcome, ended.object))
    }

    fn tell(&mut self, what: impl std::fmt::Display) {
        self.log.push(format!("{:9.3} s  {what}", self.now.ns() as f64 / 1e9));
    }

    /// All services are started anew with the other scene, each after a while of its own: what one
    /// of them sends may reach another that still knows the former.
    fn change_the_scene(&mut self) {
        let is_time = self.view.decision == messages::ActKind::Ask && self.policy.is_up();
        let Some(to) = self.change.take_if(|_| is_time) else { return };
        self.tell("the scene changes");
        self.speech.replace(configured::<speech::shell::SpeechProgram>(&to));
        self.grounding.replace(configured::<grounding::shell::GroundingProgram>(&to));
        self.policy.replace(configured::<policy::shell::PolicyProgram>(&to));
        self.arm.replace(configured::<arm::shell::ArmProgram>(&to));
        self.restarts = std::array::from_fn(|_| Some(self.now + self.faults.downtime()));
        let wanted = &self.scene.object(self.person.wanted).name;
        self.person.wanted = to.scene.object_named(wanted).expect("what is wanted stays");
        (self.scene, self.model) = (to.scene.clone(), Model::new(&to.scene, to.dialogue.params));
        let records = self.policy.journal().len();
        self.before = Some((std::mem::replace(&mut self.settings, to), records));
    }

    fn restart_the_dead(&mut self) {
        let due = |at: Option<Time>| at.is_some_and(|at| at <= self.now);
        let [speech, grounding, policy, arm] = self.restarts.map(due);
        if speech {
            self.restarts[0] = None;
            let outputs = self.speech.start(self.now);
            self.voice = None;
            self.route_speech(outputs);
        }
        if grounding {
            self.restarts[1] = None;
            let outputs = self.grounding.start(self.now);
            self.route_grounding(outputs);
        }
        if policy {
            self.restarts[2] = None;
            let outputs = self.policy.start(self.now);
            self.route_policy(outputs);
        }
        if arm {
            self.restarts[3] = None;
            let outputs = self.arm.start(self.now);
            self.route_arm(outputs);
        }
    }

    fn person_speaks(&mut self) {
        if let Some(injection) = self.person.speak(self.now) {
            for _ in 0..self.faults.copies(self.now) {
                self.inboxes.speech.push(speech::In::Injection(injection.clone()));
            }
        }
    }

    fn voice_goes_on(&mut self) {
        if let Some((line, ends)) = self.voice
            && ends <= self.now
        {
            self.voice = None;
            let ended = PlaybackEvent { playback: line, state: PlaybackState::Ended };
            self.inboxes.speech.push(speech::In::Playback(ended));
        }
    }

    fn pass_speech(&mut self) {
        let inbox = std::mem::take(&mut self.inboxes.speech);
        let outputs = pass(&mut self.speech, inbox, self.now, &mut self.faults);
        self.bury(0, self.speech.is_up(), "speech");
        self.route_speech(outputs);
    }

    fn pass_grounding(&mut self) {
        let inbox = std::mem::take(&mut self.inboxes.grounding);
        let outputs = pass(&mut self.grounding, inbox, self.now, &mut self.faults);
        self.bury(1, self.grounding.is_up(), "grounding");
        self.route_grounding(outputs);
    }

    fn pass_policy(&mut self) {
        let inbox = std::mem::take(&mut self.inboxes.policy);
        let outputs = pass(&mut self.policy, inbox, self.now, &mut self.faults);
        self.bury(2, self.policy.is_up(), "policy");
        self.route_policy(outputs);
    }

    fn pass_arm(&mut self) {
        let inbox = std::mem::take(&mut self.inboxes.arm);
        let outputs = pass(&mut self.arm, inbox, self.now, &mut self.faults);
        self.bury(3, self.arm.is_up(), "arm");
        self.route_arm(outputs);
    }

    /// Notes that a process has died in its pass, and when it will be back.
    fn bury(&mut self, which: usize, is_up: bool, name: &str) {
        if !is_up && self.restarts[which].is_none() {
            self.restarts[which] = Some(self.now + self.faults.downtime());
            self.tell(format_args!("{name} dies"));
        }
    }

    fn route_speech(&mut self, outputs: Vec<speech::Out>) {
        for output in outputs {
            let copies = self.faults.copies(self.now);
            match output {
                speech::Out::Utterance(utterance) => {
                    let inbox = &mut self.inboxes.grounding;
                    inbox.extend(std::iter::repeat_n(utterance, copies));
                }
                speech::Out::Receipt(receipt) if copies > 0 => self.person.acknowledge(&receipt),
                speech::Out::Receipt(_) => {}
                speech::Out::Presented(presented) => {
                    self.person.hear(&presented, self.now);
                    let message = policy::In::Presented(presented);
                    self.inboxes.policy.extend(std::iter::repeat_n(message, copies));
                }
                speech::Out::Activity(activity) => {
                    let message = policy::In::Activity(activity);
                    self.inboxes.policy.extend(std::iter::repeat_n(message, copies));
                }
                speech::Out::Motion(command) => self.inboxes.arm.push(arm::In::Motion(command)),
                speech::Out::Speak(line) => {
                    self.tell(format_args!("robot: {}", line.text));
                    self.voice = Some((line.playback, self.now + LINE));
                    let started =
                        PlaybackEvent { playback: line.playback, state: PlaybackState::Started };
                    self.inboxes.speech.push(speech::In::Playback(started));
                }
                speech::Out::StopSpeaking => self.voice = None,
                speech::Out::Hearing(_) => {}
                speech::Out::Partial(_)
                | speech::Out::InterimSamples(..)
                | speech::Out::DecodeEarly(..) => {}
                speech::Out::Recognise(..) | speech::Out::OpenMicrophone(..) => {
                    unreachable!("the person types")
                }
            }
        }
    }

    #[allow(clippy::vec_box, reason = "the node's own output type")]
    fn route_grounding(&mut self, outputs: Vec<Box<messages::Observation>>) {
        for observation in outputs {
            for _ in 0..self.faults.copies(self.now) {
                let message = policy::In::Observation(observation.clone());
                // The bus may hand over a doubled message out of turn.
                self.inboxes.policy.insert(0, message);
            }
        }
    }

    fn route_policy(&mut self, outputs: Vec<policy::Out>) {
        for output in outputs {
            let copies = self.faults.copies(self.now);
            match output {
                policy::Out::Mark(mark) => {
                    let message = speech::In::Mark(mark);
                    self.inboxes.speech.extend(std::iter::repeat_n(message, copies));
                }
                policy::Out::Act(act) => {
                    self.check_durable(&act);
                    if act.kind() == Ok(ActKind::Ask) {
                        let question = Question::try_from(act.question).expect("a question");
                        self.person.announce(act.prompt, question, &self.scene, &self.model);
                    }
                    let (to_speech, to_arm) = (speech::In::Act(act.clone()), arm::In::Act(act));
                    self.inboxes.speech.extend(std::iter::repeat_n(to_speech, copies));
                    self.inboxes.arm.extend(std::iter::repeat_n(to_arm, copies));
                }
                policy::Out::View(view) => self.view = *view,
            }
        }
    }

    fn route_arm(&mut self, outputs: Vec<arm::Out>) {
        for output in outputs {
            if let arm::Out::Status(status) = output {
                let copies = self.faults.copies(self.now);
                let (to_policy, to_speech) = (policy::In::Arm(status), speech::In::Arm(status));
                self.inboxes.policy.extend(std::iter::repeat_n(to_policy, copies));
                self.inboxes.speech.extend(std::iter::repeat_n(to_speech, copies));
            }
        }
    }

    /// Whatever becomes visible must be durable already.
    fn check_durable(&mut self, act: &messages::RobotAct) {
        let durable = self.policy.journal().last().map_or(0, |record| record.state.act.id.0);
        if act.act > durable && act.kind != ActKind::Wait.code() {
            self.premature.push(format!("act {} before record {durable}", act.act));
        }
    }
}

fn pass<N: Node>(
    host: &mut Host<N>,
    inbox: Vec<N::In>,
    now: Time,
    faults: &mut Faults,
) -> Vec<N::Out>
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
    let crash = if host.is_up() { faults.crash(now) } else { None };
    host.pass(events, now, crash)
}
