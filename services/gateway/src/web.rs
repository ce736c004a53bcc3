//! The gateway's addresses: `/` lists robots, `/ROBOT/…` is a robot's console, and `/_/…` are the gateway's own, which
//! no robot's name can be.

use std::sync::Arc;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{FromRequestParts, Path, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, Response, StatusCode, Uri, header};
use axum::middleware::{self, Next};
use axum::response::{AppendHeaders, IntoResponse, Redirect};
use axum::routing::{get, post};
use roster::Name;
use serde_json::json;

use crate::audit::{Entry, Outcome};
use crate::people::Right;
use crate::robots::Unreached;
use crate::sessions::SESSION_S;
use crate::socket::{self, FRAME_BYTES_MAX, Visit};
use crate::{Gateway, access, proxy};

/// Delay after a wrong secret, against guessing.
const PAUSE: std::time::Duration = std::time::Duration::from_secs(1);
/// Longest form with a secret, bytes.
const FORM_MAX: usize = 2_048;

/// The gateway's own files: path, type, contents. Colours and type are those of the console's page.
const FILES: [(&str, &str, &str); 5] = [
    ("base.css", "text/css", include_str!("../../console/page/css/base.css")),
    ("icon.svg", "image/svg+xml", include_str!("../../console/page/icon.svg")),
    ("fleet.css", "text/css", include_str!("../page/fleet.css")),
    ("fleet.js", "text/javascript", include_str!("../page/fleet.js")),
    ("early.js", "text/javascript", include_str!("../../console/page/js/early.js")),
];
const LIST: &str = include_str!("../page/fleet.html");
const LOGIN: &str = include_str!("../page/login.html");

type Shared = State<Arc<Gateway>>;

/// Makes the routes.
pub(crate) fn router(gateway: Arc<Gateway>) -> Router {
    Router::new()
        .route("/", get(list))
        .route("/_/robots", get(robots))
        .route("/_/login", get(login_page).post(login))
        .route("/_/logout", post(logout))
        .route("/_/healthz", get(|| async { "ready\n" }))
        .route("/_/{file}", get(file))
        .route("/{robot}", get(to_folder))
        .route("/{robot}/", get(robot_page))
        .route("/{robot}/{*path}", get(robot_page))
        .fallback(|| async { (StatusCode::NOT_FOUND, "page not found\n") })
        .layer(middleware::from_fn_with_state(Arc::clone(&gateway), guard))
        .with_state(gateway)
}

/// Rejects requests that are not addressed to this gateway, exchanges a link's secret for a session, and adds
/// security headers.
async fn guard(State(gateway): Shared, request: Request, next: Next) -> Response<Body> {
    let headers = request.headers();
    let mut response = if !gateway.address.is_addressed(headers) {
        let why = format!("this gateway serves {} only\n", gateway.address);
        (StatusCode::MISDIRECTED_REQUEST, why).into_response()
    } else if let Some(secret) = form_field(request.uri().query().unwrap_or_default(), "token")
        && request.method() == Method::GET
    {
        enter(&gateway, headers, &secret, request.uri().path()).await
    } else {
        next.run(request).await
    };
    let headers = response.headers_mut();
    // A console has said already what its page may load.
    headers.entry(header::CONTENT_SECURITY_POLICY).or_insert(HeaderValue::from_static(
        "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
    ));
    for (name, value) in [
        ("x-content-type-options", "nosniff"),
        ("x-frame-options", "DENY"),
        ("referrer-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
        ("permissions-policy", "microphone=(self), camera=(), geolocation=()"),
    ] {
        headers.insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
    response
}

/// The person of a request, or the answer to one who is not known.
async fn known(gateway: &Gateway, headers: &HeaderMap) -> Result<Name, Response<Body>> {
    if let Some(person) = access::person(headers, &gateway.people.current(), &gateway.sessions) {
        return Ok(person);
    }
    if access::bearer(headers).is_some() {
        tokio::time::sleep(PAUSE).await;
    }
    if wants_page(headers) {
        return Err(Redirect::to("/_/login").into_response());
    }
    let why = "log in at /_/login; programs send the header Authorization: Bearer SECRET\n";
    Err((StatusCode::UNAUTHORIZED, why).into_response())
}

fn wants_page(headers: &HeaderMap) -> bool {
    access::text(headers, &header::ACCEPT).is_some_and(|accepts| accepts.contains("text/html"))
}

async fn list(State(gateway): Shared, headers: HeaderMap) -> Response<Body> {
    match known(&gateway, &headers).await {
        Ok(_) => html(StatusCode::OK, LIST),
        Err(response) => response,
    }
}

async fn robots(State(gateway): Shared, headers: HeaderMap) -> Response<Body> {
    let person = match known(&gateway, &headers).await {
        Ok(person) => person,
        Err(response) => return response,
    };
    let robots = gateway.robots.list(&gateway.people.current(), &person).await;
    let version = env!("CARGO_PKG_VERSION");
    let kind = [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
    (kind, json!({ "person": person, "version": version, "robots": robots }).to_string())
        .into_response()
}

async fn to_folder(Path(robot): Path<String>) -> Response<Body> {
    match Name::new(&robot) {
        Ok(robot) => Redirect::to(&format!("/{robot}/")).into_response(),
        Err(_) => (StatusCode::NOT_FOUND, "page not found\n").into_response(),
    }
}

/// Everything of a robot's console, its socket included.
async fn robot_page(State(gateway): Shared, request: Request) -> Response<Body> {
    let (mut parts, _) = request.into_parts();
    let (headers, uri) = (parts.headers.clone(), parts.uri.clone());
    let person = match known(&gateway, &headers).await {
        Ok(person) => person,
        Err(response) => return response,
    };
    let (first, rest) = split(&uri);
    let right = Name::new(first).ok().and_then(|robot| {
        let right = gateway.people.current().right(&person, &robot)?;
        Some((robot, right))
    });
    // Whether there is such a robot is not for strangers to know.
    let Some((robot, right)) = right else {
        let why = format!(
            "{person} has no right to a robot {first}; help: ask who administers the gateway"
        );
        return refuse(&headers, StatusCode::FORBIDDEN, &why);
    };
    if rest == "/login" {
        return Redirect::to("/_/login").into_response();
    }
    let console = match gateway.robots.reach(&robot).await {
        Ok(console) => console,
        Err(why) => return unreached(&headers, &why),
    };
    if rest == "/ws" {
        let upgrade = WebSocketUpgrade::from_request_parts(&mut parts, &()).await;
        return match upgrade {
            Ok(upgrade) => open(gateway, &headers, upgrade, person, (robot, right), console).await,
            Err(rejection) => rejection.into_response(),
        };
    }
    if let Some(why) = proxy::denied(rest, right) {
        return refuse(&headers, StatusCode::FORBIDDEN, why);
    }
    let query = uri.query().map(|query| format!("?{query}")).unwrap_or_default();
    match proxy::pass(&console, &format!("{rest}{query}"), &headers).await {
        Ok(response) if response.status() == StatusCode::NOT_FOUND => {
            refuse(&headers, StatusCode::NOT_FOUND, "page not found")
        }
        Ok(response) => response,
        Err((status, why)) => refuse(&headers, status, &why),
    }
}

async fn open(
    gateway: Arc<Gateway>,
    headers: &HeaderMap,
    upgrade: WebSocketUpgrade,
    person: Name,
    (robot, right): (Name, Right),
    console: crate::robots::Console,
) -> Response<Body> {
    if !access::is_own(headers) {
        let why = "only pages of this gateway may open a robot's socket\n";
        return (StatusCode::FORBIDDEN, why).into_response();
    }
    let socket = match socket::open(&console, headers).await {
        Ok(socket) => socket,
        Err(why) => return (StatusCode::BAD_GATEWAY, format!("{why}\n")).into_response(),
    };
    let upgrade = upgrade.max_message_size(FRAME_BYTES_MAX).max_frame_size(FRAME_BYTES_MAX);
    upgrade.on_upgrade(move |page| async move {
        let _used = gateway.robots.used(&robot);
        Visit::new(&gateway, person, robot, right).serve(page, socket).await;
    })
}

/// The robot in an address, and the path from its console's `/` on.
fn split(uri: &Uri) -> (&str, &str) {
    let path = uri.path().trim_start_matches('/');
    let end = path.find('/').unwrap_or(path.len());
    path.split_at(end)
}

fn unreached(headers: &HeaderMap, why: &Unreached) -> Response<Body> {
    let mut response = refuse(headers, StatusCode::SERVICE_UNAVAILABLE, &why.to_string());
    // A browser looks again.
    response
        .headers_mut()
        .insert(HeaderName::from_static("refresh"), HeaderValue::from_static("2"));
    response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from_static("2"));
    response
}

fn refuse(headers: &HeaderMap, status: StatusCode, why: &str) -> Response<Body> {
    if !wants_page(headers) {
        return (status, format!("{}\n", why.trim_end())).into_response();
    }
    let why = why.replace('&', "&amp;").replace('<', "&lt;");
    html(
        status,
        &format!(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>whichone</title>\
         <link rel=\"stylesheet\" href=\"/_/base.css\"><link rel=\"stylesheet\" href=\"/_/fleet.css\">\
         <main class=\"notice\"><h1>{status}</h1><p>{why}</p><p><a href=\"/\">All robots</a></p></main></html>\n"
        ),
    )
}

fn html(status: StatusCode, text: &str) -> Response<Body> {
    let kind =
        [(header::CONTENT_TYPE, "text/html; charset=utf-8"), (header::CACHE_CONTROL, "no-store")];
    (status, kind, text.to_owned()).into_response()
}

async fn file(Path(name): Path<String>) -> Response<Body> {
    match FILES.iter().find(|(known, ..)| *known == name) {
        Some((_, kind, text)) => {
            let kind = format!("{kind}; charset=utf-8");
            ([(header::CONTENT_TYPE, kind), (header::CACHE_CONTROL, "no-cache".into())], *text)
                .into_response()
        }
        None => (StatusCode::NOT_FOUND, "page not found\n").into_response(),
    }
}

async fn login_page() -> Response<Body> {
    html(StatusCode::OK, LOGIN)
}

async fn login(State(gateway): Shared, headers: HeaderMap, form: Bytes) -> Response<Body> {
    if !access::is_own(&headers) {
        return (StatusCode::FORBIDDEN, "log in from the gateway's own page\n").into_response();
    }
    let form = std::str::from_utf8(&form).ok().filter(|form| form.len() <= FORM_MAX);
    let secret = form.and_then(|form| form_field(form, "token")).unwrap_or_default();
    enter(&gateway, &headers, &secret, "/").await
}

async fn logout(State(gateway): Shared, headers: HeaderMap) -> Response<Body> {
    if !access::is_own(&headers) {
        return (StatusCode::FORBIDDEN, "log out from the gateway's own page\n").into_response();
    }
    if let Some(value) = access::cookie(&headers) {
        gateway.sessions.end(&value);
    }
    let cookie = AppendHeaders([(header::SET_COOKIE, gateway.address.cookie(&headers, "", 0))]);
    (cookie, Redirect::to("/_/login")).into_response()
}

/// Exchanges a secret for a session and leads to a page: the secret does not stay in the address.
async fn enter(gateway: &Gateway, headers: &HeaderMap, secret: &str, page: &str) -> Response<Body> {
    let begun = gateway.sessions.begin(&gateway.people.current(), secret);
    let Some((person, value)) = begun else {
        tokio::time::sleep(PAUSE).await;
        return Redirect::to("/_/login?wrong").into_response();
    };
    gateway.audit.note(&Entry::new(&person, None, "login", Outcome::Done));
    let cookie = gateway.address.cookie(headers, &value, SESSION_S);
    // One slash: two would lead to another host. A redirect of another site's link would not carry the cookie.
    let page =
        format!("/{}", page.trim_start_matches('/')).replace('&', "&amp;").replace('"', "&quot;");
    let go_on = format!(
        "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={page}\"><title>whichone</title>\n"
    );
    let mut response = html(StatusCode::OK, &go_on);
    if let Ok(cookie) = HeaderValue::from_str(&cookie) {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
}

/// Returns a field of a form or a query whose value needs no decoding, as secrets do not.
fn form_field(form: &str, name: &str) -> Option<String> {
    let mut pairs = form.split('&').filter_map(|pair| pair.split_once('='));
    pairs.find(|(key, _)| *key == name).map(|(_, value)| value.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_divided_into_robot_and_path() {
        let split = |address: &str| {
            let uri: Uri = address.parse().unwrap();
            let (robot, path) = split(&uri);
            (robot.to_owned(), path.to_owned())
        };
        let of = |robot: &str, path: &str| (robot.to_owned(), path.to_owned());
        assert_eq!(split("/r1/"), of("r1", "/"));
        assert_eq!(split("/r1/api/history?limit=3"), of("r1", "/api/history"));
        assert_eq!(split("//r1//ws"), of("r1", "//ws"));
        assert_eq!(split("/r1"), of("r1", ""));
        assert!(Name::new("_").is_err(), "no robot has the gateway's own place");
    }
}
