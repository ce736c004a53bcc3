//! Questions per interaction: a small histogram for each policy and kind of people.

use evaluation::charts::{Axis, Chart, Panel, Shape};
use evaluation::distinct;
use evaluation::simulation::{HISTOGRAM, Tally};

use super::{Row, position};

/// Half the share of its place that a bar fills.
const HALF_BAR: f64 = 0.4;

/// Returns the chart.
pub(super) fn draw(results: &[(&Row, Tally)]) -> Chart {
    let policies = distinct(results.iter().map(|(row, _)| row.policy.clone()));
    let people = distinct(results.iter().map(|(row, _)| row.people.name().to_owned()));
    let bins = bins(results);
    let highest = |(_, tally): &(&Row, Tally)| shares(tally, bins).into_iter().fold(0.0, f64::max);
    let tallest = results.iter().map(highest).fold(0.0, f64::max);
    let place =
        |row: &Row| (position(&policies, &row.policy), position(&people, row.people.name()));
    let mut ordered: Vec<&(&Row, Tally)> = results.iter().collect();
    ordered.sort_by_key(|(row, _)| place(row));
    let panel = |(row, tally): &&(&Row, Tally)| panel(row, tally, place(row).0, (bins, tallest));
    Chart {
        title: "Questions per interaction, repetitions included".to_owned(),
        note: "Vertical: % of interactions.".to_owned(),
        panels: ordered.iter().map(panel).collect(),
        columns: people.len().max(1),
        panel_size: (640, 250),
        legend: Vec::new(),
    }
}

/// Share of all interactions with more questions than have bars of their own, per cent.
const TAIL_PERCENT: f64 = 1.0;

/// Returns the number of bars; the last one holds all with that many questions or more.
fn bins(results: &[(&Row, Tally)]) -> usize {
    let long = |n: usize| {
        results
            .iter()
            .any(|(_, tally)| shares(tally, HISTOGRAM)[n..].iter().sum::<f64>() > TAIL_PERCENT)
    };
    1 + (0..HISTOGRAM).rev().find(|n| long(*n)).unwrap_or(0)
}

/// Returns the share of the interactions by number of questions, in per cent.
fn shares(tally: &Tally, bins: usize) -> Vec<f64> {
    let all = tally.interactions().max(1) as f64;
    let mut shares = vec![0.0; bins];
    for (n, count) in tally.histogram.into_iter().enumerate() {
        shares[n.min(bins - 1)] += 100.0 * count as f64 / all;
    }
    shares
}

/// Bars, and the mean in the heading.
fn panel(row: &Row, tally: &Tally, series: usize, (bins, tallest): (usize, f64)) -> Panel {
    // Every number where there is room for it, else every fifth.
    let name = |n: usize| match n {
        n if n + 1 == bins => format!("{n}+"),
        n if bins <= 12 || n % 5 == 0 => n.to_string(),
        _ => String::new(),
    };
    let bar = |(n, share): (usize, f64)| {
        let middle = n as f64 + 0.5;
        (series, Shape::Bar((middle - HALF_BAR, 0.0), (middle + HALF_BAR, share)))
    };
    let (policy, people) = (&row.policy, row.people.name());
    Panel {
        heading: format!("{policy}, {people}: mean {:.2}", tally.questions.mean()),
        x: Axis::named("", (0..bins).map(name).collect()),
        y: Axis::up_to("", tallest),
        shapes: shares(tally, bins).into_iter().enumerate().map(bar).collect(),
    }
}
