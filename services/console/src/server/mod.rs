//! The web server: the page's files, sockets, and the API for programs.

mod access;
mod assets;
pub mod limits;
pub mod message;
pub mod routes;
pub(crate) mod socket;
pub mod web;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::{ConnectInfo, Request, State};
use axum::http::{HeaderMap, Method, Response, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Redirect};
use axum::routing::get;
use page_history::History;
use page_part::Files;
use page_scenes::{Operators, Scenes};
use web_server::connections::{Gate, Of};
use web_server::login::{form_limit, pause, token_of};
use web_server::request::{bearer, text, wants_page};
use web_server::security::{content_policy, harden};
use web_server::sessions::unix_s;

use crate::hub::Hub;
use crate::hub::outbound::PageSettings;
use crate::live::Live;
pub use access::Access;
pub use routes::page_asset;

/// Intervals of the server's progress reports with connected pages, and without.
const PROGRESS_EVERY: (Duration, Duration) = (Duration::from_millis(250), Duration::from_secs(1));

/// State and files that the server serves.
#[derive(Debug)]
pub struct App {
    pub hub: Hub,
    pub live: Live,
    pub history: Arc<History>,
    pub scenes: Arc<Scenes>,
    pub access: Arc<Access>,
    /// The interface for programs.
    pub http: Arc<http_api::Api>,
    pub group: String,
    pub settings: PageSettings,
    /// The robot's description (URDF).
    pub urdf: String,
    /// Folder with the sound of the robot's lines.
    pub voice_dir: Option<PathBuf>,
    /// Files of studies.
    pub study: Box<dyn Files>,
}

impl Operators for App {
    fn must_operate(&self, session: &str) -> Result<(), String> {
        self.hub.must_operate(session)
    }
}

/// Serves a listener until the hub ends.
pub async fn serve(gate: Gate, app: Arc<App>) -> std::io::Result<()> {
    let mut ending = app.hub.ending();
    let (beating, table) = (Arc::clone(&app), gate.table());
    let progress = tokio::spawn(async move {
        loop {
            beating.hub.progress.fetch_add(1, Ordering::Relaxed);
            let now = service::clock::now();
            beating.hub.tick(now);
            let (connected, alone) = PROGRESS_EVERY;
            tokio::time::sleep(if table.tick(now) { connected } else { alone }).await;
        }
    });
    let router = router(app).into_make_service_with_connect_info::<Of>();
    let served = axum::serve(gate, router)
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
        .route("/study/{file}", get(routes::study))
        .merge(page_history::routes(Arc::clone(&app.history)))
        .merge(page_scenes::routes(Arc::clone(&app.scenes), Arc::clone(&app) as Arc<dyn Operators>))
        .fallback(routes::asset)
        .layer(middleware::from_fn_with_state(Arc::clone(&app), admit))
        // The routes below are open without the token, or check it themselves.
        .merge(http_api::routes(Arc::clone(&app.http)))
        .route("/foxglove", get(routes::foxglove))
        .route("/healthz", get(routes::health))
        .route("/login", get(routes::asset).post(routes::login).layer(form_limit()))
        .layer(middleware::from_fn_with_state(Arc::clone(&app), address))
        .with_state(app)
}

/// Requires the token or a session, except for the files of the login page, which hold no data of
/// this robot. A link with the token gets a session: the token leaves the address.
async fn admit(
    State(app): State<Arc<App>>,
    ConnectInfo(Of(connection)): ConnectInfo<Of>,
    request: Request,
    next: Next,
) -> Response<Body> {
    let (is_get, uri) = (request.method() == Method::GET, request.uri());
    if let Some((token, rest)) = token_of(uri).filter(|_| is_get) {
        return routes::enter(&app, request.headers(), &token, &rest).await;
    }
    if app.access.is_known(request.headers(), unix_s()) {
        connection.prove();
        return next.run(request).await;
    }
    if assets::is_open(uri.path()) {
        return next.run(request).await;
    }
    if is_get && wants_page(request.headers()) {
        return Redirect::to("/login").into_response();
    }
    if bearer(request.headers()).is_some() {
        pause().await;
    }
    let what = Access::refusal(request.headers(), false);
    let help =
        "`whichone console` prints a link; programs send the header Authorization: Bearer TOKEN";
    (StatusCode::UNAUTHORIZED, format!("{what}; help: {help}\n")).into_response()
}

/// Rejects requests that are not addressed to this console, and adds the security headers.
async fn address(State(app): State<Arc<App>>, request: Request, next: Next) -> Response<Body> {
    let host = text(request.headers(), &header::HOST).map(str::to_owned);
    let mut response = if app.access.is_addressed(request.headers()) {
        next.run(request).await
    } else {
        let why =
            "this console serves its own machine only; help: use http://localhost and its port\n";
        (StatusCode::MISDIRECTED_REQUEST, why).into_response()
    };
    let camera = app.settings.camera.as_ref().map(|camera| camera.origin.as_str());
    secure(response.headers_mut(), host.as_deref(), camera);
    response
}

/// Adds security headers to an answer to a request that was addressed to `host`: no foreign
/// scripts, no framing, and no foreign pictures but those of the camera's origin.
pub fn secure(headers: &mut HeaderMap, host: Option<&str>, camera: Option<&str>) {
    // `'self'` covers sockets of the same host in newer browsers only.
    let plain =
        |host: &&str| host.bytes().all(|b| b.is_ascii_alphanumeric() || b".-:[]".contains(&b));
    let sockets = host.filter(plain).map(|host| format!(" ws://{host} wss://{host}"));
    let camera = camera.map(|origin| format!(" {origin}")).unwrap_or_default();
    let policy = content_policy(&format!(
        "img-src 'self' data: blob:{camera}; media-src 'self' blob:; connect-src 'self'{}; \
         worker-src 'self' blob:; ",
        sockets.unwrap_or_default()
    ));
    headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    harden(headers);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn policy(host: Option<&str>, camera: Option<&str>) -> String {
        let mut headers = HeaderMap::new();
        secure(&mut headers, host, camera);
        headers[header::CONTENT_SECURITY_POLICY].to_str().unwrap().to_owned()
    }

    #[test]
    fn headers_forbid_foreign_scripts() {
        let own = policy(Some("localhost:8377"), None);
        assert!(own.contains("connect-src 'self' ws://localhost:8377 wss://localhost:8377;"));
        assert!(!own.contains("unsafe"));
        assert!(!policy(Some("x; script-src *"), None).contains("script-src"));
    }

    #[test]
    fn headers_allow_pictures_of_the_cameras_origin_only() {
        let with_camera = policy(None, Some("http://camera:8080"));
        assert!(with_camera.contains("img-src 'self' data: blob: http://camera:8080;"));
        assert!(policy(None, None).contains("img-src 'self' data: blob:;"));
    }
}
