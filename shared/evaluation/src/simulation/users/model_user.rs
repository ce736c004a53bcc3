//! The user whom the observation model assumes.

use dialogue::{Answer, Model};
use scene::{AttributeId, ObjectId, Question, ValueId};
use vocabulary::{Announce, Rng};

/// A person who answers with the probabilities of eq. (6) and (7): silent with `1 − p_l`, wrong
/// with `ε`. Who may take a value for another one draws it once, and sticks to it. The same seed
/// answers the same.
#[derive(Clone, Debug)]
pub struct ModelUser {
    wanted: ObjectId,
    rng: Rng,
    errors: Option<Errors>,
    /// The user's perception of the attributes asked about so far.
    perceived: Vec<(AttributeId, Option<ValueId>)>,
}

/// How often a user errs, whatever the model expects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Probability that a value is taken for another one, throughout.
    pub misperception: f64,
    /// Probability that an answer is wrong, each by itself.
    pub slip: f64,
}

impl ModelUser {
    /// A person who wants that object.
    pub fn new(wanted: ObjectId, seed: u64) -> Self {
        Self { wanted, rng: Rng::new(seed), errors: None, perceived: Vec::new() }
    }

    /// A person who wants that object and errs at rates of their own.
    pub fn erring(wanted: ObjectId, seed: u64, errors: Errors) -> Self {
        Self { errors: Some(errors), ..Self::new(wanted, seed) }
    }

    /// A person who wants one of the objects, each as likely.
    pub fn wanting_any(model: &Model, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        let wanted = rng.below(model.objects()).into();
        Self { wanted, rng, errors: None, perceived: Vec::new() }
    }

    /// The object that the person wants.
    pub fn wanted(&self) -> ObjectId {
        self.wanted
    }

    /// Draws an answer.
    pub fn answer(&mut self, model: &Model, question: Question) -> Answer {
        if let Some(k) = question.attribute()
            && (self.errors.is_some() || model.misperceives())
        {
            let perceived = self.perceive(model, k);
            return self.say(model, question, perceived);
        }
        let answers = Answer::possible(model, question);
        let probability = |answer: &Answer| answer.probability(model, question, self.wanted);
        let drawn = self.rng.index(answers.iter().map(probability));
        drawn.map_or(Answer::Silence, |index| answers[index])
    }

    /// Returns the value that the user believes the object to have, if it has the attribute.
    fn perceive(&mut self, model: &Model, k: AttributeId) -> Option<ValueId> {
        if let Some((_, known)) = self.perceived.iter().find(|(of, _)| *of == k) {
            return *known;
        }
        let own = model.value(self.wanted, k);
        let values = model.values(k);
        let perceived = own.filter(|_| values > 1).map_or(own, |own| {
            let entry = model.column(k)[self.wanted.index()];
            let chance = |v: usize| match (self.errors, model.chances(k, entry)) {
                (Some(_), _) if v == own.index() => 1.0 - self.misperception(),
                (Some(_), _) => self.misperception() / (values - 1) as f64,
                (None, chances) => {
                    chances.map_or(f64::from(u8::from(v == own.index())), |it| it[v])
                }
            };
            let chances: Vec<f64> = (0..values).map(chance).collect();
            self.rng.index(chances).map(ValueId::from)
        });
        self.perceived.push((k, perceived));
        perceived
    }

    fn misperception(&self) -> f64 {
        self.errors.map_or(0.0, |errors| errors.misperception)
    }

    /// Draws an answer about an attribute that is taken for that value.
    fn say(&mut self, model: &Model, question: Question, value: Option<ValueId>) -> Answer {
        let reliability = model.params().of(question);
        if self.rng.uniform() >= reliability.p_l {
            return Answer::Silence;
        }
        let means = match question {
            Question::Which(k) => value.map(|v| Answer::Value(k, v)),
            Question::Choice(k, options) => {
                let option = value.filter(|v| options.contains(*v));
                Some(option.map_or(Answer::No, |v| Answer::Value(k, v)))
            }
            Question::Attribute(_, v) if value == Some(v) => Some(Answer::Yes),
            _ => Some(Answer::No),
        };
        let slip = self.errors.map_or(reliability.epsilon, |errors| errors.slip);
        if let Some(means) = means
            && self.rng.uniform() >= slip
        {
            return means;
        }
        let mut others = Answer::possible(model, question);
        others.retain(|it| *it != Answer::Silence && Some(*it) != means);
        let any = others.get(self.rng.below(others.len().max(1))).copied();
        any.or(means).unwrap_or(Answer::Silence)
    }

    /// Draws whether the announced pick of an object is denied in time.
    pub fn denies(&mut self, model: &Model, announce: Announce, object: ObjectId) -> bool {
        if announce.is_final() {
            return false;
        }
        let (own, other) = announce.denials(model.params().epsilon);
        self.rng.uniform() < if object == self.wanted { own } else { other }
    }
}

#[cfg(test)]
mod tests {
    use vocabulary::{Actions, Mode, Params};

    use super::*;
    use crate::simulation::testing::bowls;

    #[test]
    fn people_answer_with_the_models_probabilities() {
        let scene = bowls();
        let model =
            Model::new(&scene, Params { p_l: 0.8, epsilon: 0.2, alpha: 0.2, ..Params::default() });
        let wanted = scene.object_named("metal2").unwrap();
        let mut user = ModelUser::new(wanted, 61);
        let actions = Actions { mode: Mode::Present, ..Actions::default() };
        for question in model.questions(actions) {
            const DRAWS: u32 = 2_000;
            let drawn: Vec<Answer> = (0..DRAWS).map(|_| user.answer(&model, question)).collect();
            for answer in Answer::possible(&model, question) {
                let p = answer.probability(&model, question, wanted);
                let count = drawn.iter().filter(|d| **d == answer).count();
                let share = count as f64 / f64::from(DRAWS);
                let sigma = (p * (1.0 - p) / f64::from(DRAWS)).sqrt();
                assert!((share - p).abs() < 5.0 * sigma + 1e-9, "{question:?} {answer:?}: {share}");
            }
        }
    }
}
