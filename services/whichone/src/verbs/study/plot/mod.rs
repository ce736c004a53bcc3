//! The study as pictures, each as SVG and as PNG.

mod histogram;
mod scatter;

use service::exit::Exit;

use evaluation::simulation::Tally;

use super::design::Row;
use crate::error::CliError;

/// A picture's file name and bytes.
pub(super) type Picture = (String, Vec<u8>);

/// Every picture of the study that there is something to show in.
///
/// # Errors
/// A picture that cannot be encoded.
pub(super) fn pictures(results: &[(&Row, Tally)]) -> Result<Vec<Picture>, CliError> {
    let (real_time, in_turns): (Vec<_>, Vec<_>) =
        results.iter().cloned().partition(|(row, _)| row.people.in_real_time());
    let mut canvases = Vec::new();
    if !in_turns.is_empty() {
        let title = "Success and time per interaction, by policy";
        canvases.push(("success", scatter::draw(title, &in_turns, |row| row.policy.clone())));
        canvases.push(("questions", histogram::draw(&in_turns)));
    }
    if !real_time.is_empty() {
        let title = "Success and time per dialogue, by rules of turn-taking";
        canvases.push(("turn-taking", scatter::draw(title, &real_time, |row| row.people.rules())));
    }
    let mut pictures = Vec::new();
    for (name, canvas) in canvases {
        pictures.push((format!("{name}.svg"), evaluation::charts::svg(&canvas).into_bytes()));
        let png = evaluation::charts::png(&canvas)
            .map_err(|error| CliError::new(Exit::Storage, format!("{name}.png: {error}")))?;
        pictures.push((format!("{name}.png"), png));
    }
    Ok(pictures)
}

/// The names in order of appearance, each once.
fn distinct(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    for name in names {
        if !list.contains(&name) {
            list.push(name);
        }
    }
    list
}

#[cfg(test)]
mod tests;
