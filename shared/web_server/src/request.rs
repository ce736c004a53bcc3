//! Where a request comes from and to whom it is addressed, by its headers.

use axum::http::{HeaderMap, header};

/// Returns a header's text.
pub fn text<'a>(headers: &'a HeaderMap, name: &header::HeaderName) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
}

/// Returns the secret that a program sends. The scheme may be in capital or small letters (RFC 9110, 11.1). Of several
/// none counts: what is sent then is a wrong secret.
pub fn bearer(headers: &HeaderMap) -> Option<&str> {
    if authorizations(headers) > 1 {
        return Some("");
    }
    let (scheme, secret) = text(headers, &header::AUTHORIZATION)?.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then_some(secret)
}

/// Returns how many headers `Authorization` a request has: more than one is an error of its sender (RFC 9110, 5.3).
pub fn authorizations(headers: &HeaderMap) -> usize {
    headers.get_all(header::AUTHORIZATION).iter().count()
}

/// Returns the origin of the page that makes the request.
pub fn origin(headers: &HeaderMap) -> Option<&str> {
    text(headers, &header::ORIGIN)
}

/// Returns whether the request comes from a page of this server: its origin is its host.
pub fn is_own(headers: &HeaderMap) -> bool {
    let place = origin(headers).and_then(|origin| {
        origin.strip_prefix("http://").or_else(|| origin.strip_prefix("https://"))
    });
    let host = text(headers, &header::HOST);
    place.zip(host).is_some_and(|(place, host)| place.eq_ignore_ascii_case(host))
}

/// Returns whether the request is addressed to the machine that it is made on. Another host name at a server that is only
/// reached from there is an attack by another site (DNS rebinding).
pub fn is_for_this_machine(headers: &HeaderMap) -> bool {
    text(headers, &header::HOST).is_some_and(is_this_machine)
}

/// Returns whether the client shows pages, as browsers do.
pub fn wants_page(headers: &HeaderMap) -> bool {
    text(headers, &header::ACCEPT).is_some_and(|accepts| accepts.contains("text/html"))
}

fn is_this_machine(host: &str) -> bool {
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
    fn scheme_of_a_secret_is_read_in_any_case() {
        for (header, secret) in
            [("Bearer x", Some("x")), ("bearer x", Some("x")), ("Basic x", None), ("Bearer", None)]
        {
            assert_eq!(bearer(&headers(&[("authorization", header)])), secret, "{header}");
        }
    }

    #[test]
    fn several_secrets_are_a_wrong_one() {
        let mut twice = headers(&[("authorization", "Bearer x")]);
        assert_eq!((authorizations(&twice), bearer(&twice)), (1, Some("x")));
        twice.append(header::AUTHORIZATION, "Bearer x".parse().unwrap());
        assert_eq!((authorizations(&twice), bearer(&twice)), (2, Some("")));
    }

    #[test]
    fn pages_of_other_sites_are_not_own() {
        let own = |origin, host| is_own(&headers(&[("origin", origin), ("host", host)]));
        assert!(own("http://localhost:8377", "localhost:8377"));
        assert!(own("https://robots.example", "Robots.example"));
        assert!(!own("http://localhost:9000", "localhost:8377"));
        assert!(!own("https://evil.example", "robots.example"));
        assert!(!own("null", "localhost:8377") && !own("ftp://a", "a"));
        assert!(!is_own(&headers(&[("host", "localhost:8377")])));
    }

    #[test]
    fn this_machine_has_few_names() {
        let is_here = |host| is_for_this_machine(&headers(&[("host", host)]));
        for host in ["localhost:8377", "127.0.0.1:9", "[::1]:8377", "LOCALHOST", "127.0.0.1"] {
            assert!(is_here(host), "{host}");
        }
        for host in ["evil.example", "evil.example:8377", "10.0.0.1:8377", "localhost.evil.example"]
        {
            assert!(!is_here(host), "{host}");
        }
        assert!(!is_for_this_machine(&HeaderMap::new()));
    }
}
