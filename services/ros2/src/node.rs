//! The node as a service of the group: one loop, in which nothing waits.

use crate::dds::{Call, Dds};
use crate::diagnostics::{Counters, statuses};
use crate::joints::JointNames;
use crate::types::{DiagnosticArray, Header, Text, Time as RosTime, Triggered};
use crate::{hear, objects, orders, threads};
use config::Settings;
use messages::{Injection, JointStates, MotionOrder, PromptId, Service, WorldView, topics};
use scene::Scene;
use service::bus::{EncodedReader, EncodedWriter, Reader, WakeListener};
use service::client::{Client, random_key};
use service::control::{Reply, Request, call};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use service::status::GroupStatus;
use service::stop_socket::StopClient;
use service::view::{
    ArmView, DialogueView, HearingView, Latest, LatestTopics, Lines, Speaker, View,
};
use service::view::{drain, quiet};
use service::worker_channel::{self, DeviceReceiver, DeviceSender};
use service::{Span, Time, clock, service_loop};
use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Longest sleep; joint states wake the node, it polls the other topics.
const LOOK_EVERY: Span = Span::from_ms(20);
/// Shortest interval between two publications of the objects or of the state.
const SHOW_EVERY: Span = Span::from_ms(100);
/// Interval at which the threads of the DDS implementation are counted.
const COUNT_EVERY: Span = Span::from_ms(250);
/// Interval of the diagnostics.
const DIAGNOSE_EVERY: Span = Span::from_ms(1_000);
/// Timeout of the supervisor's answer.
const SUPERVISOR_PATIENCE: Duration = Duration::from_secs(2);
/// Words that withdraw a request.
const NEVER_MIND: &str = "never mind";

/// Status of the group, or why there is none.
type Status = Result<Box<GroupStatus>, String>;

/// Runs the service until it is shut down.
pub fn run() -> ExitCode {
    let about = "presents the group as a ROS 2 node (docs/ros2.md)";
    service_loop::program(Service::Ros2.name(), about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    // A signal would end the threads of the DDS implementation: the kernel gives those that are handled, which
    // end the process anyway, to the main thread.
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let mut node = Node::open(&environment, &settings)?;
    drive(lifecycle, &mut node)
}

/// Who waits for the answer to an utterance.
#[derive(Debug)]
enum Speaking {
    /// No call: the words came by topic.
    Topic,
    /// A call of `cancel`.
    Cancel(Call),
}

/// A call of `stop` or `resume`.
type MotionCall = (MotionOrder, Call);

/// The group's topics.
struct Group {
    latest: LatestTopics,
    joints: Reader<JointStates>,
    worlds: EncodedReader<WorldView>,
    injections: EncodedWriter<Injection>,
    client: Client,
}

struct Node {
    dds: Dds,
    group: Group,
    wake_listener: WakeListener,
    paths: GroupPaths,
    stop_client: StopClient,
    orders: orders::Orders<MotionCall>,
    waiting: hear::Waiting<Speaking>,
    statuses: DeviceReceiver<Status>,
    status: Status,
    scene: Scene,
    names: JointNames,
    latest: Latest,
    lines: Lines,
    world: Option<WorldView>,
    counters: Counters,
    /// Refused utterances that a warning has reported.
    reported: u64,
    began: Time,
    threads: usize,
    counted: Time,
    shown: Time,
    state: String,
    objects: Option<(WorldView, Vec<f64>)>,
    /// A source had more than one pass takes.
    has_more: bool,
    is_ending: bool,
}

impl Node {
    fn open(environment: &Environment, settings: &Settings) -> Result<Self, Failure> {
        let paths = &environment.paths;
        let failed = |what: &'static str| {
            move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
        };
        let client = Client::of_service(environment, Service::Ros2.name())?;
        let bus = client.bus();
        let wake_listener = bus.wake_listener(Service::Ros2)?;
        let mut latest = LatestTopics::open(bus)?;
        if settings.group.perception.enabled {
            latest = latest.with_table(bus, &settings.scene)?;
        }
        let scene = latest.set_scene(settings.scene.clone());
        let group = Group {
            latest,
            joints: bus.reader(&topics::JOINTS)?,
            worlds: bus.encoded_reader(&topics::WORLD)?,
            injections: bus.encoded_writer(&topics::INJECTION)?,
            client,
        };
        let files = settings.robot_files();
        let robot = robot_model::Robot::read(&files.urdf, files.srdf.as_ref());
        let robot = robot.map_err(|found| Failure::new(Exit::Config, found.to_string()))?;
        let dds = Dds::open(&settings.ros2).map_err(|e| Failure::new(Exit::NotReached, e))?;
        let mut counters = Counters::default();
        dds.robot_description
            .publish(Text { data: files.urdf.text.clone() }, &mut counters.dropped);
        let (sender, statuses) = worker_channel::channel().map_err(failed("inbox"))?;
        watch_supervisor(paths, sender).map_err(failed("supervisor's thread"))?;
        let threads = threads::running();
        let config::Ros2 { domain_id, namespace, node, network, .. } = &settings.ros2;
        tracing::info!(domain_id, namespace, node, ?network, threads, "joined the DDS domain");
        let began = clock::now();
        Ok(Self {
            dds,
            group,
            wake_listener,
            paths: paths.clone(),
            stop_client: StopClient::open(paths).map_err(failed("motion stop's socket"))?,
            orders: orders::Orders::default(),
            waiting: hear::Waiting::default(),
            statuses,
            status: Err("no status yet".to_owned()),
            scene,
            names: JointNames::new(&robot),
            latest: Latest::default(),
            lines: Lines::new(began),
            world: None,
            counters,
            reported: 0,
            began,
            threads,
            counted: began,
            shown: Time(0),
            state: String::new(),
            objects: None,
            has_more: false,
            is_ending: false,
        })
    }

    /// Takes orders to the motion stop and gives them to the arm.
    fn on_orders(&mut self) {
        let Self { dds, counters, orders, .. } = self;
        dds.clear();
        let mut is_stopped = false;
        // A flood of stops is one stop.
        let more = dds.stop_topic.drain(&mut counters.unreadable, |_, _| is_stopped = true);
        self.has_more = more;
        let stops = dds.stop.calls(&mut counters.unreadable);
        let resumes = dds.resume.calls(&mut counters.unreadable);
        let calls =
            |order, calls: Vec<Call>| calls.into_iter().map(move |call| (order, Some(call)));
        // Of a stop and a release at once, the stop counts.
        let all = calls(MotionOrder::Resume, resumes).chain(calls(MotionOrder::Stop, stops));
        let mut overruled = Vec::new();
        for (order, call) in all.chain(is_stopped.then_some((MotionOrder::Stop, None))) {
            tracing::info!(?order, "motion stop");
            overruled.extend(orders.give(order, call.map(|call| (order, call)), clock::now()));
        }
        self.respond(overruled, &failure("overruled by another order"));
        self.advance_orders();
    }

    fn advance_orders(&mut self) {
        let now = clock::now();
        if let Some((order, given)) = self.orders.due(now) {
            let sent = self.stop_client.send(order, given);
            self.orders.on_sent(&sent);
        }
        while let Some(state) = self.stop_client.take() {
            self.orders.on_answer(state, clock::now());
        }
        let Some((callers, result)) = self.orders.result(clock::now()) else { return };
        let success = |message: &str| Triggered { success: true, message: message.to_owned() };
        let response = match result {
            Ok(state) if state.stopped && state.at_rest => success("stopped, at rest"),
            Ok(state) if state.stopped => success("stopped"),
            Ok(_) => success("released"),
            Err(why) => {
                tracing::error!(why, "motion order not confirmed");
                failure(&why)
            }
        };
        self.respond(callers, &response);
    }

    fn respond(&mut self, callers: Vec<MotionCall>, response: &Triggered) {
        for (order, call) in callers {
            let server = match order {
                MotionOrder::Stop => &self.dds.stop,
                MotionOrder::Resume => &self.dds.resume,
            };
            server.respond(call, response.clone(), &mut self.counters.dropped);
        }
    }

    /// Takes words, and calls of `cancel`.
    fn on_words(&mut self) {
        let now = clock::now();
        let seen = PromptId(self.latest.presented.prompt);
        let Self { dds, counters, waiting, .. } = self;
        let (mut unreadable, mut refused) = (0, 0);
        let more = dds.hear.drain(&mut unreadable, |Text { data }, info| {
            let key = hear::key(info.publisher_gid().as_bytes(), info.sequence_number(), &data);
            if let Err((_, why)) = waiting.add(Speaking::Topic, (key, &data), seen, now) {
                refused += 1;
                tracing::debug!(why, "an utterance is refused");
            }
        });
        counters.unreadable += unreadable;
        counters.refused += refused;
        self.has_more |= more;
        let is_open = self.latest.view.as_ref().is_some_and(|view| view.interaction != 0);
        for call in dds.cancel.calls(&mut counters.unreadable) {
            let words = (random_key(), NEVER_MIND);
            let refused = match is_open {
                true => {
                    waiting.add(Speaking::Cancel(call), words, seen, now).err().map(|(_, why)| why)
                }
                false => Some("no request is open"),
            };
            if let Some(why) = refused {
                dds.cancel.respond(call, failure(why), &mut counters.dropped);
            }
        }
    }

    fn advance_words(&mut self) {
        let now = clock::now();
        if let Some(request) = self.waiting.due(now)
            && let Err(error) = self.group.injections.send(request)
        {
            tracing::debug!(%error, "utterance not sent yet");
        }
        while let Some((speaking, answer)) = self.waiting.expired(now) {
            self.on_answer(speaking, answer);
        }
    }

    fn on_answer(&mut self, speaking: Speaking, answer: hear::Answer) {
        match &answer {
            Ok(_) => self.counters.accepted += 1,
            Err(why) => {
                self.counters.refused += 1;
                tracing::warn!(why, "an utterance is not followed");
            }
        }
        let Speaking::Cancel(call) = speaking else { return };
        let response = match answer {
            Ok(number) => {
                let message = format!("\"{NEVER_MIND}\" is accepted as utterance {number}");
                Triggered { success: true, message }
            }
            Err(why) => failure(&why),
        };
        self.dds.cancel.respond(call, response, &mut self.counters.dropped);
    }

    /// Takes in what the group has published, and passes on what is not a state.
    fn take_in(&mut self) {
        let offset = Offset::now();
        for states in drain(&self.group.joints) {
            let state = self.names.convert(&states, offset.ros(Time(states.at_ns)));
            self.dds.joint_states.publish(state, &mut self.counters.dropped);
        }
        let mut arrived = self.group.latest.take();
        for receipt in &arrived.receipts {
            if let Some((speaking, answer)) = self.waiting.on_receipt(receipt) {
                self.on_answer(speaking, answer);
            }
        }
        self.latest.update(&arrived);
        if let Some(scene) = arrived.scene.take() {
            self.scene = scene;
            self.objects = None;
        }
        if arrived.view.as_ref().is_some_and(|view| view.scene_key != self.scene.key())
            && let Ok(settings) = Settings::load_snapshot(&self.paths.run())
        {
            self.scene = self.group.latest.set_scene(settings.scene);
        }
        for (speaker, data) in self.lines.take_in(&self.latest, &arrived.receipts) {
            let outlet = match speaker {
                // One that began before this start was published then.
                Speaker::Robot if Time(self.latest.presented.started_ns) >= self.began => {
                    &self.dds.say
                }
                Speaker::Person => &self.dds.heard,
                Speaker::Robot | Speaker::Unmeant | Speaker::System => continue,
            };
            outlet.publish(Text { data }, &mut self.counters.dropped);
        }
        if let Some(world) = quiet(self.group.worlds.latest()) {
            let located = objects::located(&self.group.latest, &world);
            let frames = objects::frames(&self.scene, &located, offset.ros(Time(world.at_ns)));
            self.dds.tf.publish(frames, &mut self.counters.dropped);
            self.world = Some(world);
        }
    }

    /// Publishes objects and state, where they have changed.
    fn show(&mut self, now: Time) {
        if now < self.shown + SHOW_EVERY {
            return;
        }
        self.shown = now;
        let belief = self.latest.view.as_ref().map_or(&[][..], |view| &view.belief);
        if let Some(world) = &self.world {
            let world = objects::located(&self.group.latest, world);
            let is_shown = self.objects.as_ref().is_some_and(|(before, shown_belief)| {
                before.objects == world.objects && shown_belief == belief
            });
            if !is_shown {
                let markers = objects::markers(&self.scene, &world, belief);
                self.dds.objects.publish(markers, &mut self.counters.dropped);
                self.objects = Some((world, belief.to_vec()));
            }
        }
        let state = self.state_text();
        if state != self.state {
            self.dds.state.publish(Text { data: state.clone() }, &mut self.counters.dropped);
            self.state = state;
        }
    }

    /// The state as `whichone watch --json` prints it.
    fn state_text(&self) -> String {
        let Self { scene, latest, .. } = self;
        let view = View {
            dialogue: latest.view.as_ref().map(|view| DialogueView::new(scene, view)),
            said: self.lines.said(),
            hearing: latest.hearing.as_ref().map(HearingView::new),
            arm: latest.arm.as_ref().map(|arm| ArmView::new(scene, arm)),
            group: self.status.as_ref().ok().map(Box::as_ref),
        };
        // Every view can be written.
        serde_json::to_string(&view).unwrap_or_default()
    }

    /// Takes in the supervisor's status, which comes once a second, and publishes it.
    fn diagnose(&mut self) {
        self.statuses.clear();
        let mut is_new = false;
        while let Some(status) = self.statuses.take() {
            (self.status, is_new) = (status, true);
        }
        if !is_new {
            return;
        }
        if self.counters.refused > self.reported {
            let new = self.counters.refused - self.reported;
            tracing::warn!(new, total = self.counters.refused, "utterances were refused");
            self.reported = self.counters.refused;
        }
        let header = Header { stamp: Offset::now().ros(clock::now()), ..Header::default() };
        let group = self.status.as_ref().map(Box::as_ref).map_err(String::as_str);
        let status = statuses(group, &self.counters);
        self.dds
            .diagnostics
            .publish(DiagnosticArray { header, status }, &mut self.counters.dropped);
    }

    /// Returns an error if a thread of the DDS implementation has ended: only a new process helps.
    fn count_threads(&mut self, now: Time) -> Result<(), Failure> {
        if now < self.counted + COUNT_EVERY {
            return Ok(());
        }
        self.counted = now;
        let running = threads::running();
        self.threads = self.threads.max(running);
        if running == self.threads {
            return Ok(());
        }
        let what = format!(
            "{running} of {} DDS threads run: one has ended, as after a stop of the process or a \
             suspension of the machine; restarting",
            self.threads
        );
        Err(Failure::new(Exit::NotReached, what))
    }
}

impl Cycle for Node {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        let longest = if self.has_more { Span::from_ms(0) } else { LOOK_EVERY };
        let sources = [Some(self.dds.fd()), Some(self.stop_client.fd()), Some(self.statuses.fd())];
        (sources, now + longest)
    }

    fn shut_down(&mut self) {
        self.is_ending = true;
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if self.is_ending {
            return Ok(ControlFlow::Break(()));
        }
        self.on_orders();
        if ready.by_wake
            && let Some(joined) = self.wake_listener.take()
        {
            self.group.client.bus().connect(joined);
        }
        self.take_in();
        self.on_words();
        self.advance_words();
        let now = clock::now();
        self.diagnose();
        self.show(now);
        self.count_threads(now)?;
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(None)
    }
}

/// Response to a call that is not carried out.
fn failure(why: &str) -> Triggered {
    Triggered { success: false, message: why.to_owned() }
}

/// Difference between the system's clock and the monotonic one.
struct Offset {
    monotonic: Time,
    system: Duration,
}

impl Offset {
    fn now() -> Self {
        let system = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self { monotonic: clock::now(), system }
    }

    /// Returns a time of the monotonic clock as ROS has it.
    fn ros(&self, at: Time) -> RosTime {
        let age = Duration::from_nanos(self.monotonic.ns().saturating_sub(at.ns()));
        RosTime::new(self.system.saturating_sub(age))
    }
}

/// Requests the group's status every second, on a thread of its own: answers may take a while.
fn watch_supervisor(paths: &GroupPaths, main_loop: DeviceSender<Status>) -> std::io::Result<()> {
    let socket = paths.control_socket();
    let every = Duration::from_secs_f64(DIAGNOSE_EVERY.s());
    let ask = move || {
        loop {
            let status = match call(&socket, &Request::Status, SUPERVISOR_PATIENCE) {
                Ok(Reply::Status(status)) => Ok(status),
                Ok(other) => Err(format!("{other:?}")),
                Err(error) => Err(error.to_string()),
            };
            // A full inbox gets the next status a second later.
            let _ = main_loop.offer(status);
            std::thread::sleep(every);
        }
    };
    std::thread::Builder::new().name("supervisor".into()).spawn(ask).map(drop)
}
