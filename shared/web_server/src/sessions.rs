//! Sessions of browsers that have shown a secret: a random name in a cookie. They live through restarts of the server, in a
//! file of its own that holds hashes only, and end with the secret.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use axum::http::{HeaderMap, header};
use safe_files::{read_private, replace_private};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use service::console_link::random_secret;
use sha2::{Digest, Sha256};

use crate::request::text;

/// Before the hash of a secret.
pub const HASH: &str = "sha256:";

/// Returns what is stored of a secret. Secrets are random numbers of 128 bits, so that a fast hash is enough; a word of the
/// owner's own lies beside it in the clear. Hashes are compared: how long that takes says nothing about a secret.
pub fn hash(secret: &str) -> String {
    let digest = Sha256::digest(secret.as_bytes());
    let hex = digest.iter().map(|byte| format!("{byte:02x}"));
    std::iter::once(HASH.to_owned()).chain(hex).collect()
}

/// Returns the wall clock's time, Unix seconds.
pub fn unix_s() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs()
}

/// The rules of a server's sessions.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// First part of the cookie's name.
    pub cookie: &'static str,
    /// Most sessions; the oldest of whoever has most gives way.
    pub most: usize,
    /// Most sessions of one person; the oldest gives way.
    pub each: usize,
    /// Life of a session, seconds.
    pub life_s: u64,
}

/// A session of person `P`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Session<P> {
    /// Hash of the cookie's value.
    cookie: String,
    person: P,
    /// Hash of the secret that began it.
    secret: String,
    began_s: u64,
}

/// What a server calls a session: the hash of its cookie's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SessionName(String);

/// All of them, oldest first.
#[derive(Debug)]
pub struct Sessions<P> {
    rules: Rules,
    file: PathBuf,
    open: Mutex<Vec<Session<P>>>,
}

impl<P: Clone + PartialEq + Serialize + DeserializeOwned> Sessions<P> {
    /// Reads the file; one that cannot be read has none.
    pub fn open(rules: Rules, file: PathBuf) -> Self {
        let text = read_private(&file).unwrap_or_default();
        let open = serde_json::from_str(&text).unwrap_or_default();
        Self { rules, file, open: Mutex::new(open) }
    }

    /// Begins a session of a person who has shown this secret; returns the cookie's value. Ends those for which
    /// `is_valid` does not hold: it is asked for a person and the hash of the secret that began the session.
    pub fn begin(
        &self,
        person: P,
        secret: &str,
        now_s: u64,
        is_valid: impl Fn(&P, &str) -> bool,
    ) -> Option<String> {
        let value = random_secret().ok()?;
        let session =
            Session { cookie: hash(&value), person, secret: hash(secret), began_s: now_s };
        let mut open = self.lock();
        open.retain(|known| self.is_alive(known, now_s, &is_valid));
        open.push(session);
        self.make_room(&mut open);
        self.store(&open);
        Some(value)
    }

    /// Ends the oldest sessions of whoever has too many.
    fn make_room(&self, open: &mut Vec<Session<P>>) {
        loop {
            let of = |person: &P| open.iter().filter(|it| it.person == *person).count();
            let Some((at, count)) = (0..open.len())
                .map(|at| (at, of(&open[at].person)))
                .rev()
                .max_by_key(|(_, count)| *count)
            else {
                return;
            };
            if open.len() <= self.rules.most && count <= self.rules.each {
                return;
            }
            open.remove(at);
        }
    }

    /// Returns the person of a request by its cookie, and the session's name for [`Sessions::lasts`], if the session is
    /// valid as in [`Sessions::begin`].
    pub fn person(
        &self,
        headers: &HeaderMap,
        now_s: u64,
        is_valid: impl Fn(&P, &str) -> bool,
    ) -> Option<(P, SessionName)> {
        let said: Vec<String> = self.said(headers).map(hash).collect();
        let open = self.lock();
        let mut known = open.iter().filter(|known| said.contains(&known.cookie));
        let alive = known.find(|known| self.is_alive(known, now_s, &is_valid));
        alive.map(|known| (known.person.clone(), SessionName(known.cookie.clone())))
    }

    /// Returns whether a session has neither ended nor expired, and is valid as in [`Sessions::begin`].
    pub fn lasts(
        &self,
        session: &SessionName,
        now_s: u64,
        is_valid: impl Fn(&P, &str) -> bool,
    ) -> bool {
        let open = self.lock();
        let mut known = open.iter().filter(|known| known.cookie == session.0);
        known.any(|known| self.is_alive(known, now_s, &is_valid))
    }

    /// Ends the session of a request.
    pub fn end(&self, headers: &HeaderMap) {
        let said: Vec<String> = self.said(headers).map(hash).collect();
        if said.is_empty() {
            return;
        }
        let mut open = self.lock();
        open.retain(|known| !said.contains(&known.cookie));
        self.store(&open);
    }

    /// Returns the cookie with a value, or without a value one that ends at once, for the browser that makes a request.
    pub fn cookie(&self, headers: &HeaderMap, value: Option<&str>, is_https: bool) -> String {
        let (name, life_s) = (self.name(headers), value.map_or(0, |_| self.rules.life_s));
        let (value, secure) = (value.unwrap_or_default(), if is_https { "; Secure" } else { "" });
        format!("{name}={value}; Path=/; Max-Age={life_s}; HttpOnly; SameSite=Strict{secure}")
    }

    /// The cookie's name. Browsers send a cookie to every port of a host, so it names the port that the browser sees:
    /// servers on one host, also behind tunnels, do not take each other's place.
    fn name(&self, headers: &HeaderMap) -> String {
        let port = text(headers, &header::HOST).and_then(|host| host.rsplit_once(':'));
        let port = port.and_then(|(_, port)| port.parse::<u16>().ok()).unwrap_or(0);
        format!("{}_{port}", self.rules.cookie)
    }

    fn said<'a>(&self, headers: &'a HeaderMap) -> impl Iterator<Item = &'a str> {
        let wanted = self.name(headers);
        let all = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
        all.flat_map(|cookies| cookies.split(';')).filter_map(move |pair| {
            let (name, value) = pair.trim().split_once('=')?;
            (name == wanted).then_some(value)
        })
    }

    fn is_alive(
        &self,
        session: &Session<P>,
        now_s: u64,
        is_valid: impl Fn(&P, &str) -> bool,
    ) -> bool {
        now_s < session.began_s.saturating_add(self.rules.life_s)
            && is_valid(&session.person, &session.secret)
    }

    fn store(&self, open: &[Session<P>]) {
        let text = serde_json::to_string(open).unwrap_or_default();
        // Without it the session ends with this process.
        if let Err(error) = replace_private(&self.file, &text) {
            tracing::warn!(%error, "a browser's session is not stored");
        }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Session<P>>> {
        // Every change leaves a consistent list.
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: Rules = Rules { cookie: "test", most: 3, each: 2, life_s: 100 };
    const SECRET: &str = "0123456789abcdef";

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (name.parse().unwrap(), value.parse().unwrap())).collect()
    }

    fn with(value: &str) -> HeaderMap {
        let cookies = format!("a=b; test_80=other; test_80={value}");
        headers(&[("host", "robot:80"), ("cookie", &cookies)])
    }

    #[test]
    fn sessions_are_bounded_and_end() {
        let folder = tempfile::tempdir().unwrap();
        let sessions = Sessions::open(RULES, folder.path().join("sessions"));
        let begin = |number: u64| sessions.begin(number, SECRET, number, |_, _| true).unwrap();
        let values = [0, 1, 2, 3].map(begin);
        let person = |value: &str, now_s| {
            let known = sessions.person(&with(value), now_s, |_, _| true);
            known.map(|(person, _)| person)
        };
        assert_eq!([0, 1, 3].map(|n| person(&values[n], 100)), [None, Some(1), Some(3)]);
        assert_eq!([100, 101].map(|now_s| person(&values[1], now_s)), [Some(1), None]);
        assert_eq!(sessions.person(&with(&values[3]), 5, |_, _| false), None, "not valid");
        let (_, name) = sessions.person(&with(&values[3]), 5, |_, _| true).unwrap();
        let lasts = |now_s, is_valid| sessions.lasts(&name, now_s, |_, _| is_valid);
        assert_eq!([lasts(5, true), lasts(5, false), lasts(103, true)], [true, false, false]);
        sessions.end(&with(&values[3]));
        assert_eq!((person(&values[3], 5), lasts(5, true)), (None, false));
        assert_eq!(sessions.lock().len(), 2);
    }

    #[test]
    fn logins_of_one_person_end_no_other_persons_sessions() {
        let folder = tempfile::tempdir().unwrap();
        let sessions = Sessions::open(RULES, folder.path().join("sessions"));
        let begin =
            |person: &str| sessions.begin(person.to_owned(), SECRET, 1, |_, _| true).unwrap();
        let person = |value: &str| sessions.person(&with(value), 2, |_, _| true).map(|it| it.0);
        let operator = begin("ann");
        let viewer: Vec<String> = (0..520).map(|_| begin("bob")).collect();
        assert_eq!(person(&operator).as_deref(), Some("ann"));
        let alive = viewer.iter().filter(|value| person(value).is_some()).count();
        assert_eq!((alive, person(&viewer[519]).as_deref()), (2, Some("bob")));
        // Where there are too many in all, whoever has most gives way.
        begin("eve");
        assert_eq!(person(&operator).as_deref(), Some("ann"));
        assert_eq!(viewer.iter().filter(|value| person(value).is_some()).count(), 1);
    }

    #[test]
    fn cookies_are_hidden_and_name_the_port() {
        let folder = tempfile::tempdir().unwrap();
        let sessions = Sessions::<()>::open(RULES, folder.path().join("sessions"));
        let (port, none) = (headers(&[("host", "robot:80")]), HeaderMap::new());
        let rules = "Path=/; Max-Age=100; HttpOnly; SameSite=Strict";
        assert_eq!(sessions.cookie(&port, Some("v"), false), format!("test_80=v; {rules}"));
        assert_eq!(sessions.cookie(&none, Some("v"), true), format!("test_0=v; {rules}; Secure"));
        assert!(sessions.cookie(&none, None, true).starts_with("test_0=; Path=/; Max-Age=0; "));
    }
}
