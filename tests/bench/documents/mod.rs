//! Figures of the documents beside those of reports. A table of a document belongs to the report if the
//! paragraph above it names the command that printed it:
//!
//! - `` `scripts/bench --processes` ``: rows are single figures, named as the report names them, and columns
//!   are `p50`, `p99`, `max`, `unit`, `peer` and `ratio` (of the p50 to the peer's); or rows are situations,
//!   and columns are `stop to rest, ms, p50` for the figure `stop to rest: SITUATION`;
//! - `` `scripts/bench --core`, "Exact values" ``: rows and columns are those of the report's table of
//!   that title.
//!
//! A documented number is off if it lies further outside the least and the greatest of the runs than its
//! last digit, and for what a machine decides a tenth, allows.

mod markdown;
mod measured;
mod number;
#[cfg(test)]
mod tests;

use crate::parts::Part;
use crate::report::{Report, latest, print};
use markdown::{Source, Table, plain};
use measured::Cell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The variable that changes what is measured.
const MODEL: &str = "WHICHONE_WHISPER_MODEL";

/// A cell of a document that belongs to the report, and what became of it.
struct Compared<'a> {
    table: &'a Table,
    row: usize,
    column: usize,
    outcome: Outcome,
}

enum Outcome {
    Found(Cell),
    /// Nothing of that name is in the report.
    Unbound,
}

/// The arguments of this process as reports hold them.
pub(crate) fn arguments() -> Vec<String> {
    let model = std::env::var_os(MODEL).map(|_| MODEL.to_owned());
    model.into_iter().chain(std::env::args().skip(1)).collect()
}

/// Prints every documented figure that reports hold or should hold. Fails if one is off.
pub(crate) fn compare(reports: &[PathBuf]) -> ExitCode {
    with_reports(reports, |reports| {
        let mut counts = [0; 3];
        for (name, path) in documents() {
            let text = std::fs::read_to_string(&path)?;
            for table in markdown::tables(&text) {
                let counted = compare_table(&name, &table, reports);
                counts.iter_mut().zip(counted).for_each(|(sum, count)| *sum += count);
            }
        }
        let [holds, off, unbound] = counts;
        print(&format!("{holds} as documented, {off} off, {unbound} unbound"));
        Ok(if off == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    })
}

/// Writes the medians of the reports into the tables of the documents.
pub(crate) fn write(reports: &[PathBuf]) -> ExitCode {
    with_reports(reports, |reports| {
        for (_, path) in documents() {
            let text = std::fs::read_to_string(&path)?;
            let new = written(&text, reports);
            if new != text {
                std::fs::write(path, new)?;
            }
        }
        Ok(ExitCode::SUCCESS)
    })
}

fn with_reports(
    paths: &[PathBuf],
    act: impl FnOnce(&[Report]) -> std::io::Result<ExitCode>,
) -> ExitCode {
    let paths = if paths.is_empty() { vec![latest()] } else { paths.to_vec() };
    let reports = paths.iter().map(|path| {
        let read = std::fs::read(path).and_then(|json| Ok(serde_json::from_slice(&json)?));
        read.map_err(|error| format!("{}: {error}; help: run scripts/bench first", path.display()))
    });
    let result = reports.collect::<Result<Vec<Report>, _>>();
    let result = result.and_then(|reports| act(&reports).map_err(|error| error.to_string()));
    result.unwrap_or_else(|error| {
        print(&error);
        ExitCode::from(74)
    })
}

/// The documents with figures, by name and path.
fn documents() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let pages = std::fs::read_dir(root.join("docs")).into_iter().flatten().flatten();
    let pages = pages.filter_map(|page| page.file_name().into_string().ok());
    let pages = pages.filter(|page| page.ends_with(".md")).map(|page| format!("docs/{page}"));
    let mut names: Vec<String> = pages.chain(["README.md".to_owned()]).collect();
    names.sort();
    names.into_iter().map(|name| (name.clone(), root.join(name))).collect()
}

/// Prints a table's cells. Returns how many are as documented, off, and unbound.
fn compare_table(document: &str, table: &Table, reports: &[Report]) -> [usize; 3] {
    let Some(Source { command, .. }) = &table.source else { return [0; 3] };
    if !is_bound(table) {
        print(&format!("{document}:{}: unbound: printed by `{command}`", table.line));
        return [0, 0, 1];
    }
    let Some(compared) = cells(table, reports) else {
        print(&format!("{document}:{}: not measured: `{command}`", table.line));
        return [0; 3];
    };
    let mut counts = [0; 3];
    for Compared { table, row, column, outcome } in compared {
        let (cells, head) = (&table.rows[row], &table.heads[column]);
        let at = format!("{document}:{}: {}, {head}", table.line_of(row), plain(&cells[0]));
        let (shown, counted) = match outcome {
            Outcome::Unbound => ("unbound: nothing of that name in the report".to_owned(), 2),
            Outcome::Found(cell) => {
                let (documented, spread) = (&cells[column], cell.spread());
                let holds = cell.holds(documented);
                let verdict = if holds { "as documented" } else { "OFF" };
                let measured = cell.text_like(documented);
                let spread = if spread.is_empty() { spread } else { format!(" ({spread})") };
                let shown = format!("{documented}, measured {measured}{spread}: {verdict}");
                (shown, usize::from(!holds))
            }
        };
        print(&format!("{at}: {shown}"));
        counts[counted] += 1;
    }
    counts
}

/// Returns whether a table shows figures or a table of the report.
fn is_bound(table: &Table) -> bool {
    table.source.as_ref().is_some_and(|Source { command, title }| {
        let is_of_figures = || table.heads.iter().any(|head| measured::is_statistic(head));
        command.contains("scripts/bench") && (title.is_some() || is_of_figures())
    })
}

/// Returns the document with the figures of the reports.
fn written(text: &str, reports: &[Report]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for table in markdown::tables(text) {
        let mut rows = table.rows.clone();
        for Compared { row, column, outcome, .. } in cells(&table, reports).into_iter().flatten() {
            if let Outcome::Found(cell) = outcome {
                rows[row][column] = cell.text_like(&table.rows[row][column]);
            }
        }
        for (n, cells) in rows.iter().enumerate().filter(|(n, cells)| **cells != table.rows[*n]) {
            lines[table.line_of(n) - 1] = markdown::row(cells);
        }
    }
    lines.join("\n") + "\n"
}

/// Returns the cells of a table that belong to reports; none if no report was made by its command.
fn cells<'a>(table: &'a Table, reports: &[Report]) -> Option<Vec<Compared<'a>>> {
    let source = table.source.as_ref().filter(|_| is_bound(table))?;
    let covers = |report: &&Report| covers(&report.arguments, &source.command);
    let reports: Vec<&Report> = reports.iter().filter(covers).collect();
    if reports.is_empty() {
        return None;
    }
    let tables = reports.iter().flat_map(|report| &report.tables);
    let tables: Vec<_> = tables.filter(|own| Some(&own.title) == source.title.as_ref()).collect();
    let find = |name: &str, head: &str| match &source.title {
        Some(_) => Cell::of_table(&tables, name, head),
        None => Cell::of_figure(&reports, name, head),
    };
    let mut compared = Vec::new();
    for (row, cells) in table.rows.iter().enumerate() {
        for (column, head) in table.heads.iter().enumerate().skip(1) {
            if matches!(cells.get(column).map(String::as_str), None | Some("–")) {
                continue;
            }
            let outcome = find(&plain(&cells[0]), &plain(head));
            let outcome = outcome.map_or(Outcome::Unbound, Outcome::Found);
            compared.push(Compared { table, row, column, outcome });
        }
    }
    Some(compared)
}

/// Returns whether a run with these arguments measures what the command does.
fn covers(arguments: &[String], command: &str) -> bool {
    let words = command.split_whitespace().filter(|word| *word != "scripts/bench");
    let words = words.map(|word| if word.starts_with(MODEL) { MODEL } else { word });
    let (parts, settings) = divided(words);
    let (own_parts, own_settings) = divided(without_runs(arguments).into_iter());
    let holds_all = |these: &[&str], those: &[&str]| these.iter().all(|it| those.contains(it));
    parts.iter().all(|part| part.is_measured_by(&own_parts))
        && holds_all(&settings, &own_settings)
        && holds_all(&own_settings, &settings)
}

/// The parts that words select, and the other words.
fn divided<'a>(words: impl Iterator<Item = &'a str>) -> (Vec<&'static Part>, Vec<&'a str>) {
    let (options, others): (Vec<_>, Vec<_>) =
        words.partition(|word| Part::of_option(word).is_some());
    (options.into_iter().filter_map(Part::of_option).collect(), others)
}

/// The arguments without the number of runs, which changes nothing that is measured.
fn without_runs(arguments: &[String]) -> Vec<&str> {
    let mut before = "";
    let words = arguments.iter().map(String::as_str);
    let kept = words.filter(|word| {
        let is_number = std::mem::replace(&mut before, word) == "--runs";
        !is_number && !word.starts_with("--runs")
    });
    kept.collect()
}
