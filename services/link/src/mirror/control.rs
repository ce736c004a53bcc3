//! The control socket of a mirrored group: shows the robot's services, and takes no order for them.

use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use roster::Name;
use service::control::{DownReport, REQUEST_BYTES_MAX, Refusal, RefusalKind, Reply, Request};
use service::status::{Actual, GroupState, GroupStatus, ServiceState, ServiceStatus, Wanted};

/// Timeout of a client for its request and its reply.
const CLIENT_PATIENCE: Duration = Duration::from_secs(2);
/// Interval at which a client that waits is looked after.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// Knowledge about the robot.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub(super) robot: Name,
    pub(super) group: String,
    pub(super) epoch: u64,
    pub(super) scene: String,
    pub(super) config: PathBuf,
    pub(super) began: Instant,
    /// Status of the robot's group, as last shown.
    pub(super) status: Option<GroupStatus>,
    /// When anything was heard of it last.
    pub(super) heard: Option<Instant>,
    /// Process of the local console, and whether there is to be one.
    pub(super) console: Option<Option<u32>>,
    /// `whichone down` was called.
    pub(super) is_down: bool,
}

/// Time without any message after which the robot counts as lost: its states come each second.
const LOST_AFTER: Duration = Duration::from_millis(3_500);

impl Known {
    fn is_lost(&self) -> bool {
        self.heard.is_none_or(|heard| heard.elapsed() > LOST_AFTER)
    }

    /// The local group's status: the robot's services, and those that are local.
    fn status(&self) -> GroupStatus {
        let mut services = vec![self.link()];
        services.extend(self.console.map(|pid| self.own("console", pid, pid.is_some())));
        let theirs = self.status.iter().flat_map(|status| &status.services);
        let theirs = theirs.filter(|service| !["link", "console"].contains(&service.name.as_str()));
        services.extend(theirs.cloned());
        let state = match &self.status {
            Some(status) if !self.is_lost() => status.state,
            Some(_) => GroupState::Degraded,
            None => GroupState::Starting,
        };
        GroupStatus {
            name: self.group.clone(),
            state,
            supervisor_pid: std::process::id(),
            version: build_info::full_version(),
            build: Some(build_info::current().clone()),
            uptime_s: self.began.elapsed().as_secs_f64(),
            epoch: self.epoch,
            scene: self.scene.clone(),
            profile: Some(format!("mirror of {}", self.robot)),
            config: self.config.clone(),
            set: None,
            orphans_killed: 0,
            rss_kib: None,
            cpu_s: None,
            services,
        }
    }

    fn link(&self) -> ServiceStatus {
        let mut link = self.own("link", Some(std::process::id()), !self.is_lost());
        let robot = &self.robot;
        link.why = self.is_lost().then(|| match self.heard {
            Some(heard) => {
                format!("nothing heard of robot {robot} for {:.0} s", heard.elapsed().as_secs_f64())
            }
            None => format!("nothing heard of robot {robot} yet"),
        });
        link
    }

    fn own(&self, name: &str, pid: Option<u32>, is_ready: bool) -> ServiceStatus {
        let (actual, state) = match is_ready {
            true => (Actual::Ready, ServiceState::Ready),
            false => (Actual::Starting, ServiceState::Restarting),
        };
        ServiceStatus {
            name: name.to_owned(),
            wanted: Wanted::Up,
            actual,
            state,
            why: None,
            pid,
            incarnation: 1,
            uptime_s: Some(self.began.elapsed().as_secs_f64()),
            restarts: 0,
            beat_age_ms: None,
            input_age_ms: None,
            version: Some(build_info::full_version()),
            says: None,
            rejected: 0,
            lost: 0,
            journal_syncs: 0,
            journal_sync_s: 0.0,
            swapped: None,
            last_exit: None,
            log_tail: Vec::new(),
            rss_kib: None,
            cpu_s: None,
        }
    }
}

/// Listens until the group's end; each client has a thread.
pub(super) fn listen(socket: &Path, known: &Arc<Mutex<Known>>) -> std::io::Result<()> {
    let listener = UnixListener::bind(socket)?;
    let known = Arc::clone(known);
    let accept = move || {
        for stream in listener.incoming().flatten() {
            if lock(&known).is_down {
                return;
            }
            let known = Arc::clone(&known);
            let serve = move || {
                if let Err(error) = serve(stream, &known) {
                    tracing::debug!(%error, "a client of the control socket is gone");
                }
            };
            if let Err(error) = std::thread::Builder::new().name("control".into()).spawn(serve) {
                tracing::warn!(%error, "a request is not answered");
            }
        }
    };
    std::thread::Builder::new().name("control".into()).spawn(accept).map(drop)
}

/// Locks the knowledge; a thread that has panicked leaves it readable.
pub(super) fn lock(known: &Mutex<Known>) -> std::sync::MutexGuard<'_, Known> {
    known.lock().unwrap_or_else(PoisonError::into_inner)
}

fn serve(stream: UnixStream, known: &Mutex<Known>) -> std::io::Result<()> {
    stream.set_read_timeout(Some(CLIENT_PATIENCE))?;
    stream.set_write_timeout(Some(CLIENT_PATIENCE))?;
    let mut line = String::new();
    BufReader::new(&stream).take(REQUEST_BYTES_MAX as u64).read_line(&mut line)?;
    let refuse = |kind, what: String| Reply::Refused(Refusal::new(kind, what));
    let reply = match serde_json::from_str(&line) {
        Ok(request) => answer(request, known),
        Err(error) => refuse(RefusalKind::Usage, format!("not a request: {error}")),
    };
    let mut text = serde_json::to_vec(&reply)?;
    text.push(b'\n');
    (&stream).write_all(&text)
}

fn answer(request: Request, known: &Mutex<Known>) -> Reply {
    match request {
        Request::Ping => Reply::Done { message: "here".to_owned() },
        Request::Status => Reply::Status(Box::new(lock(known).status())),
        Request::WaitReady { wait_ms } => wait_ready(Duration::from_millis(wait_ms), known),
        Request::Down => {
            lock(known).is_down = true;
            Reply::Down(DownReport::default())
        }
        _ => {
            let known = lock(known);
            let Known { robot, group, .. } = &*known;
            let what = format!(
                "group {group} mirrors robot {robot}, whose services are not ordered from here; help: give the order \
                 on the robot's own computer"
            );
            Reply::Refused(Refusal::new(RefusalKind::Usage, what))
        }
    }
}

fn wait_ready(longest: Duration, known: &Mutex<Known>) -> Reply {
    let until = Instant::now() + longest;
    loop {
        let status = lock(known).status();
        if status.state == GroupState::Ready {
            return Reply::Done { message: format!("group {} is ready", status.name) };
        }
        if Instant::now() >= until {
            let why = status.services.iter().find_map(|service| service.why.clone());
            let what = why.unwrap_or_else(|| "the robot's group is not ready".to_owned());
            return Reply::Refused(Refusal::new(RefusalKind::NotReached, what));
        }
        std::thread::sleep(LOOK_EVERY);
    }
}
