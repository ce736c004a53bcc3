use super::*;
use crate::testing::{bowls, markers, random_scene};
use crate::{Actions, Costs, Lookahead, Mode, Model, ModelUser, Params, Rng, registry};

const YES_NO: Actions = Actions { mode: Mode::Remote, attribute: true, which: false };

fn problem(model: &Model) -> DecisionProblem<'_> {
    DecisionProblem::new(model, Costs::SECONDS, YES_NO)
}

/// Asking until answered, then picking: `V = −4 + 0.99 (0.95 (0.99·50 − 0.01·100) + 0.05 V)`.
#[test]
fn two_markers_by_hand() {
    let model = Model::new(&markers(), Params::default());
    let found = evaluate(&mut Lookahead::default(), &problem(&model), &Belief::uniform(2), 1e-9);
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
    assert!((guess.value + 75.0).abs() < 1e-9 && guess.questions == 0.0 && guess.decisions == 1);
    let costs = Costs::PREDECESSOR;
    let wait = DecisionProblem { costs, ..problem(&model) };
    let waited = evaluate(&mut *never, &wait, &Belief::uniform(6), 0.0);
    assert!((waited.value + 10.0).abs() < 1e-9 && waited.waiting == 1.0);
}

/// The enumeration against dialogues with simulated people.
#[test]
fn dialogues_average_out_to_the_evaluation() {
    let mut rng = Rng::new(91);
    let scene = random_scene(&mut rng, 6, &[3, 2, 3], 0);
    let model = Model::new(&scene, Params { p_l: 0.8, epsilon: 0.08, alpha: 0.2 });
    let actions = Actions { which: true, ..YES_NO };
    let problem = DecisionProblem { actions, ..problem(&model) };
    let mut planner = registry::planner("entropy").unwrap();
    let exact = evaluate(&mut *planner, &problem, &Belief::uniform(6), 1e-7);
    const DIALOGUES: u32 = 1_000;
    let (mut value, mut squares, mut success, mut questions) = (0.0, 0.0, 0.0, 0.0);
    for seed in 0..u64::from(DIALOGUES) {
        let (gained, right, asked) = dialogue(&mut *planner, &problem, seed);
        value += gained;
        squares += gained * gained;
        success += f64::from(u8::from(right));
        questions += f64::from(asked);
    }
    let n = f64::from(DIALOGUES);
    let (value, deviation) = (value / n, (squares / n - (value / n).powi(2)).sqrt());
    let error = 4.0 * deviation / n.sqrt();
    assert!((value - exact.value).abs() < error, "{value} ± {error}, {exact:?}");
    assert!((success / n - exact.success).abs() < 0.05, "{} {exact:?}", success / n);
    assert!((questions / n - exact.questions).abs() < 0.2, "{} {exact:?}", questions / n);
}

fn dialogue(
    planner: &mut dyn Planner,
    problem: &DecisionProblem<'_>,
    seed: u64,
) -> (f64, bool, u32) {
    let mut user = ModelUser::wanting_any(problem.model, seed);
    let mut belief = Belief::uniform(problem.model.objects());
    let (mut value, mut discount) = (0.0, 1.0);
    for step in 0.. {
        let action = planner.decide(problem, &belief, Step { interaction: 0, step }).action;
        match action {
            Action::Wait => panic!("there is something to ask"),
            Action::Pick(i) => {
                let right = i == user.wanted();
                let reward = if right { problem.costs.correct } else { -problem.costs.wrong };
                return (value + discount * reward, right, step);
            }
            Action::Ask(question) => {
                value -= discount * problem.cost(action);
                discount *= problem.costs.discount;
                let answer = user.answer(problem.model, question);
                belief.update(problem.model, question, &answer.reading(problem.model));
            }
        }
    }
    unreachable!("dialogues end")
}
