//! Programs at a robot's console: `/ROBOT/api/v1/…` (docs/http.md), with the rights of a person.

use std::sync::atomic::Ordering;
use std::time::Duration;

use axum::body::{Body, Bytes, to_bytes};
use axum::http::request::Parts;
use axum::http::{Method, Response, StatusCode, header};
use axum::response::IntoResponse;
use roster::Name;
use serde_json::{Value, json};
use tokio::time::timeout;
use web_server::request::{is_own, origin};

use crate::Gateway;
use crate::audit::{Entry, Outcome};
use crate::people::Right;
use crate::proxy::{self, ProgramRequest};
use crate::robots::Console;

/// Longest body, bytes, and the time for it to arrive.
const BODY_MAX: usize = 16 << 10;
const BODY_PATIENCE: Duration = Duration::from_secs(10);

/// The person behind a request, the robot, and the person's right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Visitor<'a> {
    pub(crate) person: &'a Name,
    pub(crate) robot: &'a Name,
    pub(crate) right: Right,
}

/// Returns the answer to a program that is refused, as the console's own are.
pub(crate) fn problem(status: StatusCode, why: &str) -> Response<Body> {
    let code = match status {
        StatusCode::UNAUTHORIZED => "token",
        StatusCode::FORBIDDEN => "right",
        StatusCode::NOT_FOUND => "not_found",
        StatusCode::REQUEST_TIMEOUT => "slow",
        StatusCode::PAYLOAD_TOO_LARGE => "too_large",
        StatusCode::TOO_MANY_REQUESTS => "too_many",
        _ => "unavailable",
    };
    coded(status, code, why)
}

fn coded(status: StatusCode, code: &str, why: &str) -> Response<Body> {
    let title = status.canonical_reason().unwrap_or_default();
    let body = json!({
        "type": "about:blank", "title": title, "status": status.as_u16(), "code": code,
        "detail": why.trim_end(),
    });
    let kind =
        [(header::CONTENT_TYPE, "application/problem+json"), (header::CACHE_CONTROL, "no-store")];
    let mut response = (status, kind, body.to_string()).into_response();
    if matches!(status, StatusCode::SERVICE_UNAVAILABLE | StatusCode::TOO_MANY_REQUESTS) {
        response.headers_mut().insert(header::RETRY_AFTER, 2.into());
    }
    response
}

/// Passes a permitted request on to a console; orders are recorded before, a stop afterwards.
pub(crate) async fn serve(
    gateway: &Gateway,
    visitor: Visitor<'_>,
    console: &Console,
    parts: &Parts,
    (path, body): (&str, Body),
) -> Response<Body> {
    if let Some(origin) = origin(&parts.headers).filter(|_| !is_own(&parts.headers)) {
        let why = format!("expected a program, found a page of {origin}");
        return coded(StatusCode::FORBIDDEN, "origin", &why);
    }
    if parts.method == Method::GET {
        return pass(visitor, console, parts, (path, Bytes::new())).await;
    }
    let what = path.rsplit('/').next().unwrap_or_default();
    let order = Order::new(gateway, visitor, what);
    if visitor.right != Right::Operator {
        order.note(Outcome::Refused, None);
        return problem(StatusCode::FORBIDDEN, &crate::rules::viewers_error(visitor.person));
    }
    if what == "stop" {
        let response = pass(visitor, console, parts, (path, Bytes::new())).await;
        // Nothing may delay it. The console's own audit has those beyond the person's budget.
        if gateway.budgets.take(visitor.person) {
            order.note_result(response.status());
        }
        return response;
    }
    if !gateway.budgets.take(visitor.person) {
        return problem(
            StatusCode::TOO_MANY_REQUESTS,
            "too many orders at a time; help: wait a moment",
        );
    }
    let body = match read(body).await {
        Ok(body) => body,
        Err(response) => return response,
    };
    if let Err(error) = order.record(&body).await {
        let why = format!("the audit cannot be written: {error}");
        return problem(StatusCode::SERVICE_UNAVAILABLE, &why);
    }
    let response = pass(visitor, console, parts, (path, body)).await;
    order.note_result(response.status());
    response
}

async fn read(body: Body) -> Result<Bytes, Response<Body>> {
    match timeout(BODY_PATIENCE, to_bytes(body, BODY_MAX)).await {
        Ok(Ok(body)) => Ok(body),
        Ok(Err(_)) => {
            let why = format!("expected a body of at most {BODY_MAX} bytes");
            Err(problem(StatusCode::PAYLOAD_TOO_LARGE, &why))
        }
        Err(_) => Err(problem(StatusCode::REQUEST_TIMEOUT, "the body did not arrive in time")),
    }
}

async fn pass(
    Visitor { person, .. }: Visitor<'_>,
    console: &Console,
    parts: &Parts,
    (path, body): (&str, Bytes),
) -> Response<Body> {
    let request =
        ProgramRequest { method: &parts.method, path, headers: &parts.headers, person, body };
    match proxy::pass_program(console, request).await {
        Ok(response) => response,
        Err(why) => problem(StatusCode::SERVICE_UNAVAILABLE, &why),
    }
}

/// An order, for the audit.
struct Order<'a> {
    gateway: &'a Gateway,
    visitor: Visitor<'a>,
    what: &'a str,
    /// Number of the request; its entries have the same.
    number: u64,
}

impl<'a> Order<'a> {
    fn new(gateway: &'a Gateway, visitor: Visitor<'a>, what: &'a str) -> Self {
        let number = gateway.visits.fetch_add(1, Ordering::Relaxed) + 1;
        Self { gateway, visitor, what, number }
    }

    fn entry(&self, outcome: Outcome, text: Option<String>) -> Entry {
        let Visitor { person, robot, .. } = self.visitor;
        let entry = Entry::new(person, Some(robot), self.what, outcome);
        Entry { text, order: Some((self.number, 0)), ..entry }
    }

    /// Records the order with its words and all else that it says.
    async fn record(&self, body: &[u8]) -> std::io::Result<()> {
        let mut said: Value = serde_json::from_slice(body).unwrap_or_default();
        let text = said.as_object_mut().and_then(|said| said.remove("text"));
        let text = text.and_then(|text| text.as_str().map(str::to_owned));
        let with = Some(said).filter(|said| said.as_object().is_some_and(|said| !said.is_empty()));
        self.gateway.audit.record(&Entry { with, ..self.entry(Outcome::Ordered, text) }).await
    }

    fn note(&self, outcome: Outcome, why: Option<String>) {
        self.gateway.audit.note(&self.entry(outcome, why));
    }

    fn note_result(&self, status: StatusCode) {
        match status.is_success() {
            true => self.note(Outcome::Done, None),
            false => self.note(Outcome::Failed, Some(status.to_string())),
        }
    }
}
