//! The journals of a group, which know one another: which epoch they are of, which of them exist,
//! and which numbers are over because a journal was set aside.
//!
//! | the group's file `epoch` | |
//! |---|---|
//! | epoch | since the last fresh start |
//! | per service: generation, exists | a journal that exists must be there, whole, and of this generation |
//! | numbers over | no number up to here is ever given again |
//!
//! Invariant: a service appends its first record only after the file says that its journal exists.
//! So a journal that never held anything and a lost one are never confused.
//!
//! The file has one writer at a time, by a lock: the supervisor before it starts a service, a
//! service that makes its journal, and [`set_aside`] while the group is down. It is replaced
//! atomically and synced.

mod agreement;

pub use agreement::{Behind, agree, check_agreement};

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use journal::{Ending, Header, Journal, JournalOpenError, KEPT, Recovered};
use messages::Service;
use rustix::fs::{FlockOperation, flock};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::exit::{Exit, Failure};
use crate::group::GroupPaths;
use crate::lifecycle::Environment;
use crate::{SetAside, Span, clock, epoch};

/// Numbers that each setting aside skips: more than a journal ever gives, so that a number which
/// only a lost journal, a page or a client knew is never given again.
pub const NUMBERS_SKIPPED: u64 = 1_000_000_000;

/// Timeout for a journal's or the set's lock: a previous incarnation may still be ending.
const LOCK_PATIENCE: Span = Span::from_ms(3_000);

/// The journals of a group.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JournalSet {
    /// Epoch of all the journals.
    pub epoch: u64,
    /// Utterances, interactions, prompts and acts up to this number are over.
    pub numbers_over: u64,
    journals: BTreeMap<String, Entry>,
}

/// One service's journal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    generation: u64,
    exists: bool,
}

/// A journal that cannot be used, with the way out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Unusable {
    message: String,
    /// Whether the journal is of another version or group, rather than lost or damaged.
    pub is_foreign: bool,
}

/// A journal with its records, and the numbers that are over.
pub(crate) type Opened<R> = (Journal<R>, Recovered<R>, Option<SetAside>);

impl JournalSet {
    /// The set of a new epoch: no journal exists.
    pub fn new(epoch: u64) -> Self {
        let first =
            |service: Service| (service.name().to_owned(), Entry { generation: 1, exists: false });
        Self { epoch, numbers_over: 0, journals: Service::JOURNALED.map(first).into() }
    }

    /// Reads the set; `None` before the first start.
    ///
    /// # Errors
    /// The file cannot be read, is damaged or of another version, or is missing although there are
    /// journals (`InvalidData`).
    pub fn load(paths: &GroupPaths) -> io::Result<Option<Self>> {
        let path = paths.epoch_file();
        let failed = |kind, what: &str| io::Error::new(kind, format!("{}: {what}", path.display()));
        let invalid = |what: &str| {
            let help = "help: start over with `whichone up --fresh`, which keeps the old journals";
            failed(ErrorKind::InvalidData, &format!("{what}; {help}"))
        };
        // Journals of an earlier format have no set; they are refused by their own headers.
        let has_set = |service: &Service| {
            let found = journal::inspect(&paths.journal_file(service.name()));
            !matches!(found, Err(JournalOpenError::Missing | JournalOpenError::Foreign(_)))
        };
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(failed(error.kind(), &error.to_string()));
            }
            Err(_) if Service::JOURNALED.iter().any(has_set) => {
                return Err(invalid("the file is missing beside journals that it describes"));
            }
            Err(_) => return Ok(None),
            Ok(text) => text,
        };
        let read = epoch::whole_line(&text).and_then(|line| serde_json::from_str(line).ok());
        let damaged = "expected the set of journals, found damage or another version";
        read.map(Some).ok_or_else(|| invalid(damaged))
    }

    /// Writes the set.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, paths: &GroupPaths) -> io::Result<()> {
        let line = serde_json::to_string(self)?;
        safe_files::replace_private_synced(&paths.epoch_file(), epoch::with_checksum(&line))
    }

    /// Returns every journal that cannot be used.
    pub fn check(&self, paths: &GroupPaths) -> Vec<Unusable> {
        let names = self.journals.iter();
        let unusable = |(service, entry): (&String, &Entry)| {
            let path = paths.journal_file(service);
            let error = self.check_file(&path, paths, *entry).err()?;
            Some(Unusable::new(&path, service, &error))
        };
        names.filter_map(unusable).collect()
    }

    fn check_file(
        &self,
        path: &Path,
        paths: &GroupPaths,
        entry: Entry,
    ) -> Result<(), JournalOpenError> {
        let found = match journal::inspect(path) {
            Err(JournalOpenError::Missing) if !entry.exists => return Ok(()),
            found => found?,
        };
        found.header.check(&self.header(&found.header.record, paths, entry))?;
        match found.ending {
            Ending::Corrupt { at, seq, .. } => Err(JournalOpenError::Corrupt { at, seq }),
            Ending::Whole | Ending::Torn { .. } => Ok(()),
        }
    }

    fn header(&self, record: &str, paths: &GroupPaths, entry: Entry) -> Header {
        Header {
            record: record.to_owned(),
            group: paths.name().to_string(),
            epoch: self.epoch,
            generation: entry.generation,
        }
    }

    /// The set of a new epoch in the place of journals that are put aside. An arm whose stop was
    /// latched, or is not known not to be, starts without its own memory: it waits for a person.
    pub fn renewed(paths: &GroupPaths, old: Option<&Self>, epoch: u64) -> Self {
        let mut set = Self::new(epoch);
        let (arm, was_free) = (Service::Arm.name(), || agreement::is_free(paths) == Some(true));
        let had_journal = old.is_some_and(|old| old.journals.get(arm).is_some_and(|it| it.exists));
        if (had_journal || paths.journal_file(arm).exists()) && !was_free() {
            set.lose(&[Service::Arm], 1);
        }
        set
    }

    /// Notes that the journals of these services are gone, and that as many numbers more are over.
    fn lose(&mut self, services: &[Service], numbers: u64) {
        for service in services {
            let entry = self.entry(service.name());
            *entry = Entry { generation: entry.generation + 1, exists: false };
        }
        self.numbers_over = self.numbers_over.saturating_add(numbers);
    }

    fn entry(&mut self, service: &str) -> &mut Entry {
        let first = Entry { generation: 1, exists: false };
        self.journals.entry(service.to_owned()).or_insert(first)
    }
}

impl Unusable {
    fn new(path: &Path, service: &str, error: &JournalOpenError) -> Self {
        let help = match error.is_lost() {
            true => format!("; help: `whichone journal set-aside {service}`, with the group down"),
            false => String::new(),
        };
        let is_foreign =
            matches!(error, JournalOpenError::Foreign(_) | JournalOpenError::Undecodable { .. });
        Self { message: format!("{}: {error}{help}", path.display()), is_foreign }
    }

    /// Returns the exit code for this error.
    pub fn exit(&self) -> Exit {
        if self.is_foreign { Exit::Config } else { Exit::Storage }
    }
}

/// Opens a service's journal, or makes it if the set has none yet. Journals of the `older` kinds of
/// record are continued.
pub(crate) fn open<R: Serialize + DeserializeOwned>(
    environment: &Environment,
    service: &str,
    record: &str,
    older: &[&str],
) -> Result<Opened<R>, Failure> {
    let paths = &environment.paths;
    let file = paths.epoch_file();
    let none = || Failure::new(Exit::Storage, format!("{}: the file is missing", file.display()));
    let load =
        || JournalSet::load(paths).map_err(|error| Failure::new(Exit::Storage, error.to_string()));
    let mut set = load()?.ok_or_else(none)?;
    if set.epoch != environment.epoch.0 {
        let (ours, theirs) = (environment.epoch, set.epoch);
        let what =
            format!("expected epoch {ours}, found {theirs}; help: `whichone down`, then `up`");
        return Err(Failure::new(Exit::Config, format!("{}: {what}", file.display())));
    }
    let entry = *set.entry(service);
    let path = paths.journal_file(service);
    let header = set.header(record, paths, entry);
    let opened = patiently(|| match entry.exists {
        true => Journal::take_over(&path, &header, older),
        false => Journal::open_or_create(&path, &header),
    });
    let (journal, recovered) = opened.map_err(|error| {
        let unusable = Unusable::new(&path, service, &error);
        Failure::new(unusable.exit(), unusable.to_string())
    })?;
    if !entry.exists {
        // Before the first record: from now on its absence is a loss.
        let _lock = lock(paths).map_err(|error| Failure::file(&paths.epoch_lock(), &error))?;
        set = load()?.ok_or_else(none)?;
        set.entry(service).exists = true;
        set.save(paths).map_err(|error| Failure::file(&file, &error))?;
    }
    let is_own = entry.generation > 1 && recovered.records.is_empty();
    let over = (set.numbers_over > 0).then_some(SetAside { over: set.numbers_over, is_own });
    Ok((journal, recovered, over))
}

fn patiently<T>(
    mut open: impl FnMut() -> Result<T, JournalOpenError>,
) -> Result<T, JournalOpenError> {
    let until = clock::now() + LOCK_PATIENCE;
    loop {
        match open() {
            Err(JournalOpenError::Locked { .. }) if clock::now() < until => {
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
            opened => return opened,
        }
    }
}

/// Locks the set for a change; each takes milliseconds.
fn lock(paths: &GroupPaths) -> io::Result<File> {
    let file = safe_files::open_lock(&paths.epoch_lock())?;
    let until = clock::now() + LOCK_PATIENCE;
    loop {
        match flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Err(rustix::io::Errno::WOULDBLOCK) if clock::now() < until => {
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
            locked => return locked.map(|()| file).map_err(io::Error::from),
        }
    }
}

/// Moves the journals of these services into a folder of their own, with their older parts, and
/// lets every number so far be over: each service then continues above it, and work in progress
/// ends. Returns the folder; `None` without a file to move.
///
/// A crash in between leaves a journal that is missing, for which this is the way out again.
///
/// # Errors
/// The group is running or was never started, or a file cannot be moved.
pub fn set_aside(paths: &GroupPaths, services: &[Service]) -> Result<Option<PathBuf>, Failure> {
    let none = || Failure::new(Exit::NotReached, format!("group {} has no journals", paths.name()));
    let file = paths.epoch_file();
    let load =
        || JournalSet::load(paths).map_err(|error| Failure::new(Exit::Storage, error.to_string()));
    load()?.ok_or_else(none)?;
    let _locks = [paths.supervisor_lock(), paths.alive_lock()]
        .map(|path| lock_idle(paths, &path))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let mut set = load()?.ok_or_else(none)?;
    let parts: Vec<_> = services.iter().flat_map(|service| parts(paths, *service)).collect();
    let folder = match parts.is_empty() {
        true => None,
        false => Some(move_parts(paths, &parts).map_err(|e| Failure::file(paths.root(), &e))?),
    };
    set.lose(services, NUMBERS_SKIPPED);
    set.save(paths).map_err(|error| Failure::file(&file, &error))?;
    Ok(folder)
}

/// Takes a lock that a running group holds.
fn lock_idle(paths: &GroupPaths, path: &Path) -> Result<File, Failure> {
    let file = safe_files::open_lock(path).map_err(|error| Failure::file(path, &error))?;
    flock(&file, FlockOperation::NonBlockingLockExclusive).map_err(|_| {
        let what = format!("group {} is running; help: `whichone down` first", paths.name());
        Failure::new(Exit::NotReached, what)
    })?;
    Ok(file)
}

/// The files of a service's journal, oldest last.
fn parts(paths: &GroupPaths, service: Service) -> impl Iterator<Item = PathBuf> {
    let file = paths.journal_file(service.name());
    let older = (1..=KEPT).map(|n| safe_files::suffixed(&file, n)).collect::<Vec<_>>();
    std::iter::once(file).chain(older).filter(|path| path.exists())
}

/// Moves files into a new folder, and returns it.
fn move_parts(paths: &GroupPaths, parts: &[PathBuf]) -> io::Result<PathBuf> {
    let folder = new_folder(paths.root())?;
    for part in parts {
        fs::rename(part, folder.join(part.file_name().unwrap_or_default()))?;
    }
    for changed in [&folder, &paths.journal(), paths.root()] {
        File::open(changed)?.sync_all()?;
    }
    Ok(folder)
}

/// Makes a folder `set-aside-SECONDS`, which is never one that exists: its files would be replaced.
fn new_folder(root: &Path) -> io::Result<PathBuf> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let mut second = now.map_or(0, |time| time.as_secs());
    loop {
        let folder = root.join(format!("set-aside-{second}"));
        match fs::DirBuilder::new().mode(0o700).create(&folder) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => second += 1,
            made => return made.map(|()| folder),
        }
    }
}

#[cfg(test)]
mod tests;
