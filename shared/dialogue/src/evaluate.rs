//! The exact value of a policy, by following every dialogue it can lead to.

use std::collections::BTreeMap;

use scene::{ObjectId, Question};
use vocabulary::Action;

use crate::{Answer, Belief, Decision, DecisionProblem, Planner, Step};

/// Performance of a policy from a belief, in expectation over wanted object and answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// Discounted return.
    pub value: f64,
    /// Probability of picking the wanted object.
    pub success: f64,
    /// Number of questions asked, repetitions after silence included.
    pub questions: f64,
    /// Number of announced picks that were denied.
    pub denied: f64,
    /// Probability of waiting for ever.
    pub waiting: f64,
    /// Probability of the dialogues that were cut short by picking the then likeliest object.
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
    let mut walk = Walk { planner, problem, cut, known: BTreeMap::new(), total: EMPTY };
    let mut level = BTreeMap::from([(belief.key(), (1.0, belief.clone()))]);
    let mut step = 0;
    while !level.is_empty() {
        level = walk.follow(level, step);
        step += 1;
    }
    walk.total.decisions = walk.known.len();
    walk.total
}

const EMPTY: Evaluation = Evaluation {
    value: 0.0,
    success: 0.0,
    questions: 0.0,
    denied: 0.0,
    waiting: 0.0,
    cut: 0.0,
    decisions: 0,
};

/// Beliefs reached at one step, with the probability of reaching them.
type Level = BTreeMap<Vec<i64>, (f64, Belief)>;

struct Walk<'a> {
    planner: &'a mut dyn Planner,
    problem: &'a DecisionProblem<'a>,
    cut: f64,
    known: BTreeMap<(bool, Vec<i64>), Decision>,
    total: Evaluation,
}

impl Walk<'_> {
    fn follow(&mut self, level: Level, step: u32) -> Level {
        let mut next = Level::new();
        let discount = self.problem.costs.discount.powi(i32::try_from(step).unwrap_or(i32::MAX));
        for (key, (reached, belief)) in level {
            let action = if reached < self.cut {
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
        match action {
            Action::Pick(i) => self.pick(i, belief, reached, discount, next),
            Action::Wait => {
                self.total.value += discount * reached * self.problem.costs.wait_value();
                self.total.waiting += reached;
            }
            Action::Ask(question) => {
                self.total.value -= discount * reached * self.problem.cost(action);
                self.total.questions += reached;
                for answer in Answer::possible(self.problem.model, question) {
                    let (heard, after) = hear(self.problem, belief, question, answer);
                    next.entry(after.key()).or_insert((0.0, after)).0 += reached * heard;
                }
            }
        }
    }

    /// A pick ends the dialogue, unless it is denied. Nothing is denied if the dialogue is cut
    /// short or the robot concludes that the object is absent.
    fn pick(
        &mut self,
        i: ObjectId,
        belief: &Belief,
        reached: f64,
        discount: f64,
        next: &mut Level,
    ) {
        let DecisionProblem { model, costs, announce, concessions, .. } = *self.problem;
        let right = concessions.chances(model, belief)[i.index()];
        if announce.is_final() || model.absent() == Some(i) || reached < self.cut {
            self.total.value += discount * reached * costs.pick_value(right);
            self.total.success += reached * right;
            return;
        }
        let epsilon = model.params().epsilon;
        let (settled, denied) = announce.settle(&costs, epsilon, right);
        self.total.value += discount * reached * settled;
        self.total.success += reached * right * (1.0 - announce.denials(epsilon).0);
        self.total.denied += reached * denied;
        // The manager counts a denial twice.
        let no = |belief| hear(self.problem, belief, Question::Point(i), Answer::No).1;
        let after = no(&no(belief));
        next.entry(after.key()).or_insert((0.0, after)).0 += reached * denied;
    }
}

/// Probability of an answer, and the belief after it. Who wants one of several objects that are
/// equally right answers about each of them alike.
fn hear(
    problem: &DecisionProblem<'_>,
    belief: &Belief,
    question: Question,
    answer: Answer,
) -> (f64, Belief) {
    let model = problem.model;
    let mut after = belief.clone();
    let alike = match question {
        Question::Point(asked) if !problem.concessions.indifferent.is_empty() => {
            Some((asked, problem.concessions.wishes(model)))
        }
        _ => None,
    };
    let probability = |i: usize| match &alike {
        Some((asked, wishes)) if wishes[i] == wishes[asked.index()] => {
            answer.probability(model, question, *asked)
        }
        _ => answer.probability(model, question, i.into()),
    };
    let heard = belief.probabilities().iter().enumerate().map(|(i, p)| p * probability(i)).sum();
    if alike.is_some() {
        let log: Vec<f64> = (0..belief.len()).map(|i| probability(i).ln()).collect();
        after.weigh(&log);
    } else {
        after.update(model, question, &answer.reading(model));
    }
    (heard, after)
}

#[cfg(test)]
mod tests {
    use vocabulary::{Actions, Costs, Mode, Params, Reliability};

    use super::*;
    use crate::testing::{bowls, markers, scene};
    use crate::{Lookahead, Model, registry};

    const YES_NO: Actions =
        Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };

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

    /// "Red, blue or green?", then a pick: `V = −4.7 + 0.99 (0.9 (0.98·50 − 0.02·100) + 0.1 V)`.
    #[test]
    fn a_choice_among_three_by_hand() {
        let scene = scene(
            r#"{"objects":[{"name":"a","attributes":{"color":"red"}},
                {"name":"b","attributes":{"color":"blue"}},
                {"name":"c","attributes":{"color":"green"}}]}"#,
        );
        let choice = Some(Reliability { p_l: 0.9, epsilon: 0.02 });
        let model = Model::new(&scene, Params { choice, ..Params::default() });
        let actions = Actions { choice: true, ..YES_NO };
        let problem = DecisionProblem { actions, ..problem(&model) };
        let found = evaluate(&mut Lookahead::default(), &problem, &Belief::uniform(3), 1e-9);
        let value = (-4.7 + 0.99 * 0.9 * 47.0) / (1.0 - 0.99 * 0.1);
        assert!((found.value - value).abs() < 1e-6, "{found:?} not {value}");
        assert!((found.success - 0.98).abs() < 1e-9, "{found:?}");
        assert!((found.questions - 1.0 / 0.9).abs() < 1e-6, "{found:?}");
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
