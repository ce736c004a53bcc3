//! Success against seconds, with the intervals of both; a panel for each kind of people.

use evaluation::charts::{Axis, Chart, Panel, Shape};
use evaluation::distinct;
use evaluation::simulation::{Interval, Mean, Tally};

use super::{Row, position};

/// Explanation below the chart.
const NOTE: &str = "Lines: 95 % intervals. Success lies by the logarithm of the failures.";

/// A point of the chart.
struct Point {
    series: usize,
    panel: usize,
    success: (f64, Interval),
    seconds: (f64, Interval),
}

/// Returns the chart; `series` names what is compared.
pub(super) fn draw(
    title: &str,
    results: &[(&Row, Tally)],
    series: impl Fn(&Row) -> String,
) -> Chart {
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
