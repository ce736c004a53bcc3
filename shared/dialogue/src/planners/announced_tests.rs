//! Planners with announced picks that can be denied.

use std::collections::HashMap;

use scene::{ObjectId, Question};
use vocabulary::{Actions, Announce, Costs, Mode, Params, Rng};

use super::*;
use crate::testing::{bowls, markers, random_durations, random_scene};
use crate::{Answer, Evaluation, Model, Step, evaluate, registry};

const YES_NO: Actions =
    Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };
const OPEN: Actions = Actions { mode: Mode::Remote, attribute: true, which: true, choice: false };
const PRESENT: Actions =
    Actions { mode: Mode::Present, attribute: true, which: false, choice: false };
const PICKING: Actions =
    Actions { mode: Mode::Remote, attribute: false, which: false, choice: false };

fn announced<'a>(
    model: &'a Model,
    costs: Costs,
    actions: Actions,
    (heard, cost_s): (f64, f64),
) -> DecisionProblem<'a> {
    let announce = Announce { heard, cost_s };
    DecisionProblem { announce, ..DecisionProblem::new(model, costs, actions) }
}

/// A denial is wrong as often as two answers are that agree.
fn erroneous(epsilon: f64) -> f64 {
    epsilon.powi(2) / (epsilon.powi(2) + (1.0 - epsilon).powi(2))
}

/// Value iteration over beliefs to a depth, from the observation model and the equation alone. A
/// leaf is worth waiting for ever at least, and a right pick at most.
struct Exact<'a> {
    problem: &'a DecisionProblem<'a>,
    known: HashMap<(u32, Vec<i64>), (f64, f64)>,
}

impl Exact<'_> {
    fn value(&mut self, belief: &[f64], depth: u32) -> (f64, f64) {
        let costs = self.problem.costs;
        let wait = costs.wait_value();
        if depth == 0 {
            return (wait, costs.correct);
        }
        let key = (depth, belief.iter().map(|p| (p * 1e10).round() as i64).collect());
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let mut best = (wait, wait);
        let mut offer = |(lower, upper): (f64, f64)| {
            best = (f64::max(best.0, lower), f64::max(best.1, upper));
        };
        for i in 0..self.problem.model.objects() {
            offer(self.pick(belief, i, depth));
        }
        for question in self.problem.model.questions(self.problem.actions) {
            offer(self.ask(belief, question, depth));
        }
        self.known.insert(key, best);
        best
    }

    fn pick(&mut self, belief: &[f64], i: usize, depth: u32) -> (f64, f64) {
        let DecisionProblem { model, costs, announce, .. } = *self.problem;
        let epsilon = erroneous(model.params().epsilon);
        let denies = |j: usize| announce.heard * if j == i { epsilon } else { 1.0 - epsilon };
        let paid = |j: usize| if j == i { costs.correct } else { -costs.wrong };
        let objects = || belief.iter().enumerate();
        let kept: f64 = objects().map(|(j, b)| b * (1.0 - denies(j)) * paid(j)).sum();
        let denied: f64 = objects().map(|(j, b)| b * denies(j)).sum();
        let after: Vec<f64> = objects().map(|(j, b)| b * denies(j) / denied).collect();
        let (lower, upper) = self.value(&after, depth - 1);
        let worth = |after: f64| kept + denied * (costs.discount * after - announce.cost_s);
        (worth(lower), worth(upper))
    }

    fn ask(&mut self, belief: &[f64], question: Question, depth: u32) -> (f64, f64) {
        let DecisionProblem { model, costs, .. } = *self.problem;
        let cost = self.problem.cost(Action::Ask(question));
        let mut sums = (-cost, -cost);
        for answer in Answer::possible(model, question) {
            let likely = |i: usize| answer.probability(model, question, i.into());
            let joint: Vec<f64> = belief.iter().enumerate().map(|(i, b)| b * likely(i)).collect();
            let heard: f64 = joint.iter().sum();
            if heard < 1e-15 {
                continue;
            }
            let after: Vec<f64> = joint.into_iter().map(|b| b / heard).collect();
            let (lower, upper) = self.value(&after, depth - 1);
            sums.0 += costs.discount * heard * lower;
            sums.1 += costs.discount * heard * upper;
        }
        sums
    }
}

/// Deep enough for the doubts that count.
const DEPTH: u32 = 16;

#[test]
fn value_iteration_finds_the_same_values() {
    let seed = 151;
    let mut rng = Rng::new(seed);
    let scenes = [markers(), random_scene(&mut rng, 3, &[2, 2], 0)];
    for scene in scenes {
        let model =
            Model::new(&scene, Params { p_l: 0.9, epsilon: 0.05, alpha: 0.2, ..Params::default() });
        for actions in [YES_NO, PRESENT, PICKING] {
            for denial in [(0.0, 0.0), (0.4, 10.0), (0.8, 6.0), (0.95, 1.0)] {
                let problem = announced(&model, Costs::SECONDS, actions, denial);
                let weights: Vec<f64> = (0..model.objects()).map(|_| 0.2 + rng.uniform()).collect();
                let belief = Belief::from_probabilities(&weights).unwrap();
                let mut exact = Exact { problem: &problem, known: HashMap::new() };
                let (lower, upper) = exact.value(&belief.probabilities(), DEPTH);
                let decision = Optimal::default().decide(&problem, &belief, Step::default());
                let (found_lower, found_upper) = decision.bounds.unwrap();
                let label = format!("seed {seed} {actions:?} {denial:?}: {lower} {upper}");
                assert!(upper - lower < 2.0, "{label}: too shallow to tell");
                let slack = 1e-6;
                assert!(found_lower <= upper + slack, "{label} {decision:?}");
                assert!(found_upper >= lower - slack, "{label} {decision:?}");
                let found = evaluate(&mut Optimal::default(), &problem, &belief, 1e-9);
                assert!(found.value <= upper + 1e-3, "{label} {found:?}");
                assert!(found.value >= lower - 1e-3, "{label} {found:?}");
            }
        }
    }
}

fn solved(problem: &DecisionProblem<'_>, planner: &str) -> (Decision, Evaluation) {
    let belief = Belief::uniform(problem.model.hypotheses());
    let mut planner = registry::planner(planner).unwrap();
    let decision = planner.decide(problem, &belief, Step::default());
    (decision, evaluate(&mut *planner, problem, &belief, 1e-4))
}

/// Certified bounds that meet, and a policy whose exact value is between them.
#[test]
fn the_bowls_are_solved_where_picks_can_be_denied() {
    let model = Model::new(&bowls(), Params::default());
    for actions in [YES_NO, PRESENT, OPEN, PICKING] {
        let mut before = f64::NEG_INFINITY;
        for heard in [0.5, 0.8, 0.9] {
            let problem = announced(&model, Costs::SECONDS, actions, (heard, 8.0));
            for planner in ["lookahead", "optimal"] {
                let (decision, found) = solved(&problem, planner);
                let label = format!("{planner} {actions:?} {heard}");
                let (lower, upper) = decision.bounds.unwrap();
                assert!(upper - lower <= 1e-3, "{label}: {lower} {upper}");
                let slack = 1e-3 + 150.0 * found.cut;
                assert!(found.value >= lower - slack, "{label}: {found:?} {lower}");
                assert!(found.value <= upper + slack, "{label}: {found:?} {upper}");
                assert!(lower > before, "{label}: who is heard more often is not worse off");
            }
            before = solved(&problem, "optimal").1.value;
        }
    }
}

/// Every planner's exact value is below the certified upper bound, on scenes with doubles, missing
/// attributes, own costs, and with possibly absent objects.
#[test]
fn no_policy_beats_the_bounds() {
    let seed = 152;
    let mut rng = Rng::new(seed);
    for draw in 0..6 {
        let scene = random_scene(&mut rng, 5, &[3, 2], 4 * (draw % 2));
        let model = Model::new(&scene, Params::default());
        let model = if draw % 3 == 2 { model.with_absent() } else { model };
        let own = random_durations(&mut rng, &model, Costs::SECONDS);
        for actions in [YES_NO, PRESENT, OPEN] {
            let denial = (0.3 + 0.65 * rng.uniform(), 12.0 * rng.uniform());
            let plain = announced(&model, Costs::SECONDS, actions, denial);
            let problem = match draw {
                4.. => DecisionProblem { durations: Some(&own), ..plain },
                _ => plain,
            };
            let best = Optimal::default().decide(
                &problem,
                &Belief::uniform(model.hypotheses()),
                Step::default(),
            );
            let (lower, upper) = best.bounds.unwrap();
            for name in registry::names() {
                let label = format!("seed {seed} draw {draw} {name} {actions:?} {denial:?}");
                let (decision, found) = solved(&problem, name);
                let slack = 1e-3 + 150.0 * found.cut;
                assert!(found.value <= upper + slack, "{label}: {found:?} above {upper}");
                if name == "optimal" {
                    assert!(
                        found.value >= lower - slack,
                        "{label}: {found:?} below {lower} of {best:?}"
                    );
                }
                let asks = matches!(decision.action, Action::Ask(_));
                assert!(!asks || decision.expected_questions >= 1.0, "{label}");
                assert!(problem.actions.allow(decision.action), "{label}");
                assert!(decision.alternatives.iter().all(|(a, _)| *a != decision.action));
            }
        }
    }
}

/// If nobody is heard, everything is as before, to the last bit.
#[test]
fn unheard_denials_change_nothing() {
    let mut rng = Rng::new(153);
    for scene in [bowls(), random_scene(&mut rng, 9, &[3, 2, 2], 4)] {
        let model = Model::new(&scene, Params::default());
        for actions in [YES_NO, OPEN, PRESENT] {
            let plain = DecisionProblem::new(&model, Costs::SECONDS, actions);
            let unheard = announced(&model, Costs::SECONDS, actions, (0.0, 8.0));
            assert_eq!(plain.key(), unheard.key());
            assert_ne!(plain.key(), announced(&model, Costs::SECONDS, actions, (0.1, 8.0)).key());
            for name in registry::names() {
                assert_eq!(solved(&plain, name), solved(&unheard, name), "{name} {actions:?}");
            }
        }
    }
}

/// Two markers: "Is it red?" costs 4 s, announcing one and being corrected 6 s half of the time. By
/// hand for a person who is always heard and never errs.
#[test]
fn announcing_replaces_the_last_question() {
    let params = Params { p_l: 0.95, epsilon: 1e-9, alpha: 0.2, ..Params::default() };
    let model = Model::new(&markers(), params);
    let heard = 0.999_999;
    let (decision, found) =
        solved(&announced(&model, Costs::SECONDS, YES_NO, (heard, 6.0)), "optimal");
    assert_eq!(decision.action, Action::Pick(ObjectId(0)));
    // Right at once, or after a denial.
    let value = 0.5 * 50.0 + 0.5 * (-6.0 + 0.99 * 50.0);
    assert!((found.value - value).abs() < 1e-3, "{found:?} not {value}");
    assert!((found.denied - 0.5).abs() < 1e-3 && found.questions == 0.0, "{found:?}");
    // A user who is heard every other time is asked.
    let (decision, _) = solved(&announced(&model, Costs::SECONDS, YES_NO, (0.5, 6.0)), "optimal");
    assert!(matches!(decision.action, Action::Ask(_)), "{decision:?}");
}
