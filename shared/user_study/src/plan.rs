//! Random choices of a study, from recorded seeds: the order of policies, and the objects.

use serde::{Deserialize, Serialize};
use vocabulary::Rng;

use crate::{Design, Objects, Order, Protocol};

/// Letters and digits that cannot be confused.
const LETTERS: &[u8] = b"ACDEFGHJKMNPQRTUVWXY34679";

/// One interaction that a participant is to have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Step {
    /// The policy that decides.
    pub policy: String,
    /// `true` if it is practice, which does not count.
    pub practice: bool,
}

/// Counts of the study so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Participants that were begun, whatever became of them.
    pub begun: usize,
    /// Participants who count, by the policy that they met first.
    pub policies: Vec<(String, usize)>,
}

/// Returns an anonymous name for a participant: six letters or digits.
pub fn new_id(seed: u64) -> String {
    let mut rng = Rng::new(seed ^ 0x6964);
    (0..6).map(|_| char::from(LETTERS[rng.below(LETTERS.len())])).collect()
}

/// Returns the interactions of a new participant, in order.
pub fn plan(protocol: &Protocol, counts: &Counts, seed: u64) -> Vec<Step> {
    let mut rng = Rng::new(seed ^ 0x706c_616e);
    let policies = match protocol.design {
        Design::Between => vec![fewest(protocol, counts, &mut rng)],
        Design::Within => ordered(protocol, counts.begun, &mut rng),
    };
    let step = |policy: &String, practice| Step { policy: policy.clone(), practice };
    let practice = (0..protocol.warmup).map(|_| step(&policies[0], true));
    let counted = policies
        .iter()
        .flat_map(|policy| (0..protocol.interactions).map(move |_| step(policy, false)));
    practice.chain(counted).collect()
}

/// Returns the policy that the fewest have met, by lot among equals.
fn fewest(protocol: &Protocol, counts: &Counts, rng: &mut Rng) -> String {
    let count = |policy: &String| {
        counts.policies.iter().find(|(name, _)| name == policy).map_or(0, |(_, count)| *count)
    };
    let least = protocol.policies.iter().map(count).min().unwrap_or(0);
    let open: Vec<&String> = protocol.policies.iter().filter(|p| count(p) == least).collect();
    open[rng.below(open.len())].clone()
}

fn ordered(protocol: &Protocol, row: usize, rng: &mut Rng) -> Vec<String> {
    let policies = &protocol.policies;
    match protocol.order {
        Order::Random => shuffled(policies, rng),
        Order::Latin => {
            square_row(policies.len(), row).into_iter().map(|k| policies[k].clone()).collect()
        }
    }
}

fn shuffled(policies: &[String], rng: &mut Rng) -> Vec<String> {
    let mut list = policies.to_vec();
    for last in (1..list.len()).rev() {
        list.swap(last, rng.below(last + 1));
    }
    list
}

/// Returns a row of Williams' square: each number is in each place alike, and after each other
/// alike. Odd sizes need twice the rows, the second half mirrored.
fn square_row(size: usize, row: usize) -> Vec<usize> {
    let rows = if size % 2 == 1 && size > 1 { 2 * size } else { size };
    let row = row % rows;
    let zigzag = |k: usize| if k % 2 == 1 { k.div_ceil(2) } else { (size - k / 2) % size };
    let mut numbers: Vec<usize> = (0..size).map(|k| (zigzag(k) + row) % size).collect();
    if row >= size {
        numbers.reverse();
    }
    numbers
}

/// Returns the place of the object to be desired next. `own` and `all` say how often each was
/// desired by the participant and in the study; `number` counts the participant's draws.
///
/// # Panics
/// `own` is empty.
pub fn draw(objects: Objects, own: &[usize], all: &[usize], seed: u64, number: u32) -> usize {
    // Each draw has a generator of its own, so that it depends only on the stored data.
    let mut rng = Rng::new(seed ^ 0x6472_6177 ^ (u64::from(number) << 40));
    match objects {
        Objects::Uniform => rng.below(own.len()),
        Objects::Balanced => {
            let rank = |k: &usize| (own[*k], all.get(*k).copied().unwrap_or(0));
            let least = (0..own.len()).map(|k| rank(&k)).min();
            let open: Vec<usize> = (0..own.len()).filter(|k| Some(rank(k)) == least).collect();
            open[rng.below(open.len())]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::protocol;
    use std::collections::BTreeSet;

    fn comparing(design: Design, order: Order, policies: &[&str]) -> Protocol {
        let policies = policies.iter().map(|p| (*p).to_owned()).collect();
        Protocol { design, order, policies, ..protocol() }
    }

    #[test]
    fn participant_ids_omit_ambiguous_letters() {
        let ids: BTreeSet<String> = (0..500).map(new_id).collect();
        assert_eq!(ids.len(), 500);
        for id in &ids {
            assert_eq!(id.len(), 6);
            assert!(!id.contains(['0', 'O', '1', 'I', 'L', '5', 'S', '2', 'Z', '8', 'B']), "{id}");
        }
    }

    #[test]
    fn plan_between_participants_is_balanced() {
        let protocol = comparing(Design::Between, Order::Random, &["a", "b", "c"]);
        let mut counts = Counts::default();
        for n in 1..=30 {
            let plan = plan(&protocol, &counts, n);
            let first = plan[0].policy.clone();
            assert!(plan.iter().all(|step| step.policy == first));
            counts.begun += 1;
            match counts.policies.iter_mut().find(|(name, _)| *name == first) {
                Some((_, count)) => *count += 1,
                None => counts.policies.push((first, 1)),
            }
            let met = counts.policies.iter().map(|(_, count)| *count);
            let most = met.clone().max().unwrap();
            let least = if counts.policies.len() < 3 { 0 } else { met.min().unwrap() };
            assert!(most - least <= 1, "{counts:?}");
        }
    }

    #[test]
    fn plan_within_a_participant_has_every_policy_after_practice() {
        for order in [Order::Random, Order::Latin] {
            let protocol = Protocol { warmup: 2, ..comparing(Design::Within, order, &["a", "b"]) };
            for begun in 0..8 {
                let counts = Counts { begun, ..Counts::default() };
                let plan = plan(&protocol, &counts, begun as u64);
                let of = |name: &str, practice| {
                    plan.iter().filter(|s| s.policy == name && s.practice == practice).count()
                };
                assert_eq!((of("a", false), of("b", false)), (3, 3));
                assert_eq!(of(&plan[2].policy, true), 2, "practice is with the first policy");
                assert!(plan[..2].iter().all(|step| step.practice));
            }
        }
    }

    #[test]
    fn latin_square_balances_positions_and_successions() {
        for size in 1..=7 {
            let rows = if size % 2 == 1 && size > 1 { 2 * size } else { size };
            let square: Vec<Vec<usize>> = (0..rows).map(|row| square_row(size, row)).collect();
            let times = rows / size;
            for value in 0..size {
                for place in 0..size {
                    let count = square.iter().filter(|row| row[place] == value).count();
                    assert_eq!(count, times, "{size}: {square:?}");
                }
                for before in (0..size).filter(|before| *before != value) {
                    let pairs = square.iter().flat_map(|row| row.windows(2));
                    let count = pairs.filter(|pair| **pair == [before, value]).count();
                    assert_eq!(count, times, "{size}: {square:?}");
                }
            }
        }
    }

    #[test]
    fn plan_draws_objects_uniformly_or_in_balanced_turns() {
        let mut seen = [0_u32; 6];
        for seed in 0..6000 {
            seen[draw(Objects::Uniform, &[0; 6], &[0; 6], seed, 1)] += 1;
        }
        assert!(seen.iter().all(|count| (850..1150).contains(count)), "{seen:?}");
        let (mut own, mut all) = ([0; 6], [4, 4, 3, 4, 4, 4]);
        for number in 0..12 {
            let k = draw(Objects::Balanced, &own, &all, 7, number);
            assert!(number > 0 || k == 2, "the study's rarest comes first");
            own[k] += 1;
            all[k] += 1;
        }
        assert_eq!(own, [2; 6]);
    }
}
