//! The robot's side: a service that shows its group to mirrors, and takes words and orders.
//!
//! The main loop reads topics, submits words and chooses messages; it never touches the network.
//! Threads of their own send states, joints and answers, and one only orders motion stops.

mod answering;
mod motion;
mod senders;
mod sources;

use std::ops::ControlFlow;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use config::Settings;
use messages::{AudioChunk, Injection, Receipt, Service, SoundFile, topics};
use roster::Presence;
use service::bus::{EncodedWriter, Reader, WakeListener, Writer};
use service::client::{Client, random_number};
use service::control::{Watched, watch_supervisor};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use service::worker_channel::{self, DeviceReceiver};
use service::{Span, Time, clock, service_loop};
use zenoh::query::Query;

use crate::identity::Identity;
use crate::names::{Call, Keys};
use crate::presence::{self, PRESENCE_EVERY};
use crate::say::Asked;
use crate::session::close;
use senders::Senders;
use sources::TopicSources;

/// Longest sleep: while words wait for their receipts, while the robot is watched, and else.
const LOOK_EVERY: [Span; 3] = [Span::from_ms(2), Span::from_ms(15), Span::from_ms(250)];
/// Messages of one pass: a peer that sends without end does not keep the loop.
const INBOUND_MAX: usize = 256;
/// Interval at which the supervisor is asked.
const STATUS_EVERY: Duration = Duration::from_millis(2_000);

/// Runs the service until it is shut down.
pub fn run() -> ExitCode {
    let about = "links the group to operators elsewhere (docs/remote.md)";
    service_loop::program(crate::settings::NAME, about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let mut robot = Robot::open(&environment, settings)?;
    let ended = drive(lifecycle, &mut robot);
    if let Some(senders) = robot.senders.take() {
        close(senders);
    }
    ended
}

/// Events from other threads to the main loop.
enum Inbound {
    /// A connection to the router.
    Connected(Box<Senders>),
    /// A request of a mirror.
    Asked(Call, Query),
    /// Sound of a person.
    Audio(Vec<u8>),
    /// The group's state, or why there is none.
    Status(Watched),
}

struct Robot {
    settings: Settings,
    paths: GroupPaths,
    epoch: u64,
    client: Client,
    wake_listener: WakeListener,
    inbox: DeviceReceiver<Inbound>,
    sources: TopicSources,
    receipts: Reader<Receipt>,
    injections: EncodedWriter<Injection>,
    audio: Writer<AudioChunk>,
    asked: Asked<Query>,
    senders: Option<Senders>,
    presence: Presence,
    presence_sent: Option<Time>,
    /// File of the line whose sound was sent last.
    line_sent: Option<SoundFile>,
    /// The latest line, by its file, as it travels.
    line: Option<(SoundFile, Vec<u8>)>,
    is_ending: Arc<AtomicBool>,
}

impl Robot {
    fn open(environment: &Environment, settings: Settings) -> Result<Self, Failure> {
        let failed = |what: &'static str| {
            move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
        };
        let own: crate::settings::Settings = settings.part()?;
        let folder = own.keys.ok_or_else(|| {
            let what = "link.keys is not set; help: set it to the folder robots/NAME of `whichone link init`";
            Failure::new(Exit::Config, what)
        })?;
        let identity = Identity::load(&folder)?;
        identity.require(true, &folder)?;
        let paths = environment.paths.clone();
        let client = Client::of_service(environment, crate::settings::NAME)?;
        let bus = client.bus();
        let wake_listener = bus.wake_listener(Service::Other(crate::settings::NAME))?;
        let start = random_number();
        let sources = TopicSources::open(bus, &settings, start)?;
        let (sender, inbox) = worker_channel::channel().map_err(failed("inbox"))?;
        let keys = Keys::of(&identity.name);
        let is_ending = Arc::new(AtomicBool::new(false));
        let presence = Presence {
            robot: identity.name.to_string(),
            version: build_info::full_version(),
            scene: settings.scene.name().to_owned(),
            dialogue: "idle".to_owned(),
            arm: "rest".to_owned(),
            ..Presence::default()
        };
        let main_loop = sender.clone();
        // A full inbox gets the next status.
        let take = move |status| drop(main_loop.offer(Inbound::Status(status)));
        let pause = || {
            std::thread::sleep(STATUS_EVERY);
            true
        };
        watch_supervisor(&paths, take, pause).map_err(failed("supervisor's thread"))?;
        let receipts = bus.reader(&topics::RECEIPT)?;
        let injections = bus.encoded_writer(&topics::INJECTION)?;
        let audio = bus.writer(&topics::AUDIO)?;
        let ending = Arc::clone(&is_ending);
        let connecting =
            senders::Connecting { identity, folder, keys, start, paths: paths.clone() };
        let connect = move || connecting.run(&sender, &ending);
        std::thread::Builder::new()
            .name("connect".into())
            .spawn(connect)
            .map_err(failed("connecting thread"))?;
        Ok(Self {
            settings,
            paths,
            epoch: environment.epoch.0,
            client,
            wake_listener,
            inbox,
            sources,
            receipts,
            injections,
            audio,
            asked: Asked::default(),
            senders: None,
            presence,
            presence_sent: None,
            line_sent: None,
            line: None,
            is_ending,
        })
    }

    fn take_in(&mut self) {
        self.inbox.clear();
        for _ in 0..INBOUND_MAX {
            let Some(inbound) = self.inbox.take() else { return };
            match inbound {
                Inbound::Connected(senders) => self.senders = Some(*senders),
                Inbound::Asked(call, query) => self.on_call(call, query),
                Inbound::Audio(bytes) => self.on_audio(&bytes),
                Inbound::Status(status) => self.on_status(status),
            }
        }
    }

    /// Sends changes to watchers.
    fn send(&mut self, now: Time) {
        self.send_line();
        let Some(senders) = &self.senders else { return };
        self.sources.send(senders, now);
        let (view, status) = (self.sources.view(), self.sources.status());
        presence::add(&mut self.presence, view, status, &self.settings.scene);
        let is_due = self.presence_sent.is_none_or(|sent| now >= sent + PRESENCE_EVERY);
        if is_due {
            self.presence_sent = Some(now);
            senders.presence(&self.presence);
        }
    }

    fn on_status(&mut self, status: Watched) {
        match status {
            Ok(status) => {
                self.presence.state = format!("{:?}", status.state).to_lowercase();
                if let Some(senders) = &self.senders {
                    senders.group(&status);
                }
            }
            Err(why) => {
                tracing::debug!(why, "no status from the supervisor");
                self.presence.state.clear();
            }
        }
    }
}

impl Cycle for Robot {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        let is_watched = self.senders.as_ref().is_some_and(Senders::is_watched);
        let [busy, watched, alone] = LOOK_EVERY;
        let longest = match (self.asked.is_waiting(), is_watched) {
            (true, _) => busy,
            (false, true) => watched,
            (false, false) => alone,
        };
        ([Some(self.inbox.fd()), None, None], now + longest)
    }

    fn shut_down(&mut self) {
        self.is_ending.store(true, Ordering::Relaxed);
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if self.is_ending.load(Ordering::Relaxed) {
            return Ok(ControlFlow::Break(()));
        }
        if ready.by_wake
            && let Some(joined) = self.wake_listener.take()
        {
            self.client.bus().connect(joined);
        }
        self.take_in();
        self.submit();
        self.sources.look();
        self.send(clock::now());
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(None)
    }
}
