//! Refusals and failures, as `application/problem+json` (RFC 9457).

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::json;

/// Why a request is not carried out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    status: StatusCode,
    /// A word for programs, which never changes.
    pub(crate) code: &'static str,
    /// A sentence for people, with help where there is some.
    pub(crate) detail: String,
    /// Seconds after which the same request may succeed.
    retry_s: Option<u64>,
}

impl Problem {
    fn new(status: StatusCode, code: &'static str, detail: impl Into<String>) -> Self {
        Self { status, code, detail: detail.into(), retry_s: None }
    }

    fn after(self, seconds: u64) -> Self {
        Self { retry_s: Some(seconds), ..self }
    }

    /// The request cannot be read.
    pub(crate) fn unreadable(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, "unreadable", detail)
    }

    /// The request can be read, and a value in it is out of its range.
    pub(crate) fn invalid(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid", detail)
    }

    /// No token, or none that is known.
    pub(crate) fn token(has_one: bool) -> Self {
        let what = if has_one { "wrong token" } else { "token required" };
        let help =
            "send the header Authorization: Bearer TOKEN; `whichone token add NAME` makes one";
        Self::new(StatusCode::UNAUTHORIZED, "token", format!("{what}; help: {help}"))
    }

    /// The token lacks a right.
    pub(crate) fn right(name: &str, right: &str) -> Self {
        let what = format!("the token {name} may not {right}");
        let help = format!("`whichone token add {name} --may {right},…` changes its rights");
        Self::new(StatusCode::FORBIDDEN, "right", format!("{what}; help: {help}"))
    }

    /// A page of another site makes the request.
    pub(crate) fn origin(origin: &str) -> Self {
        let what = format!("expected a program, found a page of {origin}");
        Self::new(StatusCode::FORBIDDEN, "origin", format!("{what}; help: leave out `Origin`"))
    }

    /// There is no such address.
    pub(crate) fn not_found() -> Self {
        let help = "help: /api/v1/openapi.json lists the addresses";
        Self::new(StatusCode::NOT_FOUND, "not_found", format!("address not found; {help}"))
    }

    /// The address has no such method.
    pub(crate) fn method() -> Self {
        let help = "help: /api/v1/openapi.json has the methods of each address";
        Self::new(StatusCode::METHOD_NOT_ALLOWED, "method", format!("method not allowed; {help}"))
    }

    /// The body does not arrive.
    pub(crate) fn slow(seconds: u64) -> Self {
        let detail = format!("expected the whole request within {seconds} s");
        Self::new(StatusCode::REQUEST_TIMEOUT, "slow", detail)
    }

    /// The body is too long.
    pub(crate) fn too_large(most: usize) -> Self {
        let detail = format!("expected a body of at most {most} bytes");
        Self::new(StatusCode::PAYLOAD_TOO_LARGE, "too_large", detail)
    }

    /// The state of the robot forbids it.
    pub(crate) fn conflict(code: &'static str, detail: impl Into<String>) -> Self {
        Self::new(StatusCode::CONFLICT, code, detail)
    }

    /// The speech service refuses the words.
    pub(crate) fn refused(note: &str) -> Self {
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "refused", note)
    }

    /// Another conversation is open.
    pub(crate) fn busy() -> Self {
        let what = "the robot is talking with someone else";
        let help = "wait until that request has ended; a stop is always taken";
        Self::new(StatusCode::LOCKED, "busy", format!("{what}; help: {help}")).after(5)
    }

    /// Too many requests at a time.
    pub(crate) fn too_many(what: &str) -> Self {
        let detail = format!("too many {what} at a time; help: wait for earlier ones");
        Self::new(StatusCode::TOO_MANY_REQUESTS, "too_many", detail).after(1)
    }

    /// The robot cannot do it now.
    pub(crate) fn unavailable(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::SERVICE_UNAVAILABLE, "unavailable", detail).after(2)
    }

    /// Whether the words will be heard is not known.
    pub(crate) fn not_accepted(detail: impl Into<String>) -> Self {
        let help = "help: send the request again with the same Idempotency-Key";
        let detail = format!("{}; {help}", detail.into());
        Self::new(StatusCode::SERVICE_UNAVAILABLE, "not_accepted", detail).after(1)
    }

    /// The arm has not confirmed an order in time.
    pub(crate) fn not_confirmed(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::GATEWAY_TIMEOUT, "not_confirmed", detail)
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let Self { status, code, detail, retry_s } = self;
        let title = status.canonical_reason().unwrap_or_default();
        let body = json!({
            "type": "about:blank", "title": title, "status": status.as_u16(), "code": code,
            "detail": detail,
        });
        let kind = [
            (header::CONTENT_TYPE, "application/problem+json"),
            (header::CACHE_CONTROL, "no-store"),
        ];
        let mut response = (status, kind, body.to_string()).into_response();
        let headers = response.headers_mut();
        if status == StatusCode::UNAUTHORIZED {
            headers.insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
        }
        if let Some(seconds) = retry_s {
            headers.insert(header::RETRY_AFTER, HeaderValue::from(seconds));
        }
        response
    }
}
