//! The list of connected robots, as the link's program reports it: `whichone fleet --watch` as a
//! child process, so that the gateway knows no transport.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use roster::{Change, Name, Presence};
use service::exit::{Exit, Failure};
use service::launch::program_of;

/// Pause before a child that has ended is started again.
const PAUSE: Duration = Duration::from_secs(2);

/// The connected robots.
#[derive(Debug)]
pub struct Feed {
    robots: Arc<Mutex<BTreeMap<Name, Option<Presence>>>>,
    child: Arc<Mutex<Option<Child>>>,
}

impl Feed {
    /// Starts to follow the robots that `keys` are for.
    ///
    /// # Errors
    /// The link's program is missing, or the thread cannot be started.
    pub fn start(keys: &Path) -> Result<Self, Failure> {
        let feed = Self { robots: Arc::default(), child: Arc::default() };
        let (robots, child, keys) =
            (Arc::clone(&feed.robots), Arc::clone(&feed.child), keys.to_owned());
        // The first failure is the caller's.
        let first = launch(&keys)?;
        let follow = move || {
            let mut next = Some(first);
            loop {
                match next.take().map_or_else(|| launch(&keys), Ok) {
                    Ok(process) => follow(process, &child, &robots),
                    Err(error) => tracing::warn!("{error}; trying again"),
                }
                std::thread::sleep(PAUSE);
            }
        };
        std::thread::Builder::new()
            .name("fleet".into())
            .spawn(follow)
            .map_err(|error| Failure::new(Exit::NotReached, format!("fleet's thread: {error}")))?;
        Ok(feed)
    }

    /// The robots that are connected.
    pub fn all(&self) -> BTreeMap<Name, Option<Presence>> {
        lock(&self.robots).clone()
    }

    /// Returns whether a robot is connected.
    pub fn has(&self, robot: &Name) -> bool {
        lock(&self.robots).contains_key(robot)
    }
}

impl Drop for Feed {
    fn drop(&mut self) {
        if let Some(child) = lock(&self.child).as_mut() {
            // A child that cannot be killed ends by itself: it has no reader any more.
            let _ = child.kill();
        }
    }
}

fn launch(keys: &Path) -> Result<Child, Failure> {
    let program = program_of("link");
    let mut command = Command::new(&program);
    command.args(["fleet", "--watch", "--keys"]).arg(keys);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| missing(&program, &error))
}

/// The link's program cannot be started.
pub(crate) fn missing(program: &Path, error: &std::io::Error) -> Failure {
    let help = "help: robots elsewhere need it: `scripts/link build`";
    Failure::new(Exit::NotReached, format!("{}: {error}; {help}", program.display()))
}

/// Reads a child's lines until it ends.
fn follow(
    mut process: Child,
    child: &Mutex<Option<Child>>,
    robots: &Mutex<BTreeMap<Name, Option<Presence>>>,
) {
    let Some(output) = process.stdout.take() else { return };
    *lock(child) = Some(process);
    // The new child reports everything again.
    lock(robots).clear();
    for line in BufReader::new(output).lines().map_while(Result::ok).filter(|line| !line.is_empty())
    {
        match serde_json::from_str(&line) {
            Ok(Change::Here { robot, presence }) => drop(lock(robots).insert(robot, presence)),
            Ok(Change::Gone { gone }) => drop(lock(robots).remove(&gone)),
            Err(error) => tracing::warn!(%error, line, "expected a change of the fleet"),
        }
    }
    if let Some(mut ended) = lock(child).take() {
        let status = ended.wait();
        tracing::warn!(?status, "the list of robots has ended; starting it again");
    }
    lock(robots).clear();
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // Every change leaves a consistent value.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
