//! The recorder as a service of the group.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::time::SystemTime;

use config::{SNAPSHOT_FILE, Settings};
use messages::Service;
use recording::clock::WallClock;
use recording::file::Attached;
use recording::group_reader::{GroupReader, OpenError};
use recording::list::{entries, incomplete};
use recording::recover;
use recording::ring::{Ring, TEND_EVERY, free_space};
use service::bus::WakeListener;
use service::client::Client;
use service::exit::{Exit, Failure};
use service::folders::make_private;
use service::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use service::{Span, Time, clock, service_loop};

/// Intervals between two looks at all topics: while much is sent, and otherwise.
const LOOK_EVERY: (Span, Span) = (Span::from_ms(100), Span::from_ms(250));
/// Seconds before the end of the newest recording from which on a message may not be in it.
const UNFLUSHED_S: f64 = 1.0;

/// Runs the service until it is shut down.
pub fn run() -> ExitCode {
    let about = "records every topic into MCAP files (docs/recording.md)";
    service_loop::program(Service::Recorder.name(), about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let mut recorder = Recorder::open(&environment, &settings)?;
    drive(lifecycle, &mut recorder)
}

struct Recorder {
    /// Keeps the readers' shared memory open.
    _client: Client,
    wake_listener: WakeListener,
    reader: GroupReader,
    ring: Ring,
    next_look: Time,
    next_tend: Time,
    is_ending: bool,
}

impl Recorder {
    fn open(environment: &Environment, settings: &Settings) -> Result<Self, Failure> {
        let paths = &environment.paths;
        let folder = paths.recordings();
        make_private(&folder).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
        let began = clock::now();
        let since = newest(&folder, began);
        let client = Client::of_service(environment, Service::Recorder.name())?;
        let wake_listener = client.bus().wake_listener(Service::Recorder)?;
        let reader = GroupReader::open(client.bus(), settings, paths.log(), since);
        let reader = reader.map_err(|error| match error {
            OpenError::Bus(error) => error.into(),
            OpenError::Settings(found) => found.into(),
            OpenError::Robot(found) => Failure::new(Exit::Config, found),
        })?;
        let attached = attached(environment, settings);
        let limits: recording::settings::Recorder = settings.part()?;
        let ring = Ring::new(folder.clone(), limits, attached, Box::new(free_space));
        let mut recorder = Self {
            _client: client,
            wake_listener,
            reader,
            ring,
            next_look: began,
            next_tend: began,
            is_ending: false,
        };
        // Deletes files that are too old: the rest is completed.
        recorder.tend(began);
        let torn = incomplete(&folder);
        // Beside the recording, as it may take a while. A failure leaves them unfinished.
        let recovery = move || recover::recover_all(&torn);
        let spawned = std::thread::Builder::new().name("recover".into()).spawn(recovery);
        if let Err(error) = spawned {
            tracing::warn!(%error, "unfinished recordings are not completed");
        }
        Ok(recorder)
    }

    /// Takes the new messages of all topics; they are dropped while nothing is recorded. Returns
    /// whether the next look should come soon.
    fn look(&mut self, now: Time) -> bool {
        let Self { reader, ring, .. } = self;
        match ring.clock() {
            Some(clock) => reader.look(now, clock, &mut |sample| ring.write(sample, now)),
            None => {
                reader.skip();
                false
            }
        }
    }

    fn tend(&mut self, now: Time) {
        let Self { ring, reader, .. } = self;
        if let Some(clock) = ring.clock() {
            reader.show_logs(now, clock, &mut |sample| ring.write(sample, now));
        }
        let is_new = ring.tend(now, WallClock::read());
        if let Some(clock) = ring.clock().filter(|_| is_new) {
            reader.begin(now, clock, &mut |sample| ring.write(sample, now));
        }
        self.next_tend = now + TEND_EVERY;
    }
}

/// The moment up to which an earlier recording has the messages: a second before its last flush, so
/// that some may be in both and none is lost.
fn newest(folder: &Path, now: Time) -> Time {
    let written = entries(folder).pop().and_then(|file| file.path.metadata().ok()?.modified().ok());
    let age = written.and_then(|at| SystemTime::now().duration_since(at).ok());
    let age = age.map(|age| Span::from_s(age.as_secs_f64() + UNFLUSHED_S));
    age.map_or(Time(0), |age| Time(now.ns().saturating_sub(age.0)))
}

fn attached(environment: &Environment, settings: &Settings) -> Attached {
    let robot = settings.robot_files();
    let srdf = robot.srdf.iter().map(|file| ("robot.srdf", "application/xml", file.text.clone()));
    let files = [
        (SNAPSHOT_FILE, "application/toml", settings.snapshot()),
        ("scene.toml", "application/toml", settings.scene_file().text.clone()),
        ("robot.urdf", "application/xml", robot.urdf.text.clone()),
    ];
    let files = files.into_iter().chain(srdf);
    let group = [
        ("group", environment.paths.name().to_string()),
        ("epoch", environment.epoch.to_string()),
        ("scene", settings.scene.name().to_owned()),
        ("version", build_info::full_version()),
    ];
    Attached {
        files: files.map(|(name, media, text)| (name.to_owned(), media, text)).collect(),
        group: group
            .map(|(key, value)| (key.to_owned(), value))
            .into_iter()
            .collect::<BTreeMap<_, _>>(),
    }
}

impl Cycle for Recorder {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, _now: Time) -> (Sources<'_>, Time) {
        ([None; 3], self.next_look)
    }

    fn shut_down(&mut self) {
        self.is_ending = true;
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if ready.by_wake {
            // It writes no topic that those who join could have missed.
            self.wake_listener.take();
        }
        let now = clock::now();
        // Clients wake the recorder: their messages are gone when they end.
        if now >= self.next_look || ready.by_wake || self.is_ending {
            // Messages from clients are answered soon.
            let soon = self.look(now) || ready.by_wake;
            self.next_look = now + if soon { LOOK_EVERY.0 } else { LOOK_EVERY.1 };
            // At the end, too: log lines of the last second.
            if now >= self.next_tend || self.is_ending {
                self.tend(now);
            }
        }
        if self.is_ending {
            self.ring.finish(now);
            return Ok(ControlFlow::Break(()));
        }
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(None)
    }

    fn shortage(&self) -> Option<&str> {
        self.ring.paused()
    }
}
