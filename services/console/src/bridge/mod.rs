//! The main loop's work: what arrives on the topics is folded into the picture, what viewers ask for
//! is carried out, and what has changed is pinned on the board.

mod correcting;
mod kept;
mod motion;
mod ports;
mod saying;
pub(crate) mod supervisor;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use config::Settings;
use messages::{Injection, JointStates, MotionCommand, topics};
use serde_json::Value as Json;
use service::bus::{EncodedWriter, Writer};
use service::client::Client;
use service::clock;
use service::exit::Failure;
use service::group::GroupPaths;
use service::worker_channel::DeviceReceiver;
use service::{Span, Time};

use crate::hub::command::{Command, Motion, Verb, Words};
use crate::hub::{Hub, ViewerId};
use crate::picture::{self, Now, Picture, Transcript};
use crate::server::App;
use crate::server::routes::sound_file;
use crate::study::Study;
use crate::voice::Voice;
use kept::Kept;
use motion::Motions;
use ports::{Ports, all, quiet};
use saying::Saying;

/// Commands of viewers that are taken in one pass; the rest waits for the next.
const COMMANDS_MAX: usize = 128;
/// How often joints are sent while they move, and while they rest.
const JOINTS_EVERY: (Span, Span) = (Span::from_ms(33), Span::from_ms(500));
/// A smaller change of every joint is none, radians or percent.
const STILL: f64 = 1e-4;

/// Everything that the main loop owns.
#[derive(Debug)]
pub struct Bridge {
    app: Arc<App>,
    paths: GroupPaths,
    client: Client,
    ports: Ports,
    injections: EncodedWriter<Injection>,
    motion: Writer<MotionCommand>,
    picture: Picture,
    voice: Voice,
    study: Study,
    saying: Saying,
    motions: Motions,
    kept: Kept,
    voice_dir: Option<PathBuf>,
    /// The joints that were sent last, and when.
    joints: Option<(JointStates, Time)>,
    newest_joints: Option<JointStates>,
}

/// The ends of the ways to the main loop.
#[derive(Debug)]
pub struct Inbox {
    /// What viewers ask for.
    pub commands: DeviceReceiver<Command>,
    /// Orders to the motion stop.
    pub motions: DeviceReceiver<Motion>,
}

impl Bridge {
    /// Opens the topics.
    ///
    /// # Errors
    /// A topic of another schema, or no shared memory.
    pub fn open(
        app: Arc<App>,
        client: Client,
        paths: &GroupPaths,
        settings: &Settings,
        study: Study,
    ) -> Result<Self, Failure> {
        let bus = client.bus();
        let kept = Kept::in_folder(&paths.run());
        let transcript = Transcript::after(kept.read(), now().unix_ms);
        Ok(Self {
            ports: Ports::open(bus)?,
            injections: bus.encoded_writer(&topics::INJECTION)?,
            motion: bus.writer(&topics::MOTION)?,
            picture: Picture::new(settings.scene.clone(), transcript),
            voice: Voice::default(),
            study,
            saying: Saying::default(),
            motions: Motions::default(),
            kept,
            voice_dir: app.voice_dir.clone(),
            paths: paths.clone(),
            app,
            client,
            joints: None,
            newest_joints: None,
        })
    }

    /// One pass: stops first, then what has arrived, then what viewers ask for, then what is new.
    pub fn pass(&mut self, inbox: &Inbox) {
        self.orders(inbox);
        let now = now();
        self.take_in(now);
        self.orders(inbox);
        self.carry_out(inbox, now);
        self.go_on(now);
        self.show(now);
    }

    /// Whether something waits for an answer, so that the next look should come soon.
    pub fn is_busy(&self) -> bool {
        !self.saying.is_empty() || self.motions.is_waiting()
    }

    fn hub(&self) -> &Hub {
        &self.app.hub
    }

    fn orders(&mut self, inbox: &Inbox) {
        inbox.motions.clear();
        while let Some(motion) = inbox.motions.take() {
            tracing::info!(viewer = %motion.viewer, stop = motion.stop, "motion stop");
            self.motions.order(motion, &self.motion, &self.app.hub, clock::now());
        }
    }

    /// Causes before effects, as far as one look can tell: utterances, what was understood, what was
    /// decided, what is said. What is pending comes before the view, which is the newer of the two.
    fn take_in(&mut self, now: Now) {
        for receipt in all(&self.ports.receipts) {
            self.saying.answered(&receipt, &self.app.hub);
            self.picture.see_receipt(&receipt, now);
        }
        for observation in all(&self.ports.observations) {
            self.picture.see_observation(&observation);
        }
        for act in all(&self.ports.acts) {
            self.picture.see_act(&act);
        }
        if let Some(activity) = quiet(self.ports.activity.latest()) {
            self.picture.see_activity(activity);
        }
        if let Some(presented) = quiet(self.ports.presented.latest()) {
            let line = format!("line-{}-{}.wav", presented.prompt, presented.presentation);
            let sound = self.voice_dir.as_deref().and_then(|folder| sound_file(folder, &line));
            let has_sound = sound.is_some_and(|file| file.is_file());
            self.picture.see_presented(presented, has_sound, now);
        }
        if let Some(hearing) = quiet(self.ports.hearing.latest()) {
            self.picture.see_hearing(hearing);
        }
        for (status, sent) in self.ports.stamped_statuses() {
            self.motions.confirm(&status, sent, &self.app.hub);
            self.picture.see_arm(status, now);
        }
        if let Some(world) = quiet(self.ports.worlds.latest()) {
            self.picture.see_world(world);
        }
        if let Some(trajectory) = quiet(self.ports.trajectories.latest()) {
            self.picture.see_trajectory(trajectory);
        }
        if let Some(view) = quiet(self.ports.views.latest()) {
            self.picture.see_view(view, now);
            self.follow_scene();
        }
        if let Some(joints) = quiet(self.ports.joints.latest()) {
            self.newest_joints = Some(joints);
        }
        for partial in all(&self.ports.partials) {
            let number = self.voice.stream_of(partial.request()).map(|(_, number)| number);
            let (stream, frame) = picture::partial(&partial, number);
            self.hub().board.partial(&stream, frame);
        }
    }

    /// A scene that was changed under way: the snapshot is of the new one before the policy is.
    fn follow_scene(&mut self) {
        if self.picture.is_of_another_scene()
            && let Ok(settings) = Settings::load_snapshot(&self.paths.run())
        {
            self.picture.set_scene(settings.scene);
        }
    }

    fn carry_out(&mut self, inbox: &Inbox, now: Now) {
        inbox.commands.clear();
        for _ in 0..COMMANDS_MAX {
            let Some(command) = inbox.commands.take() else { return };
            match command {
                Command::Do(viewer, id, verb) => self.carry_out_verb(viewer, id, verb, now),
                Command::Sound(viewer, frame) => {
                    if let Err(why) = self.voice.frame(&self.client, viewer, frame) {
                        let told = serde_json::json!({ "t": "error", "error": why });
                        self.hub().send(viewer, told.to_string());
                    }
                }
                Command::Left(viewer) => self.voice.left(viewer),
                Command::Group(Ok(group)) => self.picture.see_group(*group, now),
                Command::Group(Err(why)) => tracing::debug!(why, "the supervisor says nothing"),
            }
        }
    }

    fn carry_out_verb(&mut self, viewer: ViewerId, id: u64, verb: Verb, now: Now) {
        let refused = match verb {
            Verb::Study(verb, arguments) => {
                let outcome = self.study.verb(viewer, &verb, &arguments, &self.picture, now);
                return self.hub().answer(viewer, id, outcome);
            }
            verb => self.say(Some((viewer, id)), verb, now),
        };
        if let Err(why) = refused {
            self.hub().answer(viewer, id, Err(why));
        }
    }

    /// Says something to the robot, for a viewer or for the study.
    fn say(&mut self, viewer: Option<(ViewerId, u64)>, verb: Verb, now: Now) -> Result<(), String> {
        let words = match verb {
            Verb::Say(words) => words,
            Verb::NotThat | Verb::StartOver => {
                let (view, arm) = (self.picture.view(), self.picture.arm());
                match verb {
                    Verb::NotThat => typed(&correcting::not_that(self.picture.scene(), view, arm)?),
                    _ => typed(correcting::start_over(view)?),
                }
            }
            Verb::Study(..) => return Err("a study does not ask itself".to_owned()),
        };
        self.saying.add(viewer, words, now.at)
    }

    fn go_on(&mut self, now: Now) {
        self.saying.pass(&self.injections, &self.app.hub, now.at);
        self.motions.pass(&self.motion, &self.app.hub, now.at);
        for (viewer, frame) in self.voice.pass(&self.client, now.at) {
            self.hub().send(viewer, frame);
        }
        for event in self.picture.take_events() {
            self.study.event(&event, &self.picture, now);
        }
        for verb in self.study.pass(&self.picture, now) {
            if let Err(why) = self.say(None, verb, now) {
                tracing::warn!(why, "the study could not say something");
            }
        }
    }

    fn show(&mut self, now: Now) {
        let sections = self.picture.sections(now);
        let study = self.study.section(&self.picture, now).map(|study| ("study", study));
        for (name, value) in sections.into_iter().chain(study) {
            self.hub().board.section(name, &Json::to_string(&value));
        }
        for line in self.picture.transcript().take_changed() {
            self.kept.note();
            self.hub().board.line(line.id, &line.to_text());
        }
        self.kept.write(self.picture.transcript().lines(), now.at);
        for stages in self.picture.latency().take_news() {
            self.hub().metrics.latency.observe(stages.total / 1e3);
        }
        self.show_joints(now.at);
    }

    fn show_joints(&mut self, now: Time) {
        let Some(newest) = self.newest_joints else { return };
        let due = self.joints.as_ref().is_none_or(|(last, sent)| {
            let (moving, resting) = JOINTS_EVERY;
            let changed = (newest.position.iter().zip(&last.position))
                .chain(newest.gripper_percent.iter().zip(&last.gripper_percent))
                .any(|(new, old)| (new - old).abs() > STILL);
            let every = if changed { moving } else { resting };
            now >= *sent + every && newest.at_ns != last.at_ns
        });
        if due {
            self.joints = Some((newest, now));
            self.hub().board.joints(picture::joints(&newest));
        }
    }
}

fn typed(text: &str) -> Words {
    let alternatives = Vec::new();
    Words { text: text.to_owned(), alternatives, spoken: false, began: None, ended: None }
}

/// Both clocks.
pub(crate) fn now() -> Now {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Now { at: clock::now(), unix_ms: unix.as_millis() as u64 }
}
