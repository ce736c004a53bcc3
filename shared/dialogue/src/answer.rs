//! Possible answers to a question: the observation space in which planners look ahead.
//!
//! The paper's observation model read literally lets a base word come with probability `p_l` after
//! every action, which makes waiting as informative as asking. Planners therefore expect a
//! question to be answered with yes, no, or (an open one) a value, or not at all, and expect
//! nothing while they wait. The belief is still updated with whatever was really said.

use scene::{AttributeId, ObjectId, Question, Reading, Response, Scene, ValueId};

use crate::{Model, Naming};

/// An answer to a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Answer {
    /// Nothing was heard.
    Silence,
    /// Yes, to a yes/no question.
    Yes,
    /// No, to a yes/no question; no option, to a choice.
    No,
    /// The value of the attribute, to an open question or a choice.
    Value(AttributeId, ValueId),
}

impl Answer {
    /// Every answer that a question can get.
    pub fn possible(model: &Model, question: Question) -> Vec<Self> {
        match question {
            Question::None => vec![Self::Silence],
            Question::Point(_) | Question::Attribute(..) => {
                vec![Self::Yes, Self::No, Self::Silence]
            }
            Question::Which(k) => {
                let values = (0..model.values(k)).map(|v| Self::Value(k, ValueId::from(v)));
                values.chain([Self::Silence]).collect()
            }
            Question::Choice(k, options) => {
                let values = options.values().iter().map(|v| Self::Value(k, *v));
                let is_neither = Naming::of(model, question).is_some_and(|law| law.neither);
                values.chain(is_neither.then_some(Self::No)).chain([Self::Silence]).collect()
            }
        }
    }

    /// Returns the answer of a user who wants `wanted` and neither errs nor stays silent, except
    /// that there is nothing to say about an attribute that the object lacks. A user who wants an
    /// absent object says no to everything.
    pub fn truthful(model: &Model, question: Question, wanted: ObjectId) -> Self {
        match question {
            Question::None => Self::Silence,
            Question::Point(i) if i == wanted => Self::Yes,
            Question::Attribute(k, v) if model.has(wanted, k, v) => Self::Yes,
            Question::Point(_) | Question::Attribute(..) => Self::No,
            Question::Which(k) => {
                model.value(wanted, k).map_or(Self::Silence, |v| Self::Value(k, v))
            }
            Question::Choice(k, options) => {
                let named = model.value(wanted, k).filter(|v| options.contains(*v));
                named.map_or(Self::No, |v| Self::Value(k, v))
            }
        }
    }

    /// `P(answer | D = wanted, question)`; 0 for an answer that the question cannot get.
    pub fn probability(self, model: &Model, question: Question, wanted: ObjectId) -> f64 {
        let params = model.params().of(question);
        match (self, question) {
            (Self::Silence, Question::None) => 1.0,
            (Self::Silence, _) => 1.0 - params.p_l,
            (Self::Yes | Self::No, Question::Attribute(k, _)) if model.absent() == Some(wanted) => {
                let yes = model.unknown_yes(k);
                params.p_l * if self == Self::Yes { yes } else { 1.0 - yes }
            }
            (Self::Yes | Self::No, Question::Attribute(k, v)) if model.is_doubtful(k) => {
                let (chance, epsilon) = (model.chance(wanted, k, v), params.epsilon);
                let yes = chance * (1.0 - epsilon) + (1.0 - chance) * epsilon;
                params.p_l * if self == Self::Yes { yes } else { 1.0 - yes }
            }
            (Self::Yes | Self::No, Question::Point(_) | Question::Attribute(..)) => {
                let right = self == Self::truthful(model, question, wanted);
                params.p_l * if right { 1.0 - params.epsilon } else { params.epsilon }
            }
            (Self::Value(k, v), Question::Which(asked) | Question::Choice(asked, _))
                if k == asked =>
            {
                params.p_l * named(model, question, Some(v), wanted)
            }
            (Self::No, Question::Choice(..)) => params.p_l * named(model, question, None, wanted),
            _ => 0.0,
        }
    }

    /// The answer as the belief hears it.
    pub fn reading(self, model: &Model) -> Reading {
        match self {
            Self::Silence => Reading::default(),
            Self::Yes => Reading { response: Response::Yes, ..Reading::default() },
            Self::No => Reading { response: Response::No, ..Reading::default() },
            Self::Value(k, v) => Reading { base: vec![model.word(k, v)], ..Reading::default() },
        }
    }

    /// The answer as a person says it; nothing for silence.
    pub fn text(self, scene: &Scene) -> &str {
        match self {
            Self::Silence => "",
            Self::Yes => "yes",
            Self::No => "no",
            Self::Value(k, v) => &scene.attributes()[k.index()].values[v.index()].name,
        }
    }
}

/// Probability of naming the value, or no option, given an answer.
fn named(model: &Model, question: Question, named: Option<ValueId>, wanted: ObjectId) -> f64 {
    let Some((k, law)) = question.attribute().zip(Naming::of(model, question)) else { return 0.0 };
    let is_possible = match (question, named) {
        (Question::Choice(_, options), Some(v)) => options.contains(v),
        (_, Some(_)) => true,
        (_, None) => law.neither,
    };
    let entry = model.column(k)[wanted.index()];
    if is_possible { law.answer(model, named, entry) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use vocabulary::{Actions, Mode, Params, Reliability, Rng};

    use super::*;
    use crate::Belief;
    use crate::testing::{bowls, everyone, perceived, random_scene};

    fn models() -> Vec<Model> {
        let mut rng = Rng::new(51);
        let scenes = [bowls(), random_scene(&mut rng, 12, &[4, 1, 2], 3)];
        let choice = Some(Reliability { p_l: 0.8, epsilon: 0.1 });
        let model = |scene| Model::new(scene, Params { choice, ..Params::default() });
        let perceived = perceived(&mut rng, &scenes[1]);
        let scenes = scenes.iter().chain([&perceived]);
        scenes.flat_map(|scene| [model(scene), model(scene).with_absent()]).collect()
    }

    #[test]
    fn answers_are_a_distribution() {
        for model in models() {
            let actions = Actions { mode: Mode::Present, choice: true, ..Actions::default() };
            for question in model.questions(actions) {
                for wanted in everyone(model.hypotheses()) {
                    let answers = Answer::possible(&model, question);
                    let sum: f64 =
                        answers.iter().map(|a| a.probability(&model, question, wanted)).sum();
                    assert!((sum - 1.0).abs() < 1e-14, "{question:?} {wanted:?}: {sum}");
                }
            }
        }
    }

    /// Planners expect exactly the answers with which the belief is updated.
    #[test]
    fn answers_move_the_belief_by_their_probability() {
        for model in models() {
            let actions = Actions { mode: Mode::Present, choice: true, ..Actions::default() };
            for question in model.questions(actions) {
                for answer in Answer::possible(&model, question) {
                    let weights: Vec<f64> = everyone(model.hypotheses())
                        .map(|i| answer.probability(&model, question, i))
                        .collect();
                    let expected = Belief::from_probabilities(&weights).unwrap();
                    let mut belief = Belief::uniform(model.hypotheses());
                    belief.update(&model, question, &answer.reading(&model));
                    for i in everyone(model.hypotheses()) {
                        let (a, b) = (belief.probability(i), expected.probability(i));
                        assert!((a - b).abs() < 1e-14, "{question:?} {answer:?}: {a} {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_truthful_answer_is_the_most_probable_one() {
        let scene = bowls();
        let model = Model::new(&scene, Params::default());
        let actions = Actions { mode: Mode::Present, choice: true, ..Actions::default() };
        for question in model.questions(actions) {
            for wanted in everyone(6) {
                let truth = Answer::truthful(&model, question, wanted);
                let p = truth.probability(&model, question, wanted);
                for other in Answer::possible(&model, question) {
                    assert!(other == truth || other.probability(&model, question, wanted) < p);
                }
            }
        }
    }

    #[test]
    fn answers_are_said_in_the_scenes_words() {
        let scene = bowls();
        let model = Model::new(&scene, Params::default());
        let color = scene.attribute_named("color").unwrap();
        let clear = scene.object_named("clear").unwrap();
        let answer = Answer::truthful(&model, Question::Which(color), clear);
        assert_eq!(answer.text(&scene), "clear");
        assert_eq!((Answer::Yes.text(&scene), Answer::Silence.text(&scene)), ("yes", ""));
    }
}
