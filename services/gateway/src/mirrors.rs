//! Mirrors of robots elsewhere: child processes, one for each robot in use, each a group in the
//! gateway's folder with a console on a port of its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use roster::Name;
use rustix::process::{Pid, Signal, kill_process};
use service::control::{Request, call};
use service::exit::{Exit, Failure};
use service::folders::make_private;
use service::group::{ENV_HOME, GroupName, GroupPaths};
use service::launch::program_of;

use crate::feed::missing;
use crate::robots::{Console, Unreached, console, home_of_mirrors};

/// Time without use after which a mirror ends.
const IDLE_MAX: Duration = Duration::from_secs(300);
/// Shortest time between two starts of one.
const START_EVERY: Duration = Duration::from_secs(3);
/// Mirrors at a time: each is two processes, of some 30 MB together.
const MIRRORS_MAX: usize = 64;
/// Timeout of a mirror's answer on its control socket.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time for the end of all mirrors.
const END_PATIENCE: Duration = Duration::from_secs(8);

/// All mirrors of the gateway.
#[derive(Debug)]
pub(crate) struct Mirrors {
    keys: PathBuf,
    home: PathBuf,
    running: Arc<Mutex<BTreeMap<Name, Mirror>>>,
}

#[derive(Debug)]
struct Mirror {
    /// `None` for one that a former gateway has left running.
    child: Option<Child>,
    started: Instant,
    used: Instant,
    pages: usize,
}

/// An open page of a robot.
#[derive(Debug)]
pub(crate) struct Used {
    robot: Name,
    running: Arc<Mutex<BTreeMap<Name, Mirror>>>,
}

impl Mirrors {
    /// No mirrors yet; their groups lie in `home`.
    ///
    /// # Errors
    /// The folder cannot be made, or its path is too long.
    pub(crate) fn new(keys: &Path, home: PathBuf) -> Result<Self, Failure> {
        let home = home_of_mirrors(home)?;
        make_private(&home).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
        let keys = std::path::absolute(keys).unwrap_or_else(|_| keys.to_owned());
        Ok(Self { keys, home, running: Arc::default() })
    }

    /// Returns whether there is one of this robot.
    pub(crate) fn runs(&self, robot: &Name) -> bool {
        lock(&self.running).contains_key(robot)
    }

    /// Returns the console of a robot's mirror, which is started if needed.
    ///
    /// # Errors
    /// It is not ready yet, or cannot be started.
    pub(crate) async fn reach(&self, robot: &Name) -> Result<Console, Unreached> {
        let failed = |error: Failure| Unreached::Failed(error.to_string());
        let paths = self.paths(robot).map_err(failed)?;
        self.keep(robot, &paths).map_err(failed)?;
        let console = console(&paths).ok_or_else(|| Unreached::Starting(robot.clone()))?;
        // The address may be that of a mirror of former times.
        match tokio::net::TcpStream::connect(&console.place).await {
            Ok(_) => Ok(console),
            Err(_) => Err(Unreached::Starting(robot.clone())),
        }
    }

    /// Notes that a page is open until the result is dropped.
    pub(crate) fn used(&self, robot: &Name) -> Used {
        if let Some(mirror) = lock(&self.running).get_mut(robot) {
            mirror.pages += 1;
        }
        Used { robot: robot.clone(), running: Arc::clone(&self.running) }
    }

    fn paths(&self, robot: &Name) -> Result<GroupPaths, Failure> {
        Ok(GroupPaths::in_home(&self.home, &GroupName::new(robot.as_str())?)?)
    }

    /// Starts a mirror if none runs.
    fn keep(&self, robot: &Name, paths: &GroupPaths) -> Result<(), Failure> {
        let mut running = lock(&self.running);
        let now = Instant::now();
        if let Some(mirror) = running.get_mut(robot) {
            mirror.used = now;
            let ended = mirror.child.as_mut().and_then(|child| child.try_wait().ok().flatten());
            let is_lost = mirror.child.is_none() && !answers(paths);
            if ended.is_none() && !is_lost || mirror.started.elapsed() < START_EVERY {
                return Ok(());
            }
            tracing::warn!(%robot, ?ended, "a mirror has ended; starting it again");
            mirror.child = Some(self.launch(robot)?);
            mirror.started = now;
            return Ok(());
        }
        if running.len() >= MIRRORS_MAX {
            let what = format!("{MIRRORS_MAX} robots are in use; help: close pages of others");
            return Err(Failure::new(Exit::NotReached, what));
        }
        let child = if answers(paths) { None } else { Some(self.launch(robot)?) };
        running.insert(robot.clone(), Mirror { child, started: now, used: now, pages: 0 });
        Ok(())
    }

    fn launch(&self, robot: &Name) -> Result<Child, Failure> {
        let program = program_of("link");
        let path = self.home.join(format!("{robot}.log"));
        let log =
            safe_files::create_private(&path).map_err(|error| Failure::file(&path, &error))?;
        let mut command = Command::new(&program);
        command.args(["--mirror", robot.as_str(), "--group", robot.as_str()]);
        command.args(["--listen", "127.0.0.1:0", "--keys"]).arg(&self.keys);
        command.env(ENV_HOME, &self.home).stdin(Stdio::null()).stdout(Stdio::null()).stderr(log);
        command.spawn().map_err(|error| missing(&program, &error))
    }

    /// Ends those that have been unused for a while.
    pub(crate) async fn end_idle(&self) {
        let is_idle = |mirror: &Mirror| mirror.pages == 0 && mirror.used.elapsed() > IDLE_MAX;
        let mut idle = Vec::new();
        lock(&self.running).retain(|robot, mirror| {
            let is_idle = is_idle(mirror);
            if is_idle {
                idle.push((robot.clone(), mirror.child.take()));
            }
            !is_idle
        });
        for (robot, child) in idle {
            tracing::info!(%robot, "nobody uses the mirror; ending it");
            let Ok(paths) = self.paths(&robot) else { continue };
            // The runtime's own threads do not wait for a process.
            let _ = tokio::task::spawn_blocking(move || {
                ask_to_end(child.as_ref(), &paths);
                wait_for_end(child, Instant::now() + PATIENCE);
            })
            .await;
        }
    }

    /// Ends all mirrors, and waits for them.
    pub(crate) fn end(&self) {
        let all = std::mem::take(&mut *lock(&self.running));
        for (robot, mirror) in &all {
            if let Ok(paths) = self.paths(robot) {
                ask_to_end(mirror.child.as_ref(), &paths);
            }
        }
        let until = Instant::now() + END_PATIENCE;
        all.into_values().for_each(|mirror| wait_for_end(mirror.child, until));
    }
}

impl Drop for Used {
    fn drop(&mut self) {
        if let Some(mirror) = lock(&self.running).get_mut(&self.robot) {
            mirror.pages = mirror.pages.saturating_sub(1);
            mirror.used = Instant::now();
        }
    }
}

/// Returns whether a mirror answers on its control socket.
fn answers(paths: &GroupPaths) -> bool {
    paths.control_socket().exists()
        && call(&paths.control_socket(), &Request::Ping, Duration::from_millis(300)).is_ok()
}

fn ask_to_end(child: Option<&Child>, paths: &GroupPaths) {
    match child {
        // Not reaped yet: the number is still its own.
        Some(child) => drop(kill_process(Pid::from_child(child), Signal::TERM)),
        None => drop(call(&paths.control_socket(), &Request::Down, PATIENCE)),
    }
}

fn wait_for_end(child: Option<Child>, until: Instant) {
    let Some(mut child) = child else { return };
    while Instant::now() < until {
        if !matches!(child.try_wait(), Ok(None)) {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let _ = child.kill();
    let _ = child.wait();
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // Every change leaves a consistent value.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
