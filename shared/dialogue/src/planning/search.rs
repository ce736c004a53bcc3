//! Best-first search over the beliefs that a dialogue can reach.
//!
//! Beliefs are nodes, questions and denials of announced picks lead from one to several, and equal
//! beliefs are one node however they were reached: the order of answers does not matter, so the
//! graph is far smaller than the tree of dialogues. Every node keeps a certified lower and upper
//! bound, and an estimate between them that leads the search when it cannot close the bounds.

mod plan;

use std::collections::HashMap;

use super::bound::{Bound, Value};
use super::channel::{Price, Query};
use super::one_step_lookahead::{AnnouncedPick, Choice, OneStepEvaluator, OneStepLookahead};
use super::outcome::{denial, outcomes};
use super::reduced::Reduced;
use crate::stable_hash::StableHash128;

/// How long to search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Effort {
    /// Most beliefs to look at.
    pub(crate) beliefs_max: usize,
    /// Gap between the bounds at which the value counts as known.
    pub(crate) tolerance: f64,
    /// Method for closing a larger gap that the search leaves.
    pub(crate) certify: Option<Certify>,
}

/// Effort to bring the bounds together after the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Certify {
    /// Most further beliefs to look at for a better plan.
    pub(crate) plan_max: usize,
    /// Most beliefs of an easier problem to look at for an upper bound.
    pub(crate) easier_max: usize,
}

/// The graph of beliefs searched so far; the first node is the belief that is decided about.
#[derive(Debug)]
pub(crate) struct Search<'a> {
    reduced: &'a Reduced,
    evaluator: OneStepEvaluator<'a>,
    nodes: Vec<Node>,
    /// Class probabilities, node after node.
    masses: Vec<f64>,
    known: HashMap<u128, usize>,
}

/// A belief.
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) value: Value,
    /// Value of the better of waiting and a pick that is final.
    pub(crate) stop: f64,
    /// Class of the pick in `stop`.
    pub(crate) class: usize,
    /// Entropy over classes, nats.
    pub(crate) entropy: f64,
    pub(crate) branches: Vec<Branch>,
    rest: f64,
}

/// Move after which a dialogue can continue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Move {
    /// A question.
    Ask(Query),
    /// The announced pick of a class.
    Announce(u32),
}

/// A move at a belief.
#[derive(Debug)]
pub(crate) struct Branch {
    pub(crate) to: Move,
    pub(crate) price: Price,
    pub(crate) value: Value,
    /// Probability and node of each answer; empty until the move is followed.
    pub(crate) answers: Vec<(f64, usize)>,
}

/// Guide of a descent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lead {
    /// The upper bound: proves that other questions are worse.
    Hope,
    /// The estimate: improves the plan that looks best.
    Expectation,
}

/// Mostly the plan that looks best is improved; now and then it is asked whether it is the best.
const LEADS: [Lead; 4] = [Lead::Hope, Lead::Expectation, Lead::Expectation, Lead::Expectation];
/// Most questions that are kept at a belief.
const BRANCHES_MAX: usize = 48;
/// Descents without anything left to follow after which the rest of the gap is rounding.
const BARREN_MAX: u32 = 32;
/// No plan asks that often; a guard against cycles of answers that cancel out.
const DEPTH_MAX: usize = 64;

impl<'a> Search<'a> {
    /// A search that has looked one step ahead from the belief itself.
    pub(crate) fn new(reduced: &'a Reduced, bound: &'a Bound) -> Self {
        let mut search = Self {
            reduced,
            evaluator: OneStepEvaluator::new(reduced, bound),
            nodes: Vec::new(),
            masses: Vec::new(),
            known: HashMap::new(),
        };
        search.node(&reduced.mass);
        search
    }

    /// The belief to decide about.
    pub(crate) fn root(&self) -> &Node {
        &self.nodes[0]
    }

    /// How many beliefs were looked at.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Another belief.
    pub(crate) fn at(&self, node: usize) -> &Node {
        &self.nodes[node]
    }

    /// Searches until the value is known or the effort is spent.
    pub(crate) fn run(&mut self, effort: Effort) {
        // Answers that would change the root's value by less than this are not followed; it
        // shrinks once nothing larger is left.
        let mut focus = effort.tolerance;
        let mut barren = 0;
        for lead in LEADS.into_iter().cycle() {
            let solved = self.root().value.gap() <= effort.tolerance;
            let spent = self.nodes.len() >= effort.beliefs_max;
            if solved || spent || barren >= BARREN_MAX {
                break;
            }
            if !self.descend(lead, focus) && lead == Lead::Hope {
                focus *= 0.5;
                barren += 1;
            }
        }
    }

    /// Goes down along the leading questions and the most doubtful answers to a question that has
    /// not been followed, follows it, and updates the beliefs on the way. False if there was none.
    fn descend(&mut self, lead: Lead, focus: f64) -> bool {
        let mut path = Vec::new();
        let mut node = 0;
        let mut weight = 1.0;
        let mut followed = false;
        while path.len() < DEPTH_MAX {
            let Some(branch) = self.nodes[node].leading(lead) else { break };
            path.push((node, branch));
            if self.nodes[node].branches[branch].answers.is_empty() {
                self.follow(node, branch);
                followed = true;
                break;
            }
            let (probability, next) = self.most_doubtful(&self.nodes[node].branches[branch]);
            weight *= probability * self.nodes[node].branches[branch].price.discount;
            if weight * self.nodes[next].value.gap() < focus {
                break;
            }
            node = next;
        }
        for &(node, branch) in path.iter().rev() {
            self.back_up(node, branch);
        }
        followed
    }

    fn most_doubtful(&self, branch: &Branch) -> (f64, usize) {
        let doubt = |(probability, node): (f64, usize)| probability * self.nodes[node].value.gap();
        let answers = branch.answers.iter().copied();
        answers.reduce(|a, b| if doubt(b) > doubt(a) { b } else { a }).unwrap_or((0.0, 0))
    }

    fn follow(&mut self, node: usize, branch: usize) {
        let classes = self.reduced.classes();
        let mass = &self.masses[node * classes..(node + 1) * classes];
        let answers = match (self.nodes[node].branches[branch].to, &self.reduced.announced) {
            (Move::Ask(query), _) => outcomes(self.reduced, query, mass),
            (Move::Announce(class), Some(it)) => vec![denial(self.reduced, it, class, mass)],
            (Move::Announce(_), None) => Vec::new(),
        };
        let answers = answers.into_iter().map(|(p, mass)| (p, self.node(&mass))).collect();
        self.nodes[node].branches[branch].answers = answers;
    }

    fn back_up(&mut self, node: usize, branch: usize) {
        let mut after = Value::default();
        let followed = &self.nodes[node].branches[branch];
        for &(probability, next) in &followed.answers {
            after.add(probability, &self.nodes[next].value);
        }
        let fresh = after.pay(&followed.price);
        let node = &mut self.nodes[node];
        let value = &mut node.branches[branch].value;
        value.lower = value.lower.max(fresh.lower);
        value.upper = value.upper.min(fresh.upper).max(value.lower);
        value.estimate = fresh.estimate.clamp(value.lower, value.upper);
        node.refresh();
    }

    /// The node of a belief, made if it is new.
    fn node(&mut self, mass: &[f64]) -> usize {
        let key = key(mass);
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let number = self.nodes.len();
        self.nodes.push(Node::new(self.reduced, self.evaluator.look_ahead(mass)));
        self.masses.extend_from_slice(mass);
        self.known.insert(key, number);
        number
    }
}

impl Node {
    fn new(reduced: &Reduced, one_step: OneStepLookahead) -> Self {
        let OneStepLookahead { value, stop, class, entropy, choices, picks, mut rest, .. } =
            one_step;
        let asked = choices.into_iter().map(|Choice { query, value, .. }| {
            let price = reduced.channel(query).price;
            Branch { to: Move::Ask(query), price, value, answers: Vec::new() }
        });
        let picked = picks.into_iter().map(|AnnouncedPick { class, price, value }| Branch {
            to: Move::Announce(class),
            price,
            value,
            answers: Vec::new(),
        });
        let mut branches: Vec<Branch> = asked.chain(picked).collect();
        rest = rest.max(drop_unpromising(&mut branches, stop));
        let mut node = Self { value, stop, class, entropy, branches, rest };
        node.refresh();
        node
    }

    /// The best move by estimate, if it is estimated to be better than stopping.
    pub(crate) fn best(&self) -> Option<&Branch> {
        let best = self.leading(Lead::Expectation).map(|branch| &self.branches[branch]);
        best.filter(|branch| branch.value.estimate > self.stop)
    }

    fn leading(&self, lead: Lead) -> Option<usize> {
        let rank = |branch: &Branch| match lead {
            Lead::Hope => branch.value.upper,
            Lead::Expectation => branch.value.estimate,
        };
        (self.branches.iter().enumerate())
            .reduce(|a, b| if rank(b.1) > rank(a.1) { b } else { a })
            .filter(|(_, branch)| branch.value.upper > self.stop)
            .map(|(index, _)| index)
    }

    /// Takes the value from the branches. Bounds only ever tighten.
    fn refresh(&mut self) {
        let mut best =
            Value { lower: self.stop, upper: self.rest.max(self.stop), estimate: self.stop };
        for Branch { value, .. } in &self.branches {
            best.lower = best.lower.max(value.lower);
            best.upper = best.upper.max(value.upper);
            best.estimate = best.estimate.max(value.estimate);
        }
        let lower = best.lower.max(self.value.lower);
        let upper = best.upper.min(self.value.upper).max(lower);
        self.value = Value { lower, upper, estimate: best.estimate.clamp(lower, upper) };
    }
}

/// Drops the moves that cannot beat stopping and the least promising beyond [`BRANCHES_MAX`];
/// returns the upper bound of the dropped ones.
fn drop_unpromising(branches: &mut Vec<Branch>, stop: f64) -> f64 {
    branches.sort_by(|a, b| b.value.estimate.total_cmp(&a.value.estimate));
    let mut rest = f64::NEG_INFINITY;
    let mut kept = 0;
    branches.retain(|branch| {
        let promising = branch.value.upper > stop && kept < BRANCHES_MAX;
        kept += usize::from(promising);
        rest = if promising { rest } else { branch.value.upper.max(rest) };
        promising
    });
    rest
}

/// Beliefs that agree to about 1e-11 are one, which moves a value by no more than that times the
/// stake of a pick.
fn key(mass: &[f64]) -> u128 {
    const STEPS: f64 = (1_u64 << 36) as f64;
    mass.iter()
        .fold(StableHash128::default(), |hash, m| hash.add((m * STEPS).round() as u64))
        .wide()
}
