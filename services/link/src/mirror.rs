//! The operator's side: a remote robot as a group here. `watch`, `status`, `say`, `chat`, `await`
//! and the console find a group's topics, sockets and settings, all of this process.

mod console;
mod control;
mod inlets;
mod local;
mod motion;
mod passing;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use config::Settings;
use roster::Name;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths};
use service::worker_channel::{DeviceReceiver, DeviceSender, channel};
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Session, Wait};

use crate::identity::Identity;
use crate::names::{Call, Keys};
use crate::presence::Hello;
use crate::session::{close, connect_patiently, request};
use local::Local;

/// Timeout of the robot's settings, after which they are requested again.
const HELLO_PATIENCE: Duration = Duration::from_secs(3);

/// Folder of the sound of the robot's lines, in the group's folder `run/`.
const SAID: &str = "said";

/// The mirrored robot, and options of the mirror.
#[derive(Clone, Debug)]
pub struct Options {
    /// The robot.
    pub robot: Name,
    /// The person's folder of keys.
    pub keys: PathBuf,
    /// The local group.
    pub group: GroupName,
    /// Address of the console; `None` for no console.
    pub console: Option<String>,
}

/// Events from the library's threads to the main loop.
enum Inbound {
    /// A frame of a state, with the state's name.
    State(String, Vec<u8>),
    /// Joint states.
    Joints(Vec<u8>),
    /// The robot's link with this number has come or gone.
    Alive(String, bool),
    /// First message to a new mirror.
    Hello(Vec<u8>),
    /// Receipts for the words with this key.
    Receipts(messages::RequestKey, Vec<u8>),
    /// The request with these words has ended; without an answer if no receipts came.
    WordsEnded(messages::RequestKey),
    /// Sound of a line of the robot.
    Line(Vec<u8>),
}

/// Why a mirrored group ends.
enum End {
    /// The mirror was asked to end.
    Asked,
    /// The robot's group was restarted, or its settings have changed: the mirror follows.
    Changed,
}

/// Mirrors a robot until SIGTERM, SIGINT or `whichone down`.
///
/// # Errors
/// The keys are not a person's, or the local group cannot be made.
pub fn run(options: &Options) -> Result<(), Failure> {
    let identity = Identity::load(&options.keys)?;
    identity.require(false, &options.keys)?;
    let paths = GroupPaths::resolve(&options.group)
        .map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
    let is_ending = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&is_ending))
            .map_err(|error| Failure::new(Exit::NotReached, format!("signals: {error}")))?;
    }
    let held = local::hold(&paths, &options.robot)?;
    let ended = || is_ending.load(Ordering::Relaxed);
    let Some(session) = connect_patiently(&identity, &options.keys, &ended) else { return Ok(()) };
    let keys = Keys::of(&options.robot);
    let (sender, inbox) =
        channel().map_err(|error| Failure::new(Exit::NotReached, format!("inbox: {error}")))?;
    subscribe(&session, &keys, &sender, options.console.is_some())
        .map_err(|error| Failure::new(Exit::NotReached, format!("subscriptions: {error}")))?;
    let link = Link { session, keys, sender, options: options.clone() };
    while let Some(hello) = link.hello(&inbox, &ended) {
        let settings = local::settings(&paths, &hello, options)?;
        let local = Local::raise(&paths, &hello, &settings, options)?;
        match passing::run(&link, &inbox, local, &hello, &settings, &ended)? {
            End::Asked => break,
            End::Changed => tracing::info!("the robot's group has changed; following"),
        }
    }
    close(link);
    drop(held);
    Ok(())
}

/// The way to the robot.
struct Link {
    session: Session,
    keys: Keys,
    sender: DeviceSender<Inbound>,
    options: Options,
}

impl Link {
    /// Asks for the robot's settings until they come; `None` if it is not wanted any more.
    fn hello(
        &self,
        inbox: &DeviceReceiver<Inbound>,
        is_ending: &dyn Fn() -> bool,
    ) -> Option<Hello> {
        let mut asked: Option<std::time::Instant> = None;
        let mut is_reported = false;
        while !is_ending() {
            if asked.is_none_or(|at| at.elapsed() >= HELLO_PATIENCE) {
                if asked.is_some() && !is_reported {
                    let robot = &self.options.robot;
                    tracing::warn!(
                        "robot {robot} does not answer; waiting for it. help: see that its link runs, \
                         and that these keys are for it"
                    );
                    is_reported = true;
                }
                asked = Some(std::time::Instant::now());
                self.ask_hello();
            }
            inbox.clear();
            while let Some(inbound) = inbox.take() {
                let bytes = match inbound {
                    Inbound::Hello(bytes) => bytes,
                    // It has just come.
                    Inbound::Alive(_, true) => {
                        self.ask_hello();
                        continue;
                    }
                    _ => continue,
                };
                match postcard::from_bytes(&bytes) {
                    Ok(hello) => return Some(hello),
                    Err(error) => tracing::warn!(
                        "the robot's settings: {error}; help: install the same version of whichone on both machines"
                    ),
                }
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        None
    }

    fn ask_hello(&self) {
        let sender = self.sender.clone();
        let take = move |bytes| drop(sender.offer(Inbound::Hello(bytes)));
        request(&self.session, &self.keys, Call::Hello, Vec::new(), HELLO_PATIENCE, take);
    }
}

/// Subscribes to everything that the robot shows, and to its voice if somebody may listen.
fn subscribe(
    session: &Session,
    keys: &Keys,
    sender: &DeviceSender<Inbound>,
    listens: bool,
) -> zenoh::Result<()> {
    // Messages that find no room are shown a second later.
    let (own, main) = (keys.clone(), sender.clone());
    let on_state = move |sample: Sample| {
        if let Some(name) = own.state_of(sample.key_expr().as_str()) {
            let bytes = sample.payload().to_bytes().into_owned();
            let _ = main.offer(Inbound::State(name.to_owned(), bytes));
        }
    };
    session.declare_subscriber(keys.state("**")).callback(on_state).background().wait()?;
    let main = sender.clone();
    let on_joints = move |sample: Sample| {
        let _ = main.offer(Inbound::Joints(sample.payload().to_bytes().into_owned()));
    };
    session.declare_subscriber(keys.joints()).callback(on_joints).background().wait()?;
    if listens {
        let main = sender.clone();
        let on_line = move |sample: Sample| {
            // Lines that find no room are requested.
            let _ = main.offer(Inbound::Line(sample.payload().to_bytes().into_owned()));
        };
        session.declare_subscriber(keys.line()).callback(on_line).background().wait()?;
    }
    let main = sender.clone();
    let on_alive = move |sample: Sample| {
        let key = sample.key_expr().as_str();
        let start = key.rsplit('/').next().unwrap_or_default().to_owned();
        main.send(Inbound::Alive(start, sample.kind() == SampleKind::Put));
    };
    let liveliness = session.liveliness();
    let alive = liveliness.declare_subscriber(keys.alive("*")).history(true);
    alive.callback(on_alive).background().wait()
}

/// Settings of the mirrored group: the robot's, except for those of its own machine.
fn own_settings(text: &str, paths: &GroupPaths, options: &Options) -> Result<Settings, Failure> {
    let said = paths.run().join(SAID).display().to_string();
    let listen = options.console.clone().unwrap_or_else(|| "127.0.0.1:0".to_owned());
    let changes = [
        ("console.listen", listen.as_str()),
        ("console.access", "token"),
        ("study.enabled", "false"),
        ("speech.voice_dir", said.as_str()),
    ];
    let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
    Ok(Settings::from_snapshot("the robot's settings", text, ("", &changes))?)
}
