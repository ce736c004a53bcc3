//! Whom a request comes from, and whether it is meant for this gateway.

use axum::http::{HeaderMap, header};
use roster::Name;
use web_server::request::{bearer, is_for_this_machine, text};
use web_server::sessions::{Rules, SessionName, Sessions, hash, unix_s};

use crate::people::People;

/// The rules of people's sessions.
pub(crate) const SESSIONS: Rules =
    Rules { cookie: "whichone_gateway", most: 512, each: 32, life_s: 7 * 24 * 3_600 };
/// Their file in the gateway's folder.
pub(crate) const SESSIONS_FILE: &str = "sessions.json";

/// The address under which people reach the gateway.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    /// `https` or `http`.
    pub(crate) scheme: String,
    /// Host, with its port if it is not the scheme's.
    pub(crate) host: String,
}

impl std::fmt::Display for Address {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}://{}", self.scheme, self.host)
    }
}

impl std::str::FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected https://HOST or http://HOST:PORT, found {text:?}");
        let (scheme, host) = text.trim_end_matches('/').split_once("://").ok_or_else(wrong)?;
        let plain = |byte: u8| byte.is_ascii_alphanumeric() || b".-:[]".contains(&byte);
        let fits = ["http", "https"].contains(&scheme) && !host.is_empty();
        match fits && host.bytes().all(plain) {
            true => Ok(Self { scheme: scheme.to_owned(), host: host.to_ascii_lowercase() }),
            false => Err(wrong()),
        }
    }
}

impl Address {
    /// Returns whether a request is addressed to this gateway: another host name is an attack by
    /// another site (DNS rebinding). The loopback address always is, for tunnels.
    pub(crate) fn is_addressed(&self, headers: &HeaderMap) -> bool {
        let host = text(headers, &header::HOST);
        host.is_some_and(|host| host.eq_ignore_ascii_case(&self.host))
            || is_for_this_machine(headers)
    }

    /// Returns whether people reach the gateway by https.
    pub(crate) fn is_https(&self) -> bool {
        self.scheme == "https"
    }
}

/// A known person, and the proof.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Known {
    /// The person.
    pub(crate) person: Name,
    by: By,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum By {
    /// The hash of the secret.
    Secret(String),
    Session(SessionName),
}

impl Known {
    /// Returns the person who makes a request, by a bearer secret or by the cookie of a session.
    pub(crate) fn of(
        headers: &HeaderMap,
        people: &People,
        sessions: &Sessions<Name>,
    ) -> Option<Self> {
        if let Some(secret) = bearer(headers) {
            let by = By::Secret(hash(secret));
            return Some(Self { person: people.with_secret(secret)?.clone(), by });
        }
        let is_valid = |of: &Name, secret: &str| people.has_secret(of, secret);
        let (person, session) = sessions.person(headers, unix_s(), is_valid)?;
        Some(Self { person, by: By::Session(session) })
    }

    /// Returns whether the proof holds: the secret is the same, and the session has not ended.
    pub(crate) fn lasts(&self, people: &People, sessions: &Sessions<Name>) -> bool {
        match &self.by {
            By::Secret(secret) => people.has_secret(&self.person, secret),
            By::Session(session) => {
                let is_valid = |of: &Name, secret: &str| people.has_secret(of, secret);
                sessions.lasts(session, unix_s(), is_valid)
            }
        }
    }
}

/// Begins a session of the person with this secret; returns the person and the cookie's value.
pub(crate) fn log_in(
    people: &People,
    sessions: &Sessions<Name>,
    secret: &str,
) -> Option<(Name, String)> {
    let person = people.with_secret(secret)?;
    let is_valid = |of: &Name, secret: &str| people.has_secret(of, secret);
    let value = sessions.begin(person.clone(), secret, unix_s(), is_valid)?;
    Some((person.clone(), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::people::{self, People, PeopleFile};

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (name.parse().unwrap(), value.parse().unwrap())).collect()
    }

    #[test]
    fn only_the_gateways_own_address_and_loopback_are_served() {
        let address: Address = "https://Robots.example/".parse().unwrap();
        assert_eq!(address.to_string(), "https://robots.example");
        for (host, expected) in [
            ("robots.example", true),
            ("localhost:8400", true),
            ("127.0.0.1:8400", true),
            ("[::1]:1", true),
            ("evil.example", false),
            ("localhost.evil.example", false),
        ] {
            assert_eq!(address.is_addressed(&headers(&[("host", host)])), expected, "{host}");
        }
        assert!(!address.is_addressed(&HeaderMap::new()));
        for bad in ["robots.example", "ftp://a", "https://", "https://a/b", "https://a\"b"] {
            assert!(bad.parse::<Address>().is_err(), "{bad}");
        }
        assert!(address.is_https());
    }

    #[test]
    fn sessions_live_through_a_restart_and_end_with_the_secret() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(people::FILE);
        let ann = Name::new("ann").unwrap();
        let secret = people::add(&path, &ann, &[], &[], false).unwrap().unwrap();
        let file = PeopleFile::open(path.clone(), People::load).unwrap();
        let sessions = || Sessions::open(SESSIONS, folder.path().join(SESSIONS_FILE));
        let begun = sessions();
        assert_eq!(log_in(&file.current(), &begun, "0123456789abcdef"), None);
        let (of, value) = log_in(&file.current(), &begun, &secret).unwrap();
        assert_eq!(of, ann);
        let stored = std::fs::read_to_string(folder.path().join(SESSIONS_FILE)).unwrap();
        assert!(!stored.contains(&value) && !stored.contains(&secret));
        let again = sessions();
        let with = |value: &str| headers(&[("cookie", &format!("whichone_gateway_0={value}"))]);
        let of = |headers: &HeaderMap| Known::of(headers, &file.current(), &again);
        let known = of(&with(&value)).unwrap();
        let bearer = of(&headers(&[("authorization", &format!("Bearer {secret}"))])).unwrap();
        assert_eq!((&known.person, &bearer.person), (&ann, &ann));
        assert_eq!(of(&with(&secret)), None);
        let lasts = |known: &Known| known.lasts(&file.current(), &again);
        assert!(lasts(&known) && lasts(&bearer));
        people::add(&path, &ann, &[], &[], true).unwrap();
        assert_eq!(of(&with(&value)), None);
        assert!(!lasts(&known) && !lasts(&bearer), "with the secret ends what it has opened");
        again.end(&with(&value));
        assert_eq!(std::fs::read_to_string(folder.path().join(SESSIONS_FILE)).unwrap(), "[]");
    }
}
