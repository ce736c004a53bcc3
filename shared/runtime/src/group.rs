//! Name and folders of a group, and its identity among the processes of the machine.

use std::io;
use std::path::{Path, PathBuf};

/// Name of the environment variable that holds the group's name.
pub const ENV_GROUP: &str = "WHICHONE_GROUP";
/// … the folder that holds all groups.
pub const ENV_HOME: &str = "WHICHONE_HOME";
/// … the service's own name.
pub const ENV_SERVICE: &str = "WHICHONE_SERVICE";
/// … the service's incarnation.
pub const ENV_INCARNATION: &str = "WHICHONE_INCARNATION";
/// … the epoch of the group's journals.
pub const ENV_EPOCH: &str = "WHICHONE_EPOCH";
/// … the file descriptor whose end of file says that the supervisor is gone.
pub const ENV_LIFELINE_FD: &str = "WHICHONE_LIFELINE_FD";
/// … the log filter, as of `tracing_subscriber::EnvFilter`.
pub const ENV_LOG: &str = "WHICHONE_LOG";
/// … the form of the log lines: `json` for one object a line, anything else for text.
pub const ENV_LOG_FORMAT: &str = "WHICHONE_LOG_FORMAT";

/// Longest path of a Unix socket, without the final zero.
const SOCKET_PATH_MAX: usize = 107;

/// File system of the machine's shared memory.
pub const SHM: &str = "/dev/shm";

/// Letters of names in shared memory: one for each six bits.
const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
/// Letters that identify the group; equal at each of its starts.
const STABLE_LETTERS: usize = 6;
/// Letters drawn at each start: 96 bits, which another user can neither guess nor occupy. More do
/// not fit into the path of a socket.
const RANDOM_LETTERS: usize = 16;

/// A group's name: 1 to 32 of `a–z 0–9 -`, beginning with a letter or digit.
#[derive(Clone, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct GroupName(String);

/// Invalid name of a group, or no folder for it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GroupError {
    /// The name is not allowed.
    #[error("group name {0:?}: use 1 to 32 of a-z, 0-9 and -, beginning with a letter or digit")]
    Name(String),
    /// No home folder is known.
    #[error("no home folder: set {ENV_HOME} to a folder for the groups, or HOME")]
    Home,
    /// A socket's path would be too long for the operating system.
    #[error("{0}: {1} bytes are too long for a socket; set {ENV_HOME} to a shorter folder")]
    TooLong(PathBuf, usize),
}

impl GroupName {
    /// The default group.
    pub const DEFAULT: &'static str = "whichone";

    /// Checks a name.
    ///
    /// # Errors
    /// The name is invalid.
    pub fn new(name: &str) -> Result<Self, GroupError> {
        let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let fits = (1..=32).contains(&name.len()) && !name.starts_with('-');
        if fits && name.chars().all(allowed) {
            Ok(Self(name.to_owned()))
        } else {
            Err(GroupError::Name(name.to_owned()))
        }
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl std::fmt::Display for GroupName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::str::FromStr for GroupName {
    type Err = GroupError;

    fn from_str(name: &str) -> Result<Self, GroupError> {
        Self::new(name)
    }
}

impl TryFrom<String> for GroupName {
    type Error = GroupError;

    fn try_from(name: String) -> Result<Self, GroupError> {
        Self::new(&name)
    }
}

impl From<GroupName> for String {
    fn from(name: GroupName) -> String {
        name.0
    }
}

/// The folders and files of one group. `run/` exists only while the group runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroupPaths {
    name: GroupName,
    root: PathBuf,
}

impl GroupPaths {
    /// The group's place: `$WHICHONE_HOME/<name>`, else `$XDG_STATE_HOME/whichone/<name>`, else
    /// `~/.local/state/whichone/<name>`.
    ///
    /// # Errors
    /// No home folder, or one whose path is too long for sockets.
    pub fn resolve(name: &GroupName) -> Result<Self, GroupError> {
        let var = |key| std::env::var_os(key).filter(|v| !v.is_empty()).map(PathBuf::from);
        let home = var(ENV_HOME)
            .or_else(|| var("XDG_STATE_HOME").map(|state| state.join("whichone")))
            .or_else(|| var("HOME").map(|home| home.join(".local/state/whichone")))
            .ok_or(GroupError::Home)?;
        Self::in_home(&home, name)
    }

    /// The group's place in the given home folder.
    ///
    /// # Errors
    /// A path that is too long for sockets.
    pub fn in_home(home: &Path, name: &GroupName) -> Result<Self, GroupError> {
        let home = std::path::absolute(home).unwrap_or_else(|_| home.to_owned());
        let paths = Self { root: home.join(name.as_str()), name: name.clone() };
        let longest = paths.notify_socket("a-service-of-a-user", u32::MAX);
        match longest.as_os_str().len() {
            bytes if bytes > SOCKET_PATH_MAX => Err(GroupError::TooLong(longest, bytes)),
            _ => Ok(paths),
        }
    }

    /// Paths below a path that cannot be a folder.
    pub(crate) fn nowhere() -> Self {
        Self {
            root: PathBuf::from("/dev/null/whichone"),
            name: GroupName(GroupName::DEFAULT.to_owned()),
        }
    }

    /// The group's name.
    pub fn name(&self) -> &GroupName {
        &self.name
    }

    /// The folder that holds all groups.
    pub fn home(&self) -> &Path {
        self.root.parent().unwrap_or(&self.root)
    }

    /// The group's folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Sockets, the settings in force, and the name of the shared memory; gone after `down`.
    pub fn run(&self) -> PathBuf {
        self.root.join("run")
    }

    /// Logs of the services and the supervisor.
    pub fn log(&self) -> PathBuf {
        self.root.join("log")
    }

    /// Journals.
    pub fn journal(&self) -> PathBuf {
        self.root.join("journal")
    }

    /// The settings by which the journals were written.
    pub fn kept_settings(&self) -> PathBuf {
        self.journal().join("settings")
    }

    /// Decisions that the policy has worked out; a cache, which may be deleted.
    pub fn policies(&self) -> PathBuf {
        self.root.join("policies")
    }

    /// The recogniser's dictionary and language model of the scene; a cache, which may be deleted.
    pub fn recogniser(&self) -> PathBuf {
        self.root.join("recogniser")
    }

    /// Recordings of the group's topics.
    pub fn recordings(&self) -> PathBuf {
        self.root.join("recordings")
    }

    /// Flights: the inputs and statements of the services.
    pub fn flights(&self) -> PathBuf {
        self.root.join("flight")
    }

    /// The data of studies with people, if no other folder is set; never deleted.
    pub fn study(&self) -> PathBuf {
        self.root.join("study")
    }

    /// A service's journal.
    pub fn journal_file(&self, service: &str) -> PathBuf {
        self.journal().join(format!("{service}.journal"))
    }

    /// A service's log.
    pub fn log_file(&self, service: &str) -> PathBuf {
        self.log().join(format!("{service}.log"))
    }

    /// The file that holds the [epoch](crate::epoch) and the set of journals.
    pub fn epoch_file(&self) -> PathBuf {
        self.root.join("epoch")
    }

    /// Held while the journals' file `epoch` is changed.
    pub fn epoch_lock(&self) -> PathBuf {
        self.root.join("epoch.lock")
    }

    /// Held by the supervisor for its life.
    pub fn supervisor_lock(&self) -> PathBuf {
        self.root.join("supervisor.lock")
    }

    /// Share-locked by every service for its life, so that the end of the last one can be awaited.
    pub fn alive_lock(&self) -> PathBuf {
        self.root.join("alive.lock")
    }

    /// Held by the supervisor while it removes a dead service's shared memory; the successor waits
    /// for it.
    pub fn cleanup_lock(&self) -> PathBuf {
        self.run().join("cleanup.lock")
    }

    /// The supervisor's control socket.
    pub fn control_socket(&self) -> PathBuf {
        self.run().join("control.sock")
    }

    /// The arm's socket for orders to the motion stop.
    pub fn stop_socket(&self) -> PathBuf {
        self.run().join("stop.sock")
    }

    /// A motion stop that no arm has confirmed. It outlives the group and holds for the next arm.
    pub fn kept_stop(&self) -> PathBuf {
        self.root.join("stop.kept")
    }

    /// The services that an operator has put down. It outlives a supervisor that is killed.
    pub fn put_down(&self) -> PathBuf {
        self.root.join("put_down")
    }

    /// The address of the console, while it serves one.
    pub fn console_url(&self) -> PathBuf {
        self.run().join("console.url")
    }

    /// Returns the socket for notifications of one incarnation of a service.
    pub fn notify_socket(&self, service: &str, incarnation: u32) -> PathBuf {
        self.run().join(format!("n-{service}-{incarnation}"))
    }

    /// The file that names the group's shared memory, while there is some. Only its owner can read
    /// it, and nothing else says the name before the first segment exists.
    pub fn shm_name_file(&self) -> PathBuf {
        self.run().join("shm")
    }

    /// File with the services that topics wake beyond their own table ([`crate::wakes`]).
    pub fn wakes_file(&self) -> PathBuf {
        self.run().join("wakes")
    }

    /// Prefix of every name of the group in shared memory, at each start: two groups differ even if
    /// they share a name in different homes.
    pub fn shm_stem(&self) -> String {
        let mut hash = scene::StableHash::default();
        hash.bytes(self.root.as_os_str().as_encoded_bytes());
        format!("wo{}", letters(&hash.value().to_le_bytes()[..STABLE_LETTERS]))
    }

    /// Draws an unpredictable name for shared memory.
    ///
    /// # Errors
    /// The operating system has no random numbers.
    pub(crate) fn draw_shm_name(&self) -> io::Result<ShmName> {
        let mut random = [0; RANDOM_LETTERS];
        rustix::rand::getrandom(&mut random, rustix::rand::GetRandomFlags::empty())?;
        Ok(ShmName(self.shm_stem() + &letters(&random)))
    }

    /// Returns the name of the running group's shared memory.
    ///
    /// # Errors
    /// The group is not running, or the file that names it is damaged.
    pub fn shm_name(&self) -> io::Result<ShmName> {
        let name = std::fs::read_to_string(self.shm_name_file())?;
        let is_whole = name.len() == 2 + STABLE_LETTERS + RANDOM_LETTERS
            && name.starts_with(&self.shm_stem())
            && name.bytes().all(|byte| LETTERS.contains(&byte));
        if !is_whole {
            let what = format!("{}: damaged", self.shm_name_file().display());
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        Ok(ShmName(name))
    }
}

/// Name of a group's shared memory for one start: prefix of all its segments, and name of the
/// folder with iceoryx2's other files. The folder is here because of its sockets, whose paths must
/// be short.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShmName(String);

impl ShmName {
    /// Prefix of the segments.
    pub fn prefix(&self) -> &str {
        &self.0
    }

    /// The folder of iceoryx2's other files.
    pub fn folder(&self) -> PathBuf {
        Path::new(SHM).join(&self.0)
    }
}

fn letters(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| char::from(LETTERS[usize::from(byte % 64)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_checked() {
        assert!(GroupName::new("lab-2").is_ok());
        for bad in ["", "-a", "Lab", "a/b", "a b", &"x".repeat(33)] {
            assert_eq!(GroupName::new(bad), Err(GroupError::Name(bad.to_owned())));
        }
    }

    #[test]
    fn groups_of_different_homes_never_meet() {
        let name = GroupName::new("lab").unwrap();
        let one = GroupPaths::in_home(Path::new("/a"), &name).unwrap();
        let two = GroupPaths::in_home(Path::new("/b"), &name).unwrap();
        assert_ne!(one.shm_stem(), two.shm_stem());
    }

    #[test]
    fn name_in_shared_memory_differs_at_each_start_and_leaves_room_for_sockets() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        let (one, two) = (paths.draw_shm_name().unwrap(), paths.draw_shm_name().unwrap());
        assert_ne!(one, two);
        assert!(one.prefix().starts_with(&paths.shm_stem()));
        // iceoryx2 adds the prefix, a number of 128 bits and a suffix.
        let socket = one.folder().join(format!("{}{}.event", one.prefix(), u128::MAX));
        assert!(socket.as_os_str().len() <= SOCKET_PATH_MAX);

        std::fs::create_dir_all(paths.run()).unwrap();
        assert_eq!(paths.shm_name().unwrap_err().kind(), io::ErrorKind::NotFound);
        std::fs::write(paths.shm_name_file(), one.prefix()).unwrap();
        assert_eq!(paths.shm_name().unwrap(), one);
        std::fs::write(paths.shm_name_file(), "wo../../x").unwrap();
        assert_eq!(paths.shm_name().unwrap_err().kind(), io::ErrorKind::InvalidData);
    }

    #[test]
    fn home_path_too_long_for_sockets_is_rejected() {
        let deep = PathBuf::from(format!("/{}", "x".repeat(90)));
        let error = GroupPaths::in_home(&deep, &GroupName::new("lab").unwrap()).unwrap_err();
        assert!(error.to_string().contains(ENV_HOME));
    }
}
