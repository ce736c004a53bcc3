//! `licences`: those of the libraries in this program.

use std::io::Read;

use command_line::Outcome;
use command_line::output::Output;
use flate2::read::GzDecoder;
use serde_json::json;
use service::exit::{Exit, Failure};

/// Written by `scripts/package notices`; `tests/dependencies.rs` compares it with the libraries.
const NOTICES: &[u8] = include_bytes!("../../notices.gz");

/// Prints the notices.
pub(super) fn licences(out: &mut Output<'_>) -> Outcome {
    let mut text = String::new();
    let read = GzDecoder::new(NOTICES).read_to_string(&mut text);
    read.map_err(|error| Failure::new(Exit::Invariant, format!("notices: {error}")))?;
    match out.is_json() {
        true => out.json(&json!({ "text": text }))?,
        false => out.text(&text)?,
    }
    Ok(Exit::Ok)
}
