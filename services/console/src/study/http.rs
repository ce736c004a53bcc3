//! The study's HTTP endpoints: data and results, read from its files on each request.

use std::path::PathBuf;
use std::sync::Arc;

use axum::Router;
use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use evaluation::user_study::{self, Participant};

use super::files;
use crate::server::App;

/// Everything below `/study/`.
pub fn routes() -> Router<Arc<App>> {
    Router::new().route("/study/{file}", get(file))
}

async fn file(State(app): State<Arc<App>>, Path(name): Path<String>) -> Response {
    let folder = app.study_dir.clone();
    let answer = tokio::task::spawn_blocking(move || serve(folder, &name)).await;
    answer.unwrap_or_else(|_| StatusCode::INTERNAL_SERVER_ERROR.into_response())
}

fn serve(folder: PathBuf, name: &str) -> Response {
    let people = match files::read(&folder) {
        Ok(people) => people,
        Err(why) => return (StatusCode::INTERNAL_SERVER_ERROR, why + "\n").into_response(),
    };
    let csv = |text: String| download(name, "text/csv; charset=utf-8", text);
    match name {
        "export.csv" | "interactions.csv" => csv(user_study::tables(&people).interactions),
        "participants.csv" => csv(user_study::tables(&people).participants),
        "dictionary.csv" => csv(user_study::tables(&people).dictionary),
        "export.json" => {
            download(name, "application/json", format!("{:#}\n", user_study::to_json(&people)))
        }
        "report.json" => {
            let report = user_study::report(&people).to_json();
            ([(header::CONTENT_TYPE, "application/json")], report.to_string()).into_response()
        }
        _ => picture(&people, name),
    }
}

fn picture(people: &[Participant], name: &str) -> Response {
    let pictures = user_study::pictures(&user_study::report(people));
    let wanted = name.strip_suffix(".svg");
    let found = pictures.into_iter().find(|(name, _)| Some(*name) == wanted);
    let Some((_, chart)) = found else {
        return (StatusCode::NOT_FOUND, "the study has no such file\n").into_response();
    };
    match evaluation::charts::svg(&chart) {
        Ok(text) => ([(header::CONTENT_TYPE, "image/svg+xml")], text).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, format!("{error}\n")).into_response(),
    }
}

fn download(name: &str, kind: &'static str, text: String) -> Response {
    let name = format!("attachment; filename=\"{name}\"");
    let heads = [(header::CONTENT_TYPE, kind.to_owned()), (header::CONTENT_DISPOSITION, name)];
    (heads, text).into_response()
}
