//! Sessions of browsers whose person has shown a secret. They live through restarts of the gateway, in a file of its own
//! that holds hashes only, and end with the person's secret.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use roster::Name;
use safe_files::{read_private, replace_private};
use serde::{Deserialize, Serialize};
use service::console_link::random_secret;

use crate::people::{People, hash};

/// The file in the gateway's folder.
pub(crate) const FILE: &str = "sessions.json";
/// Most sessions; the oldest gives way.
const SESSIONS_MAX: usize = 512;
/// Life of a session, seconds.
pub(crate) const SESSION_S: u64 = 7 * 24 * 3_600;

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Session {
    /// Hash of the cookie's value.
    cookie: String,
    person: Name,
    /// Hash of the secret that began it.
    secret: String,
    began_s: u64,
}

/// All of them, oldest first.
#[derive(Debug)]
pub(crate) struct Sessions {
    file: PathBuf,
    open: Mutex<Vec<Session>>,
}

impl Sessions {
    /// Reads the file; one that cannot be read has none.
    pub(crate) fn open(file: PathBuf) -> Self {
        let text = read_private(&file).unwrap_or_default();
        let open = serde_json::from_str(&text).unwrap_or_default();
        Self { file, open: Mutex::new(open) }
    }

    /// Begins a session of the person with this secret; returns the person and the cookie's value.
    pub(crate) fn begin(&self, people: &People, secret: &str) -> Option<(Name, String)> {
        let person = people.with_secret(secret)?.clone();
        let value = random_secret().ok()?;
        let session = Session {
            cookie: hash(&value),
            person: person.clone(),
            secret: hash(secret),
            began_s: now_s(),
        };
        let mut open = self.lock();
        open.retain(|known| known.is_alive(people, session.began_s));
        let excess = (open.len() + 1).saturating_sub(SESSIONS_MAX);
        open.drain(..excess);
        open.push(session);
        self.store(&open);
        Some((person, value))
    }

    /// Returns the person of a session.
    pub(crate) fn person(&self, people: &People, value: &str) -> Option<Name> {
        let (cookie, now_s) = (hash(value), now_s());
        let open = self.lock();
        let mut known = open.iter().filter(|known| known.is_alive(people, now_s));
        known.find(|known| known.cookie == cookie).map(|known| known.person.clone())
    }

    /// Ends a session.
    pub(crate) fn end(&self, value: &str) {
        let cookie = hash(value);
        let mut open = self.lock();
        open.retain(|known| known.cookie != cookie);
        self.store(&open);
    }

    fn store(&self, open: &[Session]) {
        let text = serde_json::to_string(open).unwrap_or_default();
        // Without it the session ends with this process.
        if let Err(error) = replace_private(&self.file, &text) {
            tracing::warn!(%error, "a browser's session is not stored");
        }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Session>> {
        // Every change leaves a consistent list.
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Session {
    fn is_alive(&self, people: &People, now_s: u64) -> bool {
        now_s < self.began_s.saturating_add(SESSION_S)
            && people.has_secret(&self.person, &self.secret)
    }
}

fn now_s() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::people::{self, PeopleFile};

    #[test]
    fn sessions_live_through_a_restart_and_end_with_the_secret() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(people::FILE);
        let ann = Name::new("ann").unwrap();
        let secret = people::add(&path, &ann, &[], &[], false).unwrap().unwrap();
        let file = PeopleFile::open(path.clone()).unwrap();
        let sessions = Sessions::open(folder.path().join(FILE));
        assert_eq!(sessions.begin(&file.current(), "0123456789abcdef"), None);
        let (person, value) = sessions.begin(&file.current(), &secret).unwrap();
        assert_eq!(person, ann);
        let stored = std::fs::read_to_string(folder.path().join(FILE)).unwrap();
        assert!(!stored.contains(&value) && !stored.contains(&secret));
        let again = Sessions::open(folder.path().join(FILE));
        assert_eq!(again.person(&file.current(), &value), Some(ann.clone()));
        assert_eq!(again.person(&file.current(), &secret), None);
        people::add(&path, &ann, &[], &[], true).unwrap();
        assert_eq!(again.person(&file.current(), &value), None);
        sessions.end(&value);
        assert_eq!(std::fs::read_to_string(folder.path().join(FILE)).unwrap(), "[]");
    }

    #[test]
    fn sessions_are_bounded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(people::FILE);
        let ann = Name::new("ann").unwrap();
        let secret = people::add(&path, &ann, &[], &[], false).unwrap().unwrap();
        let people = People::load(&path).unwrap();
        let sessions = Sessions::open(folder.path().join(FILE));
        let first = sessions.begin(&people, &secret).unwrap().1;
        (0..SESSIONS_MAX).for_each(|_| drop(sessions.begin(&people, &secret)));
        assert_eq!(sessions.lock().len(), SESSIONS_MAX);
        assert_eq!(sessions.person(&people, &first), None);
    }
}
