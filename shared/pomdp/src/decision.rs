//! The dialogue's decision problem as a POMDP in the format's terms.
//!
//! The state is the object that is wanted (or that it is `absent`, where the model holds that
//! possible), and one more: a pick ends the interaction, so it leads to `end`, where nothing is
//! paid or heard any more. Waiting and asking leave the state as it is (eq. (2), (3)); what is
//! heard depends on it by [`Answer::probability`].

use dialogue::{Action, Answer, DecisionProblem};
use scene::{AttributeId, ObjectId, Question, Scene, ValueId};

use crate::{Matrix, PAIRS_MAX, Pomdp, Reward, Rewards, Row, Values, escape};

/// The problem has more pairs of action and state than a text can sensibly hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{states} states and {actions} actions are too large a problem for this format, which lists \
     probabilities for each pair ({PAIRS_MAX} at most); leave objects or kinds of question out"
)]
pub struct TooLarge {
    /// What may be wanted, and the end.
    pub states: usize,
    /// Waiting, questions and picks.
    pub actions: usize,
}

/// The decision problem that the planners solve, every question of the action space in it, useful
/// or not.
///
/// # Errors
/// If it is too large.
///
/// # Panics
/// If `scene` is not the one that the problem's model was made of.
pub fn of_dialogue(scene: &Scene, problem: &DecisionProblem<'_>) -> Result<Pomdp, TooLarge> {
    let model = problem.model;
    assert_eq!(scene.objects().len(), model.objects(), "scene and model belong together");
    let questions = problem.actions.questions(model);
    let objects = || (0..model.objects()).map(ObjectId::from);
    let asks = questions.iter().map(|question| Action::Ask(*question));
    let actions: Vec<Action> =
        std::iter::once(Action::Wait).chain(asks).chain(objects().map(Action::Pick)).collect();
    let states = model.hypotheses() + 1;
    if states.saturating_mul(actions.len()) > PAIRS_MAX {
        return Err(TooLarge { states, actions: actions.len() });
    }
    let answers = answers(problem, &questions);
    let wanted = scene.objects().iter().map(|object| escape("wanted", &[&object.name]));
    let absent = model.absent().map(|_| escape("absent", &[]));
    let uniform = 1.0 / model.hypotheses() as f64;
    let tables = Tables { problem, states, answers: &answers };
    Ok(Pomdp {
        discount: problem.costs.discount,
        values: Values::Reward,
        states: wanted.chain(absent).chain([escape("end", &[])]).collect(),
        actions: actions.iter().map(|action| action_name(scene, *action)).collect(),
        observations: answers.iter().map(|answer| answer_name(scene, *answer)).collect(),
        start: (0..model.hypotheses()).map(|_| uniform).chain([0.0]).collect(),
        transition: actions.iter().map(|action| tables.transition(*action)).collect(),
        observation: actions.iter().map(|action| tables.observation(*action)).collect(),
        reward: tables.rewards(&actions),
    })
}

/// Every answer that some question can get, silence first.
fn answers(problem: &DecisionProblem<'_>, questions: &[Question]) -> Vec<Answer> {
    let mut answers = vec![Answer::Silence];
    let yes_no = questions.iter().any(|question| !matches!(question, Question::Which(_)));
    if yes_no {
        answers.extend([Answer::Yes, Answer::No]);
    }
    for question in questions.iter().filter(|question| matches!(question, Question::Which(_))) {
        let values = Answer::possible(problem.model, *question).into_iter();
        answers.extend(values.filter(|answer| *answer != Answer::Silence));
    }
    answers
}

struct Tables<'a> {
    problem: &'a DecisionProblem<'a>,
    states: usize,
    answers: &'a [Answer],
}

impl Tables<'_> {
    fn end(&self) -> u32 {
        self.states as u32 - 1
    }

    fn transition(&self, action: Action) -> Matrix {
        match action {
            Action::Pick(_) => Matrix::alike(self.states, self.states, vec![(self.end(), 1.0)]),
            Action::Wait | Action::Ask(_) => Matrix::identity(self.states),
        }
    }

    fn observation(&self, action: Action) -> Matrix {
        let silence: Row = vec![(0, 1.0)];
        let Action::Ask(question) = action else {
            return Matrix::alike(self.states, self.answers.len(), silence);
        };
        let model = self.problem.model;
        let mut heard: Vec<(u32, Answer)> = Answer::possible(model, question)
            .into_iter()
            .filter_map(|answer| {
                let column = self.answers.iter().position(|known| *known == answer)?;
                Some((column as u32, answer))
            })
            .collect();
        heard.sort_by_key(|(column, _)| *column);
        let row = |wanted: usize| -> Row {
            let entries = heard.iter().map(|(column, answer)| {
                (*column, answer.probability(model, question, ObjectId::from(wanted)))
            });
            entries.filter(|(_, p)| *p != 0.0).collect()
        };
        Matrix::of_rows(self.answers.len(), (0..model.hypotheses()).map(row).chain([silence]))
    }

    fn rewards(&self, actions: &[Action]) -> Rewards {
        let costs = self.problem.costs;
        let any = Reward { action: None, start: None, end: None, observation: None, value: 0.0 };
        let mut lines = Vec::new();
        for (number, action) in actions.iter().enumerate() {
            let line = Reward { action: Some(number as u32), ..any };
            match action {
                Action::Pick(object) => {
                    lines.push(Reward { value: -costs.wrong, ..line });
                    let wanted = Some(u32::from(object.0));
                    lines.push(Reward { start: wanted, value: costs.correct, ..line });
                }
                asking => lines.push(Reward { value: -self.problem.cost(*asking), ..line }),
            }
        }
        lines.push(Reward { start: Some(self.end()), ..any });
        Rewards { lines }
    }
}

fn action_name(scene: &Scene, action: Action) -> String {
    let object = |i: ObjectId| scene.object(i).name.as_str();
    match action {
        Action::Wait | Action::Ask(Question::None) => escape("wait", &[]),
        Action::Pick(i) => escape("pick", &[object(i)]),
        Action::Ask(Question::Point(i)) => escape("point", &[object(i)]),
        Action::Ask(Question::Which(k)) => escape("which", &[attribute_name(scene, k)]),
        Action::Ask(Question::Attribute(k, v)) => {
            escape("is", &[attribute_name(scene, k), value_name(scene, k, v)])
        }
    }
}

fn answer_name(scene: &Scene, answer: Answer) -> String {
    match answer {
        Answer::Silence => escape("silence", &[]),
        Answer::Yes => escape("yes", &[]),
        Answer::No => escape("no", &[]),
        Answer::Value(k, v) => escape("says", &[attribute_name(scene, k), value_name(scene, k, v)]),
    }
}

fn attribute_name(scene: &Scene, k: AttributeId) -> &str {
    &scene.attributes()[k.index()].name
}

fn value_name(scene: &Scene, k: AttributeId, v: ValueId) -> &str {
    &scene.attributes()[k.index()].values[v.index()].name
}
