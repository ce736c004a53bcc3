//! The beliefs after the answers to a question.

use super::channel::Query;
use super::column::Column;
use super::reduced::Reduced;

/// Probability of each answer that tells something, and the class probabilities after it.
pub(crate) fn outcomes(reduced: &Reduced, query: Query, mass: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let channel = reduced.channel(query);
    let mut answers: Vec<Vec<f64>> = Vec::new();
    match query {
        Query::Point { class } => {
            let is = |c: usize| c == class as usize;
            answers.push(weigh(mass, |c| if is(c) { channel.own } else { channel.other }));
            answers.push(weigh(mass, |c| if is(c) { channel.other } else { channel.own }));
        }
        Query::Is { column, cell } => {
            let Column { cells, unknown, .. } = reduced.column(column);
            for (is, not) in [(channel.own, channel.other), (channel.other, channel.own)] {
                answers.push(weigh(mass, |c| match (cells[c], unknown) {
                    (own, _) if own == cell => is,
                    (none, Some(unknown)) if none == unknown.cell => unknown.probability(is > not),
                    _ => not,
                }));
            }
        }
        Query::Which { column } => {
            let column = reduced.column(column);
            let lacks = |c: usize| column.lacks(column.cells[c]);
            for cell in column.named() {
                answers.push(weigh(mass, |c| match column.cells[c] {
                    own if own == cell => channel.own,
                    _ if lacks(c) => channel.lacking,
                    _ => channel.other,
                }));
            }
            if channel.absent_other > 0.0 {
                let absent =
                    |c| if lacks(c) { channel.absent_lacking } else { channel.absent_other };
                answers.push(weigh(mass, absent));
            }
        }
    }
    answers.into_iter().map(|weighed| normalise(reduced, weighed)).collect()
}

fn weigh(mass: &[f64], factor: impl Fn(usize) -> f64) -> Vec<f64> {
    mass.iter().enumerate().map(|(c, m)| m * factor(c)).collect()
}

fn normalise(reduced: &Reduced, mut mass: Vec<f64>) -> (f64, Vec<f64>) {
    let heard: f64 = mass.iter().sum();
    let scale = 1.0 / heard.max(f64::MIN_POSITIVE);
    mass.iter_mut().for_each(|m| *m *= scale);
    for run in &reduced.interchangeable {
        mass[run.clone()].sort_by(|a, b| b.total_cmp(a));
    }
    (heard, mass)
}
