//! A page for one shared interaction, without a group: `whichone-console view FILE`.

use std::io::{self, Read, Write};
use std::net::Ipv4Addr;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::{Response, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::IntoResponse;
use axum::routing::get;
use serde::Deserialize;
use service::console_link::random_secret;
use service::exit::{Exit, Failure};
use web_server::request::is_for_this_machine;

use crate::history::Interaction;
use crate::server::{page_asset, secure};

/// Mark of the page in a file.
const FORMAT: &str = "whichone.interaction/1";
/// Largest file, bytes: many times the size of an interaction.
const FILE_MAX: u64 = 32 << 20;

/// Serves the page for a file on a free port of this machine until the process is ended. Prints the
/// link, which only its reader knows.
pub fn view(file: &Path) -> ExitCode {
    match serve(file) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            // A closed standard error is the caller's choice.
            let _ = writeln!(io::stderr(), "error: {failure}");
            failure.exit.code()
        }
    }
}

fn serve(file: &Path) -> Result<(), Failure> {
    let shared =
        Arc::new(Shared { text: read(file)?, path: format!("/shared/{}.json", secret()?) });
    let failed = |error: io::Error| Failure::new(Exit::NotReached, error.to_string());
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    runtime.map_err(failed)?.block_on(async {
        let listener =
            tokio::net::TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let link = format!("http://{address}/history?shared={}", shared.path);
        writeln!(io::stdout(), "{link}").map_err(Failure::output)?;
        let router = Router::new().fallback(get(answer)).with_state(Arc::clone(&shared));
        axum::serve(listener, router.layer(middleware::from_fn(guard))).await.map_err(failed)
    })
}

fn secret() -> Result<String, Failure> {
    random_secret().map_err(|error| Failure::new(Exit::NotReached, error.to_string()))
}

/// Reads the file, which must hold an interaction.
fn read(file: &Path) -> Result<String, Failure> {
    let failed = |error: io::Error| Failure::file(file, &error);
    let mut opened = safe_files::open_regular(file).map_err(failed)?;
    let length = opened.metadata().map_err(failed)?.len();
    let wrong = |found: String| {
        let help = "help: save one with the arrow in the history of the console's page";
        let expected = format!("expected an interaction, JSON with \"format\": \"{FORMAT}\"");
        Failure::new(Exit::Config, format!("{}: {expected}, found {found}; {help}", file.display()))
    };
    if length > FILE_MAX {
        return Err(wrong(format!("{length} bytes")));
    }
    let mut bytes = Vec::new();
    opened.read_to_end(&mut bytes).map_err(failed)?;
    let text = String::from_utf8(bytes).map_err(|_| wrong("a file that is not text".to_owned()))?;
    let json: serde_json::Value =
        serde_json::from_str(&text).map_err(|error| wrong(format!("no JSON ({error})")))?;
    match &json["format"] {
        format if format == FORMAT => {}
        serde_json::Value::Null => return Err(wrong("no format".to_owned())),
        format => return Err(wrong(format!("format {format}"))),
    }
    let read = Interaction::deserialize(&json);
    read.map(|_| text).map_err(|error| wrong(format!("other content ({error})")))
}

#[derive(Debug)]
struct Shared {
    text: String,
    path: String,
}

async fn answer(State(shared): State<Arc<Shared>>, request: Request) -> Response<Body> {
    let path = request.uri().path();
    if path == shared.path {
        let json =
            [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
        return (json, shared.text.clone()).into_response();
    }
    // The console's own page needs a group.
    let path = if path == "/" { "/history" } else { path };
    page_asset(path, request.headers())
}

/// Rejects requests that are not addressed to this machine, and adds the security headers.
async fn guard(request: Request, next: Next) -> Response<Body> {
    let mut response = match is_for_this_machine(request.headers()) {
        true => next.run(request).await,
        false => StatusCode::MISDIRECTED_REQUEST.into_response(),
    };
    secure(response.headers_mut(), None, None);
    response
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use std::fs;

    fn read_as_file(content: &str) -> Result<String, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("shared.json");
        fs::write(&file, content).unwrap();
        let read = read(&file).map_err(|failure| failure.to_string());
        read.inspect_err(|why| assert!(why.contains("shared.json: expected"), "{why}"))
    }

    #[test]
    fn viewer_takes_interactions_only() {
        let page = include_str!("../page/js/history/model.js");
        assert!(page.contains(&format!("\"{FORMAT}\"")), "the page writes what is read here");
        let whole = json!({ "format": FORMAT, "group": "lab", "version": "0", "interaction": 3,
            "unix_ms": null, "whole": true, "objects": [{ "name": "a", "label": "the cup" }],
            "moments": [{ "after_ms": 0, "event": { "type": "silence" }, "thought": null }],
            "left_out": 0, "end": null });
        assert!(read_as_file(&whole.to_string()).is_ok());
        let with = |key: &str, value: Value| {
            let mut json = whole.clone();
            json[key] = value;
            json.to_string()
        };
        for (content, found) in [
            (String::new(), "no JSON"),
            ("{\"a\": 1}".to_owned(), "no format"),
            ("[1]".to_owned(), "no format"),
            (with("format", json!("whichone.interaction/2")), "interaction/2"),
            (with("moments", json!(7)), "other content"),
        ] {
            let why = read_as_file(&content).unwrap_err();
            assert!(why.contains(found) && why.contains("help:"), "{why}");
        }
    }
}
