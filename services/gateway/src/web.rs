//! The gateway's addresses: `/` lists robots, `/ROBOT/…` is a robot's console, and `/_/…` are the
//! gateway's own, which no robot's name can be.

use std::sync::Arc;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{ConnectInfo, FromRequestParts, Path, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, Response, StatusCode, Uri, header};
use axum::middleware::{self, Next};
use axum::response::{AppendHeaders, IntoResponse, Redirect};
use axum::routing::{get, post};
use roster::Name;
use serde_json::json;
use web_server::connections::{Connection, Of};
use web_server::login::{form_limit, pause, secret_of, stepping_stone, token_of};
use web_server::request::{bearer, is_own, wants_page};
use web_server::security::{content_policy, harden};

use crate::access::Known;
use crate::audit::{Entry, Outcome};
use crate::people::Right;
use crate::robots::Unreached;
use crate::socket::{self, FRAME_BYTES_MAX, Visit};
use crate::{Gateway, access, programs, proxy};

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

const TOO_OFTEN: &str = "too many logins, pages and orders at a time; help: wait a moment\n";

type Shared = State<Arc<Gateway>>;
/// The connection of a request.
type On = ConnectInfo<Of>;

/// Makes the routes.
pub(crate) fn router(gateway: Arc<Gateway>) -> Router {
    Router::new()
        .route("/", get(list))
        .route("/_/robots", get(robots))
        .route("/_/login", get(login_page).post(login).layer(form_limit()))
        .route("/_/logout", post(logout))
        .route("/_/healthz", get(|| async { "ready\n" }))
        .route("/_/{file}", get(file))
        .route("/{robot}", get(to_folder))
        .route("/{robot}/", get(robot_page))
        .route("/{robot}/api/v1/{*path}", get(program).post(program))
        .route("/{robot}/{*path}", get(robot_page))
        .fallback(|| async { (StatusCode::NOT_FOUND, "page not found\n") })
        .layer(middleware::from_fn_with_state(Arc::clone(&gateway), guard))
        .with_state(gateway)
}

/// Rejects requests that are not addressed to this gateway, exchanges a link's secret for a
/// session, and adds security headers.
async fn guard(State(gateway): Shared, request: Request, next: Next) -> Response<Body> {
    let headers = request.headers();
    let mut response = if !gateway.address.is_addressed(headers) {
        let why = format!("this gateway serves {} only\n", gateway.address);
        (StatusCode::MISDIRECTED_REQUEST, why).into_response()
    } else if let Some((secret, page)) = token_of(request.uri())
        && request.method() == Method::GET
    {
        enter(&gateway, headers, &secret, &page).await
    } else {
        next.run(request).await
    };
    let headers = response.headers_mut();
    // A console has already declared the permitted sources of its page.
    headers.entry(header::CONTENT_SECURITY_POLICY).or_insert_with(|| content_policy(""));
    harden(headers);
    response
}

/// The person of a request, whose connection is proven, or the answer to one who is not known.
async fn known(
    gateway: &Gateway,
    connection: &Connection,
    headers: &HeaderMap,
) -> Result<Known, Response<Body>> {
    if let Some(known) = Known::of(headers, &gateway.people.current(), &gateway.sessions) {
        connection.prove();
        return Ok(known);
    }
    if bearer(headers).is_some() {
        pause().await;
    }
    if wants_page(headers) {
        return Err(Redirect::to("/_/login").into_response());
    }
    let why = "log in at /_/login; programs send the header Authorization: Bearer SECRET\n";
    Err((StatusCode::UNAUTHORIZED, why).into_response())
}

async fn list(State(gateway): Shared, on: On, headers: HeaderMap) -> Response<Body> {
    match known(&gateway, &on.0.0, &headers).await {
        Ok(_) => html(StatusCode::OK, LIST),
        Err(response) => response,
    }
}

async fn robots(State(gateway): Shared, on: On, headers: HeaderMap) -> Response<Body> {
    let person = match known(&gateway, &on.0.0, &headers).await {
        Ok(known) => known.person,
        Err(response) => return response,
    };
    let robots = gateway.robots.list(&gateway.people.current(), &person).await;
    let version = build_info::full_version();
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

/// The interface for programs of a robot's console.
async fn program(State(gateway): Shared, on: On, request: Request) -> Response<Body> {
    let (parts, body) = request.into_parts();
    let ConnectInfo(Of(connection)) = on;
    let Ok(known) = known(&gateway, &connection, &parts.headers).await else {
        let why = "unknown secret; programs send the header Authorization: Bearer SECRET";
        return programs::problem(StatusCode::UNAUTHORIZED, why);
    };
    let (first, rest) = split(&parts.uri);
    let (robot, right) = match right_to(&gateway, &known.person, first) {
        Ok(right) => right,
        Err(why) => return programs::problem(StatusCode::FORBIDDEN, &why),
    };
    let console = match gateway.robots.reach(&robot).await {
        Ok(console) => console,
        Err(why) => return programs::problem(StatusCode::SERVICE_UNAVAILABLE, &why.to_string()),
    };
    let visitor = programs::Visitor { person: &known.person, robot: &robot, right };
    programs::serve(&gateway, visitor, &console, &parts, (rest, body)).await
}

/// Returns a robot and the person's right to it, or why there is none. Whether there is such a
/// robot is not for strangers to know.
fn right_to(gateway: &Gateway, person: &Name, robot: &str) -> Result<(Name, Right), String> {
    let right = Name::new(robot).ok().and_then(|robot| {
        let right = gateway.people.current().right(person, &robot)?;
        Some((robot, right))
    });
    let help = "help: ask who administers the gateway";
    right.ok_or_else(|| format!("{person} has no right to a robot {robot}; {help}"))
}

/// Everything else of a robot's console, its socket included.
async fn robot_page(State(gateway): Shared, on: On, request: Request) -> Response<Body> {
    let (mut parts, _) = request.into_parts();
    let (headers, uri) = (parts.headers.clone(), parts.uri.clone());
    let ConnectInfo(Of(connection)) = on;
    let known = match known(&gateway, &connection, &headers).await {
        Ok(known) => known,
        Err(response) => return response,
    };
    let (first, rest) = split(&uri);
    let (robot, right) = match right_to(&gateway, &known.person, first) {
        Ok(right) => right,
        Err(why) => return refuse(&headers, StatusCode::FORBIDDEN, &why),
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
            Ok(upgrade) => {
                let visitor = (known, connection);
                open(gateway, &headers, upgrade, visitor, (robot, right), console).await
            }
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
    (known, connection): (Known, Arc<Connection>),
    (robot, right): (Name, Right),
    console: crate::robots::Console,
) -> Response<Body> {
    if !is_own(headers) {
        let why = "only pages of this gateway may open a robot's socket\n";
        return (StatusCode::FORBIDDEN, why).into_response();
    }
    if !gateway.budgets.take(&known.person) {
        return (StatusCode::TOO_MANY_REQUESTS, TOO_OFTEN).into_response();
    }
    let Some(place) = gateway.places.take(&known.person) else {
        let why = format!("{} has too many pages open; help: close some\n", known.person);
        return (StatusCode::TOO_MANY_REQUESTS, why).into_response();
    };
    let socket = match socket::open(&console, headers).await {
        Ok(socket) => socket,
        Err(why) => return (StatusCode::BAD_GATEWAY, format!("{why}\n")).into_response(),
    };
    let upgrade = upgrade.max_message_size(FRAME_BYTES_MAX).max_frame_size(FRAME_BYTES_MAX);
    upgrade.on_upgrade(move |page| async move {
        connection.become_page();
        let (_used, _place) = (gateway.robots.used(&robot), place);
        Visit::new(&gateway, known, robot, right).serve(page, socket).await;
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
    if !is_own(&headers) {
        return (StatusCode::FORBIDDEN, "log in from the gateway's own page\n").into_response();
    }
    let secret = secret_of(&form);
    enter(&gateway, &headers, &secret, "/").await
}

async fn logout(State(gateway): Shared, headers: HeaderMap) -> Response<Body> {
    if !is_own(&headers) {
        return (StatusCode::FORBIDDEN, "log out from the gateway's own page\n").into_response();
    }
    gateway.sessions.end(&headers);
    let cookie = gateway.sessions.cookie(&headers, None, gateway.address.is_https());
    let cookie = AppendHeaders([(header::SET_COOKIE, cookie)]);
    (cookie, Redirect::to("/_/login")).into_response()
}

/// Exchanges a secret for a session and leads to a page: the secret does not stay in the address.
async fn enter(gateway: &Gateway, headers: &HeaderMap, secret: &str, page: &str) -> Response<Body> {
    let people = gateway.people.current();
    if let Some(person) = people.with_secret(secret)
        && !gateway.budgets.take(person)
    {
        return (StatusCode::TOO_MANY_REQUESTS, TOO_OFTEN).into_response();
    }
    let begun = access::log_in(&people, &gateway.sessions, secret);
    let Some((person, value)) = begun else {
        pause().await;
        return Redirect::to("/_/login?wrong").into_response();
    };
    gateway.audit.note(&Entry::new(&person, None, "login", Outcome::Done));
    let cookie = gateway.sessions.cookie(headers, Some(&value), gateway.address.is_https());
    let mut response = html(StatusCode::OK, &stepping_stone(page, "/_/icon.svg"));
    if let Ok(cookie) = HeaderValue::from_str(&cookie) {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
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
