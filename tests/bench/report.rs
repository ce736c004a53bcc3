//! The table that is printed and written.

pub(crate) use evaluation::charts::Series;
use evaluation::charts::{Chart, Scale};
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
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) note: String,
    pub(crate) heads: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

/// Lines of cost in microseconds over one thing that grows.
#[derive(Debug, Serialize)]
pub(crate) struct Plot {
    /// Name of its files.
    pub(crate) file: &'static str,
    /// The growing quantity.
    pub(crate) over: &'static str,
    #[serde(serialize_with = "by_name")]
    pub(crate) series: Vec<Series>,
}

/// The points of each line under its name.
fn by_name<S: serde::Serializer>(series: &[Series], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(series.iter().map(|line| (&line.name, &line.points)))
}

/// All figures of a run.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    figures: Vec<Figure>,
    pub(crate) tables: Vec<Table>,
    pub(crate) plots: Vec<Plot>,
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
        for Plot { file, over, series } in &self.plots {
            let rows = plotted(series);
            text += &format!("\n## Cost over {over}\n\nMedian, µs; plots: {file}.svg, {file}.png.");
            text += &format!("\n\n{rows}");
        }
        text
    }

    /// Prints the tables and writes them, and the plots, to `target/bench`.
    pub(crate) fn write(&self) -> std::io::Result<()> {
        let text = self.text();
        print(&text);
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/bench");
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("report.md"), text)?;
        let json = serde_json::to_vec_pretty(self).map_err(std::io::Error::other)?;
        std::fs::write(folder.join("report.json"), json)?;
        self.plots.iter().try_for_each(|plot| plot.write(&folder))
    }
}

impl Plot {
    fn write(&self, folder: &Path) -> std::io::Result<()> {
        let title = format!("Cost over the number of {}", self.over);
        let labels = (self.over, "median, µs");
        let chart = Chart::lines(&title, labels, Scale::Logarithmic, &self.series)
            .and_then(|chart| evaluation::charts::files(self.file, &chart))
            .map_err(std::io::Error::other)?;
        chart.iter().try_for_each(|(name, bytes)| std::fs::write(folder.join(name), bytes))
    }
}

/// The points of a plot as a table.
fn plotted(series: &[Series]) -> String {
    let xs = series.first().map(|first| first.points.iter().map(|(x, _)| x.to_string()));
    let heads: Vec<String> =
        std::iter::once(String::new()).chain(xs.into_iter().flatten()).collect();
    let row = |series: &Series| {
        let ys = series.points.iter().map(|(_, y)| format!("{y:.2}"));
        std::iter::once(series.name.clone()).chain(ys).collect()
    };
    markdown(&heads, &series.iter().map(row).collect::<Vec<_>>())
}

fn markdown(heads: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = format!("|{}\n", "---|".repeat(heads.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(heads) + &rule + &rows
}
