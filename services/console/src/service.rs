//! The console's program: sets up bridge and web server, and drives both.

use std::ops::ControlFlow;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use config::{Recogniser, Settings, Voice};
use group_metrics::Metrics;
use http_api::Rules;
use messages::Service;
use page_history::History;
use page_scenes::{Desk, Scenes};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use service::bus::WakeListener;
use service::client::Client;
use service::clock;
use service::console_link::{self, random_secret};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use service::service_loop;
use service::worker_channel;
use service::{Span, Time};

use crate::bridge::{self, Bridge, Inbox};
use crate::hub::outbound::{CameraSettings, PageSettings, VoiceSettings};
use crate::hub::{Channels, Hub};
use crate::live::{self, Live};
use crate::server::limits::Limits;
use crate::server::web::Web;
use crate::server::{Access, App};
use crate::viewer;

/// Longest sleep with and without viewers. Prompts, acts and phases of the arm wake the console; it
/// polls the other topics.
const LOOK_EVERY: (Span, Span) = (Span::from_ms(10), Span::from_ms(250));
/// Most restarts that wait for the supervisor.
const RESTARTS_MAX: usize = 8;

/// Runs the service until it is shut down; with `view FILE`, the page for a shared interaction.
pub fn run() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [verb, file] = &arguments[..]
        && verb == "view"
    {
        return viewer::view(file.as_ref());
    }
    let about = "serves the page from which a user talks to the robot and sees what it believes";
    service_loop::program(Service::Console.name(), about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let mut console = Console::open(&environment, &settings)?;
    // The main loop counts as well until its first pass, which may come after the first visitor.
    console.app.hub.alive(clock::now());
    console.web.try_to_listen(clock::now());
    drive(lifecycle, &mut console)
}

/// Bridge and web server, driven by the main loop.
struct Console {
    app: Arc<App>,
    bridge: Bridge,
    inbox: Inbox,
    wake_listener: WakeListener,
    web: Web,
    is_ending: bool,
}

impl Console {
    fn open(environment: &Environment, settings: &Settings) -> Result<Self, Failure> {
        let paths = &environment.paths;
        let failed = |what: &'static str| {
            move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
        };
        let client = Client::of_service(environment, Service::Console.name())?;
        let wake_listener = client.bus().wake_listener(Service::Console).map_err(|error| {
            Failure::new(Exit::NotReached, format!("wake-ups of the console: {error}"))
        })?;
        let (commands, command_inbox) = worker_channel::channel().map_err(failed("inbox"))?;
        let (motions, motion_inbox) = worker_channel::channel().map_err(failed("inbox"))?;
        let (restarts, restart_inbox) = crossbeam_channel::bounded(RESTARTS_MAX);
        let study = page_study::open(settings, paths)?;
        let handover = Span::from_s(settings.console.handover.as_secs_f64());
        let channels = Channels { commands: commands.clone(), motions, restarts };
        let (limits, is_live_possible) = limits(settings.console.viewers_max);
        let history = History::start(paths).map_err(failed("history's thread"))?;
        let in_force = settings.scene_file().text.clone();
        let (socket, lock) = (paths.control_socket(), scenes_lock(settings, study.is_some()));
        let desk = Desk::new(socket, in_force, lock, language::word_findings);
        let scenes = Arc::new(Scenes::start(desk).map_err(failed("scene editor's thread"))?);
        let session = random_secret().map_err(failed("session"))?;
        let access = Arc::new(access(settings, paths)?);
        let hub = Hub::new(channels, limits.viewers, handover, Metrics::new(paths.recordings()));
        let rules = rules(&access, &hub, settings.console.discovery);
        let (http, feed) =
            http_api::open(paths, rules).map_err(failed("interface for programs"))?;
        let app = Arc::new(App {
            history,
            scenes,
            hub,
            live: Live::new(settings, paths.name().as_str(), &session, is_live_possible)?,
            access,
            http,
            group: paths.name().to_string(),
            settings: page_settings(settings, study.is_some()),
            urdf: settings.robot_files().urdf.text.clone(),
            voice_dir: settings.voice_dir(&paths.run()),
            study: page_study::files(settings, paths)?,
        });
        bridge::supervisor::watch(paths, &app, restart_inbox, commands)
            .map_err(failed("supervisor's thread"))?;
        let web = Web::new(&app, settings.console.listen, paths.console_url(), limits.others)
            .map_err(failed("web server's threads"))?;
        let bridge = Bridge::open(Arc::clone(&app), client, paths, settings, (study, feed))?;
        let inbox = Inbox { commands: command_inbox, motions: motion_inbox };
        Ok(Self { app, bridge, inbox, wake_listener, web, is_ending: false })
    }
}

/// Why scenes are not changed from the page, if they are not.
fn scenes_lock(settings: &Settings, has_study: bool) -> Option<String> {
    let why = match (has_study, settings.console.edit_scenes) {
        (true, _) => "the scene is part of a study; help: set study.enabled = false",
        (_, false) => "scenes are not edited here; help: set console.edit_scenes = true",
        _ => return None,
    };
    Some(why.to_owned())
}

fn access(settings: &Settings, paths: &GroupPaths) -> Result<Access, Failure> {
    if settings.console.access == config::Access::Open {
        tracing::warn!("console.access is open: every user of this machine can operate the robot");
        return Ok(Access::open());
    }
    let file = console_link::token_file(paths);
    let failed = |error| Failure::new(Exit::Storage, format!("{}: {error}", file.display()));
    Access::by_token(&file, console_link::sessions_file(paths)).map_err(failed)
}

/// Rules of the interface for programs, which the console's own token may use as well.
fn rules(access: &Arc<Access>, hub: &Hub, discovery: bool) -> Rules {
    let access = Arc::clone(access);
    let is_owner = Box::new(move |said: &str| access.is_token(said));
    Rules { is_owner, is_stop: language::is_stop, ending: hub.ending(), discovery }
}

/// Raises the limit of descriptors as far as allowed, and divides it: first to pages, then to the
/// live view. Returns whether enough is left for that.
fn limits(viewers_max: usize) -> (Limits, bool) {
    let Rlimit { maximum, .. } = getrlimit(Resource::Nofile);
    let raised = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum });
    let allowed = getrlimit(Resource::Nofile).current.map_or(usize::MAX, |most| most as usize);
    let used = std::fs::read_dir("/proc/self/fd").map_or(0, Iterator::count);
    let free = allowed.saturating_sub(used);
    let limits = Limits::new(viewers_max, free);
    let is_live_possible = free >= Limits::most(viewers_max) + live::descriptors();
    if limits.viewers < viewers_max {
        let most = limits.viewers;
        tracing::warn!(allowed, used, ?raised, "too few file descriptors: at most {most} pages");
    }
    (limits, is_live_possible)
}

fn page_settings(settings: &Settings, study: bool) -> PageSettings {
    PageSettings {
        language: settings.console.language.clone(),
        voice: VoiceSettings {
            recogniser: settings.speech.recogniser != Recogniser::None,
            voice: settings.speech.voice != Voice::Print,
        },
        study,
        simulated: settings.arm.driver == config::KINEMATIC.name,
        camera: settings.console.camera.as_ref().map(|camera| CameraSettings {
            url: camera.url.clone(),
            every_ms: camera.every.map(|every| every.as_secs_f64() * 1e3),
            origin: camera.origin.clone(),
        }),
    }
}

impl Cycle for Console {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        let (watched, alone) = LOOK_EVERY;
        let is_watched = self.app.hub.viewers() > 0 || self.bridge.is_busy();
        let longest = if is_watched { watched } else { alone };
        let Inbox { motions, commands } = &self.inbox;
        let programs = Some(self.bridge.http.fd());
        ([Some(motions.fd()), Some(commands.fd()), programs], now + longest)
    }

    fn shut_down(&mut self) {
        self.web.shut_down();
        self.is_ending = true;
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if self.is_ending {
            return Ok(ControlFlow::Break(()));
        }
        let began = Instant::now();
        if ready.by_wake {
            // It writes nothing that those who join could have missed.
            self.wake_listener.take();
        }
        self.bridge.pass(&self.inbox);
        self.app.hub.metrics.pass.observe(began.elapsed().as_secs_f64());
        let now = clock::now();
        self.web.try_to_listen(now);
        self.app.hub.alive(now);
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, now: Time) -> Health {
        match self.web.is_working(now) {
            true => Health::Working(None),
            false => Health::Stuck,
        }
    }
}
