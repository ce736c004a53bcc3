//! The beliefs after the answers to a question.

use super::announced::Announced;
use super::channel::Query;
use super::reduced::Reduced;

/// Probability of each informative answer, and the class probabilities after it.
pub(crate) fn outcomes(reduced: &Reduced, query: Query, mass: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let channel = reduced.channel(query);
    let mut answers: Vec<Vec<f64>> = Vec::new();
    match query {
        Query::Point { class } => {
            let is = |c: usize| c == class as usize;
            answers.push(weigh(mass, |c| if is(c) { channel.own } else { channel.other }));
            answers.push(weigh(mass, |c| if is(c) { channel.other } else { channel.own }));
        }
        Query::Is { partition, block } => {
            let partition = reduced.partition(partition);
            for heard in [(channel.own, channel.other), (channel.other, channel.own)] {
                answers.push(weigh(mass, |c| partition.answer(block, partition.blocks[c], heard)));
            }
        }
        Query::Which { partition } => {
            let partition = reduced.partition(partition);
            for block in partition.named() {
                answers.push(weigh(mass, |c| partition.names(block, partition.blocks[c])));
            }
            if channel.absent_other > 0.0 {
                let absent = |c| partition.names_absent(partition.blocks[c]);
                answers.push(weigh(mass, absent));
            }
        }
        Query::Choice { partition, offer } => {
            let partition = reduced.partition(partition);
            let offer = partition.offer_at(offer);
            for chosen in offer.answers() {
                answers
                    .push(weigh(mass, |c| partition.chooses(offer, chosen, partition.blocks[c])));
            }
            if channel.absent_other > 0.0 {
                answers.push(weigh(mass, |c| partition.chooses_absent(offer, partition.blocks[c])));
            }
        }
    }
    answers.into_iter().map(|weighed| normalise(reduced, weighed)).collect()
}

/// Probability that the announced pick of a class is denied, and the class probabilities after it.
pub(super) fn denial(
    reduced: &Reduced,
    announced: &Announced,
    class: u32,
    mass: &[f64],
) -> (f64, Vec<f64>) {
    let denied = |c: usize| if c == class as usize { announced.own } else { announced.other };
    normalise(reduced, weigh(mass, denied))
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
