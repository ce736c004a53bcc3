//! Success against seconds, with the intervals of both; a panel for each kind of people.

use evaluation::charts::{
    Align, BLACK, Canvas, FAINT, GREY, LETTER_WIDTH, Linear, Missing, Place, Size, colour,
};
use evaluation::simulation::{Interval, Mean, Tally};

use super::distinct;
use crate::verbs::study::design::Row;

/// Width of a panel, height of all, and between two.
const PANEL: (f64, f64, f64) = (300.0, 380.0, 26.0);
/// Left of the first panel, above it, and below.
const MARGIN: (f64, f64, f64) = (86.0, 74.0, 84.0);
/// Between two lines of the legend.
const LEGEND_LINE: f64 = 22.0;
/// What is to be known for reading it.
const NOTE: &str = "Lines: 95 % intervals. Success lies by the logarithm of the failures.";

/// A point of the picture.
struct Point {
    series: usize,
    panel: usize,
    success: (f64, Interval),
    seconds: (f64, Interval),
}

/// The picture; `series` names what is compared.
pub(super) fn draw(
    title: &str,
    results: &[(&Row, Tally)],
    series: impl Fn(&Row) -> String,
) -> Canvas {
    let names = distinct(results.iter().map(|(row, _)| series(row)));
    let people = distinct(results.iter().map(|(row, _)| row.people.name().to_owned()));
    let at = |list: &[String], name: &str| list.iter().position(|n| n == name).unwrap_or(0);
    let point = |(row, tally): &(&Row, Tally)| {
        let time: &Mean = if row.people.in_real_time() { &tally.talk_s } else { &tally.seconds };
        Point {
            series: at(&names, &series(row)),
            panel: at(&people, row.people.name()),
            success: (tally.success(), tally.success_interval()),
            seconds: (time.mean(), time.interval()),
        }
    };
    let points: Vec<Point> = results.iter().map(point).collect();
    let x = Linear::up_to(points.iter().map(|p| p.seconds.1.high).fold(0.0, f64::max));
    let y = Missing::holding(points.iter().flat_map(|p| [p.success.0, p.success.1.high]));
    let right = MARGIN.0 + people.len() as f64 * (PANEL.0 + PANEL.2);
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let height = MARGIN.1 + PANEL.1 + MARGIN.2;
    let height = height.max(MARGIN.1 + names.len() as f64 * LEGEND_LINE + MARGIN.2);
    let mut canvas = Canvas::new(right + 44.0 + LETTER_WIDTH * longest as f64, height);
    canvas.words((MARGIN.0, 24.0), title, Align::Left, Size::Large, BLACK);
    let note = (MARGIN.0, height - 12.0);
    canvas.words(note, NOTE, Align::Left, Size::Small, GREY);
    for (n, name) in people.iter().enumerate() {
        let corner = (MARGIN.0 + n as f64 * (PANEL.0 + PANEL.2), MARGIN.1);
        frame(&mut canvas, corner, name, (&x, &y), n == 0);
        for point in points.iter().filter(|point| point.panel == n) {
            spread(&mut canvas, corner, point, (&x, &y));
        }
        for point in points.iter().filter(|point| point.panel == n) {
            let at = within(corner, x.place(point.seconds.0), y.place(point.success.0));
            canvas.mark(at, point.series);
        }
    }
    for (n, name) in names.iter().enumerate() {
        let line = MARGIN.1 + 10.0 + n as f64 * LEGEND_LINE;
        canvas.mark((right + 8.0, line), n);
        canvas.words((right + 24.0, line), name, Align::Left, Size::Small, BLACK);
    }
    canvas
}

/// The place in a panel at these shares of its axes.
fn within((left, top): Place, x: f64, y: f64) -> Place {
    (left + x * PANEL.0, top + (1.0 - y) * PANEL.1)
}

fn frame(canvas: &mut Canvas, corner: Place, name: &str, axes: (&Linear, &Missing), first: bool) {
    let (x, y) = axes;
    for mark in y.marks() {
        let (left, at) = within(corner, 0.0, y.place(mark));
        canvas.line((left, at), (left + PANEL.0, at), 1.0, FAINT);
        if first {
            let text = format!("{}", (1e4 * mark).round() / 100.0);
            canvas.words((left - 8.0, at), &text, Align::Right, Size::Small, GREY);
        }
    }
    for mark in x.marks() {
        let (at, bottom) = within(corner, x.place(mark), 0.0);
        canvas.line((at, corner.1), (at, bottom), 1.0, FAINT);
        let text = format!("{}", (1e6 * mark).round() / 1e6);
        canvas.words((at, bottom + 14.0), &text, Align::Middle, Size::Small, GREY);
    }
    let bottom = corner.1 + PANEL.1;
    canvas.line((corner.0, bottom), (corner.0 + PANEL.0, bottom), 1.5, BLACK);
    canvas.line(corner, (corner.0, bottom), 1.5, BLACK);
    let middle = corner.0 + 0.5 * PANEL.0;
    canvas.words((middle, corner.1 - 14.0), name, Align::Middle, Size::Small, BLACK);
    canvas.words((middle, bottom + 36.0), "seconds", Align::Middle, Size::Small, BLACK);
    if first {
        let place = (corner.0 - 62.0, corner.1 - 14.0);
        canvas.words(place, "success %", Align::Left, Size::Small, BLACK);
    }
}

/// The intervals as a cross.
fn spread(canvas: &mut Canvas, corner: Place, point: &Point, (x, y): (&Linear, &Missing)) {
    let (at_x, at_y) = (x.place(point.seconds.0), y.place(point.success.0));
    let (seconds, success) = (point.seconds.1, point.success.1);
    let ends = [
        (within(corner, x.place(seconds.low), at_y), within(corner, x.place(seconds.high), at_y)),
        (within(corner, at_x, y.place(success.low)), within(corner, at_x, y.place(success.high))),
    ];
    for (from, to) in ends {
        canvas.line(from, to, 1.5, colour(point.series));
    }
}
