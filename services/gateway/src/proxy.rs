//! Single requests to a robot's console.

use std::time::Duration;

use axum::body::{Body, Bytes, to_bytes};
use axum::http::{HeaderMap, Method, Request, Response, StatusCode, header};
use hyper::client::conn::http1::handshake;
use hyper_util::rt::TokioIo;
use roster::Name;
use tokio::net::TcpStream;
use tokio::time::timeout;

use crate::people::Right;
use crate::robots::Console;

/// Timeout of a console's answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// Timeout of its answer to a program, which may wait for the robot's reply for a minute.
const PROGRAM_PATIENCE: Duration = Duration::from_secs(75);
/// Timeout of its answer for the list of robots.
const LOOK_PATIENCE: Duration = Duration::from_millis(1_500);
/// Largest state for the list of robots, bytes.
const STATE_MAX: usize = 4 << 20;

/// Headers of a request that matter to a console. All others, such as cookies, stay here.
const PASSED: [&str; 4] = ["accept", "accept-encoding", "if-none-match", "host"];
/// Headers that a program may set.
const PROGRAMS: [&str; 5] = ["accept", "content-type", "host", "idempotency-key", "last-event-id"];
/// Tells the console for whom the gateway asks.
const PERSON: &str = "whichone-person";
/// Headers of an answer that are about the connection, or that only the gateway may set.
const KEPT_BACK: [&str; 6] =
    ["connection", "transfer-encoding", "upgrade", "set-cookie", "location", "www-authenticate"];

/// First parts of paths that a viewer may read.
const VIEWERS: [&str; 12] = [
    "",
    "index.html",
    "history",
    "history.html",
    "audience",
    "audience.html",
    "css",
    "js",
    "strings",
    "vendor",
    "icon.svg",
    "robot.urdf",
];

/// Returns why someone with this right may not read a console's path, from `/` on, if so.
pub(crate) fn denied(path: &str, right: Right) -> Option<&'static str> {
    let mut parts = path.trim_start_matches('/').split('/');
    let first = parts.next().unwrap_or_default();
    match first {
        "foxglove" => Some("the live view is served by the robot's own console only"),
        "voice" => None,
        "api" if matches!(parts.next(), Some("state" | "history")) => None,
        _ if right == Right::Operator || VIEWERS.contains(&first) => None,
        _ => Some("only operators of this robot may see this"),
    }
}

/// Passes a request to read on to a console.
///
/// # Errors
/// The status of the refusal, and its reason.
pub(crate) async fn pass(
    console: &Console,
    path_and_query: &str,
    headers: &HeaderMap,
) -> Result<Response<Body>, (StatusCode, String)> {
    let mut request = Request::get(path_and_query);
    for name in PASSED {
        if let Some(value) = headers.get(name) {
            request = request.header(name, value);
        }
    }
    let away = |what: String| (StatusCode::BAD_GATEWAY, format!("the robot's console: {what}\n"));
    let mut response = match timeout(PATIENCE, ask(console, request)).await {
        Ok(answer) => answer.map_err(away)?,
        Err(_) => return Err(away("no answer within 10 s".to_owned())),
    };
    // The request has the token, so that the console has no reason to redirect.
    if response.status().is_redirection() && response.status() != StatusCode::NOT_MODIFIED {
        return Err(away(format!("unexpected answer {}", response.status())));
    }
    for name in KEPT_BACK {
        response.headers_mut().remove(name);
    }
    Ok(response)
}

/// A request of a program.
#[derive(Debug)]
pub(crate) struct ProgramRequest<'a> {
    pub(crate) method: &'a Method,
    pub(crate) path: &'a str,
    pub(crate) headers: &'a HeaderMap,
    /// Person whose secret the program has.
    pub(crate) person: &'a Name,
    pub(crate) body: Bytes,
}

/// Passes a program's request on to a console, in the name of its person.
///
/// # Errors
/// The reason for the missing answer.
pub(crate) async fn pass_program(
    console: &Console,
    ProgramRequest { method, path, headers, person, body }: ProgramRequest<'_>,
) -> Result<Response<Body>, String> {
    let mut request = Request::builder().method(method).uri(path);
    for name in PROGRAMS {
        if let Some(value) = headers.get(name) {
            request = request.header(name, value);
        }
    }
    let request = request.header(PERSON, person.as_str());
    let answer = timeout(PROGRAM_PATIENCE, ask_with(console, request, Body::from(body))).await;
    let mut response = answer.map_err(|_| "the robot's console does not answer".to_owned())??;
    for name in KEPT_BACK {
        response.headers_mut().remove(name);
    }
    Ok(response)
}

/// Reads something small from a console; `None` on failure.
pub(crate) async fn get(console: &Console, path: &str) -> Option<Vec<u8>> {
    let read = async {
        let request = Request::get(path).header(header::HOST, &console.place);
        let response = ask(console, request).await.ok()?;
        let body = to_bytes(response.into_body(), STATE_MAX).await.ok()?;
        Some(body.to_vec())
    };
    timeout(LOOK_PATIENCE, read).await.ok().flatten()
}

async fn ask(
    console: &Console,
    request: axum::http::request::Builder,
) -> Result<Response<Body>, String> {
    ask_with(console, request, Body::empty()).await
}

async fn ask_with(
    console: &Console,
    request: axum::http::request::Builder,
    body: Body,
) -> Result<Response<Body>, String> {
    let bearer = format!("Bearer {}", console.token);
    let request = request.header(header::AUTHORIZATION, bearer).body(body);
    let request = request.map_err(|error| error.to_string())?;
    let stream = TcpStream::connect(&console.place).await.map_err(|error| error.to_string())?;
    // Connections of this machine cost little, so that each request has its own.
    let (mut sender, connection) =
        handshake(TokioIo::new(stream)).await.map_err(|error| error.to_string())?;
    tokio::spawn(async move {
        if let Err(error) = connection.await {
            tracing::debug!(%error, "a connection to a console has ended");
        }
    });
    let response = sender.send_request(request).await.map_err(|error| error.to_string())?;
    Ok(response.map(Body::new))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_read_what_the_page_needs_and_nothing_else() {
        for path in
            ["/", "/history", "/api/state", "/api/history/3", "/js/main.js", "/voice/line-1-1.wav"]
        {
            assert_eq!(denied(path, Right::Viewer), None, "{path}");
        }
        for path in [
            "/study",
            "/study/export.csv",
            "//study/export.csv",
            "/api/scenes",
            "/results",
            "/metrics",
            "/x",
        ] {
            assert!(denied(path, Right::Viewer).is_some(), "{path}");
            assert_eq!(denied(path, Right::Operator), None, "{path}");
        }
        assert!(denied("/foxglove", Right::Operator).is_some());
    }
}
