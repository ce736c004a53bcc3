//! `information-seeking`: asks under uncertainty about the person who answers.

use vocabulary::Action;

use crate::planning::{Choice, Effort};
use crate::user_model::{Joint, Person};
use crate::{Answer, Belief, Decision, DecisionProblem, Model, Planner, Step};

use scene::{ObjectId, Question};

use super::searched::{affordable, searched};
use super::{Entry, Outlook, PICKS_MAX, alternatives};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "information-seeking",
    about: "Learns how reliable the user's answers are, and asks accordingly.",
    make: || Box::new(InformationSeeking),
};

/// Weighs every promising question by the information of its answers about the object and the
/// person together (after Abbasnejad et al.).
///
/// After each answer the rest of the dialogue is valued with the expected person model, so an
/// answer that contradicts the belief is worth one more question to a user who errs, and a question
/// that distinguishes careful from careless people has a value of its own. For an unknown person,
/// `ε` and `p_l` are as configured, but uncertain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct InformationSeeking;

/// Most questions that are weighed, the most promising by a one-step lookahead.
const WEIGHED_MAX: usize = 10;
/// Limits on beliefs, and on work, for valuing the dialogue after an answer.
const FOLLOWED_MAX: usize = 60;
const WORK_MAX: usize = 20_000;

impl Planner for InformationSeeking {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        let person = Person::new(problem.model.params());
        self.decide_with(problem, &Joint::new(belief.clone(), person), step)
    }

    fn decide_with(&mut self, problem: &DecisionProblem<'_>, joint: &Joint, _: Step) -> Decision {
        let belief = joint.belief();
        let model = expected(problem.model, joint.person());
        let expected = DecisionProblem { model: &model, ..*problem };
        let plain = follow(&expected, &belief);
        let mut weighed: Vec<(Action, f64)> = promising(&expected, &belief)
            .into_iter()
            .map(|question| (Action::Ask(question), ask(problem, &model, joint, question)))
            .collect();
        weighed.extend(announced(problem, &model, joint));
        weighed.sort_by(|a, b| b.1.total_cmp(&a.1));
        let (stop, stopped) = stopping(&expected, &belief);
        let best = weighed.first().copied().filter(|(_, value)| *value > stopped);
        let (action, value) = best.unwrap_or((stop, stopped));
        let alternatives = alternatives(problem, &belief, weighed, action);
        // Expectation for the plan that takes the person as known; it may pick when this one asks.
        let asks = matches!(action, Action::Ask(_));
        let expected_questions = if asks { plain.expected_questions.max(1.0) } else { 0.0 };
        Decision { action, value, alternatives, expected_questions, bounds: None }
    }

    fn uses_user_model(&self) -> bool {
        true
    }
}

/// Returns the model of people with this person's expected parameters.
fn expected(model: &Model, person: &Person) -> Model {
    model.with_params(person.params(model.params()))
}

/// Continues the dialogue with a person as expected.
fn follow(problem: &DecisionProblem<'_>, belief: &Belief) -> Decision {
    let stake = problem.costs.correct + problem.costs.wrong;
    searched(problem, belief, |reduced| Effort {
        beliefs_max: affordable(reduced, WORK_MAX).clamp(1, FOLLOWED_MAX),
        tolerance: 1e-4 * stake,
        certify: None,
    })
}

/// The better of a pick that is final and waiting, and its value.
fn stopping(problem: &DecisionProblem<'_>, belief: &Belief) -> (Action, f64) {
    if !problem.announce.is_final() {
        let wait = (Action::Wait, problem.costs.wait_value());
        let Some(absent) = problem.model.absent() else { return wait };
        let concluded = problem.costs.pick_value(belief.probability(absent));
        return if concluded > wait.1 { (Action::Pick(absent), concluded) } else { wait };
    }
    let chances = problem.concessions.chances(problem.model, belief);
    let best = chances.iter().copied().fold(0.0, f64::max);
    // Of the objects that are equally right the most probable one.
    let right = |i: &usize| chances[*i] >= best;
    let likelier = |a: usize, b: usize| {
        if belief.probability(b.into()) > belief.probability(a.into()) { b } else { a }
    };
    let likeliest = (0..chances.len()).filter(right).reduce(likelier).unwrap_or(0).into();
    let pick = problem.costs.pick_value(best);
    let wait = problem.costs.wait_value();
    if pick > wait { (Action::Pick(likeliest), pick) } else { (Action::Wait, wait) }
}

/// The most probable objects as announced picks, each with its value; empty if picks are final.
fn announced(problem: &DecisionProblem<'_>, model: &Model, joint: &Joint) -> Vec<(Action, f64)> {
    if problem.announce.is_final() {
        return Vec::new();
    }
    let chances = problem.concessions.chances(model, &joint.belief());
    let mut likeliest: Vec<usize> = (0..model.objects()).collect();
    likeliest.sort_by(|a, b| chances[*b].total_cmp(&chances[*a]));
    likeliest.truncate(PICKS_MAX);
    let value = |i: &usize| {
        let question = Question::Point(ObjectId::from(*i));
        let (settled, denied) =
            problem.announce.settle(&problem.costs, model.params().epsilon, chances[*i]);
        let mut once = joint.clone();
        once.update_mixture(model, &[(1.0, question, Answer::No.reading(model))]);
        let after = after(problem, model, &once, question, Answer::No);
        (Action::Pick(ObjectId::from(*i)), settled + problem.costs.discount * denied * after)
    };
    likeliest.iter().map(value).collect()
}

/// The questions that look best from one step ahead.
fn promising(problem: &DecisionProblem<'_>, belief: &Belief) -> Vec<Question> {
    let Outlook { reduced, one_step } = Outlook::new(problem, belief);
    let mut choices = one_step.choices;
    let by_estimate = |a: &Choice, b: &Choice| b.value.estimate.total_cmp(&a.value.estimate);
    choices.sort_by(by_estimate);
    choices.truncate(WEIGHED_MAX);
    choices.iter().map(|choice| reduced.question(choice.query)).collect()
}

/// Value of asking until something is heard, and continuing with the resulting belief.
fn ask(problem: &DecisionProblem<'_>, model: &Model, joint: &Joint, question: Question) -> f64 {
    let (mut heard, mut sum) = (0.0, 0.0);
    for answer in Answer::possible(model, question) {
        if answer == Answer::Silence {
            continue;
        }
        let probability = joint.probability(model, question, answer);
        heard += probability;
        sum += probability * after(problem, model, joint, question, answer);
    }
    let costs = &problem.costs;
    let again = 1.0 - costs.discount * (1.0 - heard);
    (costs.discount * sum - problem.cost(Action::Ask(question))) / again
}

/// Value of continuing after an answer with the resulting belief.
fn after(
    problem: &DecisionProblem<'_>,
    model: &Model,
    joint: &Joint,
    question: Question,
    answer: Answer,
) -> f64 {
    let mut next = joint.clone();
    next.update_mixture(model, &[(1.0, question, answer.reading(model))]);
    let model = expected(model, next.person());
    follow(&DecisionProblem { model: &model, ..*problem }, &next.belief()).value
}
