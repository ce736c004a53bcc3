//! An upper bound from an easier problem, for yes/no questions about attributes: whether an answer
//! was right is revealed, for the compensation of [`Told`].
//!
//! docs/pomdp.md, "Certified bounds on hard scenes", has proof and search. It keeps key, bound
//! and threshold of a belief: earlier bounds remain valid.

use std::collections::HashMap;

use vocabulary::{Costs, Rng};

use super::channel::{Channel, Query};
use super::partition::Partition;
use super::reduced::Reduced;
use super::told::{Kind, Split, Told};

/// The easier problem.
#[derive(Debug)]
pub(crate) struct Revealed<'a> {
    reduced: &'a Reduced,
    costs: Costs,
    /// For classes of one object, and for the others if there are any.
    told: Vec<Told>,
    questions: Vec<Question<'a>>,
    known: HashMap<u128, Known>,
    /// Beliefs that were looked at, and the most that may be.
    looked_at: usize,
    beliefs_max: usize,
    /// Whether there was more to look into.
    is_cut: bool,
    /// Gap allowed between bounds, weighed with their probability; a continued search begins lower.
    threshold: f64,
}

/// Result for a belief.
#[derive(Clone, Copy, Debug)]
struct Known {
    upper: f64,
    /// Threshold of the search; infinite if the belief was left once its bound was low enough.
    threshold: f64,
}

/// Question whether the wanted class is in a block.
#[derive(Debug)]
struct Question<'a> {
    partition: usize,
    blocks: &'a [u16],
    block: u16,
    channel: &'a Channel,
    /// Logarithms of the probabilities of a right and of a wrong answer.
    log: [f64; 2],
    /// Sums of these, less those of denied questions, identify beliefs.
    code: u128,
}

/// The robot's belief, and the revealed set of classes.
struct State {
    mass: Vec<f64>,
    /// Logarithms of the same.
    log: Vec<f64>,
    /// The classes that the right answers leave.
    left: Vec<u16>,
    /// Probability, at the first belief, that one of them is wanted.
    likelihood: f64,
    /// How many questions were asked.
    depth: u32,
    key: u128,
}

/// A question as it looks from one step ahead.
struct Outlook {
    question: usize,
    split: Split,
    value: f64,
    sides: [Side; 2],
}

/// A side of a question, and the right answer of those who are on it.
#[derive(Clone, Copy, Debug, Default)]
struct Side {
    /// Probability of the side among the classes that are left.
    share: f64,
    /// Upper bound on the value after the answer.
    right: f64,
    /// How much that counts in the value of the question.
    weight: f64,
}

/// No policy asks that often; a guard for the stack.
const DEPTH_MAX: u32 = 64;

impl Question<'_> {
    /// Side of a class: 0 if it says yes.
    fn side(&self, class: usize) -> usize {
        usize::from(self.blocks[class] != self.block)
    }

    /// Change of a belief's key by the right answer of a side.
    fn code(&self, side: usize) -> u128 {
        if side == 0 { self.code } else { self.code.wrapping_neg() }
    }
}

impl<'a> Revealed<'a> {
    /// The easier problem; `None` if there are other questions or announced picks.
    pub(crate) fn of(reduced: &'a Reduced, costs: &Costs) -> Option<Self> {
        let others = reduced.announced.is_some() || !reduced.pointed.is_empty();
        if others || reduced.absent.is_some() || reduced.classes() < 2 {
            return None;
        }
        let mut rng = Rng::new(0xc0de);
        let mut code = || u128::from(rng.next_u64()) << 64 | u128::from(rng.next_u64());
        let question = |query: &Query| match *query {
            Query::Is { partition, block } => {
                let channel = reduced.channel(*query);
                Some(Question {
                    partition: usize::from(partition),
                    blocks: &reduced.partition(partition).blocks,
                    block,
                    channel,
                    log: [channel.own.ln(), channel.other.ln()],
                    code: code(),
                })
            }
            _ => None,
        };
        let questions: Vec<_> = reduced.queries.iter().map(question).collect::<Option<_>>()?;
        let cheapest =
            questions.iter().map(|q| q.channel).min_by(|a, b| a.cost.total_cmp(&b.cost))?;
        let several = reduced.share.iter().copied().filter(|share| *share < 1.0);
        let classes = several.clone().count();
        let single = Kind { share: 1.0, classes: reduced.classes() - classes };
        let several = several.reduce(f64::max).map(|share| Kind { share, classes });
        // Each kind first among all; without classes of one object, as if there were one.
        let single = Kind { classes: single.classes.max(1), ..single };
        let kinds: Vec<Kind> = std::iter::once(single).chain(several).collect();
        let mut turned = kinds.clone();
        turned.reverse();
        let told = [kinds, turned].into_iter().take(1 + usize::from(several.is_some()));
        let told = told.map(|kinds| Told::new(costs, cheapest, &kinds));
        let told: Vec<Told> = told.collect::<Option<_>>()?;
        Some(Self {
            reduced,
            costs: *costs,
            told,
            questions,
            known: HashMap::new(),
            looked_at: 0,
            beliefs_max: 0,
            is_cut: false,
            threshold: f64::INFINITY,
        })
    }

    /// Upper bound on the value of the belief, from looking at that many beliefs. A bound as low as
    /// `enough` is not tightened any more.
    pub(crate) fn upper(&mut self, beliefs_max: usize, enough: f64) -> f64 {
        (self.looked_at, self.beliefs_max, self.is_cut) = (0, beliefs_max, true);
        let root = State {
            log: self.reduced.mass.iter().map(|m| m.ln()).collect(),
            mass: self.reduced.mass.clone(),
            left: (0..self.reduced.classes() as u16).collect(),
            likelihood: 1.0,
            depth: 0,
            key: 0,
        };
        let mut upper = self.told_class(&root);
        self.threshold = self.threshold.min(upper - self.stop(&root));
        while self.is_cut && self.looked_at < beliefs_max && upper > enough {
            self.is_cut = false;
            upper = upper.min(self.look_into(&root, enough));
            self.threshold *= 0.5;
        }
        upper
    }

    /// Upper bound on the value of a belief; the first that is not above `enough`.
    fn look_into(&mut self, at: &State, enough: f64) -> f64 {
        let known = self.known.get(&at.key).copied();
        if let Some(known) = known
            && (known.upper <= enough || known.threshold <= self.threshold)
        {
            return known.upper;
        }
        let (stop, told) = (self.stop(at), self.told_class(at));
        let upper = known.map_or(told, |known| known.upper.min(told));
        if upper <= enough.max(stop) || at.depth >= DEPTH_MAX {
            return upper;
        }
        if at.likelihood * (upper - stop) < self.threshold || self.looked_at >= self.beliefs_max {
            self.is_cut = true;
            return upper;
        }
        self.looked_at += 1;
        let mut best = stop.max(enough);
        for outlook in self.outlooks(at, best) {
            if outlook.value <= best {
                break;
            }
            best = best.max(self.ask(at, &outlook, best));
        }
        let threshold = if best > enough { self.threshold } else { f64::INFINITY };
        let upper = best.min(upper);
        self.known.insert(at.key, Known { upper, threshold });
        upper
    }

    /// Upper bound on the value of a question; the first that is not above `enough`.
    fn ask(&mut self, at: &State, outlook: &Outlook, enough: f64) -> f64 {
        let mut value = outlook.value;
        for (side, Side { share, right, weight }) in outlook.sides.into_iter().enumerate() {
            if share > 0.0 && value > enough {
                let next = self.answered(at, outlook, side);
                let after = self.look_into(&next, right - (value - enough) / weight);
                value -= weight * (right - after).max(0.0);
            }
        }
        value
    }

    /// The questions that may be worth more than `enough`, the most promising first.
    fn outlooks(&self, at: &State, enough: f64) -> Vec<Outlook> {
        let mut outlooks = self.look_ahead(at);
        outlooks.retain(|outlook| outlook.value > enough);
        for outlook in &mut outlooks {
            self.recall(at, outlook);
        }
        outlooks.sort_by(|a, b| b.value.total_cmp(&a.value));
        outlooks
    }

    /// Takes into account known results for the beliefs after the right answers.
    fn recall(&self, at: &State, outlook: &mut Outlook) {
        let question = &self.questions[outlook.question];
        for (side, of) in outlook.sides.iter_mut().enumerate() {
            let known = self.known.get(&at.key.wrapping_add(question.code(side)));
            if let Some(known) = known.filter(|known| known.upper < of.right) {
                outlook.value -= of.weight * (of.right - known.upper);
                of.right = known.upper;
            }
        }
    }

    /// Value of telling the class.
    fn told_class(&self, at: &State) -> f64 {
        let (mut total, mut value) = (0.0, 0.0);
        for class in &at.left {
            let (mass, log) = at.entry(*class);
            total += mass;
            value += mass * self.told_of(*class).value(mass, log);
        }
        value / total
    }

    fn told_of(&self, class: u16) -> &Told {
        let several = self.reduced.share[usize::from(class)] < 1.0;
        &self.told[usize::from(several)]
    }

    /// The better of picking and waiting. After any pick, the classes that are left get their
    /// compensation, and that of other classes is at the expense of the picked one.
    fn stop(&self, at: &State) -> f64 {
        let Costs { correct, wrong, .. } = self.costs;
        let paid =
            |class: usize| at.mass[class] * self.told_of(class as u16).compensation(at.log[class]);
        let all: f64 = (0..at.mass.len()).map(paid).sum();
        let (mut left, mut total, mut top) = (0.0, 0.0, 0.0_f64);
        for class in at.left.iter().map(|class| usize::from(*class)) {
            left += paid(class);
            total += at.mass[class];
            top = top.max(at.mass[class] * self.reduced.share[class]);
        }
        let picked = left.max((correct + wrong) * top - (all - left)) / total - wrong;
        picked.max(self.costs.wait_value())
    }

    /// Probability of every block of every partition.
    fn blocks(&self, mass: &[f64]) -> Vec<Vec<f64>> {
        let of = |partition: &Partition| {
            let mut blocks = vec![0.0; partition.values.len()];
            for (block, mass) in partition.blocks.iter().zip(mass) {
                blocks[usize::from(*block)] += mass;
            }
            blocks
        };
        self.reduced.partitions.iter().map(of).collect()
    }

    fn look_ahead(&self, at: &State) -> Vec<Outlook> {
        let total: f64 = at.left.iter().map(|class| at.entry(*class).0).sum();
        let blocks = self.blocks(&at.mass);
        let mut outlooks = Vec::with_capacity(self.questions.len());
        for (index, question) in self.questions.iter().enumerate() {
            let Channel { own, other, price, .. } = *question.channel;
            let yes = blocks[question.partition][usize::from(question.block)];
            let split = self.told[0].split(yes.clamp(0.0, 1.0));
            let [own_log, other_log] = question.log;
            // For the right answer of each side, and for the wrong one: likelihood, probability,
            // and change of a class's logarithm.
            let right = [0, 1].map(|side| (own, split.heard[side], own_log - split.log[side]));
            let wrong = [1, 0].map(|said| (other, split.heard[said], other_log - split.log[said]));
            let (mut misheard, mut sides) = (0.0, [(0.0, 0.0); 2]);
            for &class in &at.left {
                let ((mass, log), side) = (at.entry(class), question.side(usize::from(class)));
                let told = self.told_of(class);
                let after = |(likelihood, heard, added): (f64, f64, f64)| {
                    told.value_after(mass * likelihood, heard, log + added)
                };
                sides[side].0 += mass;
                sides[side].1 += mass * after(right[side]);
                misheard += mass * after(wrong[side]);
            }
            let right = sides[0].1 + sides[1].1;
            let paid = sides[0].0 * split.compensation[0] + sides[1].0 * split.compensation[1];
            let value = price.pay((own * right + other * misheard) / total) + paid / total;
            let sides = sides.map(|(mass, right)| Side {
                share: mass / total,
                right: right / mass.max(f64::MIN_POSITIVE),
                weight: price.discount * own * mass / total,
            });
            outlooks.push(Outlook { question: index, split, value, sides });
        }
        outlooks
    }

    /// The state after the right answer of that side.
    fn answered(&self, at: &State, outlook: &Outlook, side: usize) -> State {
        let question = &self.questions[outlook.question];
        let Channel { own, other, .. } = *question.channel;
        let scale = [own, other].map(|likelihood| likelihood / outlook.split.heard[side]);
        let log = outlook.split.log[side];
        let logs = question.log.map(|answer| answer - log);
        let of = |class: usize| usize::from(question.side(class) != side);
        let mass = at.mass.iter().enumerate().map(|(class, m)| m * scale[of(class)]).collect();
        let log = at.log.iter().enumerate().map(|(class, log)| log + logs[of(class)]).collect();
        let left = at.left.iter().copied().filter(|class| of(usize::from(*class)) == 0).collect();
        State {
            mass,
            log,
            left,
            likelihood: at.likelihood * outlook.sides[side].share,
            depth: at.depth + 1,
            key: at.key.wrapping_add(question.code(side)),
        }
    }
}

impl State {
    /// Probability of a class, and its logarithm.
    fn entry(&self, class: u16) -> (f64, f64) {
        (self.mass[usize::from(class)], self.log[usize::from(class)])
    }
}
