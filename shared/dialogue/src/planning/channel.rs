//! Questions as noisy channels: their costs and the dependence of answers on the class.

use scene::Question;
use vocabulary::{Action, Costs, Params};

use crate::{DecisionProblem, Naming};

/// A question about classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Query {
    /// Yes/no: is the class in that block of the partition?
    Is { partition: u16, block: u16 },
    /// Open: in which block of the partition is it?
    Which { partition: u16 },
    /// In which of some blocks is the object, if any? `offer` is an index into the partition's.
    Choice { partition: u16, offer: u16 },
    /// Yes/no question about one class.
    Point { class: u32 },
}

/// Distribution of a question's informative answers. Uninformative ones are folded into the price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Channel {
    /// Cost until an answer is informative.
    pub(crate) price: Price,
    /// Cost of asking once.
    pub(crate) cost: f64,
    /// Probability of the true answer.
    pub(crate) own: f64,
    /// Probability of one particular wrong answer.
    pub(crate) other: f64,
    /// Probability of one particular answer about a class whose true answer is not known.
    pub(crate) lacking: f64,
    /// Probability of an answer that is true of no class, about a class whose true answer is known.
    pub(crate) absent_other: f64,
    /// Probability of such an answer about a class whose true answer is not known.
    pub(crate) absent_lacking: f64,
    /// Entropy of the answers about one class, nats: the uncertainty left by all answers.
    pub(crate) noise: f64,
    /// Most information that an answer can carry, nats, whatever the belief.
    pub(crate) capacity: f64,
}

/// Cost of asking until an informative answer is heard.
///
/// With `q` the probability of hearing nothing, asking again until heard has the return `Q = −c +
/// γ((1−q) V' + q Q)`, so it costs `c / (1−γq)` and discounts by `γ(1−q) / (1−γq)`. Silence leaves
/// the belief unchanged, and so the best move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Price {
    /// Expected discounted cost.
    pub(crate) cost: f64,
    /// Expected discount of the dialogue after the answer.
    pub(crate) discount: f64,
    /// Expected number of times that it is asked.
    pub(crate) times: f64,
}

impl Price {
    /// The price of a question of that cost to which nothing is heard with probability `unheard`.
    pub(crate) fn new(costs: &Costs, cost: f64, unheard: f64) -> Self {
        let again = 1.0 - costs.discount * unheard;
        Self {
            cost: cost / again,
            discount: costs.discount * (1.0 - unheard) / again,
            times: 1.0 / (1.0 - unheard),
        }
    }

    /// Value of asking, given the value after the answer.
    pub(crate) fn pay(&self, after: f64) -> f64 {
        self.discount * after - self.cost
    }
}

/// The channels of questions that differ in their price alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Channels {
    /// Channel of a question of uniform cost.
    alike: Channel,
    /// Channels of every question, if they have costs of their own.
    own: Vec<Channel>,
}

impl Channels {
    /// The channels of yes/no questions, given those that can be asked.
    pub(crate) fn yes_no(
        problem: &DecisionProblem<'_>,
        alike: f64,
        questions: impl Iterator<Item = Question>,
    ) -> Self {
        let (costs, params) = (&problem.costs, problem.model.params());
        let alike = Channel::yes_no(params, costs, alike);
        let unheard = 1.0 - params.p_l;
        let own = |question| {
            let cost = problem.cost(Action::Ask(question));
            Channel { cost, price: Price::new(costs, cost, unheard), ..alike }
        };
        let own = problem.durations.map_or(Vec::new(), |_| questions.map(own).collect());
        Self { alike, own }
    }

    /// Channel of one question.
    pub(crate) fn of(&self, index: usize) -> &Channel {
        self.own.get(index).unwrap_or(&self.alike)
    }

    /// The cheapest of some questions.
    pub(crate) fn cheapest(&self, of: impl Iterator<Item = usize>) -> &Channel {
        let own = of.filter_map(|index| self.own.get(index));
        own.min_by(|a, b| a.cost.total_cmp(&b.cost)).unwrap_or(&self.alike)
    }
}

impl Channel {
    /// A yes/no question, eq. (6) and (7).
    pub(crate) fn yes_no(params: Params, costs: &Costs, cost: f64) -> Self {
        let own = 1.0 - params.epsilon;
        let noise = surprise(own) + surprise(params.epsilon);
        Self {
            price: Price::new(costs, cost, 1.0 - params.p_l),
            cost,
            own,
            other: params.epsilon,
            lacking: params.epsilon,
            absent_other: 0.0,
            absent_lacking: 0.0,
            noise,
            capacity: 2.0_f64.ln() - noise,
        }
    }

    /// A question that is answered by naming: with one of `named` answers that are true of classes,
    /// or of `absent` ones that are true of none. An answer of the latter kind is uninformative,
    /// unless there are classes whose true answer is not known (`lacking`).
    pub(crate) fn naming(
        problem: &DecisionProblem<'_>,
        question: Question,
        answer: &Naming,
        (named, absent): (usize, usize),
        lacking: bool,
    ) -> Self {
        let cost = match question {
            Question::Choice(..) => problem.choice_cost(answer.answers),
            question => problem.cost(Action::Ask(question)),
        };
        let absent_other = absent as f64 * answer.other;
        let known = if lacking { 1.0 } else { 1.0 - absent_other };
        let unheard = 1.0 - problem.model.params().of(question).p_l * known;
        let (own, other) = (answer.own / known, answer.other / known);
        let absent_other = if lacking { absent_other } else { 0.0 };
        let answers = named + usize::from(lacking && absent > 0);
        // No class is answered for with less noise than one whose true answer is known.
        let noise = surprise(own) + (named as f64 - 1.0) * surprise(other) + surprise(absent_other);
        Self {
            price: Price::new(&problem.costs, cost, unheard),
            cost,
            own,
            other,
            lacking: answer.lacking,
            absent_other,
            absent_lacking: if lacking { absent as f64 * answer.lacking } else { 0.0 },
            noise,
            capacity: (answers as f64).ln() - noise,
        }
    }
}

impl Channel {
    /// Whether it is answered like another, at whatever price.
    pub(crate) fn answers_like(&self, other: &Self) -> bool {
        *self == Self { price: self.price, cost: self.cost, ..*other }
            && self.price.times == other.price.times
    }

    /// How often questions like this are asked until an entropy, nats, is spent, if every answer
    /// carries all it can and the last leaves no more open than its noise.
    pub(crate) fn times_until_spent(&self, entropy: f64) -> f64 {
        self.price.times * ((entropy - self.noise) / self.capacity).max(1.0)
    }
}

/// `−p ln p`.
fn surprise(p: f64) -> f64 {
    if p > 0.0 { -p * p.ln() } else { 0.0 }
}
