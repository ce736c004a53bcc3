//! The user whom the observation model assumes.

use scene::{ObjectId, Question};
use vocabulary::{Announce, Rng};

use crate::{Answer, Model};

/// A person who answers with the probabilities of eq. (6) and (7): silent with `1 − p_l`, wrong
/// with `ε`. The same seed answers the same.
#[derive(Clone, Debug)]
pub struct ModelUser {
    wanted: ObjectId,
    rng: Rng,
}

impl ModelUser {
    /// A person who wants that object.
    pub fn new(wanted: ObjectId, seed: u64) -> Self {
        Self { wanted, rng: Rng::new(seed) }
    }

    /// A person who wants one of the objects, each as likely.
    pub fn wanting_any(model: &Model, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        Self { wanted: rng.below(model.objects()).into(), rng }
    }

    /// What the person wants.
    pub fn wanted(&self) -> ObjectId {
        self.wanted
    }

    /// Draws an answer.
    pub fn answer(&mut self, model: &Model, question: Question) -> Answer {
        let answers = Answer::possible(model, question);
        let probability = |answer: &Answer| answer.probability(model, question, self.wanted);
        let drawn = self.rng.index(answers.iter().map(probability));
        drawn.map_or(Answer::Silence, |index| answers[index])
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
    use crate::testing::bowls;

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
