//! Data and results, made from the study's files on each request.

use std::path::{Path, PathBuf};

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use user_study::Participant;

use super::files;

/// The files of studies in a folder.
#[derive(Debug)]
pub(super) struct Results(pub(super) PathBuf);

impl page_part::Files for Results {
    fn read(&self, name: &str) -> Response {
        read(&self.0, name)
    }
}

fn read(folder: &Path, name: &str) -> Response {
    let people = match files::read(folder) {
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
    match user_study::charts::svg(&chart) {
        Ok(text) => ([(header::CONTENT_TYPE, "image/svg+xml")], text).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, format!("{error}\n")).into_response(),
    }
}

fn download(name: &str, kind: &'static str, text: String) -> Response {
    let name = format!("attachment; filename=\"{name}\"");
    let heads = [(header::CONTENT_TYPE, kind.to_owned()), (header::CONTENT_DISPOSITION, name)];
    (heads, text).into_response()
}
