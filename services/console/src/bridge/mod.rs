//! The main loop's work: folds messages into the view model, carries out the commands of viewers,
//! and puts changes on the board.

mod corrections;
mod line_store;
mod motion;
mod submissions;
pub(crate) mod supervisor;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use config::Settings;
use group_metrics::Tally;
use messages::{
    Injection, InteractionId, JointStates, Observation, Outcome, Partial, RobotAct, Service,
    SoundFile, TrajectoryView, WorldView, topics,
};
use page_part::{Now, Part};
use service::bus::{Bus, BusError, EncodedReader, EncodedWriter, Reader};
use service::client::Client;
use service::clock;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::view::{LatestTopics, drain, quiet};
use service::worker_channel::DeviceReceiver;
use service::{Span, Time};

use crate::hub::command::{Command, Motion, Verb, typed};
use crate::hub::outbound::{Answer, Interim, Joints, PageMessage};
use crate::hub::{Hub, ViewerId};
use crate::live::feed::Feed;
use crate::server::App;
use crate::view_model::{Transcript, ViewModel};
use crate::voice::Voice;
use line_store::LineStore;
use motion::Motions;
use submissions::Submissions;

/// Most commands of one pass; the rest waits for the next.
const COMMANDS_MAX: usize = 128;
/// Intervals between joint states, moving and at rest.
const JOINTS_EVERY: (Span, Span) = (Span::from_ms(33), Span::from_ms(500));
/// Joints that change by less are at rest, radians or percent.
const STILL: f64 = 1e-4;

const NO_STUDY: &str = "no study is running; help: set study.enabled, and reload the group";

#[derive(Debug)]
pub struct Bridge {
    app: Arc<App>,
    paths: GroupPaths,
    client: Client,
    topics: Topics,
    injections: EncodedWriter<Injection>,
    model: ViewModel,
    voice: Voice,
    study: Option<Box<dyn Part>>,
    /// The interface for programs.
    pub http: http_api::Feed,
    feed: Feed,
    tally: Tally,
    submissions: Submissions,
    motions: Motions,
    lines: LineStore,
    /// The interaction that ended last, with its outcome: the history has those up to it.
    ended: Option<(InteractionId, Outcome)>,
    voice_dir: Option<PathBuf>,
    /// The joints that were sent last, and when.
    joints: Option<(JointStates, Time)>,
    newest_joints: Option<JointStates>,
}

/// The receiving ends of the channels to the main loop.
#[derive(Debug)]
pub struct Inbox {
    pub commands: DeviceReceiver<Command>,
    pub motions: DeviceReceiver<Motion>,
}

/// Topics that pages show.
#[derive(Debug)]
struct Topics {
    latest: LatestTopics,
    acts: Reader<RobotAct>,
    partials: Reader<Partial>,
    observations: Reader<Observation>,
    worlds: EncodedReader<WorldView>,
    trajectories: EncodedReader<TrajectoryView>,
    joints: Reader<JointStates>,
}

impl Topics {
    fn open(bus: &Bus, latest: LatestTopics) -> Result<Self, BusError> {
        Ok(Self {
            latest,
            acts: bus.reader(&topics::ACT)?,
            partials: bus.reader(&topics::PARTIAL)?,
            observations: bus.reader(&topics::OBSERVATION)?,
            worlds: bus.encoded_reader(&topics::WORLD)?,
            trajectories: bus.encoded_reader(&topics::TRAJECTORY)?,
            joints: bus.reader(&topics::JOINTS)?,
        })
    }
}

impl Bridge {
    pub fn open(
        app: Arc<App>,
        client: Client,
        paths: &GroupPaths,
        settings: &Settings,
        (study, http): (Option<Box<dyn Part>>, http_api::Feed),
    ) -> Result<Self, Failure> {
        let bus = client.bus();
        let failed =
            |error| Failure::new(Exit::NotReached, format!("the motion stop's socket: {error}"));
        let (latest, scene) = LatestTopics::open(bus, settings)?;
        let lines = LineStore::in_folder(&paths.run(), "console.lines");
        let transcript = Transcript::after(lines.read(), now().unix_ms);
        Ok(Self {
            topics: Topics::open(bus, latest)?,
            injections: bus.encoded_writer(&topics::INJECTION)?,
            model: ViewModel::new(scene, transcript),
            voice: Voice::default(),
            study,
            http,
            feed: Feed::new(settings, paths.log()),
            tally: Tally::new(clock::now()),
            submissions: Submissions::default(),
            motions: Motions::open(paths).map_err(failed)?,
            lines,
            ended: None,
            voice_dir: app.voice_dir.clone(),
            paths: paths.clone(),
            app,
            client,
            joints: None,
            newest_joints: None,
        })
    }

    /// Runs one pass: orders to the motion stop, messages, commands, sections.
    pub fn pass(&mut self, inbox: &Inbox) {
        self.orders(inbox);
        let now = now();
        self.take_in(now);
        self.orders(inbox);
        self.carry_out(inbox, now);
        self.advance(now);
        self.show(now);
        let App { live, hub, .. } = &*self.app;
        self.feed.pass(self.client.bus(), live, &hub.metrics, now.at);
    }

    /// Returns whether something waits for an answer, so that the next pass should come soon.
    pub fn is_busy(&self) -> bool {
        !self.submissions.is_empty() || self.motions.is_waiting() || self.http.is_busy()
    }

    fn hub(&self) -> &Hub {
        &self.app.hub
    }

    fn orders(&mut self, inbox: &Inbox) {
        inbox.motions.clear();
        while let Some(motion) = inbox.motions.take() {
            tracing::info!(viewer = %motion.viewer, stop = motion.stop, "motion stop");
            self.motions.order(motion, &self.app.hub, clock::now());
        }
    }

    /// Processes new messages, causes before effects as far as one pass can order them.
    fn take_in(&mut self, now: Now) {
        let Self { topics, model, tally, .. } = self;
        let app = Arc::clone(&self.app);
        let metrics = &app.hub.metrics.dialogue;
        let (observations, acts) = (drain(&topics.observations), drain(&topics.acts));
        let mut arrived = topics.latest.take();
        if let Some(scene) = arrived.scene.take() {
            model.set_scene(scene);
        }
        for receipt in &arrived.receipts {
            // Parts that an accepted utterance still needs.
            let later = [Service::Grounding, Service::Policy, Service::Arm];
            self.submissions.on_receipt(receipt, || model.unavailable(&later), &self.app.hub);
            model.on_receipt(receipt, now);
            tally.on_receipt(receipt, metrics);
            self.http.on_receipt(receipt);
        }
        let table = topics.latest.table();
        for observation in &observations {
            match table {
                Some(table) => model.on_observation(&table.observation(observation)),
                None => model.on_observation(observation),
            }
        }
        acts.iter().for_each(|act| {
            model.on_act(act);
            self.http.on_act(act);
        });
        arrived.activity.into_iter().for_each(|activity| model.on_activity(activity));
        if let Some(presented) = arrived.presented {
            let file = SoundFile::of(&presented).to_string();
            let has_sound = self.voice_dir.as_ref().is_some_and(|dir| dir.join(file).is_file());
            model.on_presented(presented, has_sound, now);
        }
        if let Some(hearing) = arrived.hearing {
            tally.on_hearing(&hearing, metrics);
            model.on_hearing(hearing);
        }
        for (status, _) in arrived.statuses {
            tally.on_arm(&status, metrics);
            model.on_arm(status, now);
        }
        let world = quiet(topics.worlds.latest());
        let world = world.map(|world| table.map_or(world.clone(), |table| table.world(&world)));
        world.into_iter().for_each(|world| model.on_world(world));
        let trajectory = quiet(topics.trajectories.latest());
        trajectory.into_iter().for_each(|trajectory| model.on_trajectory(trajectory));
        self.newest_joints = quiet(topics.joints.latest()).or(self.newest_joints);
        for partial in drain(&topics.partials) {
            let number = self.voice.stream_of(partial.request()).map(|(_, number)| number);
            let key: String = partial.stream.iter().map(|byte| format!("{byte:02x}")).collect();
            let message = PageMessage::Partial(Interim::new(&partial, number));
            self.app.hub.board.partial(&key, message.to_text());
        }
        if let Some(view) = arrived.view {
            tally.on_view(&view, metrics);
            model.on_view(view, now);
            self.follow_scene();
        }
    }

    /// Follows a reload: the snapshot has the new scene before the policy has.
    fn follow_scene(&mut self) {
        if self.model.is_of_another_scene()
            && let Ok(settings) = Settings::load_snapshot(&self.paths.run())
        {
            self.model.set_scene(self.topics.latest.set_scene(settings.scene));
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
                        self.hub().error(viewer, &why);
                    }
                }
                Command::Left(viewer) => self.voice.left(viewer),
                Command::Group(Ok(group)) => {
                    self.hub().metrics.set_group(Some(&group));
                    self.model.on_group(*group, now);
                }
                Command::Group(Err(why)) => {
                    self.hub().metrics.set_group(None);
                    tracing::debug!(why, "no status from the supervisor");
                }
            }
        }
    }

    fn carry_out_verb(&mut self, viewer: ViewerId, id: u64, verb: Verb, now: Now) {
        let (scene, latest) = (self.model.scene(), self.model.latest());
        let words = match verb {
            Verb::Say(words) => Ok(words),
            Verb::NotThat => corrections::not_that(scene, latest).map(|words| typed(&words)),
            Verb::StartOver => corrections::start_over(latest).map(typed),
            Verb::Study(verb, arguments) => {
                let outcome = match &mut self.study {
                    Some(study) => study
                        .command(&verb, &arguments, &self.model.robot(now))
                        .map(|answer| Some(Answer::Part(answer))),
                    None => Err(NO_STUDY.to_owned()),
                };
                return self.hub().answer(viewer, id, outcome);
            }
        };
        let words = words.and_then(|words| match self.model.unavailable(&[Service::Speech]) {
            Some(why) => Err(why),
            None => Ok(words),
        });
        let accepted = self.model.accepted();
        let submitted = words
            .and_then(|words| self.submissions.add(Some((viewer, id)), words, accepted, now.at));
        if let Err(why) = submitted {
            self.hub().answer(viewer, id, Err(why));
        }
    }

    fn advance(&mut self, now: Now) {
        self.model.tick(now);
        self.submissions.pass(&self.injections, &self.app.hub, now.at);
        let unavailable = || self.model.unavailable(&[Service::Speech]);
        self.http.pass(&self.injections, self.model.accepted(), unavailable, now.at);
        self.motions.pass(self.model.group(), &self.app.hub, now.at);
        self.voice.pass(&self.app.hub, now.at);
        let events = self.model.take_events();
        let Some(study) = &mut self.study else { return };
        let robot = self.model.robot(now);
        events.iter().for_each(|event| study.on_event(event, &robot));
        if let Some(words) = study.pass(&robot)
            && let Err(why) =
                self.submissions.add(None, typed(&words), self.model.accepted(), now.at)
        {
            tracing::warn!(why, "the study's words are not submitted");
        }
    }

    fn show(&mut self, now: Now) {
        let sections = self.model.sections(now);
        let (scene, latest, group) = (self.model.scene(), self.model.latest(), self.model.group());
        self.http.publish(&http_api::Robot { scene, latest, group }, !sections.is_empty());
        let study = self.study.as_ref().and_then(|study| study.section(&self.model.robot(now)));
        let study = study.map(|study| ("study", study));
        for (name, text) in sections.into_iter().chain(study) {
            self.hub().board.section(name, &text);
        }
        let motion = self.motions.section(self.model.group());
        // Every section can be written.
        let motion = serde_json::to_string(&motion).unwrap_or_default();
        self.hub().board.section("motion", &motion);
        for line in self.model.transcript().take_changed() {
            self.lines.mark_changed();
            self.hub().board.line(line.id, &line.to_text());
        }
        self.lines.write(self.model.transcript().lines(), now.at);
        let last = self.model.latest().view.as_ref().and_then(|view| view.last.as_ref());
        let ended = last.map(|last| (last.interaction, last.outcome));
        if ended != self.ended {
            self.ended = ended;
            self.app.history.on_end();
        }
        for [.., total_ms] in self.model.latency().take_news() {
            self.hub().metrics.latency.observe(total_ms / 1e3);
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
            let message = PageMessage::Joints(Joints::new(&newest));
            self.hub().board.joints(message.to_text());
        }
    }
}

pub(crate) fn now() -> Now {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Now { at: clock::now(), unix_ms: unix.as_millis() as u64 }
}
