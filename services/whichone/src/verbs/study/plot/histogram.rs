//! How many questions are asked: a small histogram for each policy and kind of people.

use evaluation::charts::{Align, BLACK, Canvas, FAINT, GREY, LETTER_WIDTH, Place, Size, colour};
use evaluation::simulation::{HISTOGRAM, Tally};

use super::distinct;
use crate::verbs::study::design::Row;

/// Width of a panel, its height, and between two.
const PANEL: (f64, f64, f64) = (250.0, 60.0, 24.0);
/// Right of the last panel, above the first, and below the last.
const MARGIN: (f64, f64, f64) = (24.0, 80.0, 56.0);
/// Share of its place that a bar fills.
const BAR: f64 = 0.8;

/// The picture.
pub(super) fn draw(results: &[(&Row, Tally)]) -> Canvas {
    let policies = distinct(results.iter().map(|(row, _)| row.policy.clone()));
    let people = distinct(results.iter().map(|(row, _)| row.people.name().to_owned()));
    let longest = policies.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let left = 40.0 + LETTER_WIDTH * longest as f64;
    let width = left + people.len() as f64 * (PANEL.0 + PANEL.2) + MARGIN.0;
    let bottom = MARGIN.1 + policies.len() as f64 * (PANEL.1 + PANEL.2);
    let mut canvas = Canvas::new(width.max(520.0), bottom + MARGIN.2);
    let title = "Questions per interaction, repetitions included";
    canvas.words((24.0, 24.0), title, Align::Left, Size::Large, BLACK);
    let bins = bins(results);
    let highest = |(_, tally): &(&Row, Tally)| shares(tally, bins).into_iter().fold(0.0, f64::max);
    let tallest = results.iter().map(highest).fold(0.0, f64::max);
    for (row, tally) in results {
        let at = |list: &[String], name: &str| list.iter().position(|n| n == name).unwrap_or(0);
        let (series, column) = (at(&policies, &row.policy), at(&people, row.people.name()));
        let x = left + column as f64 * (PANEL.0 + PANEL.2);
        let corner = (x, MARGIN.1 + series as f64 * (PANEL.1 + PANEL.2));
        if column == 0 {
            let place = (left - 16.0, corner.1 + 0.5 * PANEL.1);
            canvas.words(place, &row.policy, Align::Right, Size::Small, BLACK);
        }
        if series == 0 {
            let place = (x + 0.5 * PANEL.0, corner.1 - 18.0);
            canvas.words(place, row.people.name(), Align::Middle, Size::Small, BLACK);
        }
        panel(&mut canvas, corner, tally, (series, bins, tallest));
    }
    for column in 0..people.len() {
        let middle = left + column as f64 * (PANEL.0 + PANEL.2) + 0.5 * PANEL.0;
        let place = (middle, bottom + 16.0);
        canvas.words(place, "questions", Align::Middle, Size::Small, BLACK);
    }
    canvas
}

/// Share of all interactions with more questions than are shown one by one.
const TAIL: f64 = 0.01;

/// How many bars there are: the last holds all with that many questions or more.
fn bins(results: &[(&Row, Tally)]) -> usize {
    let long = |n: usize| {
        results.iter().any(|(_, tally)| shares(tally, HISTOGRAM)[n..].iter().sum::<f64>() > TAIL)
    };
    1 + (0..HISTOGRAM).rev().find(|n| long(*n)).unwrap_or(0)
}

/// Share of the interactions by number of questions, in so many bins.
fn shares(tally: &Tally, bins: usize) -> Vec<f64> {
    let all = tally.interactions().max(1) as f64;
    let mut shares = vec![0.0; bins];
    for (n, count) in tally.histogram.into_iter().enumerate() {
        shares[n.min(bins - 1)] += count as f64 / all;
    }
    shares
}

/// Bars, numbers below them, and the mean.
fn panel(canvas: &mut Canvas, corner: Place, tally: &Tally, how: (usize, usize, f64)) {
    let (series, bins, tallest) = how;
    let (left, bottom) = (corner.0, corner.1 + PANEL.1);
    let width = PANEL.0 / bins as f64;
    canvas.line((left, bottom), (left + PANEL.0, bottom), 1.0, FAINT);
    for (n, share) in shares(tally, bins).into_iter().enumerate() {
        let height = PANEL.1 * share / tallest.max(f64::MIN_POSITIVE);
        let x = left + (n as f64 + 0.5 * (1.0 - BAR)) * width;
        if share > 0.0 {
            canvas.area((x, bottom - height), (BAR * width, height), colour(series));
        }
        // Every number where there is room for it, else every fifth.
        if bins <= 16 || n % 5 == 0 {
            let text = if n + 1 == bins { format!("{n}+") } else { n.to_string() };
            let place = (left + (n as f64 + 0.5) * width, bottom + 9.0);
            canvas.words(place, &text, Align::Middle, Size::Small, GREY);
        }
    }
    let mean = format!("mean {:.2}", tally.questions.mean());
    canvas.words((left + PANEL.0, corner.1 + 6.0), &mean, Align::Right, Size::Small, GREY);
}
