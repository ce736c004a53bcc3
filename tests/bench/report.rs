//! The table that is printed and written.

use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// One measured figure.
#[derive(Debug, Serialize)]
pub(crate) struct Figure {
    what: String,
    unit: &'static str,
    runs: usize,
    p50: f64,
    p99: f64,
    /// The peer's name, and this p50 over the peer's.
    peer: Option<(String, f64)>,
    note: String,
}

/// Figures that belong together in rows and columns.
#[derive(Debug, Serialize)]
struct Table {
    title: String,
    note: String,
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// All figures of a run.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    figures: Vec<Figure>,
    tables: Vec<Table>,
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

impl Report {
    /// Adds a figure from its samples.
    pub(crate) fn add(&mut self, what: &str, unit: &'static str, samples: &[f64], note: &str) {
        self.figures.push(Figure {
            what: what.to_owned(),
            unit,
            runs: samples.len(),
            p50: percentile(samples, 0.5),
            p99: percentile(samples, 0.99),
            peer: None,
            note: note.to_owned(),
        });
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
        self.tables.push(Table { title: title.into(), note: note.into(), heads, rows });
    }

    /// Adds a figure with its ratio to a peer measured before.
    pub(crate) fn add_beside(
        &mut self,
        what: &str,
        unit: &'static str,
        samples: &[f64],
        peer: &str,
        note: &str,
    ) {
        self.add(what, unit, samples, note);
        let peer_p50 = self.figures.iter().find(|figure| figure.what == peer).map(|f| f.p50);
        if let (Some(peer_p50), Some(figure)) = (peer_p50, self.figures.last_mut()) {
            figure.peer = Some((peer.to_owned(), figure.p50 / peer_p50));
        }
    }

    /// All figures in one table, and the tables of figures below it.
    fn text(&self) -> String {
        let heads = ["figure", "runs", "p50", "p99", "unit", "ratio of p50 to peer", "note"];
        let row = |f: &Figure| {
            let peer = f.peer.as_ref();
            let peer = peer.map_or(String::new(), |(name, ratio)| format!("{ratio:.2} × {name}"));
            let [p50, p99] = [f.p50, f.p99].map(|value| format!("{value:.3}"));
            let (what, runs) = (f.what.clone(), f.runs.to_string());
            vec![what, runs, p50, p99, f.unit.to_owned(), peer, f.note.clone()]
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
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/bench");
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("report.md"), text)?;
        let json = serde_json::to_vec_pretty(self).map_err(std::io::Error::other)?;
        std::fs::write(folder.join("report.json"), json)
    }
}

fn markdown(heads: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = format!("|{}\n", "---|".repeat(heads.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(heads) + &rule + &rows
}
