//! Headers that forbid foreign scripts and framing.

use axum::http::{HeaderMap, HeaderName, HeaderValue};

/// Adds the headers that every answer has, whatever its page may load ([`content_policy`]).
pub fn harden(headers: &mut HeaderMap) {
    for (name, value) in [
        ("x-content-type-options", "nosniff"),
        ("x-frame-options", "DENY"),
        // Without any, browsers would not name the origin of the login form.
        ("referrer-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
        ("permissions-policy", "microphone=(self), camera=(), geolocation=()"),
    ] {
        headers.insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
}

/// Returns what a page may load: from this server only, and what `more` allows, directives that each end with `; `.
pub fn content_policy(more: &str) -> HeaderValue {
    let policy = |more: &str| {
        HeaderValue::from_str(&format!(
            "default-src 'self'; {more}object-src 'none'; base-uri 'none'; form-action 'self'; \
             frame-ancestors 'none'"
        ))
    };
    // Less is allowed where `more` is no text of a header.
    policy(more).or_else(|_| policy("")).unwrap_or(HeaderValue::from_static("default-src 'none'"))
}
