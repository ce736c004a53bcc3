//! Values of a cell in the runs of the reports, and how a documented cell compares with them.

use super::markdown::plain;
use super::number::{Number, numbers, replaced, significant};
use crate::report::{Figure, Report, Table, percentile};

/// Share of a measured value by which runs on one machine may differ on two days.
const DRIFT: f64 = 0.1;

/// A cell in every run.
#[derive(Debug, Default)]
pub(super) struct Cell {
    /// As the last run shows it.
    text: String,
    /// Each of its numbers.
    numbers: Vec<Spread>,
    /// True if the numbers depend on the machine.
    is_measured: bool,
}

/// A number in every run: its median, the least and the greatest.
#[derive(Clone, Copy, Debug)]
struct Spread {
    median: f64,
    least: f64,
    greatest: f64,
}

impl Spread {
    fn of(runs: &[[f64; 3]]) -> Self {
        let column = |n: usize| -> Vec<f64> { runs.iter().map(|run| run[n]).collect() };
        let median = percentile(&column(0), 0.5);
        let least = column(1).into_iter().fold(f64::INFINITY, f64::min);
        let greatest = column(2).into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self { median, least, greatest }
    }
}

impl Cell {
    /// A cell of a single figure's row, or of the figures of a situation. The former's head is a
    /// statistic, the latter's `what, unit, statistic`.
    pub(super) fn of_figure(reports: &[&Report], row: &str, head: &str) -> Option<Self> {
        let (what, unit, head) = match figure_of(row, head) {
            Some((what, unit, statistic)) => (what, Some(unit), statistic),
            None => (row.to_owned(), None, head),
        };
        let is_unit = |figure: &&Figure| unit.is_none_or(|unit| figure.unit == unit);
        let is_it = |figure: &&Figure| plain(&figure.what) == what && is_unit(figure);
        let runs = reports.iter().flat_map(|report| {
            report.figures.iter().filter(is_it).map(move |figure| (*report, figure))
        });
        let runs: Vec<_> = runs.collect();
        let (_, last) = runs.last()?;
        let text = |text: &str| Some(Self { text: text.to_owned(), ..Self::default() });
        match head {
            "unit" => return text(&last.unit),
            "peer" => return text(last.peer.as_ref().map(|(peer, _)| peer)?),
            _ => {}
        }
        let value = |(report, figure): &(&Report, &Figure)| value(report, figure, head);
        let values: Vec<[f64; 3]> = runs.iter().map(value).collect::<Option<_>>()?;
        let spread = Spread::of(&values);
        let text = significant(spread.median);
        Some(Self { text, numbers: vec![spread], is_measured: true })
    }

    /// A cell of a table of the report.
    pub(super) fn of_table(tables: &[&Table], row: &str, head: &str) -> Option<Self> {
        let cell = |table: &&Table| {
            let column = table.heads.iter().position(|own| plain(own) == head)?;
            table.rows.iter().find(|cells| plain(&cells[0]) == row)?.get(column).cloned()
        };
        let texts: Vec<String> = tables.iter().map(cell).collect::<Option<_>>()?;
        let values = |text: &String| numbers(text).iter().map(|number| number.value).collect();
        let runs: Vec<Vec<f64>> = texts.iter().map(values).collect();
        let count = runs.first()?.len();
        let spread = |n: usize| {
            let column = runs.iter().filter_map(|run| run.get(n)).map(|value| [*value; 3]);
            Spread::of(&column.collect::<Vec<_>>())
        };
        let is_measured = tables.iter().any(|table| !table.exact);
        let numbers = (0..count).map(spread).collect();
        Some(Self { text: texts.last()?.clone(), numbers, is_measured })
    }

    /// Returns whether the documented text lies within the spread: its numbers if both have any, else
    /// its words.
    pub(super) fn holds(&self, documented: &str) -> bool {
        let shown = numbers(documented);
        if shown.is_empty() || self.numbers.is_empty() {
            return plain(documented) == plain(&self.text);
        }
        let slack = |shown: &Number, spread: &Spread| {
            let rounding = 0.500_001 * 10_f64.powi(-(shown.decimals as i32));
            rounding + if self.is_measured { DRIFT * spread.median.abs() } else { 0.0 }
        };
        match (shown.as_slice(), self.numbers.as_slice()) {
            // The range of several runs.
            ([from, to], [own]) => {
                own.greatest >= from.value - slack(from, own)
                    && own.least <= to.value + slack(to, own)
            }
            // The value between bounds that hardly differ.
            ([one], [lower, upper]) => {
                let (from, to) =
                    (lower.least - slack(one, lower), upper.greatest + slack(one, upper));
                (from..=to).contains(&one.value)
            }
            (shown, own) => {
                let holds = |(shown, own): (&Number, &Spread)| {
                    let slack = slack(shown, own);
                    (own.least - slack..=own.greatest + slack).contains(&shown.value)
                };
                shown.len() == own.len() && shown.iter().zip(own).all(holds)
            }
        }
    }

    /// Returns the cell as a document shows it whose present text is this one.
    pub(super) fn text_like(&self, documented: &str) -> String {
        let medians: Vec<f64> = self.numbers.iter().map(|spread| spread.median).collect();
        match (numbers(documented).len(), self.numbers.as_slice()) {
            (2, [one]) => replaced(documented, &[one.least, one.greatest]),
            (0, _) => self.text.clone(),
            (count, all) if count == all.len() => replaced(documented, &medians),
            _ => self.text.clone(),
        }
    }

    /// Returns the least and the greatest of each number.
    pub(super) fn spread(&self) -> String {
        let ranges = self.numbers.iter().map(|Spread { least, greatest, .. }| {
            format!("{}–{}", significant(*least), significant(*greatest))
        });
        ranges.collect::<Vec<_>>().join(" / ")
    }
}

/// Returns the figure of a situation under the head `what, unit, statistic`, with the latter two.
pub(super) fn figure_of<'a>(situation: &str, head: &'a str) -> Option<(String, &'a str, &'a str)> {
    let (rest, statistic) = head.rsplit_once(", ")?;
    let (what, unit) = rest.rsplit_once(", ")?;
    Some((format!("{what}: {situation}"), unit, statistic))
}

/// Returns whether the head names a statistic of a figure.
pub(super) fn is_statistic(head: &str) -> bool {
    let (_, statistic) = head.rsplit_once(", ").unwrap_or(("", head));
    ["p50", "p99", "max", "ratio"].contains(&statistic)
}

/// A statistic of a figure in one run: itself, and its least and greatest within that run.
fn value(report: &Report, figure: &Figure, head: &str) -> Option<[f64; 3]> {
    let ranged = |value, (least, greatest)| [value, least, greatest];
    Some(match head {
        "p50" => ranged(figure.p50, figure.p50_range),
        "p99" => ranged(figure.p99, figure.p99_range),
        "max" => [figure.max, figure.p99_range.0, figure.max],
        "ratio" => {
            let (peer, ratio) = figure.peer.as_ref()?;
            let peer = report.figures.iter().find(|figure| figure.what == *peer)?;
            let (least, greatest) = (figure.p50_range, peer.p50_range);
            [*ratio, least.0 / greatest.1, least.1 / greatest.0]
        }
        _ => return None,
    })
}
