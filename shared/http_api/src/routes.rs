//! The addresses below `/api/v1`.

use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::{ConnectInfo, State};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use discovery::Identity;
use serde::Serialize;
use web_server::connections::Of;

use crate::api::{Api, Caller, PATH};
use crate::problem::Problem;
use crate::state::Word;
use crate::tokens::Right;
use crate::{say, stream};

/// Description of the interface.
const OPENAPI: &str = include_str!("openapi.json");

type Shared = State<Arc<Api>>;
/// The connection of a request.
type On = ConnectInfo<Of>;

/// Makes the routes, which check their tokens themselves.
pub fn routes<S: Clone + Send + Sync + 'static>(api: Arc<Api>) -> Router<S> {
    let routes = Router::new()
        .route("/info", get(info))
        .route("/openapi.json", get(openapi))
        .route("/state", get(state))
        .route("/events", get(events))
        .route("/say", post(say))
        .route("/cancel", post(cancel))
        .route("/motion/stop", post(stop))
        .route("/motion/resume", post(resume))
        .fallback(|| async { Problem::not_found() })
        .method_not_allowed_fallback(|| async { Problem::method() })
        .with_state(api);
    Router::new().nest(PATH, routes)
}

/// The identity, and whether the robot can be talked with.
#[derive(Serialize)]
struct Info<'a> {
    #[serde(flatten)]
    identity: &'a Identity,
    online: bool,
}

async fn info(State(api): Shared) -> Response {
    let online = api.events.state().state != Word::Disconnected;
    as_json(&Info { identity: &api.identity, online })
}

async fn openapi() -> Response {
    ([(header::CONTENT_TYPE, "application/json")], OPENAPI).into_response()
}

async fn state(State(api): Shared, on: On, headers: HeaderMap) -> Result<Response, Problem> {
    may(&api, on, &headers, Right::See, "state").await?;
    Ok(as_json(&*api.events.state()))
}

async fn events(State(api): Shared, on: On, headers: HeaderMap) -> Result<Response, Problem> {
    let connection = Arc::clone(&on.0.0);
    let caller = may(&api, on, &headers, Right::See, "events").await?;
    let response = stream::serve(api, caller, &headers)?;
    // Its client is silent: it is bounded in number, and ends where nobody reads it.
    connection.become_page();
    Ok(response)
}

async fn say(
    State(api): Shared,
    on: On,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Problem> {
    let caller = api.caller(&headers, &on.0.0).await?;
    let words = say::read(body, &headers, &caller).await?;
    say::say(&api, &caller, words).await
}

async fn cancel(State(api): Shared, on: On, headers: HeaderMap) -> Result<Response, Problem> {
    let caller = api.caller(&headers, &on.0.0).await?;
    say::cancel(&api, &caller, &headers).await
}

async fn stop(State(api): Shared, on: On, headers: HeaderMap) -> Result<Response, Problem> {
    let caller = may(&api, on, &headers, Right::Stop, "stop").await?;
    let stopped = api.motion.stop().await;
    // Afterwards: nothing may delay it.
    let outcome = if stopped.is_ok() { "done" } else { "failed" };
    api.note(&caller, "stop", outcome, None);
    Ok(as_json(&stopped?))
}

async fn resume(
    State(api): Shared,
    on: On,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Problem> {
    let caller = may(&api, on, &headers, Right::Resume, "resume").await?;
    let stop = say::stop_to_release(body).await?;
    api.record(&caller, "resume", None).await?;
    Ok(as_json(&api.motion.resume(stop).await?))
}

/// Returns who makes a request that needs a right.
async fn may(
    api: &Api,
    ConnectInfo(Of(connection)): On,
    headers: &HeaderMap,
    right: Right,
    what: &str,
) -> Result<Caller, Problem> {
    let caller = api.caller(headers, &connection).await?;
    api.must(&caller, right, what)?;
    Ok(caller)
}

fn as_json(body: &impl Serialize) -> Response {
    let kind = [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
    // Everything here can be written.
    (kind, serde_json::to_string(body).unwrap_or_default()).into_response()
}
