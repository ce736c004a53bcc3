//! The real reducers of all services in one thread and in simulated time, with a simulated bus,
//! voice, recogniser and user.
//!
//! | file | holds |
//! |---|---|
//! | `host.rs` | one reducer in a simulated process |
//! | `disk.rs` | its journal: the real one, on a disk that tears and loses what is not synced |
//! | `faults.rs` | faults drawn from a seed: kills, full disks, lost and duplicated messages |
//! | `forger.rs` | messages that no service sends |
//! | `user.rs` | the user and the input channels |
//! | `deaths.rs` | deaths of services, of the client and of the whole group, and what starts again |
//! | `voice.rs` | the robot's sentences, which take their time |
//! | `client.rs` | the user at a terminal, by the command line's own code, who is killed as well |
//! | `routes.rs` | routing of the services' messages |
//! | `stop.rs` | stop orders that are repeated until the arm has carried them out |
//! | `table.rs`, `noisy.rs`, `perceived.rs` | objects from perception: a table under a simulated camera or detector, and dialogues about it |
//! | `attribution.rs` | a study of turn-taking: to which question each answer is credited |

mod attribution;
mod client;
mod deaths;
mod disk;
mod faults;
mod forger;
mod host;
mod noisy;
mod perceived;
mod routes;
mod stop;
mod table;
mod user;
mod voice;

use std::iter::repeat_n;
use std::path::Path;

use config::Settings;
use dialogue::Model;
use evaluation::simulation::users::Domain;
use grounding::GroundingNode;
use messages::{Outcome, PolicyView};
use policy::PolicyNode;
use scene::{ObjectId, Scene};
use service::{Span, Time};
use speech::SpeechNode;
use vocabulary::Rng;

pub use attribution::{Count, study};
pub use client::Client;
pub use faults::{Fault, Faults};
pub use host::{Crash, Host};
pub use noisy::NoisyDetector;
pub use perceived::{Tally, at_best, before_camera, converse, detect, perceive};
pub use stop::RepeatedStop;
pub use table::{Eye, Happening, TableTop};
pub use user::{Channel, GroupUser};
use voice::{QUICK_SENTENCE_S, SENTENCE_S, Saying};

/// Time between two passes.
const STEP: Span = Span::from_ms(10);
/// A dialogue that takes longer is stuck.
const END: Time = Time(240_000_000_000);
/// A sound that a recogniser is decoding: the robot's, by its number, or the client's.
struct Decoding {
    done: Time,
    sound: Option<u64>,
    utterance: usize,
}

/// Messages that wait for each process.
#[derive(Default)]
struct Inboxes {
    speech: Vec<speech::In<'static>>,
    grounding: Vec<grounding::In<'static>>,
    policy: Vec<policy::In<'static>>,
    arm: Vec<arm::In<'static>>,
}

/// The services of a group, and everything around them.
#[allow(missing_debug_implementations, reason = "nodes have none")]
pub struct SimulatedGroup {
    /// The settings in force.
    pub settings: Settings,
    /// The settings before the scene was changed, and how many of the policy's records are theirs.
    pub before: Option<(Settings, usize)>,
    /// Settings that come into force once the first question is decided; `None` when they have.
    pub change: Option<Settings>,
    /// The service of that name.
    pub speech: Host<SpeechNode>,
    /// The service of that name.
    pub policy: Host<PolicyNode>,
    /// The service of that name; without it a dialogue ends with the decision what to pick.
    pub arm: Option<Host<arm::ArmNode>>,
    /// The user.
    pub user: GroupUser,
    /// The user at a terminal, if it is one who is killed: they act in place of `user`.
    pub client: Option<Client>,
    /// Acts that became visible before their decision was durable.
    pub premature: Vec<String>,
    grounding: Host<GroundingNode>,
    model: Model,
    /// The faults, and how many there were.
    pub faults: Faults,
    sentence_s: (f64, f64),
    /// Time until a sentence is synthesised and sounds.
    synthesis: Span,
    /// Whether the speech service dies as soon as a question is decided.
    dies_at_questions: bool,
    rng: Rng,
    now: Time,
    inboxes: Inboxes,
    /// When each process is started again: speech, grounding, policy, arm.
    restarts: [Option<Time>; 4],
    stop: RepeatedStop,
    saying: Option<Saying>,
    decoding: Vec<Decoding>,
    picked: Option<ObjectId>,
    view: PolicyView,
    story: Vec<String>,
    /// Random numbers of the forger of messages, if there is one.
    forger: Option<Rng>,
    /// The table, where the objects come from perception.
    pub table: Option<TableTop>,
    /// When the user makes the request, seconds.
    request_s: f64,
}

impl SimulatedGroup {
    /// A group of all services with a quick voice.
    pub fn new(settings: Settings, user: GroupUser, faults: Faults) -> Self {
        Self {
            model: Model::new(&settings.scene, settings.dialogue.params),
            speech: Host::new::<speech::shell::SpeechProgram>(&settings),
            grounding: Host::new::<grounding::shell::GroundingProgram>(&settings),
            policy: Host::new::<policy::shell::PolicyProgram>(&settings),
            arm: Some(Host::new::<arm::shell::ArmProgram<drivers::Shipped>>(&settings)),
            settings,
            before: None,
            change: None,
            user,
            client: None,
            premature: Vec::new(),
            faults,
            sentence_s: QUICK_SENTENCE_S,
            synthesis: Span(0),
            dies_at_questions: false,
            rng: Rng::new(0),
            now: Time(1),
            inboxes: Inboxes::default(),
            restarts: [Some(Time(1)); 4],
            stop: RepeatedStop::default(),
            saying: None,
            decoding: Vec::new(),
            picked: None,
            view: PolicyView::default(),
            story: Vec::new(),
            forger: None,
            table: None,
            request_s: user::REQUEST_S,
        }
    }

    /// A group without arm and faults, whose voice takes as long as a real one.
    pub fn talking(settings: Settings, user: GroupUser, seed: u64) -> Self {
        let (arm, sentence_s, rng) = (None, SENTENCE_S, Rng::new(seed));
        Self { arm, sentence_s, rng, ..Self::new(settings, user, Faults::none()) }
    }

    /// Puts a table under a camera in front of the robot; the user lets it look first.
    #[must_use]
    pub fn with_table(self, table: TableTop) -> Self {
        Self { table: Some(table), request_s: 1.5, ..self }
    }

    /// Records the flights of all services in a folder: another one after so many passes.
    #[must_use]
    pub fn recorded(mut self, folder: &Path, passes: u64) -> Self {
        self.speech.record(folder, passes);
        self.grounding.record(folder, passes);
        self.policy.record(folder, passes);
        self.arm.iter_mut().for_each(|arm| arm.record(folder, passes));
        self
    }

    /// Returns the number of questions in the latest interaction that ended.
    pub fn questions(&self) -> u32 {
        self.view.last.as_ref().map_or(0, |ended| ended.questions)
    }

    /// Changes the scene under the dialogue, right after the first question was decided.
    #[must_use]
    pub fn with_change(mut self, to: Settings) -> Self {
        self.change = Some(to);
        self
    }

    /// A group whose user, at a terminal, wants these objects one after another; one who regrets has
    /// the first one put back.
    pub fn with_client(
        settings: Settings,
        wanted: &[usize],
        regrets: bool,
        faults: Faults,
    ) -> Self {
        let name = |object: &usize| settings.scene.object(ObjectId::from(*object)).name.clone();
        let client = Client::new(wanted.iter().map(name).collect(), regrets);
        let group = Self::new(settings, GroupUser::typing(0), faults);
        Self { client: Some(client), ..group }
    }

    /// The user at the terminal calls the first fetch off, so long after it was announced.
    #[must_use]
    pub fn calling_off(mut self, after: Span) -> Self {
        if let Some(client) = &mut self.client {
            client.calls_off = Some(after);
        }
        self
    }

    /// The user at the terminal answers each question so long after it is shown; the robot's voice needs time for
    /// synthesis, and the speech service may die at each question.
    #[must_use]
    pub fn answered_in_haste(
        mut self,
        after: Span,
        synthesis: Span,
        dies_at_questions: bool,
    ) -> Self {
        if let Some(client) = &mut self.client {
            client.hasty = Some(after);
        }
        Self { synthesis, dies_at_questions, ..self }
    }

    /// The log of the dialogue.
    pub fn story(&self) -> String {
        self.story.join("\n")
    }

    /// Returns the outcome of the interaction and its object.
    pub fn outcome(&self) -> Option<(Outcome, Option<ObjectId>)> {
        self.view.last.as_ref().map(|ended| (ended.outcome, ended.object))
    }

    /// Runs until the interaction is over and published, or the time is up.
    pub fn run(&mut self) {
        if self.client.is_none() {
            let domain = Domain { scene: &self.settings.scene, model: &self.model };
            self.user.request(domain, self.request_s);
        }
        while self.now < END && !self.is_over() {
            self.now = self.now + STEP;
            self.change_the_scene();
            self.kill_everything();
            self.restart();
            self.finish_sentence();
            self.user_speaks();
            self.client_looks();
            self.finish_decoding();
            self.camera_looks();
            self.pass_all();
        }
    }

    fn is_over(&self) -> bool {
        if let Some(client) = &self.client {
            return client.is_done();
        }
        let Some(arm) = &self.arm else { return self.picked.is_some() };
        let up = self.speech.is_up() && self.policy.is_up() && arm.is_up();
        up && self.view.last.is_some() && self.view.interaction == 0
    }

    fn log(&mut self, what: impl std::fmt::Display) {
        self.story.push(format!("{:9.3} s  {what}", user::seconds(self.now)));
    }

    fn scene(&self) -> &Scene {
        &self.settings.scene
    }

    fn pass_all(&mut self) {
        self.forge();
        let now = self.now;
        let inbox = std::mem::take(&mut self.inboxes.speech);
        let outputs = self.speech.wake(inbox, now, &mut self.faults);
        self.note_death(0, self.speech.is_up(), "speech");
        self.route_speech(outputs);
        let inbox = std::mem::take(&mut self.inboxes.grounding);
        let outputs = self.grounding.wake(inbox, now, &mut self.faults);
        self.note_death(1, self.grounding.is_up(), "grounding");
        self.route_grounding(outputs);
        let inbox = std::mem::take(&mut self.inboxes.policy);
        let outputs = self.policy.wake(inbox, now, &mut self.faults);
        self.note_death(2, self.policy.is_up(), "policy");
        self.route_policy(outputs);
        let inbox = std::mem::take(&mut self.inboxes.arm);
        let Some(arm) = &mut self.arm else { return };
        let orders = self.stop.order().into_iter();
        let orders = orders.flat_map(|order| repeat_n(order, self.faults.copies(self.now)));
        let inbox = inbox.into_iter().chain(orders).collect();
        let outputs = arm.wake(inbox, now, &mut self.faults);
        let is_up = arm.is_up();
        self.note_death(3, is_up, "arm");
        self.route_arm(outputs);
    }

    fn camera_looks(&mut self) {
        let Some(table) = &mut self.table else { return };
        for sighting in table.look(self.now) {
            let copies = self.faults.copies(self.now);
            let message = policy::In::Sighting(Box::new(sighting));
            self.inboxes.policy.extend(repeat_n(message, copies));
        }
    }

    fn client_looks(&mut self) {
        let now = self.now;
        let Some(client) = &mut self.client else { return };
        if self.faults.client_dies(now) {
            client.kill(now + self.faults.client_downtime());
            return self.log("the client dies");
        }
        let (sent, story) = client.look(&self.settings.scene, now);
        story.into_iter().for_each(|line| self.log(line));
        for injection in sent {
            let copies = self.faults.copies(now);
            let message = speech::In::Injection(injection);
            self.inboxes.speech.extend(repeat_n(message, copies));
        }
    }
}
