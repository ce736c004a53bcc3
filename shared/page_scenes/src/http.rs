//! The scene editor's HTTP endpoints. Reading is for everyone who may open the page; all else is
//! for the page of the operator, which names its session.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, FromRequest, Path, Request, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Serialize;
use serde::de::DeserializeOwned;
use tokio::sync::OwnedSemaphorePermit;
use tokio::time::timeout;
use web_server::request::is_own;

use crate::desk::{Draft, Places, Refusal, Saving};
use crate::{Operators, Rank, Scenes};

/// Largest request: a scene file twice, as its text and as a document.
const BODY_MAX: usize = 8 << 20;
/// Time for a request to get a place and to arrive.
const BODY_PATIENCE: Duration = Duration::from_secs(30);

/// The header with the session of the page.
const SESSION: &str = "x-whichone-session";

/// What requests need of the console.
#[derive(Clone)]
struct Host {
    scenes: Arc<Scenes>,
    operators: Arc<dyn Operators>,
}

/// Makes the routes below `/api/scenes` and `/api/editor`.
pub fn routes<S>(scenes: Arc<Scenes>, operators: Arc<dyn Operators>) -> Router<S> {
    Router::new()
        .route("/api/scenes", get(list))
        .route("/api/scenes/{name}", get(open).put(save))
        .route("/api/scenes/{name}/use", post(use_scene))
        .route("/api/editor/new", get(new_scene))
        .route("/api/editor/check", post(check))
        .route("/api/editor/reach", post(reach))
        .layer(DefaultBodyLimit::max(BODY_MAX))
        .with_state(Host { scenes, operators })
}

type Answer = Result<Response, Refusal>;

async fn list(State(host): State<Host>, headers: HeaderMap) -> Answer {
    json(host.scenes.ask(host.rank(&headers), |desk| desk.list()).await?)
}

async fn open(State(host): State<Host>, Path(name): Path<String>, headers: HeaderMap) -> Answer {
    json(host.scenes.ask(host.rank(&headers), move |desk| desk.open(&name)).await?)
}

async fn new_scene(State(host): State<Host>, headers: HeaderMap) -> Answer {
    json(host.scenes.ask(host.rank(&headers), |desk| desk.new_scene()).await?)
}

async fn check(State(host): State<Host>, said: Operated<Draft>) -> Answer {
    let Operated(draft, _place) = said;
    json(host.scenes.ask(Rank::Operator, move |desk| desk.check(&draft)).await?)
}

async fn reach(State(host): State<Host>, said: Operated<Places>) -> Answer {
    let Operated(places, _place) = said;
    json(host.scenes.ask(Rank::Operator, move |desk| desk.reach(&places)).await?)
}

async fn save(
    State(host): State<Host>,
    Path(name): Path<String>,
    said: Operated<Saving>,
) -> Answer {
    let Operated(saving, _place) = said;
    json(host.scenes.ask(Rank::Operator, move |desk| desk.save(&name, &saving)).await?)
}

async fn use_scene(
    State(host): State<Host>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Answer {
    host.must_operate(&headers)?;
    json(host.scenes.ask(Rank::Operator, move |desk| desk.use_scene(&name)).await?)
}

/// Request of the operator's page, and its place among such requests. Nothing of a request is read
/// before it is known to be the operator's and has a place.
struct Operated<T>(T, OwnedSemaphorePermit);

impl<T: DeserializeOwned> FromRequest<Host> for Operated<T> {
    type Rejection = Refusal;

    async fn from_request(request: Request, host: &Host) -> Result<Self, Refusal> {
        host.must_operate(request.headers())?;
        let late =
            |_| Refusal::new(StatusCode::REQUEST_TIMEOUT, "the request did not arrive in 30 s");
        timeout(BODY_PATIENCE, async {
            let place = host.scenes.place().await?;
            let body = Bytes::from_request(request, host).await;
            let body = body.map_err(|error| Refusal::new(error.status(), error.body_text()))?;
            Ok(Self(read(&body)?, place))
        })
        .await
        .map_err(late)?
    }
}

impl Host {
    fn rank(&self, headers: &HeaderMap) -> Rank {
        if self.must_operate(headers).is_ok() { Rank::Operator } else { Rank::Viewer }
    }

    /// Checks that a request is of the operator's own page.
    fn must_operate(&self, headers: &HeaderMap) -> Result<(), Refusal> {
        let refuse = |why: &str| Refusal::new(StatusCode::FORBIDDEN, why);
        if !is_own(headers) {
            return Err(refuse("only the console's own pages may change scenes"));
        }
        let session = headers.get(SESSION).and_then(|session| session.to_str().ok());
        self.operators.must_operate(session.unwrap_or_default()).map_err(|why| refuse(&why))
    }
}

fn read<T: DeserializeOwned>(body: &Bytes) -> Result<T, Refusal> {
    let wrong = |error| Refusal::new(StatusCode::BAD_REQUEST, format!("invalid request: {error}"));
    serde_json::from_slice(body).map_err(wrong)
}

fn json(answer: impl Serialize) -> Answer {
    let text = serde_json::to_string(&answer).map_err(|error| {
        Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, format!("no answer: {error}"))
    })?;
    Ok(as_json(StatusCode::OK, text))
}

fn as_json(status: StatusCode, text: String) -> Response {
    let kind = [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
    (status, kind, text).into_response()
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        // It holds texts and numbers only.
        as_json(self.status, serde_json::to_string(&self).unwrap_or_default())
    }
}
