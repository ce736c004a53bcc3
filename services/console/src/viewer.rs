//! A page for one shared interaction, without a group: `whichone-console view FILE`.

use std::io::{self, Write};
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
use page_history::shared;
use service::console_link::random_secret;
use service::exit::{Exit, Failure};
use web_server::request::is_for_this_machine;

use crate::server::{page_asset, secure};

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
        Arc::new(Shared { text: shared::read(file)?, path: format!("/shared/{}.json", secret()?) });
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
