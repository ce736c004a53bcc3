//! The web server: the page's files, sockets, and the API for programs.

mod access;
mod assets;
mod headers;
pub mod listen;
mod login;
pub mod message;
pub mod metrics;
pub mod routes;
mod socket;
pub mod web;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::{Method, Response, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Redirect};
use axum::routing::get;
use tokio::net::TcpListener;

use crate::hub::Hub;
use crate::hub::outbound::PageSettings;
pub use access::Access;

/// Interval of the server's progress reports.
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// State and files that the server serves.
#[derive(Debug)]
pub struct App {
    /// Shared with the main loop.
    pub hub: Hub,
    /// Access rules.
    pub access: Access,
    /// The group's name.
    pub group: String,
    /// Settings that concern pages.
    pub settings: PageSettings,
    /// The robot's description (URDF).
    pub urdf: String,
    /// Folder with the sound of the robot's lines.
    pub voice_dir: Option<PathBuf>,
    /// Folder with the data of studies.
    pub study_dir: PathBuf,
}

/// Serves a listener until the hub ends.
///
/// # Errors
/// The listener fails.
pub async fn serve(listener: TcpListener, app: Arc<App>) -> std::io::Result<()> {
    let mut ending = app.hub.ending();
    let beating = Arc::clone(&app);
    let progress = tokio::spawn(async move {
        let mut beat = tokio::time::interval(PROGRESS_EVERY);
        loop {
            beat.tick().await;
            beating.hub.advance();
            beating.hub.tick(service::clock::now());
        }
    });
    let served = axum::serve(listener, router(app))
        .with_graceful_shutdown(async move {
            // A hub that is gone ends the server, too.
            let _ = ending.wait_for(|ending| *ending).await;
        })
        .await;
    progress.abort();
    served
}

fn router(app: Arc<App>) -> Router {
    Router::new()
        .route("/ws", get(routes::socket))
        .route("/api/state", get(routes::state))
        .route("/metrics", get(routes::metrics))
        .route("/robot.urdf", get(routes::urdf))
        .route("/voice/{line}", get(routes::voice))
        .merge(crate::study::routes())
        .fallback(routes::asset)
        .layer(middleware::from_fn_with_state(Arc::clone(&app), admit))
        // The routes below are open without the token.
        .route("/healthz", get(routes::health))
        .route("/login", get(routes::asset).post(login::login))
        .layer(middleware::from_fn_with_state(Arc::clone(&app), address))
        .with_state(app)
}

/// Requires the token, except for the files of the login page, which hold no data of this robot.
async fn admit(State(app): State<Arc<App>>, request: Request, next: Next) -> Response<Body> {
    if assets::is_open(request.uri().path()) || app.access.is_known(request.headers()) {
        return next.run(request).await;
    }
    let wants_page = request
        .headers()
        .get(header::ACCEPT)
        .is_some_and(|accepts| accepts.to_str().is_ok_and(|accepts| accepts.contains("text/html")));
    if wants_page && request.method() == Method::GET {
        return Redirect::to("/login").into_response();
    }
    (StatusCode::UNAUTHORIZED, "token required; help: Authorization: Bearer TOKEN\n")
        .into_response()
}

/// Rejects requests that are not addressed to this console, and adds the security headers.
async fn address(State(app): State<Arc<App>>, request: Request, next: Next) -> Response<Body> {
    let host = request.headers().get(header::HOST);
    let host = host.and_then(|host| host.to_str().ok()).map(str::to_owned);
    let mut response = if app.access.is_addressed(request.headers()) {
        next.run(request).await
    } else {
        let why =
            "this console serves its own machine only; help: use http://localhost and its port\n";
        (StatusCode::MISDIRECTED_REQUEST, why).into_response()
    };
    headers::secure(response.headers_mut(), host.as_deref());
    response
}
