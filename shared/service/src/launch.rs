//! Start of a supervisor from the command line: in the foreground, or detached from the terminal.

use messages::SUPERVISOR;
use std::env;
use std::ffi::OsString;
use std::fs::{File, TryLockError};
use std::io::{self, Read};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::exit::Exit;
use crate::folders::{FolderError, make_private, make_root};
use crate::group::{ENV_HOME, GroupName, GroupPaths};
use config::Log;
use thiserror::Error;

use crate::control::{CallError, Reply, Request, call};
use crate::log_file;

/// The program that may contain all others.
const HOST: &str = "whichone";

/// Prefix of the names of services' programs.
pub const PREFIX: &str = "whichone-";

/// Interval at which a starting supervisor is polled.
const ASK_EVERY: Duration = Duration::from_millis(1);

/// Timeout for the answer of a listening supervisor.
const ANSWER_PATIENCE: Duration = Duration::from_secs(2);

/// Rotation of the supervisor's own log, before it has read any configuration.
const LOG_BYTES_MAX: u64 = 8 << 20;

/// Options of a supervisor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The group to run.
    pub group: GroupName,
    /// Folder of the configuration.
    pub config: PathBuf,
    /// Name of a profile in the configuration.
    pub profile: Option<String>,
    /// Overrides of configuration values: dotted key and TOML value.
    pub set: Vec<(String, String)>,
    /// True to start a new epoch and keep the old journals next to it.
    pub fresh: bool,
}

/// Failure to start a supervisor.
#[derive(Debug, Error)]
pub enum LaunchError {
    /// The supervisor's program could not be started, or its log could not be created.
    #[error("{}: {}", .0.display(), .1)]
    Io(PathBuf, io::Error),
    /// A folder of the group is not its owner's alone.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The supervisor ended before it listened; its exit status and the end of its log.
    #[error("the supervisor ended with {}{}", .0, indented(.1))]
    Ended(ExitStatus, Vec<String>),
    /// The supervisor did not listen within the timeout; its log.
    #[error(
        "the supervisor is still starting after {} s; see {}; help: `whichone status` shows its state, `whichone down` \
         stops it",
        .0.as_secs_f64(), .1.display()
    )]
    Late(Duration, PathBuf),
    /// The supervisor did not answer, or the group did not become ready.
    #[error(transparent)]
    Call(#[from] CallError),
}

impl LaunchError {
    /// The exit code that a command line ends with.
    pub fn exit(&self) -> Exit {
        match self {
            Self::Ended(status, _) => match Exit::of_process(status.code()) {
                Exit::Ok => Exit::NotReached,
                exit => exit,
            },
            Self::Io(..) | Self::Folder(_) => Exit::Storage,
            Self::Late(..) | Self::Call(_) => Exit::NotReached,
        }
    }
}

/// A supervisor that has been started and does not listen yet.
#[derive(Debug)]
pub struct Launched {
    process: Child,
    paths: GroupPaths,
    log_from: u64,
}

impl Options {
    /// Returns the supervisor's command line.
    pub fn arguments(&self) -> Vec<OsString> {
        let mut arguments: Vec<OsString> = vec![
            "--group".into(),
            self.group.as_str().into(),
            "--config".into(),
            self.config.clone().into(),
        ];
        if let Some(profile) = &self.profile {
            arguments.extend(["--profile".into(), profile.into()]);
        }
        for (key, value) in &self.set {
            arguments.extend(["--set".into(), format!("{key}={value}").into()]);
        }
        if self.fresh {
            arguments.push("--fresh".into());
        }
        arguments
    }
}

/// The supervisor's program; see [`program_of`].
pub fn program() -> PathBuf {
    program_of(SUPERVISOR)
}

/// Returns the program of a service: next to the running one, where an installed `whichone` may
/// replace it ([`host_of`]), else from `PATH`. Start it with [`command`].
pub fn program_of(service: &str) -> PathBuf {
    let name = format!("{PREFIX}{service}");
    let beside = env::current_exe().ok().and_then(|own| Some(own.parent()?.join(&name)));
    beside.filter(|path| path.is_file() || host_of(path).is_some()).unwrap_or_else(|| name.into())
}

/// Returns the program that runs in place of `program`, if that is absent: a build of `whichone`
/// contains the services, and runs as the one that names it. So an installation is one file.
pub fn host_of(program: &Path) -> Option<PathBuf> {
    let name = program.file_name()?.to_str()?;
    let is_name_alone = program.parent().is_none_or(|folder| folder.as_os_str().is_empty());
    let host = program.with_file_name(HOST);
    let is_hosted = !is_name_alone && name.starts_with(PREFIX) && !program.exists();
    (is_hosted && host.is_file()).then_some(host)
}

/// The command that starts a program of the group, or `whichone` in its place.
pub fn command(program: impl AsRef<Path>) -> Command {
    let program = program.as_ref();
    let Some(host) = host_of(program) else { return Command::new(program) };
    let mut command = Command::new(host);
    command.arg0(program);
    command
}

/// Becomes the supervisor, whose program is at `program` (see [`program`]). Returns only if that
/// fails.
pub fn foreground(program: &Path, options: &Options, paths: &GroupPaths) -> LaunchError {
    let error = supervisor(program, options, paths).exec();
    LaunchError::Io(program.to_owned(), error)
}

/// Starts a supervisor in its own session, with its log in `log/supervisor.log`.
///
/// # Errors
/// It cannot be started.
pub fn detached(
    program: &Path,
    options: &Options,
    paths: &GroupPaths,
) -> Result<Launched, LaunchError> {
    make_root(paths.root())?;
    make_private(&paths.log())?;
    let path = paths.log_file(SUPERVISOR);
    let (log, log_from) = open_log(paths).map_err(|error| LaunchError::Io(path, error))?;
    let process = supervisor(program, options, paths)
        .arg("--detached")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(log)
        .spawn()
        .map_err(|error| LaunchError::Io(program.to_owned(), error))?;
    Ok(Launched { process, paths: paths.clone(), log_from })
}

fn supervisor(program: &Path, options: &Options, paths: &GroupPaths) -> Command {
    let mut command = command(program);
    command.args(options.arguments()).env(ENV_HOME, paths.home());
    command
}

fn open_log(paths: &GroupPaths) -> io::Result<(File, u64)> {
    let path = paths.log_file(SUPERVISOR);
    let limits =
        Log { level: String::new(), json: false, file_bytes_max: LOG_BYTES_MAX, files_kept: 3 };
    let log = log_file::open(&path, &limits)?;
    let from = log_file::size(&path);
    Ok((log, from))
}

/// The process of the supervisor that has a group, also while it starts and does not listen yet.
pub fn holder(paths: &GroupPaths) -> Option<u32> {
    let mut file = File::open(paths.supervisor_lock()).ok()?;
    let is_held = matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock));
    let mut text = String::new();
    file.read_to_string(&mut text).ok().filter(|_| is_held)?;
    text.trim().parse().ok()
}

impl Launched {
    /// The supervisor's process.
    pub fn pid(&self) -> u32 {
        self.process.id()
    }

    /// Waits until the supervisor listens. It first waits for services of a previous supervisor
    /// that was killed, for as long as the longest stop deadline and 5 s more.
    ///
    /// # Errors
    /// It ended (a wrong configuration, a group that runs already), or does not listen in time.
    pub fn wait_listening(&mut self, timeout: Duration) -> Result<(), LaunchError> {
        let until = Instant::now() + timeout;
        let socket = self.paths.control_socket();
        loop {
            let answer = call(&socket, &Request::Status, ANSWER_PATIENCE);
            // Another supervisor may already be running the group.
            if let Ok(Reply::Status(status)) = answer
                && status.supervisor_pid == self.process.id()
            {
                return Ok(());
            }
            if let Ok(Some(status)) = self.process.try_wait() {
                let log = log_file::tail(&self.paths.log_file(SUPERVISOR), self.log_from);
                return Err(LaunchError::Ended(status, log));
            }
            if Instant::now() > until {
                let log = self.paths.log_file(SUPERVISOR);
                return Err(LaunchError::Late(timeout, log));
            }
            thread::sleep(ASK_EVERY);
        }
    }
}

/// Waits until every service of a running group is ready. Returns the supervisor's message.
///
/// # Errors
/// No group runs, or some service is given up or not ready in time.
pub fn wait_ready(paths: &GroupPaths, timeout: Duration) -> Result<String, LaunchError> {
    let wait_ms = u64::try_from(timeout.as_millis()).unwrap_or(u64::MAX);
    let request = Request::WaitReady { wait_ms };
    let socket = paths.control_socket();
    match call(&socket, &request, timeout + ANSWER_PATIENCE)? {
        Reply::Done { message } => Ok(message),
        other => Err(CallError::unintelligible(&socket, format!("{other:?}")).into()),
    }
}

fn indented(lines: &[String]) -> String {
    lines.iter().map(|line| format!("\n  {line}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_become_a_command_line() {
        let options = Options {
            group: GroupName::new("lab").unwrap(),
            config: "config".into(),
            profile: Some("ci".into()),
            set: vec![("group.scene".into(), "tools".into())],
            fresh: true,
        };
        let words = ["--group", "lab", "--config", "config", "--profile", "ci", "--set"];
        let words = words.into_iter().chain(["group.scene=tools", "--fresh"]);
        assert_eq!(options.arguments(), words.map(OsString::from).collect::<Vec<_>>());
    }

    #[test]
    fn absent_program_of_the_group_is_run_by_the_one_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let words = |program: &Path| format!("{:?}", command(program));
        assert_eq!(host_of(&file("whichone-arm")), None, "there is none");
        std::fs::write(file("whichone"), "").unwrap();
        assert_eq!(host_of(&file("whichone-arm")), Some(file("whichone")));
        assert!(
            words(&file("whichone-arm")).contains("whichone\"] \""),
            "its name is the argument 0"
        );
        for other in ["arm", "whichone", "whichone-arm/x"] {
            assert_eq!(host_of(&file(other)), None, "{other}");
        }
        std::fs::write(file("whichone-arm"), "").unwrap();
        assert_eq!(host_of(&file("whichone-arm")), None, "it runs by its own file");
        assert_eq!(host_of(Path::new("whichone-arm")), None, "a name is looked up in PATH");
    }
}
