//! The exact value of a policy, by following every dialogue it can lead to.

use std::collections::BTreeMap;

use crate::{Action, Answer, Belief, Decision, DecisionProblem, Planner, Step};

/// What a policy achieves from a belief, in expectation over wanted object and answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// Discounted return.
    pub value: f64,
    /// Probability of picking the wanted object.
    pub success: f64,
    /// Number of questions asked, repetitions after silence included.
    pub questions: f64,
    /// Probability of waiting for ever.
    pub waiting: f64,
    /// Probability of the dialogues that were cut short, by picking what was most likely then.
    pub cut: f64,
    /// How many different beliefs the policy was asked about.
    pub decisions: usize,
}

/// Evaluates a policy under the answers that planners expect ([`Answer`]).
///
/// Dialogues that lead to the same belief at the same step are followed together, which keeps
/// their number small. A belief that is reached with less probability than `cut` is not followed
/// further. Waiting brings nothing, so a policy that waits once is taken to wait for ever.
///
/// The planner is asked once per belief for the first step and once for all later ones: one that
/// draws random numbers is evaluated for these draws.
pub fn evaluate(
    planner: &mut dyn Planner,
    problem: &DecisionProblem<'_>,
    belief: &Belief,
    cut: f64,
) -> Evaluation {
    let mut walk = Walk { planner, problem, known: BTreeMap::new(), total: EMPTY };
    let mut level = BTreeMap::from([(belief.key(), (1.0, belief.clone()))]);
    let mut step = 0;
    while !level.is_empty() {
        level = walk.follow(level, step, cut);
        step += 1;
    }
    walk.total.decisions = walk.known.len();
    walk.total
}

const EMPTY: Evaluation =
    Evaluation { value: 0.0, success: 0.0, questions: 0.0, waiting: 0.0, cut: 0.0, decisions: 0 };

/// Beliefs reached at one step, with the probability of reaching them.
type Level = BTreeMap<Vec<i64>, (f64, Belief)>;

struct Walk<'a> {
    planner: &'a mut dyn Planner,
    problem: &'a DecisionProblem<'a>,
    known: BTreeMap<(bool, Vec<i64>), Decision>,
    total: Evaluation,
}

impl Walk<'_> {
    fn follow(&mut self, level: Level, step: u32, cut: f64) -> Level {
        let mut next = Level::new();
        let discount = self.problem.costs.discount.powi(i32::try_from(step).unwrap_or(i32::MAX));
        for (key, (reached, belief)) in level {
            let action = if reached < cut {
                self.total.cut += reached;
                Action::Pick(belief.most_likely())
            } else {
                self.decide(key, &belief, step)
            };
            self.act(action, &belief, reached, discount, &mut next);
        }
        next
    }

    fn decide(&mut self, key: Vec<i64>, belief: &Belief, step: u32) -> Action {
        let (planner, problem) = (&mut self.planner, self.problem);
        let decision = (self.known.entry((step == 0, key)))
            .or_insert_with(|| planner.decide(problem, belief, Step { interaction: 0, step }));
        decision.action
    }

    fn act(
        &mut self,
        action: Action,
        belief: &Belief,
        reached: f64,
        discount: f64,
        next: &mut Level,
    ) {
        let costs = self.problem.costs;
        match action {
            Action::Pick(i) => {
                let right = belief.probability(i);
                self.total.value += discount * reached * costs.pick_value(right);
                self.total.success += reached * right;
            }
            Action::Wait => {
                self.total.value += discount * reached * costs.wait_value();
                self.total.waiting += reached;
            }
            Action::Ask(question) => {
                self.total.value -= discount * reached * self.problem.cost(action);
                self.total.questions += reached;
                let model = self.problem.model;
                for answer in Answer::possible(model, question) {
                    let heard: f64 = (belief.probabilities().iter().enumerate())
                        .map(|(i, p)| p * answer.probability(model, question, i.into()))
                        .sum();
                    let mut after = belief.clone();
                    after.update(model, question, &answer.reading(model));
                    next.entry(after.key()).or_insert((0.0, after)).0 += reached * heard;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{bowls, markers};
    use crate::{Actions, Costs, Lookahead, Mode, Model, Params, registry};

    const YES_NO: Actions = Actions { mode: Mode::Remote, attribute: true, which: false };

    fn problem(model: &Model) -> DecisionProblem<'_> {
        DecisionProblem::new(model, Costs::SECONDS, YES_NO)
    }

    /// Asking until answered, then picking: `V = −4 + 0.99 (0.95 (0.99·50 − 0.01·100) + 0.05 V)`.
    #[test]
    fn two_markers_by_hand() {
        let model = Model::new(&markers(), Params::default());
        let found =
            evaluate(&mut Lookahead::default(), &problem(&model), &Belief::uniform(2), 1e-9);
        let value = (-4.0 + 0.99 * 0.95 * 48.5) / (1.0 - 0.99 * 0.05);
        assert!((found.value - value).abs() < 1e-6, "{found:?} not {value}");
        assert!((found.success - 0.99).abs() < 1e-9, "{found:?}");
        assert!((found.questions - 1.0 / 0.95).abs() < 1e-6, "{found:?}");
        assert!(found.cut < 1e-8 && found.waiting == 0.0);
    }

    #[test]
    fn guessing_and_waiting_by_hand() {
        let model = Model::new(&bowls(), Params::default());
        let mut never = registry::planner("never-ask").unwrap();
        let guess = evaluate(&mut *never, &problem(&model), &Belief::uniform(6), 0.0);
        assert!(
            (guess.value + 75.0).abs() < 1e-9 && guess.questions == 0.0 && guess.decisions == 1
        );
        let costs = Costs::PREDECESSOR;
        let wait = DecisionProblem { costs, ..problem(&model) };
        let waited = evaluate(&mut *never, &wait, &Belief::uniform(6), 0.0);
        assert!((waited.value + 10.0).abs() < 1e-9 && waited.waiting == 1.0);
    }
}
