//! Access rules: the console's own pages, and the token where one is set.
//!
//! Pure: decided by a request's headers.

use axum::http::{HeaderMap, header};

const COOKIE: &str = "whichone_console";

#[derive(Clone, Debug)]
pub struct Access {
    token: Option<String>,
}

impl Access {
    /// Makes the rules: open to every client, or to those with the token.
    pub fn new(token: Option<String>) -> Self {
        Self { token }
    }

    /// Returns whether the request is addressed to this console. Without a token it is only reached
    /// from this machine; another host name here is an attack by another site (DNS rebinding).
    pub fn is_addressed(&self, headers: &HeaderMap) -> bool {
        let Some(host) = text(headers, &header::HOST) else { return false };
        self.token.is_some() || is_this_machine(host)
    }

    /// Returns whether the request carries the token, in a cookie or as a bearer.
    pub fn is_known(&self, headers: &HeaderMap) -> bool {
        let Some(token) = &self.token else { return true };
        let bearer = text(headers, &header::AUTHORIZATION);
        let bearer = bearer.and_then(|said| said.strip_prefix("Bearer "));
        let cookies =
            headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut pairs = cookies.flat_map(|cookies| cookies.split(';')).filter_map(|pair| {
            let (name, value) = pair.trim().split_once('=')?;
            (name == COOKIE).then_some(value)
        });
        bearer.is_some_and(|said| same(said, token)) || pairs.any(|said| same(said, &hex(token)))
    }

    /// Returns whether the request comes from a page of this console: its origin is its host.
    pub fn is_own(headers: &HeaderMap) -> bool {
        let (Some(origin), Some(host)) =
            (text(headers, &header::ORIGIN), text(headers, &header::HOST))
        else {
            return false;
        };
        let place = origin.strip_prefix("http://").or(origin.strip_prefix("https://"));
        place.is_some_and(|place| place.eq_ignore_ascii_case(host))
    }

    pub fn cookie_for(&self, said: &str) -> Option<String> {
        let token = self.token.as_ref().filter(|token| same(said, token))?;
        Some(format!("{COOKIE}={}; Path=/; HttpOnly; SameSite=Strict", hex(token)))
    }
}

fn text<'a>(headers: &'a HeaderMap, name: &header::HeaderName) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
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

/// Encodes a text for a cookie, which would need quotes otherwise.
fn hex(text: &str) -> String {
    text.bytes().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (name.parse().unwrap(), value.parse().unwrap())).collect()
    }

    fn guarded() -> Access {
        Access::new(Some("correct-horse".to_owned()))
    }

    #[test]
    fn access_without_a_token_is_for_this_machine_only() {
        let open = Access::new(None);
        for host in ["localhost:8377", "127.0.0.1:9", "[::1]:8377", "LOCALHOST", "127.0.0.1"] {
            assert!(open.is_addressed(&headers(&[("host", host)])), "{host}");
        }
        for host in ["evil.example", "evil.example:8377", "10.0.0.1:8377", "localhost.evil.example"]
        {
            assert!(!open.is_addressed(&headers(&[("host", host)])), "{host}");
        }
        assert!(!open.is_addressed(&HeaderMap::new()));
        assert!(guarded().is_addressed(&headers(&[("host", "robot.lab:8377")])));
        assert!(open.is_known(&HeaderMap::new()));
    }

    #[test]
    fn access_accepts_the_token_as_bearer_or_cookie() {
        let access = guarded();
        assert!(!access.is_known(&HeaderMap::new()));
        assert!(access.is_known(&headers(&[("authorization", "Bearer correct-horse")])));
        assert!(!access.is_known(&headers(&[("authorization", "Bearer correct-hors")])));
        let cookie = access.cookie_for("correct-horse").unwrap();
        let (pair, rules) = cookie.split_once("; ").unwrap();
        assert!(rules.contains("HttpOnly") && rules.contains("SameSite=Strict"));
        assert!(access.is_known(&headers(&[("cookie", &format!("a=b; {pair}"))])));
        assert!(!access.is_known(&headers(&[("cookie", "whichone_console=correct-horse")])));
        assert_eq!(access.cookie_for("battery-staple"), None);
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
