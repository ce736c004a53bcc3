//! The table that is printed and written.

use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

/// One measured figure.
#[derive(Debug, Serialize)]
pub(crate) struct Figure {
    pub(crate) what: String,
    /// The part of the benchmarks that measured it.
    pub(crate) part: &'static str,
    pub(crate) unit: String,
    runs: usize,
    pub(crate) p50: f64,
    pub(crate) p99: f64,
    pub(crate) max: f64,
    /// The peer's name, and this p50 over the peer's.
    pub(crate) peer: Option<(String, f64)>,
    note: String,
}

/// Figures that belong together in rows and columns.
#[derive(Debug, Serialize)]
pub(crate) struct Table {
    pub(crate) title: String,
    note: String,
    pub(crate) heads: Vec<String>,
    /// The first cell of a row is its name.
    pub(crate) rows: Vec<Vec<String>>,
}

/// All figures of a run.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    /// The part that is being measured.
    #[serde(skip)]
    pub(crate) part: &'static str,
    pub(crate) figures: Vec<Figure>,
    pub(crate) tables: Vec<Table>,
}

pub(crate) fn print(line: &str) {
    // A closed pipe is the reader's choice.
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// The value below which `share` of the samples lie.
pub(crate) fn percentile(samples: &[f64], share: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (share * (sorted.len().saturating_sub(1)) as f64).round() as usize;
    sorted.get(place).copied().unwrap_or(f64::NAN)
}

/// The folder of the reports.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/bench")
}

impl Report {
    /// Adds a figure from its samples, in the order in which they were taken.
    pub(crate) fn add(&mut self, what: &str, unit: &str, samples: &[f64], note: &str) {
        self.push(what, unit, samples, None, note);
    }

    /// Adds a figure with its ratio to a peer measured before.
    pub(crate) fn add_beside(
        &mut self,
        what: &str,
        unit: &str,
        samples: &[f64],
        peer: &str,
        note: &str,
    ) {
        let peer_p50 = self.figures.iter().rfind(|figure| figure.what == peer).map(|f| f.p50);
        let ratio = |peer_p50| (peer.to_owned(), percentile(samples, 0.5) / peer_p50);
        self.push(what, unit, samples, peer_p50.map(ratio), note);
    }

    fn push(
        &mut self,
        what: &str,
        unit: &str,
        samples: &[f64],
        peer: Option<(String, f64)>,
        note: &str,
    ) {
        if samples.is_empty() {
            return print(&format!("{what}: no samples"));
        }
        let [p50, p99, max] = [0.5, 0.99, 1.0].map(|share| percentile(samples, share));
        let [what, unit, note] = [what, unit, note].map(str::to_owned);
        let (runs, part) = (samples.len(), self.part);
        let figure = Figure { what, part, unit, runs, p50, p99, max, peer, note };
        self.figures.push(figure);
    }

    /// Adds a table.
    pub(crate) fn table<H: Into<String>>(
        &mut self,
        title: impl Into<String>,
        note: impl Into<String>,
        heads: impl IntoIterator<Item = H>,
        rows: Vec<Vec<String>>,
    ) {
        let heads = heads.into_iter().map(Into::into).collect();
        let (title, note) = (title.into(), note.into());
        self.tables.push(Table { title, note, heads, rows });
    }

    /// All figures in one table, and the tables of figures below it.
    pub(crate) fn text(&self) -> String {
        let heads = ["figure", "runs", "p50", "p99", "max", "unit", "ratio of p50 to peer", "note"];
        let row = |f: &Figure| {
            let peer = f.peer.as_ref();
            let peer = peer.map_or(String::new(), |(name, ratio)| format!("{ratio:.2} × {name}"));
            let [p50, p99, max] = [f.p50, f.p99, f.max].map(|value| format!("{value:.3}"));
            let (what, runs) = (f.what.clone(), f.runs.to_string());
            vec![what, runs, p50, p99, max, f.unit.clone(), peer, f.note.clone()]
        };
        let rows: Vec<Vec<String>> = self.figures.iter().map(row).collect();
        let mut text = markdown(&heads.map(str::to_owned), &rows);
        for table in &self.tables {
            let rows = markdown(&table.heads, &table.rows);
            text += &format!("\n## {}\n\n{}\n\n{rows}", table.title, table.note);
        }
        text
    }

    /// Prints the tables and writes them to `target/bench`.
    pub(crate) fn write(&self) -> std::io::Result<()> {
        let text = self.text();
        print(&text);
        std::fs::create_dir_all(folder())?;
        std::fs::write(folder().join("report.md"), text)?;
        let json = serde_json::to_vec_pretty(self).map_err(std::io::Error::other)?;
        std::fs::write(folder().join("report.json"), json)
    }
}

/// A table in Markdown.
pub(crate) fn markdown(heads: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = format!("|{}\n", "---|".repeat(heads.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(heads) + &rule + &rows
}
