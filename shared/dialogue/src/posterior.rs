//! Beliefs of an interaction: about the wanted object alone, as in the paper, or also about the
//! person who answers.

use std::borrow::Cow;

use scene::{Question, Reading};
use serde::{Deserialize, Serialize};

use crate::speaker::Speaker;
use crate::user_model::{Joint, Person};
use crate::{
    Belief, BeliefError, Decision, DecisionProblem, Model, Planner, Step, ValueLikelihoods,
};

/// A belief over the hypotheses, perhaps together with the person's error rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Posterior {
    /// People answer as the model's parameters say.
    Object(Belief),
    /// How this person answers is learned meanwhile.
    ObjectAndPerson(Joint),
    /// The user may take a value for another one ([`Model::with_misperceptions`]): belief about the
    /// object, and evidence about each attribute.
    Perceived(Box<Self>, ValueLikelihoods),
    /// The speaker is known: the observation model is that person's.
    Of(Speaker, Box<Self>),
}

impl Posterior {
    /// Belief before any utterance. The person counts only if the planner uses it.
    pub fn new(prior: Belief, person: Option<Person>) -> Self {
        match person {
            Some(person) => Self::ObjectAndPerson(Joint::new(prior, person)),
            None => Self::Object(prior),
        }
    }

    /// Returns the posterior of a user who may take a value for another one.
    #[must_use]
    pub fn of_perceived(self) -> Self {
        Self::Perceived(Box::new(self), ValueLikelihoods::default())
    }

    /// Returns the posterior of a known person, as under the person's own model.
    #[must_use]
    pub fn of_speaker(self, speaker: Speaker) -> Self {
        Self::Of(speaker, Box::new(self))
    }

    /// Returns the posterior of an unnamed person.
    #[must_use]
    pub(crate) fn of_anybody(self) -> Self {
        match self {
            Self::Of(_, of) => *of,
            of => of,
        }
    }

    /// The person who speaks, if known.
    pub fn speaker(&self) -> Option<&Speaker> {
        match self {
            Self::Of(speaker, _) => Some(speaker),
            _ => None,
        }
    }

    /// Evidence about each attribute, for a user who may take a value for another one.
    pub fn said(&self) -> Option<&ValueLikelihoods> {
        match self {
            Self::Object(_) | Self::ObjectAndPerson(_) => None,
            Self::Perceived(_, said) => Some(said),
            Self::Of(_, of) => of.said(),
        }
    }

    /// The model given the evidence: values as the user perceives them.
    pub fn model<'a>(&self, model: &'a Model) -> Cow<'a, Model> {
        if let Self::Of(speaker, of) = self {
            return Cow::Owned(of.model(&speaker.model(model)).into_owned());
        }
        match self.said() {
            Some(said) if !said.is_empty() => Cow::Owned(said.in_model(model)),
            _ => Cow::Borrowed(model),
        }
    }

    /// The belief over the hypotheses.
    pub fn belief(&self) -> Belief {
        match self {
            Self::Object(belief) => belief.clone(),
            Self::ObjectAndPerson(joint) => joint.belief(),
            Self::Perceived(of, _) | Self::Of(_, of) => of.belief(),
        }
    }

    /// Returns the user model, if there is one.
    pub fn person(&self) -> Option<&Person> {
        match self {
            Self::Object(_) => None,
            Self::ObjectAndPerson(joint) => Some(joint.person()),
            Self::Perceived(of, _) | Self::Of(_, of) => of.person(),
        }
    }

    /// Updates by Bayes' rule with uncertain words; see [`Belief::update_mixture`].
    ///
    /// # Panics
    /// As [`Belief::update_mixture`].
    pub fn update_mixture(&mut self, model: &Model, heard: &[(f64, Question, Reading)]) {
        match self {
            Self::Object(belief) => belief.update_mixture(model, heard),
            Self::ObjectAndPerson(joint) => joint.update_mixture(model, heard),
            Self::Perceived(of, said) => {
                let known = said.in_model(model);
                of.update_mixture(&known, heard);
                said.hear(&known, heard);
            }
            Self::Of(speaker, of) => of.update_mixture(&speaker.model(model), heard),
        }
    }

    /// Bayes' rule with evidence that does not depend on how people answer; see [`Belief::weigh`].
    ///
    /// # Panics
    /// As [`Belief::weigh`].
    pub fn weigh(&mut self, log_likelihood: &[f64]) {
        match self {
            Self::Object(belief) => belief.weigh(log_likelihood),
            Self::ObjectAndPerson(joint) => joint.weigh(log_likelihood),
            Self::Perceived(of, _) | Self::Of(_, of) => of.weigh(log_likelihood),
        }
    }

    /// Takes in that a question was answered, or was not although there was time.
    pub fn see_answer(&mut self, answered: bool) {
        match self {
            Self::Object(_) => {}
            Self::ObjectAndPerson(joint) => joint.person_mut().see_answer(answered),
            Self::Perceived(of, _) | Self::Of(_, of) => of.see_answer(answered),
        }
    }

    /// Returns a planner's decision for this belief.
    ///
    /// # Panics
    /// As [`Planner::decide`].
    pub fn decide(
        &self,
        planner: &mut dyn Planner,
        problem: &DecisionProblem<'_>,
        step: Step,
    ) -> Decision {
        match self {
            Self::Object(belief) => planner.decide(problem, belief, step),
            Self::ObjectAndPerson(joint) => planner.decide_with(problem, joint, step),
            Self::Perceived(of, said) => {
                let model = said.in_model(problem.model).planned(|k| said.of(k).is_some());
                of.decide(planner, &DecisionProblem { model: &model, ..*problem }, step)
            }
            Self::Of(speaker, of) => {
                let model = speaker.model(problem.model);
                of.decide(planner, &DecisionProblem { model: &model, ..*problem }, step)
            }
        }
    }

    /// Appends numbers that are equal for beliefs that differ by rounding alone; see
    /// [`Belief::key`].
    pub fn key_into(&self, key: &mut Vec<i64>) {
        match self {
            Self::Object(belief) => belief.key_into(key),
            Self::ObjectAndPerson(joint) => joint.key_into(key),
            Self::Perceived(of, said) => {
                of.key_into(key);
                said.key_into(key);
            }
            Self::Of(speaker, of) => {
                of.key_into(key);
                speaker.key_into(key);
            }
        }
    }

    /// Returns the representative of all beliefs with this one's key.
    ///
    /// # Errors
    /// Never for a key of its own.
    pub fn rounded(&self) -> Result<Self, BeliefError> {
        Ok(match self {
            Self::Object(belief) => Self::Object(Belief::from_key(&belief.key())?),
            Self::ObjectAndPerson(joint) => Self::ObjectAndPerson(joint.rounded()?),
            Self::Perceived(of, said) => Self::Perceived(Box::new(of.rounded()?), said.rounded()),
            Self::Of(speaker, of) => Self::Of(speaker.clone(), Box::new(of.rounded()?)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry;
    use crate::testing::bowls;
    use scene::Response;
    use vocabulary::{Actions, Costs, Params, Rng};

    /// The same evidence in another order differs by rounding alone, and is decided about alike.
    #[test]
    fn what_differs_by_rounding_is_one() {
        let model = Model::new(&bowls(), Params::default());
        let (costs, actions) = (Costs::SECONDS, Actions::default());
        let problem = DecisionProblem::new(&model, costs, actions);
        let mut rng = Rng::new(31);
        for person in [None, Some(Person::new(model.params()))] {
            for _ in 0..10 {
                let mut evidence: Vec<_> = (0..5)
                    .map(|_| {
                        let question = Question::Point(rng.below(6).into());
                        let response = [Response::Yes, Response::No][rng.below(2)];
                        (1.0, question, Reading { response, ..Reading::default() })
                    })
                    .collect();
                let fold = |evidence: &[(f64, Question, Reading)]| {
                    let mut posterior = Posterior::new(Belief::uniform(6), person.clone());
                    posterior.see_answer(false);
                    for heard in evidence {
                        posterior.see_answer(true);
                        posterior.update_mixture(&model, std::slice::from_ref(heard));
                    }
                    let mut key = Vec::new();
                    posterior.key_into(&mut key);
                    (key, posterior)
                };
                let (key, posterior) = fold(&evidence);
                evidence.reverse();
                let (other_key, other) = fold(&evidence);
                assert_eq!(key, other_key);
                let rounded = posterior.rounded().unwrap();
                assert_eq!(rounded, other.rounded().unwrap());
                let mut planner = registry::planner("information-seeking").unwrap();
                let action = rounded.decide(&mut *planner, &problem, Step::default()).action;
                assert!(actions.allow(action));
            }
        }
    }
}
