//! The addresses below `/api/history`.

use std::sync::Arc;

use axum::Router;
use axum::extract::rejection::{PathRejection, QueryRejection};
use axum::extract::{Path, Query, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use serde::{Deserialize, Serialize};
use tokio::task::JoinHandle;

use crate::{History, PAGE_MAX};

/// Makes the routes; who may read is decided before.
pub fn routes<S>(history: Arc<History>) -> Router<S> {
    Router::new()
        .route("/api/history", get(page))
        .route("/api/history/{interaction}", get(interaction))
        .with_state(history)
}

/// The requested part of the history: at most `limit` interactions before number `before`.
#[derive(Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Part {
    before: u64,
    limit: usize,
}

impl Default for Part {
    fn default() -> Self {
        Self { before: u64::MAX, limit: PAGE_MAX }
    }
}

impl Part {
    fn of(query: Result<Query<Self>, QueryRejection>) -> Result<Self, String> {
        let form = format!("expected before=N and limit=M, whole numbers, M from 1 to {PAGE_MAX}");
        match query {
            Ok(Query(part)) if (1..=PAGE_MAX).contains(&part.limit) => Ok(part),
            Ok(Query(part)) => Err(format!("{form}; found limit={}\n", part.limit)),
            Err(error) => Err(format!("{form}; {}\n", error.body_text())),
        }
    }
}

/// A part of the list of past interactions, newest first.
async fn page(
    State(history): State<Arc<History>>,
    query: Result<Query<Part>, QueryRejection>,
) -> Response {
    match Part::of(query) {
        Ok(Part { before, limit }) => {
            as_json(tokio::task::spawn_blocking(move || Some(history.page(before, limit)))).await
        }
        Err(why) => (StatusCode::BAD_REQUEST, why).into_response(),
    }
}

/// One interaction with everything that happened in it.
async fn interaction(
    State(history): State<Arc<History>>,
    number: Result<Path<u64>, PathRejection>,
) -> Response {
    let Ok(Path(number)) = number else {
        let why = "expected /api/history/N with the number N of an interaction\n";
        return (StatusCode::BAD_REQUEST, why).into_response();
    };
    as_json(tokio::task::spawn_blocking(move || history.interaction(number))).await
}

/// The result of a blocking task as JSON, 404 without one.
async fn as_json<T: Serialize>(found: JoinHandle<Option<T>>) -> Response {
    let json = [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
    let found = found.await.map(|found| found.map(|found| serde_json::to_string(&found)));
    match found {
        Ok(Some(Ok(text))) => (json, text).into_response(),
        Ok(None) => (StatusCode::NOT_FOUND, "interaction not found\n").into_response(),
        _ => (StatusCode::INTERNAL_SERVER_ERROR, "the history cannot be read\n").into_response(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn history_refuses_what_is_not_a_part_of_it() {
        let of =
            |query: &str| Part::of(Query::try_from_uri(&format!("/?{query}").parse().unwrap()));
        assert_eq!(of(""), Ok(Part::default()));
        assert_eq!(of("limit=3&before=7"), Ok(Part { before: 7, limit: 3 }));
        let wrong = ["before=abc", "before=-1", "before=", "limit=0", "limit=201", "befor=7"];
        for query in wrong.into_iter().chain(["limit=99999999999999999999"]) {
            let why = of(query).unwrap_err();
            assert!(why.starts_with("expected before=N and limit=M"), "{query}: {why}");
        }
    }
}
