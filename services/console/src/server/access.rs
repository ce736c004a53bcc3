//! Access rules: the console's own pages, the token, and the sessions of authorised browsers.
//!
//! Decided by a request's headers. The token's file is the owner's, the sessions' the console's.

use std::io;
use std::path::{Path, PathBuf};

use axum::http::{HeaderMap, header};
use safe_files::{read_private, replace_private_synced};
use service::console_link::{is_token, random_secret};
use web_server::request::{bearer, is_for_this_machine, text};
use web_server::sessions::{Rules, Sessions, hash};

/// The rules of browsers' sessions.
const SESSIONS: Rules = Rules { cookie: "whichone", most: 64, each: 64, life_s: 30 * 24 * 3_600 };

/// Rules about who may use the page.
#[derive(Debug)]
pub struct Access(Option<Guard>);

/// The token, and the sessions that were begun with it.
#[derive(Debug)]
struct Guard {
    /// The token's hash.
    token: String,
    sessions: Sessions<()>,
}

impl Access {
    /// Makes the rules for pages that everyone on this machine may use.
    pub fn open() -> Self {
        Self(None)
    }

    /// Makes the rules for those who have the token. A file that others can read, or that has no
    /// token, is replaced by one with a new token.
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
        let sessions = Sessions::open(SESSIONS, sessions_file);
        Ok(Self(Some(Guard { token: hash(&token), sessions })))
    }

    /// Returns whether the request is addressed to this console. Without a token it is only reached
    /// from this machine; another host name here is an attack by another site (DNS rebinding).
    pub fn is_addressed(&self, headers: &HeaderMap) -> bool {
        match &self.0 {
            Some(_) => text(headers, &header::HOST).is_some(),
            None => is_for_this_machine(headers),
        }
    }

    /// Returns whether the request carries the token as a bearer, or else the cookie of a session.
    pub fn is_known(&self, headers: &HeaderMap, now_s: u64) -> bool {
        let Some(guard) = &self.0 else { return true };
        match bearer(headers) {
            Some(said) => guard.is_token(said),
            None => guard.sessions.person(headers, now_s, guard.is_valid()).is_some(),
        }
    }

    /// Returns why a request is refused that is not known: it carries no token, or a wrong one, be
    /// it in its address.
    pub fn refusal(headers: &HeaderMap, has_token_in_address: bool) -> &'static str {
        match has_token_in_address || bearer(headers).is_some() {
            true => "wrong token",
            false => "token required",
        }
    }

    /// Returns whether `said` is the token. Without one, any word is.
    pub fn is_token(&self, said: &str) -> bool {
        self.0.as_ref().is_none_or(|guard| guard.is_token(said))
    }

    /// Begins a session for a browser that shows the token; returns its cookie.
    pub fn log_in(&self, headers: &HeaderMap, said: &str, now_s: u64) -> Option<String> {
        let guard = self.0.as_ref().filter(|guard| guard.is_token(said))?;
        let value = guard.sessions.begin((), said, now_s, guard.is_valid())?;
        Some(guard.sessions.cookie(headers, Some(&value), false))
    }
}

impl Guard {
    fn is_token(&self, said: &str) -> bool {
        hash(said) == self.token
    }

    fn is_valid(&self) -> impl Fn(&(), &str) -> bool {
        |(), secret| secret == self.token
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::PermissionsExt;

    use safe_files::replace_private;

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
        assert!(open.is_addressed(&headers(&[("host", "localhost:8377")])));
        assert!(!open.is_addressed(&headers(&[("host", "evil.example:8377")])));
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
        assert!(access.is_known(&browser, 100 + SESSIONS.life_s - 1));
        assert!(!access.is_known(&browser, 100 + SESSIONS.life_s), "it ends");
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
            (1..=SESSIONS.most as u64).map(|n| logged_in(&access, "localhost:1", n)).collect();
        assert!(!access.is_known(&first, 100), "the oldest has given way");
        assert!(others.iter().all(|other| access.is_known(other, 100)));
        let stored = fs::read_to_string(file.with_file_name("console.sessions")).unwrap();
        assert!(!stored.contains(TOKEN));
        assert_eq!(stored.matches("began_s").count(), SESSIONS.most);
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
        assert_eq!(read_private(&file).unwrap(), "my-own-word-123\n");
        let restarted = by_token(&file);
        let bearer = headers(&[("authorization", "Bearer my-own-word-123")]);
        assert!(restarted.is_known(&bearer, 1));
        assert!(!restarted.is_known(&browser, 1), "sessions of the former token are over");
        let browser = restarted.log_in(&HeaderMap::new(), "my-own-word-123", 1);
        assert!(browser.is_some());
    }
}
