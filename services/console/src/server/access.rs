//! Access rules: the console's own pages, the token, and the sessions of browsers that have shown it.
//!
//! Decided by a request's headers. A session is a random name in a cookie; it lives through restarts of
//! the console, in a file of the console's own; the token's file belongs to the owner of the group.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::http::{HeaderMap, header};
use safe_files::{read_private, replace_private, replace_private_synced};
use service::console_link::{is_token, random_secret};

/// Most sessions; the oldest gives way.
const SESSIONS_MAX: usize = 64;
/// Life of a session, seconds.
const SESSION_S: u64 = 30 * 24 * 3_600;

/// Who may use the page.
#[derive(Debug)]
pub struct Access(Option<Guard>);

/// The token, and the sessions that were begun with it.
#[derive(Debug)]
struct Guard {
    token: String,
    sessions_file: PathBuf,
    sessions: Mutex<Vec<Session>>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Session {
    name: String,
    /// When it began, Unix seconds.
    began_s: u64,
}

impl Access {
    /// Makes the rules for pages that everyone on this machine may use.
    pub fn open() -> Self {
        Self(None)
    }

    /// Makes the rules for those who have the token. A file that others can read, or that has no token, is
    /// replaced by one with a new token.
    ///
    /// # Errors
    /// The file of the token cannot be written.
    pub fn by_token(file: &Path, sessions_file: PathBuf) -> io::Result<Self> {
        let text = read_private(file).unwrap_or_default();
        let token = text.lines().next().filter(|token| is_token(token)).map(str::to_owned);
        let token = match token {
            Some(token) => token,
            None => {
                if file.exists() {
                    tracing::warn!(file = %file.display(), "other users could read the token, or it is none: replaced");
                }
                let token = random_secret()?;
                replace_private_synced(file, format!("{token}\n"))?;
                token
            }
        };
        let sessions = Mutex::new(read(&sessions_file, &token));
        Ok(Self(Some(Guard { token, sessions_file, sessions })))
    }

    /// Returns whether the request is addressed to this console. Without a token it is only reached
    /// from this machine; another host name here is an attack by another site (DNS rebinding).
    pub fn is_addressed(&self, headers: &HeaderMap) -> bool {
        let Some(host) = text(headers, &header::HOST) else { return false };
        self.0.is_some() || is_this_machine(host)
    }

    /// Returns whether the request carries the token as a bearer, or the cookie of a session.
    pub fn is_known(&self, headers: &HeaderMap, now_s: u64) -> bool {
        let Some(guard) = &self.0 else { return true };
        bearer(headers).is_some_and(|said| same(said, &guard.token))
            || guard.has_session(headers, now_s)
    }

    /// Returns why a request is refused that is not known: it carries no token, or a wrong one, be it in its
    /// address.
    pub fn refusal(headers: &HeaderMap, has_token_in_address: bool) -> &'static str {
        match has_token_in_address || bearer(headers).is_some() {
            true => "wrong token",
            false => "token required",
        }
    }

    /// Returns whether this is the token. Without one, any word is.
    pub fn is_token(&self, said: &str) -> bool {
        self.0.as_ref().is_none_or(|guard| same(said, &guard.token))
    }

    /// Returns whether the request comes from a page of this console: its origin is its host.
    pub fn is_own(headers: &HeaderMap) -> bool {
        let (Some(origin), Some(host)) = (Self::origin(headers), text(headers, &header::HOST))
        else {
            return false;
        };
        let place = origin.strip_prefix("http://").or(origin.strip_prefix("https://"));
        place.is_some_and(|place| place.eq_ignore_ascii_case(host))
    }

    /// Returns the origin of the page that makes the request.
    pub fn origin(headers: &HeaderMap) -> Option<&str> {
        text(headers, &header::ORIGIN)
    }

    /// Begins a session for a browser that shows the token; returns its cookie.
    pub fn log_in(&self, headers: &HeaderMap, said: &str, now_s: u64) -> Option<String> {
        let guard = self.0.as_ref().filter(|guard| same(said, &guard.token))?;
        let name = random_secret().ok()?;
        guard.begin(Session { name: name.clone(), began_s: now_s });
        let cookie = cookie_name(headers);
        Some(format!("{cookie}={name}; Path=/; Max-Age={SESSION_S}; HttpOnly; SameSite=Strict"))
    }
}

/// Returns the token that a program sends.
fn bearer(headers: &HeaderMap) -> Option<&str> {
    text(headers, &header::AUTHORIZATION)?.strip_prefix("Bearer ")
}

impl Guard {
    fn has_session(&self, headers: &HeaderMap, now_s: u64) -> bool {
        let wanted = cookie_name(headers);
        let cookies =
            headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut said = cookies.flat_map(|cookies| cookies.split(';')).filter_map(|pair| {
            let (name, value) = pair.trim().split_once('=')?;
            (name == wanted).then_some(value)
        });
        let sessions = self.sessions();
        said.any(|said| {
            sessions.iter().any(|known| known.is_alive(now_s) && same(said, &known.name))
        })
    }

    fn begin(&self, session: Session) {
        let mut sessions = self.sessions();
        sessions.retain(|known| known.is_alive(session.began_s));
        while sessions.len() >= SESSIONS_MAX {
            sessions.remove(0);
        }
        sessions.push(session);
        // Without it the session ends with this process.
        if let Err(error) = write(&self.sessions_file, &self.token, &sessions) {
            tracing::warn!(%error, "a browser's session is not stored");
        }
    }

    fn sessions(&self) -> MutexGuard<'_, Vec<Session>> {
        // Every change leaves a consistent list.
        self.sessions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Session {
    fn is_alive(&self, now_s: u64) -> bool {
        now_s < self.began_s.saturating_add(SESSION_S)
    }
}

/// Reads the sessions that were begun with this token; those of another one are over.
fn read(file: &Path, token: &str) -> Vec<Session> {
    let text = read_private(file).unwrap_or_default();
    let mut lines = text.lines();
    if !lines.next().is_some_and(|begun_with| same(begun_with, token)) {
        return Vec::new();
    }
    let session = |line: &str| {
        let (name, began_s) = line.split_once(' ')?;
        Some(Session { name: name.to_owned(), began_s: began_s.parse().ok()? })
    };
    lines.filter_map(session).collect()
}

fn write(file: &Path, token: &str, sessions: &[Session]) -> io::Result<()> {
    let lines = sessions.iter().map(|session| format!("{} {}\n", session.name, session.began_s));
    let text: String = std::iter::once(format!("{token}\n")).chain(lines).collect();
    replace_private(file, &text)
}

fn text<'a>(headers: &'a HeaderMap, name: &header::HeaderName) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
}

/// Returns the cookie's name. Browsers send a cookie to every port of a host, so it names the port that the
/// browser sees: consoles on one host, also behind tunnels, do not take each other's place.
fn cookie_name(headers: &HeaderMap) -> String {
    let port = text(headers, &header::HOST).and_then(|host| host.rsplit_once(':'));
    let port = port.and_then(|(_, port)| port.parse::<u16>().ok()).unwrap_or(0);
    format!("whichone_{port}")
}

fn is_this_machine(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|b| b.is_ascii_digit()) => name,
        _ => host,
    };
    let name = name.trim_start_matches('[').trim_end_matches(']');
    let is_loopback = |ip: std::net::IpAddr| ip.is_loopback();
    name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(is_loopback)
}

/// Compares in constant time.
fn same(said: &str, wanted: &str) -> bool {
    let (said, wanted) = (said.as_bytes(), wanted.as_bytes());
    let differ = said.iter().zip(wanted).fold(0, |differ, (a, b)| differ | (a ^ b));
    said.len() == wanted.len() && differ == 0
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::PermissionsExt;

    use super::*;

    const TOKEN: &str = "correct-horse";

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (name.parse().unwrap(), value.parse().unwrap())).collect()
    }

    fn by_token(file: &Path) -> Access {
        Access::by_token(file, file.with_file_name("console.sessions")).unwrap()
    }

    fn guarded() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("console.token");
        replace_private(&file, TOKEN).unwrap();
        (folder, file)
    }

    /// Logs a browser in at a port; returns the headers of its next requests.
    fn logged_in(access: &Access, host: &str, now_s: u64) -> HeaderMap {
        let cookie = access.log_in(&headers(&[("host", host)]), TOKEN, now_s).unwrap();
        let (pair, rules) = cookie.split_once("; ").unwrap();
        assert!(rules.contains("HttpOnly") && rules.contains("SameSite=Strict"));
        assert!(!pair.contains(TOKEN), "the cookie is not the token");
        headers(&[("host", host), ("cookie", &format!("a=b; {pair}"))])
    }

    #[test]
    fn open_access_is_for_this_machine_only() {
        let (_folder, file) = guarded();
        let (open, guarded) = (Access::open(), by_token(&file));
        for host in ["localhost:8377", "127.0.0.1:9", "[::1]:8377", "LOCALHOST", "127.0.0.1"] {
            assert!(open.is_addressed(&headers(&[("host", host)])), "{host}");
        }
        for host in ["evil.example", "evil.example:8377", "10.0.0.1:8377", "localhost.evil.example"]
        {
            assert!(!open.is_addressed(&headers(&[("host", host)])), "{host}");
        }
        assert!(!open.is_addressed(&HeaderMap::new()));
        assert!(guarded.is_addressed(&headers(&[("host", "robot.lab:8377")])));
        assert!(open.is_known(&HeaderMap::new(), 0) && !guarded.is_known(&HeaderMap::new(), 0));
    }

    #[test]
    fn token_is_a_bearer_or_begins_a_session() {
        let (_folder, file) = guarded();
        let access = by_token(&file);
        assert!(access.is_token(TOKEN) && !access.is_token("correct-hors"));
        assert!(!access.is_token("") && Access::open().is_token(""));
        let bearer = |token: &str| headers(&[("authorization", &format!("Bearer {token}"))]);
        assert!(access.is_known(&bearer(TOKEN), 0));
        assert!(!access.is_known(&bearer("correct-hors"), 0));
        assert_eq!(access.log_in(&HeaderMap::new(), "battery-staple", 0), None);
        let browser = logged_in(&access, "localhost:8377", 100);
        assert!(access.is_known(&browser, 100 + SESSION_S - 1));
        assert!(!access.is_known(&browser, 100 + SESSION_S), "it ends");
        let cookie = format!("whichone_8377={TOKEN}");
        let token_as_cookie = headers(&[("host", "localhost:8377"), ("cookie", &cookie)]);
        assert!(!access.is_known(&token_as_cookie, 100));
        let again = by_token(&file);
        assert!(again.is_known(&browser, 200), "it lives through a restart");
    }

    #[test]
    fn sessions_are_bounded_and_end_with_the_token() {
        let (_folder, file) = guarded();
        let access = by_token(&file);
        let first = logged_in(&access, "localhost:1", 0);
        let others: Vec<HeaderMap> =
            (1..=SESSIONS_MAX as u64).map(|n| logged_in(&access, "localhost:1", n)).collect();
        assert!(!access.is_known(&first, 100), "the oldest has given way");
        assert!(others.iter().all(|other| access.is_known(other, 100)));
        let stored = fs::read_to_string(file.with_file_name("console.sessions")).unwrap();
        assert_eq!(stored.lines().count(), 1 + SESSIONS_MAX);
        replace_private(&file, "another-token").unwrap();
        let renewed = by_token(&file);
        assert!(others.iter().all(|other| !renewed.is_known(other, 100)));
    }

    #[test]
    fn token_that_others_could_read_is_replaced() {
        let (_folder, file) = guarded();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o644)).unwrap();
        let access = by_token(&file);
        assert!(!access.is_known(&headers(&[("authorization", "Bearer correct-horse")]), 0));
        let token = read_private(&file).unwrap();
        assert!(is_token(token.trim()), "{token}");
        fs::remove_file(&file).unwrap();
        by_token(&file);
        assert_ne!(read_private(&file).unwrap(), token);
    }

    #[test]
    fn word_of_the_owners_own_survives_a_login() {
        let (_folder, file) = guarded();
        let running = by_token(&file);
        replace_private(&file, "my-own-word-123\n").unwrap();
        let browser = logged_in(&running, "localhost:8377", 0);
        assert_eq!(read_private(&file).as_deref(), Some("my-own-word-123\n"));
        let restarted = by_token(&file);
        let bearer = headers(&[("authorization", "Bearer my-own-word-123")]);
        assert!(restarted.is_known(&bearer, 1));
        assert!(!restarted.is_known(&browser, 1), "sessions of the former token are over");
        let browser = restarted.log_in(&HeaderMap::new(), "my-own-word-123", 1);
        assert!(browser.is_some());
    }

    #[test]
    fn access_knows_the_consoles_own_pages() {
        let own = |origin, host| Access::is_own(&headers(&[("origin", origin), ("host", host)]));
        assert!(own("http://localhost:8377", "localhost:8377"));
        assert!(own("https://robot.lab", "robot.lab"));
        assert!(!own("http://localhost:9000", "localhost:8377"));
        assert!(!own("null", "localhost:8377"));
        assert!(!Access::is_own(&headers(&[("host", "localhost:8377")])));
    }
}
