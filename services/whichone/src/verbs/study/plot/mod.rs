//! Charts of a simulated study, each as SVG and as PNG.

mod histogram;
mod scatter;

use service::exit::{Exit, Failure};

use evaluation::simulation::Tally;

use super::design::Row;

/// File name and bytes.
pub(super) type Picture = (String, Vec<u8>);

/// Returns the files of every chart with data to show.
///
/// # Errors
/// A chart cannot be drawn.
pub(super) fn pictures(results: &[(&Row, Tally)]) -> Result<Vec<Picture>, Failure> {
    let (real_time, in_turns): (Vec<_>, Vec<_>) =
        results.iter().cloned().partition(|(row, _)| row.people.in_real_time());
    let mut charts = Vec::new();
    if !in_turns.is_empty() {
        let title = "Success and time per interaction, by policy";
        charts.push(("success", scatter::draw(title, &in_turns, |row| row.policy.clone())));
        charts.push(("questions", histogram::draw(&in_turns)));
    }
    if !real_time.is_empty() {
        let title = "Success and time per dialogue, by rules of turn-taking";
        charts.push(("turn-taking", scatter::draw(title, &real_time, |row| row.people.rules())));
    }
    let mut pictures = Vec::new();
    for (name, chart) in charts {
        let files = evaluation::charts::files(name, &chart)
            .map_err(|error| Failure::new(Exit::Storage, format!("{name}: {error}")))?;
        pictures.extend(files);
    }
    Ok(pictures)
}

/// Returns the position of a name in a list that holds it.
fn position(list: &[String], name: &str) -> usize {
    list.iter().position(|own| own == name).unwrap_or(0)
}

#[cfg(test)]
mod tests;
