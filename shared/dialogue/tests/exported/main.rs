//! The exported problem, solved by a solver that knows nothing of dialogues: its bounds hold the
//! value that the planner certifies.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod parser;
mod problem;
mod solver;

use dialogue::export;
use dialogue::{Actions, Belief, Costs, DecisionProblem, Lookahead, Mode, Model, Params, Planner};
use parser::parse;
use scene::Scene;
use solver::Solver;

const YES_NO: Actions = Actions { mode: Mode::Remote, attribute: true, which: false };
const OPEN: Actions = Actions { mode: Mode::Remote, attribute: true, which: true };
const POINTING: Actions = Actions { mode: Mode::Present, attribute: false, which: false };

/// Solves the text that is exported until the bounds are `gap` apart, and compares.
fn agree(scene: &str, actions: Actions, costs: Costs, gap: f64) -> (f64, f64) {
    let scene = Scene::from_toml("scene", scene).unwrap();
    let model = Model::new(&scene, Params::default());
    let problem = DecisionProblem::new(&model, costs, actions);
    let text = export::pomdp(&scene, &problem, "").unwrap().text;
    let (lower, upper) = Solver::new(&parse(&text)).solve(gap);
    let belief = Belief::uniform(model.objects());
    let decision = Lookahead::default().decide(&problem, &belief, dialogue::Step::default());
    let certified = decision.bounds.unwrap();
    assert!(upper - lower <= gap, "{lower} {upper}");
    let rounding = 1e-6 * (costs.correct + costs.wrong);
    let apart = lower > certified.1 + rounding || upper < certified.0 - rounding;
    assert!(!apart, "solver {lower} to {upper}, planner {certified:?}");
    assert!(lower <= decision.value + rounding && decision.value <= upper + rounding);
    (lower, upper)
}

const MARKERS: &str = include_str!("../../../../config/scenes/markers.toml");
const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");

#[test]
fn two_markers() {
    for (costs, optimum) in
        [(Costs::SECONDS, 43.7814), (Costs::PREDECESSOR, 6.5901), (Costs::ABSTRACT, 0.8236)]
    {
        let gap = 1e-4 * (costs.correct + costs.wrong);
        let (lower, upper) = agree(MARKERS, YES_NO, costs, gap);
        assert!(lower <= optimum + 1e-4 && optimum <= upper + 1e-4, "{lower} {upper}");
    }
}

#[test]
fn six_bowls_with_yes_no_questions() {
    let (lower, upper) = agree(BOWLS, YES_NO, Costs::SECONDS, 0.5);
    assert!(lower <= 33.9733 + 1e-4 && 33.9733 <= upper + 1e-4, "{lower} {upper}");
}

#[test]
fn six_bowls_with_open_questions() {
    let (lower, upper) = agree(BOWLS, OPEN, Costs::SECONDS, 0.5);
    assert!(lower <= 38.0755 + 1e-4 && 38.0755 <= upper + 1e-4, "{lower} {upper}");
}

#[test]
fn six_bowls_by_pointing() {
    let (lower, upper) = agree(BOWLS, POINTING, Costs::SECONDS, 6.0);
    assert!(lower <= 23.0096 + 1e-4 && 23.0096 <= upper + 1e-4, "{lower} {upper}");
}
