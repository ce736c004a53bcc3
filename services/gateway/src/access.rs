//! Whom a request comes from, and whether it is meant for this gateway.

use axum::http::{HeaderMap, header};
use roster::Name;

use crate::people::People;
use crate::sessions::Sessions;

/// The address under which people reach the gateway.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    /// `https` or `http`.
    pub(crate) scheme: String,
    /// Host, with its port where it is not the scheme's.
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
    /// Returns whether a request is addressed to this gateway: another host name is an attack by another site (DNS
    /// rebinding). The loopback address always is, for tunnels.
    pub(crate) fn is_addressed(&self, headers: &HeaderMap) -> bool {
        let host = text(headers, &header::HOST);
        host.is_some_and(|host| host.eq_ignore_ascii_case(&self.host) || is_loopback(host))
    }

    /// The cookie of a session. Browsers send cookies to every port of a host, so it names the port.
    pub(crate) fn cookie(&self, headers: &HeaderMap, value: &str, life_s: u64) -> String {
        let name = cookie_name(headers);
        let secure = if self.scheme == "https" { "; Secure" } else { "" };
        format!("{name}={value}; Path=/; Max-Age={life_s}; HttpOnly; SameSite=Strict{secure}")
    }
}

/// Returns whether the request comes from a page of this gateway: its origin is its host.
pub(crate) fn is_own(headers: &HeaderMap) -> bool {
    let origin = text(headers, &header::ORIGIN);
    let place = origin.and_then(|origin| {
        origin.strip_prefix("http://").or_else(|| origin.strip_prefix("https://"))
    });
    let host = text(headers, &header::HOST);
    place.zip(host).is_some_and(|(place, host)| place.eq_ignore_ascii_case(host))
}

/// Returns the person who makes a request, by the secret as a bearer or by the cookie of a session.
pub(crate) fn person(headers: &HeaderMap, people: &People, sessions: &Sessions) -> Option<Name> {
    if let Some(secret) = bearer(headers) {
        return people.with_secret(secret).cloned();
    }
    cookie(headers).and_then(|value| sessions.person(people, &value))
}

/// Returns whether a request carries a secret.
pub(crate) fn bearer(headers: &HeaderMap) -> Option<&str> {
    text(headers, &header::AUTHORIZATION)?.strip_prefix("Bearer ")
}

/// Returns the value of the session's cookie.
pub(crate) fn cookie(headers: &HeaderMap) -> Option<String> {
    let wanted = cookie_name(headers);
    let all = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = all.flat_map(|cookies| cookies.split(';')).filter_map(|pair| {
        let (name, value) = pair.trim().split_once('=')?;
        (name == wanted).then(|| value.to_owned())
    });
    pairs.next()
}

/// Returns a header's text.
pub(crate) fn text<'a>(headers: &'a HeaderMap, name: &header::HeaderName) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
}

fn cookie_name(headers: &HeaderMap) -> String {
    let port = text(headers, &header::HOST).and_then(|host| host.rsplit_once(':'));
    let port = port.and_then(|(_, port)| port.parse::<u16>().ok()).unwrap_or(0);
    format!("whichone_gateway_{port}")
}

fn is_loopback(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    let name = name.trim_start_matches('[').trim_end_matches(']');
    let is_loopback = |ip: std::net::IpAddr| ip.is_loopback();
    name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(is_loopback)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let cookie = address.cookie(&headers(&[("host", "robots.example")]), "v", 9);
        assert!(cookie.starts_with("whichone_gateway_0=v; ") && cookie.ends_with("; Secure"));
        assert_eq!(
            super::cookie(&headers(&[("cookie", "a=b; whichone_gateway_0=v")])),
            Some("v".into())
        );
    }

    #[test]
    fn pages_of_other_sites_are_not_own() {
        let own = |origin, host| is_own(&headers(&[("origin", origin), ("host", host)]));
        assert!(own("https://robots.example", "robots.example"));
        assert!(!own("https://evil.example", "robots.example"));
        assert!(!own("null", "robots.example") && !is_own(&headers(&[("host", "a")])));
    }
}
