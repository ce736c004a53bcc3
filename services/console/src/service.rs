//! The service's life: it comes up with what it needs, beats while both halves work, and goes in
//! order.

use std::net::SocketAddr;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use config::{Recogniser, Settings, Voice};
use serde_json::json;
use service::client::Client;
use service::clock;
use service::exit::{Exit, Failure};
use service::lifecycle::{Environment, Lifecycle};
use service::service_loop;
use service::worker_channel;
use service::{Span, Time};
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

use crate::bridge::{self, Bridge, Inbox};
use crate::hub::command::{Command, Motion};
use crate::hub::{Hub, Ways};
use crate::server::{self, Access, App, listen};
use crate::study::{self, Study};

/// Threads of the web server.
const WORKERS: usize = 2;
/// How often the topics are looked at while somebody looks on, and while nobody does.
const LOOK_EVERY: (Span, Span) = (Span::from_ms(10), Span::from_ms(50));
/// Longest standstill of the web server's tasks that is no hang.
const STANDSTILL: Span = Span::from_ms(2_000);
/// How often a port is tried for while every one is taken.
const BIND_EVERY: Span = Span::from_ms(2_000);
/// How long pages have to take their leave.
const LEAVE: Duration = Duration::from_secs(2);
/// Restarts that wait for the supervisor.
const RESTARTS_MAX: usize = 8;

/// Runs the service until it is told to end.
pub fn run() -> ExitCode {
    let about = "serves the page from which a person talks to the robot and sees what it thinks";
    service_loop::program("console", about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())
        .map_err(|e| Failure::new(Exit::Config, e.to_string()))?;
    let client = Client::of_service(&environment, "console")?;
    let failed = |what: &'static str| {
        move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
    };
    let (to_commands, commands) = worker_channel::channel::<Command>().map_err(failed("inbox"))?;
    let (to_motions, motions) = worker_channel::channel::<Motion>().map_err(failed("inbox"))?;
    let (to_restarts, restarts) = crossbeam_channel::bounded(RESTARTS_MAX);
    let ways = Ways { commands: to_commands.clone(), motions: to_motions, restarts: to_restarts };
    let study = Study::new(&settings, &environment.paths)?;
    let handover = Span::from_s(settings.console.handover.as_secs_f64());
    let app = Arc::new(App {
        hub: Hub::new(ways, settings.console.viewers_max, handover),
        access: Access::new(settings.console.token.clone()),
        group: environment.paths.name().to_string(),
        settings: json!({
            "language": settings.console.language,
            "voice": {
                "recogniser": settings.speech.recogniser != Recogniser::None,
                "voice": settings.speech.voice != Voice::Print,
            },
            "study": study.is_offered(),
        }),
        urdf: settings.robot_files().urdf.text.clone(),
        voice_dir: settings.voice_dir(&environment.paths.run()),
        study_dir: study::folder(&settings, &environment.paths),
    });
    bridge::supervisor::watch(&environment.paths, &app, restarts, to_commands)
        .map_err(failed("supervisor's thread"))?;
    let bridge = Bridge::open(Arc::clone(&app), client, &environment.paths, &settings, study)?;
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(WORKERS)
        .thread_name("web")
        .enable_all()
        .build()
        .map_err(failed("web server's threads"))?;
    let web = Web::new(runtime, &app, &settings, &environment);
    let inbox = Inbox { commands, motions };
    let watch = Progress { last: 0, at: clock::now() };
    Loop { app, bridge, inbox, lifecycle, web, watch }.run();
    Ok(())
}

struct Loop {
    app: Arc<App>,
    bridge: Bridge,
    inbox: Inbox,
    lifecycle: Lifecycle,
    web: Web,
    watch: Progress,
}

impl Loop {
    fn run(mut self) {
        self.web.try_to_listen(clock::now());
        self.lifecycle.ready();
        tracing::info!("ready");
        loop {
            let (watched, alone) = LOOK_EVERY;
            let looked_at = self.app.hub.viewers() > 0 || self.bridge.is_busy();
            let longest = if looked_at { watched } else { alone };
            self.lifecycle.wait(&[self.inbox.motions.fd(), self.inbox.commands.fd()], longest);
            if self.lifecycle.told_to_end() {
                self.lifecycle.stopping();
                self.web.end(&self.app);
                tracing::info!("ended as told");
                return;
            }
            let began = Instant::now();
            self.bridge.pass(&self.inbox);
            self.app.hub.metrics.pass.observe(began.elapsed().as_secs_f64());
            let now = clock::now();
            self.web.try_to_listen(now);
            self.app.hub.alive(now);
            if !self.web.is_listening() || self.watch.is_well(self.app.hub.progress(), now) {
                self.lifecycle.beat(now, None);
            }
        }
    }
}

/// Whether the web server's tasks make progress.
struct Progress {
    last: u64,
    at: Time,
}

impl Progress {
    fn is_well(&mut self, progress: u64, now: Time) -> bool {
        if progress != self.last {
            (self.last, self.at) = (progress, now);
        }
        now.since(self.at) < STANDSTILL
    }
}

/// The web server and its address.
struct Web {
    runtime: Runtime,
    app: Arc<App>,
    configured: SocketAddr,
    url_file: std::path::PathBuf,
    listening: bool,
    tried: Option<Time>,
}

impl Web {
    fn new(
        runtime: Runtime,
        app: &Arc<App>,
        settings: &Settings,
        environment: &Environment,
    ) -> Self {
        Self {
            runtime,
            app: Arc::clone(app),
            configured: settings.console.listen,
            url_file: environment.paths.console_url(),
            listening: false,
            tried: None,
        }
    }

    fn is_listening(&self) -> bool {
        self.listening
    }

    /// Listens as soon as there is a port. Without one the group does without the page for a while.
    fn try_to_listen(&mut self, now: Time) {
        if self.listening || self.tried.is_some_and(|tried| now < tried + BIND_EVERY) {
            return;
        }
        let first = self.tried.replace(now).is_none();
        let before = listen::predecessor(&self.url_file, self.configured);
        let _guard = self.runtime.enter();
        let bound = listen::bind(self.configured, before).and_then(|listener| {
            let address = listener.local_addr()?;
            Ok((TcpListener::from_std(listener)?, address))
        });
        match bound {
            Ok((listener, address)) => self.begin(listener, address),
            Err(error) if first => {
                let wanted = self.configured;
                tracing::warn!(%wanted, %error, "no page: neither this port nor the next 15 are free");
            }
            Err(_) => {}
        }
    }

    fn begin(&mut self, listener: TcpListener, address: SocketAddr) {
        let (wanted, url) = (self.configured, listen::url(address));
        if wanted.port() != 0 && wanted.port() != address.port() {
            tracing::warn!(%wanted, taken = %address, "another port was taken: this one is not free");
        }
        tracing::info!(url, "the page is served");
        if let Err(error) = write_url(&self.url_file, &url) {
            tracing::warn!(%error, "the page's address is not written down");
        }
        let app = Arc::clone(&self.app);
        self.runtime.spawn(async move {
            if let Err(error) = server::serve(listener, app).await {
                tracing::error!(%error, "the web server has ended");
            }
        });
        self.listening = true;
    }

    /// Takes leave of every page.
    fn end(self, app: &App) {
        app.hub.end();
        let until = Instant::now() + LEAVE;
        while app.hub.viewers() > 0 && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        self.runtime.shutdown_timeout(Duration::from_millis(500));
    }
}

/// Readers see the old address or the new one.
fn write_url(path: &Path, url: &str) -> std::io::Result<()> {
    let new = path.with_extension("new");
    std::fs::write(&new, format!("{url}\n"))?;
    std::fs::rename(new, path)
}
