//! Charts of a simulated study, as SVG.

use evaluation::simulation::{HISTOGRAM, Tally};
use service::exit::{Exit, Failure};
use user_study::charts::{Axis, Chart, Panel, Shape};
use user_study::distinct;
use user_study::{Interval, Mean};

use super::design::Row;

/// File name and text.
pub(super) type Picture = (String, String);

/// Returns the files of every chart with data to show.
pub(super) fn pictures(results: &[(&Row, Tally)]) -> Result<Vec<Picture>, Failure> {
    let (real_time, in_turns): (Vec<_>, Vec<_>) =
        results.iter().cloned().partition(|(row, _)| row.people.in_real_time());
    let mut charts = Vec::new();
    if !in_turns.is_empty() {
        let title = "Success and time per interaction, by policy";
        charts.push(("success", scatter(title, &in_turns, |row| row.policy.clone())));
        charts.push(("questions", histogram(&in_turns)));
    }
    if !real_time.is_empty() {
        let title = "Success and time per dialogue, by rules of turn-taking";
        charts.push(("turn-taking", scatter(title, &real_time, |row| row.people.rules())));
    }
    let mut pictures = Vec::new();
    for (name, chart) in charts {
        let svg = user_study::charts::svg(&chart)
            .map_err(|error| Failure::new(Exit::Storage, format!("{name}: {error}")))?;
        pictures.push((format!("{name}.svg"), svg));
    }
    Ok(pictures)
}

/// Returns the position of a name in a list that holds it.
fn position(list: &[String], name: &str) -> usize {
    list.iter().position(|own| own == name).unwrap_or(0)
}

/// Explanation below the chart.
const NOTE: &str = "Lines: 95 % intervals. Success lies by the logarithm of the failures.";

/// A point of the chart.
struct Point {
    series: usize,
    panel: usize,
    success: (f64, Interval),
    seconds: (f64, Interval),
}

/// Success against seconds, with the intervals of both; a panel for each kind of people. `series`
/// names the compared series.
fn scatter(title: &str, results: &[(&Row, Tally)], series: impl Fn(&Row) -> String) -> Chart {
    let legend = distinct(results.iter().map(|(row, _)| series(row)));
    let people = distinct(results.iter().map(|(row, _)| row.people.name().to_owned()));
    let point = |(row, tally): &(&Row, Tally)| {
        let time: &Mean = if row.people.in_real_time() { &tally.talk_s } else { &tally.seconds };
        Point {
            series: position(&legend, &series(row)),
            panel: position(&people, row.people.name()),
            success: (tally.success(), tally.success_interval()),
            seconds: (time.mean(), time.interval()),
        }
    };
    let points: Vec<Point> = results.iter().map(point).collect();
    let slowest_s = points.iter().map(|p| p.seconds.1.high).fold(0.0, f64::max);
    let shares = || points.iter().flat_map(|p| [p.success.0, p.success.1.high]);
    let panel = |(number, name): (usize, &String)| {
        let own = points.iter().filter(|point| point.panel == number);
        let intervals = own.clone().flat_map(intervals);
        let marks = own.map(|p| (p.series, Shape::Marks(vec![(p.seconds.0, p.success.0)])));
        Panel {
            heading: name.clone(),
            x: Axis::up_to("seconds", slowest_s),
            y: Axis::missing(if number == 0 { "success %" } else { "" }, shares()),
            shapes: intervals.chain(marks).collect(),
        }
    };
    Chart {
        title: title.to_owned(),
        note: NOTE.to_owned(),
        panels: people.iter().enumerate().map(panel).collect(),
        columns: people.len().max(1),
        panel_size: (720, 920),
        legend: legend.clone(),
    }
}

/// Returns both intervals, which form a cross.
fn intervals(point: &Point) -> [(usize, Shape); 2] {
    let (x, y) = (point.seconds.0, point.success.0);
    let (seconds, success) = (point.seconds.1, point.success.1);
    [vec![(seconds.low, y), (seconds.high, y)], vec![(x, success.low), (x, success.high)]]
        .map(|ends| (point.series, Shape::Line(ends)))
}

/// Half the share of its place that a bar fills.
const HALF_BAR: f64 = 0.4;

/// Questions per interaction: a small histogram for each policy and kind of people.
fn histogram(results: &[(&Row, Tally)]) -> Chart {
    let policies = distinct(results.iter().map(|(row, _)| row.policy.clone()));
    let people = distinct(results.iter().map(|(row, _)| row.people.name().to_owned()));
    let bins = bins(results);
    let highest = |(_, tally): &(&Row, Tally)| shares(tally, bins).into_iter().fold(0.0, f64::max);
    let tallest = results.iter().map(highest).fold(0.0, f64::max);
    let place =
        |row: &Row| (position(&policies, &row.policy), position(&people, row.people.name()));
    let mut ordered: Vec<&(&Row, Tally)> = results.iter().collect();
    ordered.sort_by_key(|(row, _)| place(row));
    let panel = |(row, tally): &&(&Row, Tally)| bars(row, tally, place(row).0, (bins, tallest));
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
fn bars(row: &Row, tally: &Tally, series: usize, (bins, tallest): (usize, f64)) -> Panel {
    // Every number if there is room, else every fifth.
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

#[cfg(test)]
mod tests;
