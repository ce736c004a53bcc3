//! The node as a service of the group: one loop, in which nothing waits.

use crate::dds::Dds;
use crate::detectors::Detectors;
use crate::diagnostics::Counters;
use crate::joints::JointNames;
use crate::process::{ThreadWatch, limit_memory};
use crate::settings::{NAME, Ros2};
use crate::types::{Text, Triggered};
use crate::{hear, orders};
use config::Settings;
use messages::{Injection, JointStates, Service, Sighting, WorldView, topics};
use motion::MotionCall;
use scene::Scene;
use service::bus::{EncodedReader, EncodedWriter, Reader, WakeListener};
use service::client::Client;
use service::control::Watched;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use service::stop_socket::StopClient;
use service::view::{Latest, LatestTopics, Lines};
use service::worker_channel::{self, DeviceReceiver};
use service::{Span, Time, clock, service_loop};
use std::ops::ControlFlow;
use std::process::ExitCode;
use words::Speaking;

mod health;
mod motion;
mod publishing;
mod sightings;
mod words;

/// Longest sleep; joint states wake the node, it polls the other topics.
const LOOK_EVERY: Span = Span::from_ms(20);

/// Runs the service until it is shut down.
pub fn run() -> ExitCode {
    let about = "presents the group as a ROS 2 node (docs/ros2.md)";
    service_loop::program(NAME, about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    limit_memory()?;
    // A signal would end the threads of the DDS implementation: the kernel gives those that are handled, which
    // end the process anyway, to the main thread.
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let mut node = Node::open(&environment, &settings)?;
    drive(lifecycle, &mut node)
}

/// The group's topics.
struct Group {
    latest: LatestTopics,
    joints: Reader<JointStates>,
    worlds: EncodedReader<WorldView>,
    injections: EncodedWriter<Injection>,
    sightings: EncodedWriter<Sighting>,
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
    statuses: DeviceReceiver<Watched>,
    status: Watched,
    scene: Scene,
    names: JointNames,
    detectors: Detectors,
    latest: Latest,
    lines: Lines,
    world: Option<WorldView>,
    counters: Counters,
    /// Refused utterances that a warning has reported.
    reported: u64,
    began: Time,
    threads: ThreadWatch,
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
        let own: Ros2 = settings.part()?;
        let failed = |what: &'static str| {
            move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
        };
        let client = Client::of_service(environment, NAME)?;
        let bus = client.bus();
        let wake_listener = bus.wake_listener(Service::Other(NAME))?;
        let (latest, scene) = LatestTopics::open(bus, settings)?;
        let group = Group {
            latest,
            joints: bus.reader(&topics::JOINTS)?,
            worlds: bus.encoded_reader(&topics::WORLD)?,
            injections: bus.encoded_writer(&topics::INJECTION)?,
            sightings: bus.encoded_writer(&topics::SIGHTING)?,
            client,
        };
        let files = settings.robot_files();
        let robot = robot_model::Robot::read(&files.urdf, files.srdf.as_ref());
        let robot = robot.map_err(|found| Failure::new(Exit::Config, found.to_string()))?;
        let dds = Dds::open(&own).map_err(|e| Failure::new(Exit::NotReached, e))?;
        let mut counters = Counters::default();
        dds.robot_description
            .publish(Text { data: files.urdf.text.clone() }, &mut counters.dropped);
        let (sender, statuses) = worker_channel::channel().map_err(failed("inbox"))?;
        health::watch(paths, sender).map_err(failed("supervisor's thread"))?;
        let Ros2 { domain_id, namespace, node, network, .. } = &own;
        tracing::info!(domain_id, namespace, node, ?network, "joined the DDS domain");
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
            detectors: Detectors::new(&own.objects, settings),
            latest: Latest::default(),
            lines: Lines::new(began),
            world: None,
            counters,
            reported: 0,
            began,
            threads: ThreadWatch::begin(began),
            shown: Time(0),
            state: String::new(),
            objects: None,
            has_more: false,
            is_ending: false,
        })
    }
}

impl Cycle for Node {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        let longest = if self.has_more { Span::from_ms(0) } else { LOOK_EVERY };
        let sources =
            [Some(self.dds.arrivals.fd()), Some(self.stop_client.fd()), Some(self.statuses.fd())];
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
        self.on_detections();
        let now = clock::now();
        self.diagnose();
        self.show(now);
        self.threads.count(now)?;
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
