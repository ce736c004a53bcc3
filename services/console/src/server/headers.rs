//! Security headers of every response: no foreign scripts, no framing.

use axum::http::{HeaderMap, HeaderName, HeaderValue, header};

/// Adds the headers to an answer to a request that was addressed to `host`.
pub(super) fn secure(headers: &mut HeaderMap, host: Option<&str>) {
    // `'self'` covers sockets of the same host in newer browsers only.
    let plain =
        |host: &&str| host.bytes().all(|b| b.is_ascii_alphanumeric() || b".-:[]".contains(&b));
    let sockets = host.filter(plain).map(|host| format!(" ws://{host} wss://{host}"));
    let policy = format!(
        "default-src 'self'; img-src 'self' data: blob:; media-src 'self' blob:; \
         connect-src 'self'{}; worker-src 'self' blob:; object-src 'none'; base-uri 'none'; \
         form-action 'self'; frame-ancestors 'none'",
        sockets.unwrap_or_default()
    );
    if let Ok(policy) = HeaderValue::from_str(&policy) {
        headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    for (name, value) in [
        ("x-content-type-options", "nosniff"),
        ("x-frame-options", "DENY"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
        ("permissions-policy", "microphone=(self), camera=(), geolocation=()"),
    ] {
        headers.insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_forbid_foreign_scripts() {
        let mut headers = HeaderMap::new();
        secure(&mut headers, Some("localhost:8377"));
        let policy = headers[header::CONTENT_SECURITY_POLICY].to_str().unwrap().to_owned();
        assert!(policy.contains("connect-src 'self' ws://localhost:8377 wss://localhost:8377;"));
        assert!(!policy.contains("unsafe"));
        secure(&mut headers, Some("x; script-src *"));
        let policy = headers[header::CONTENT_SECURITY_POLICY].to_str().unwrap();
        assert!(!policy.contains("script-src"), "{policy}");
    }
}
