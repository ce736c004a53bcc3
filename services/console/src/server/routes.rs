//! Responses to single requests.

use std::sync::Arc;

use axum::body::{Body, Bytes};
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{ConnectInfo, Path, State};
use axum::http::{HeaderMap, Method, Response, StatusCode, Uri, header};
use axum::response::{AppendHeaders, IntoResponse, Redirect};
use messages::SoundFile;
use recording::live::SUBPROTOCOL;
use service::Span;
use service::clock;
use web_server::connections::Of;
use web_server::login::{form_field, pause, secret_of, stepping_stone};
use web_server::request::{bearer, is_own, origin, wants_page};
use web_server::sessions::unix_s;

use super::message::FRAME_BYTES_MAX;
use super::{Access, App, assets, socket as sockets};
use crate::hub::Role;
use crate::live;

/// Longest silence of a healthy main loop.
const WELL: Span = Span::from_ms(3_000);
/// Largest sound of a line, bytes.
const SOUND_MAX: u64 = 16 << 20;

pub(super) async fn socket(
    State(app): State<Arc<App>>,
    ConnectInfo(Of(connection)): ConnectInfo<Of>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response<Body> {
    if !is_own(&headers) {
        let why = "only the console's own pages may open its socket\n";
        return (StatusCode::FORBIDDEN, why).into_response();
    }
    upgrade
        .max_message_size(FRAME_BYTES_MAX)
        .max_frame_size(FRAME_BYTES_MAX)
        .on_upgrade(move |socket| sockets::serve(socket, connection, app))
}

/// The live view. Its viewers cannot follow the redirect by which a page's link with the token
/// becomes a session, so that the token may be in the address itself.
pub(super) async fn foxglove(
    State(app): State<Arc<App>>,
    ConnectInfo(Of(connection)): ConnectInfo<Of>,
    headers: HeaderMap,
    uri: Uri,
    upgrade: WebSocketUpgrade,
) -> Response<Body> {
    let query = uri.query().unwrap_or_default();
    if let Err((status, why)) = admitted(&app, &headers, query).await {
        return (status, why).into_response();
    }
    connection.prove();
    if !app.live.is_possible {
        let why = "too few file descriptors for a live view; help: raise the limit (ulimit -n)\n";
        return (StatusCode::SERVICE_UNAVAILABLE, why).into_response();
    }
    let role = match form_field(query, "role").as_deref() {
        Some("operator") => Role::Operator,
        Some("viewer") | None => Role::Viewer,
        Some(other) => {
            let why = format!("role: `{other}` is not one of operator, viewer\n");
            return (StatusCode::BAD_REQUEST, why).into_response();
        }
    };
    let upgrade = upgrade.protocols([SUBPROTOCOL]);
    if upgrade.selected_protocol().is_none() {
        let why =
            format!("expected the subprotocol {SUBPROTOCOL}; help: use a viewer that speaks it\n");
        return (StatusCode::BAD_REQUEST, why).into_response();
    }
    upgrade
        .max_message_size(FRAME_BYTES_MAX)
        .max_frame_size(FRAME_BYTES_MAX)
        .on_upgrade(move |socket| live::serve(socket, connection, app, role))
}

/// Checks that a viewer shows the token or a session, and comes from an origin that may connect.
async fn admitted(app: &App, headers: &HeaderMap, query: &str) -> Result<(), (StatusCode, String)> {
    let token = form_field(query, "token");
    let is_right = token.as_deref().is_some_and(|token| app.access.is_token(token));
    if !is_right && !app.access.is_known(headers, unix_s()) {
        if token.is_some() || bearer(headers).is_some() {
            pause().await;
        }
        let what = Access::refusal(headers, token.is_some());
        let help = "add ?token=TOKEN to the address; `whichone console` prints the token in a link";
        return Err((StatusCode::UNAUTHORIZED, format!("{what}; help: {help}\n")));
    }
    let origin = origin(headers);
    if is_own(headers) || origin.is_some_and(|origin| app.live.admits(origin)) {
        return Ok(());
    }
    let found = origin.unwrap_or("none");
    let why = format!(
        "expected the origin of the console or one of console.foxglove_origins, found {found}\n"
    );
    Err((StatusCode::FORBIDDEN, why))
}

pub(super) async fn state(State(app): State<Arc<App>>) -> Response<Body> {
    let json = [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
    (json, app.hub.board.all()).into_response()
}

/// A file of the studies.
pub(super) async fn study(State(app): State<Arc<App>>, Path(name): Path<String>) -> Response<Body> {
    let answer = tokio::task::spawn_blocking(move || app.study.read(&name)).await;
    answer.unwrap_or_else(|_| StatusCode::INTERNAL_SERVER_ERROR.into_response())
}

pub(super) async fn metrics(State(app): State<Arc<App>>) -> Response<Body> {
    let kind = "application/openmetrics-text; version=1.0.0; charset=utf-8";
    // It looks at a folder.
    match tokio::task::spawn_blocking(move || app.hub.metrics.text()).await {
        Ok(text) => ([(header::CONTENT_TYPE, kind)], text).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

pub(super) async fn health(State(app): State<Arc<App>>) -> Response<Body> {
    let silent = clock::now().since(app.hub.alive_at());
    match silent > WELL {
        true => (StatusCode::SERVICE_UNAVAILABLE, "the main loop hangs\n").into_response(),
        false => (StatusCode::OK, "ready\n").into_response(),
    }
}

pub(super) async fn urdf(State(app): State<Arc<App>>) -> Response<Body> {
    let kind = [(header::CONTENT_TYPE, "application/xml"), (header::CACHE_CONTROL, "no-cache")];
    (kind, app.urdf.clone()).into_response()
}

pub(super) async fn voice(State(app): State<Arc<App>>, Path(line): Path<String>) -> Response<Body> {
    let none = || (StatusCode::NOT_FOUND, "sound not found\n").into_response();
    let (Some(folder), Some(file)) = (&app.voice_dir, SoundFile::parse(&line)) else {
        return none();
    };
    let file = folder.join(file.to_string());
    let read = tokio::task::spawn_blocking(move || {
        let small = std::fs::metadata(&file).is_ok_and(|file| file.len() <= SOUND_MAX);
        small.then(|| std::fs::read(file).ok()).flatten()
    });
    match read.await {
        Ok(Some(sound)) => {
            let kind = [(header::CONTENT_TYPE, "audio/wav"), (header::CACHE_CONTROL, "no-cache")];
            (kind, sound).into_response()
        }
        _ => none(),
    }
}

pub(super) async fn asset(method: Method, uri: Uri, headers: HeaderMap) -> Response<Body> {
    if method != Method::GET && method != Method::HEAD {
        return StatusCode::METHOD_NOT_ALLOWED.into_response();
    }
    page_asset(uri.path(), &headers)
}

/// Returns the response to a request for a file of the page.
pub fn page_asset(path: &str, headers: &HeaderMap) -> Response<Body> {
    match assets::find(path) {
        Some(asset) => asset.respond(headers),
        None => missing(headers),
    }
}

fn missing(headers: &HeaderMap) -> Response<Body> {
    let page = assets::find("/404.html").filter(|_| wants_page(headers));
    let plain = || (StatusCode::NOT_FOUND, "page not found\n").into_response();
    page.map_or_else(plain, |page| {
        let mut response = page.respond(&HeaderMap::new());
        *response.status_mut() = StatusCode::NOT_FOUND;
        response
    })
}

pub(super) async fn login(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    form: Bytes,
) -> Response<Body> {
    if !is_own(&headers) {
        return (StatusCode::FORBIDDEN, "log in from the console's own page\n").into_response();
    }
    let token = secret_of(&form);
    enter(&app, &headers, &token, "/").await
}

/// Exchanges the token for a session and leads to a page; back to the login page if it is wrong.
pub(super) async fn enter(
    app: &App,
    headers: &HeaderMap,
    token: &str,
    page: &str,
) -> Response<Body> {
    let unseen = [(header::CACHE_CONTROL, "no-store")];
    if app.access.is_known(headers, unix_s()) {
        return (unseen, Redirect::to(page)).into_response();
    }
    match app.access.log_in(headers, token, unix_s()) {
        Some(cookie) => {
            let cookie = AppendHeaders([(header::SET_COOKIE, cookie)]);
            let site = headers.get("sec-fetch-site").and_then(|site| site.to_str().ok());
            let from_elsewhere = site == Some("cross-site");
            if !from_elsewhere {
                return (unseen, cookie, Redirect::to(page)).into_response();
            }
            // A redirect of another site's link would lack the cookie; the page's own one has it.
            let go_on = stepping_stone(page, "icon.svg");
            let kind = [(header::CONTENT_TYPE, "text/html; charset=utf-8")];
            (unseen, cookie, kind, go_on).into_response()
        }
        None => {
            pause().await;
            (unseen, Redirect::to("/login?wrong")).into_response()
        }
    }
}
