//! What an utterance says about values in doubt, of each object in case it is the wanted one.
//!
//! Words and answers about one attribute are independent only given its value: who has said no to "is it
//! white?" of an object that may be white says no again. So what the values may be is updated with what
//! was said, and the next utterance is scored with that.

use scene::{AttributeId, Question, Reading, Response, ValueId, WordId};

use crate::observation::named_answer;
use crate::{CERTAIN_DOUBT, Model, Naming};

impl Model {
    /// Whether any value of an object is in doubt.
    pub(crate) fn has_doubts(&self) -> bool {
        (0..self.attributes()).any(|k| self.is_doubtful(k.into()))
    }

    /// Updates the probabilities of values in doubt by Bayes' rule with what may have been heard.
    pub(crate) fn learn(&mut self, heard: &[(f64, Question, Reading)]) {
        for k in (0..self.attributes()).map(AttributeId::from) {
            if !self.is_doubtful(k) {
                continue;
            }
            let of = |v: usize| -> f64 {
                let each = heard.iter().map(|(weight, question, reading)| {
                    weight * self.said_of(k, v.into(), *question, reading)
                });
                each.sum()
            };
            let likelihood: Vec<f64> = (0..self.values(k)).map(of).collect();
            if likelihood.iter().any(|p| *p > 0.0) {
                self.weigh_doubts(k, &likelihood);
            }
        }
    }

    /// Likelihood of a reading where attribute `k` has value `v`, but for what does not depend on it.
    fn said_of(&self, k: AttributeId, v: ValueId, question: Question, reading: &Reading) -> f64 {
        let own = self.word(k, v);
        let about = |word: &WordId| self.meanings(*word).iter().any(|(of, _)| *of == k);
        let named: Vec<usize> =
            (0..reading.base.len()).filter(|at| about(&reading.base[*at])).collect();
        let is_asked = question.attribute() == Some(k);
        let law = Naming::of(self, question).filter(|_| is_asked);
        let answers = law
            .filter(|_| named.len() == 1 && named_answer(self, question, &reading.base).is_some());
        let mut likelihood = 1.0;
        for at in named {
            let (is_it, doubt) = (reading.base[at] == own, reading.doubt.of_word(at));
            let (is, not) = if let Some(law) = answers {
                (law.own, law.other)
            } else {
                let alpha = self.smoothing(doubt <= CERTAIN_DOUBT);
                (1.0, alpha / (1.0 + alpha))
            };
            let plain = if is_it { is } else { not };
            // A word that was not said tells nothing.
            likelihood *= (1.0 - doubt) * plain + doubt * 0.5;
        }
        let epsilon = |doubt: f64| {
            let epsilon = self.params().epsilon;
            epsilon + doubt * (0.5 - epsilon)
        };
        if let (Question::Attribute(asked, value), Response::Yes | Response::No) =
            (question, reading.response)
            && asked == k
        {
            let wrong = epsilon(reading.doubt.response);
            let is_right = (reading.response == Response::Yes) == (value == v);
            likelihood *= if is_right { 1.0 - wrong } else { wrong };
        }
        if let (Question::Choice(_, options), Some(law), None, Response::No) =
            (question, law, answers, reading.response)
        {
            let right = if options.contains(v) { law.other } else { law.own };
            let doubt = reading.doubt.response;
            likelihood *= (1.0 - doubt) * right + doubt / law.answers as f64;
        }
        for (at, group) in reading.excluded.iter().enumerate() {
            if let [word] = group.as_slice()
                && about(word)
            {
                let wrong = epsilon(reading.doubt.of_group(at));
                likelihood *= if *word == own { wrong } else { 1.0 - wrong };
            }
        }
        likelihood
    }
}

#[cfg(test)]
mod tests {
    use scene::{ObjectId, Perceived};
    use vocabulary::Params;

    use super::*;
    use crate::Belief;
    use crate::testing::{heard, markers};

    /// Two objects of which one may be red: asking the same again tells no more than a person's error.
    #[test]
    fn the_same_answer_again_tells_little_more() {
        let file = markers();
        let object = |number: u16, red: f64| Perceived {
            number: ObjectId(number),
            name: format!("it-{number}"),
            classes: vec![("R".to_owned(), 1.0)],
            attributes: vec![(
                "color".to_owned(),
                vec![("red".to_owned(), red), ("blue".to_owned(), 1.0 - red)],
            )],
            xyz: [0.0; 3],
            yaw: 0.0,
            seen_by: Vec::new(),
            taken: false,
        };
        let scene = file.with_objects(&[object(2, 0.8), object(3, 0.2)]);
        let mut model = Model::new(&file, Params::default()).with_objects(&scene);
        let red = Question::Attribute(AttributeId(0), ValueId(0));
        let no = [(1.0, red, heard(&scene, &[], Response::No))];
        let mut belief = Belief::uniform(2);
        let mut said = Vec::new();
        for _ in 0..3 {
            belief.update_mixture(&model, &no);
            model.learn(&no);
            said.push(belief.probability(ObjectId(1)));
        }
        // The joint distribution over object and colour, by hand.
        let epsilon = Params::default().epsilon;
        let exact = |times: i32| {
            let no =
                |red: f64| red * epsilon.powi(times) + (1.0 - red) * (1.0 - epsilon).powi(times);
            no(0.2) / (no(0.2) + no(0.8))
        };
        for (times, p) in (1..).zip(said) {
            assert!((p - exact(times)).abs() < 1e-12, "{times}: {p} not {}", exact(times));
        }
    }
}
