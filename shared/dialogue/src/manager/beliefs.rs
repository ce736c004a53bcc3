//! Beliefs of an interaction: prior, updates, and the user model if the planner uses it.

use scene::{Question, Reading};

use super::Manager;
use super::evidence::{Evidence, Mark};
use super::state::{Interaction, State};
use crate::user_model::Person;
use crate::{Belief, Model, Posterior};
use std::borrow::Cow;
use vocabulary::{PersonId, PriorObjects};

/// Interpretations, the point that is pointed at, and objects that are refused or meant.
type Content<'a> = (&'a [(f64, Question, Reading)], Option<[f64; 3]>, Option<&'a Mark>);

/// Factor of an object that a person has already.
const TAKEN: f64 = 1e-12;

impl Manager {
    /// Returns the belief of an interaction in which nothing was said.
    pub fn prior(&self, state: &State) -> Belief {
        self.prior_of(state, &PersonId::default())
    }

    /// Returns the prior for a person: by past deliveries, once there are any.
    fn prior_of(&self, state: &State, from: &PersonId) -> Belief {
        let objects = self.setup.scene.objects();
        let any_taken = objects.iter().any(|object| object.taken);
        let history = match (self.regular(state, from), self.setup.prior.objects) {
            (Some(person), _) => Some(&person.fetched),
            (None, PriorObjects::History) => Some(&state.history),
            (None, PriorObjects::Uniform) => None,
        };
        let mut weights = match history {
            None if self.setup.model.absent().is_none() && !any_taken => {
                return Belief::uniform(objects.len());
            }
            None => vec![1.0 / objects.len() as f64; objects.len()],
            Some(history) => {
                let names = objects.iter().map(|object| object.name.as_str());
                history.prior(names, self.setup.prior.smoothing)
            }
        };
        for (weight, object) in weights.iter_mut().zip(objects) {
            *weight *= if object.taken { TAKEN } else { 1.0 };
        }
        if self.setup.model.absent().is_some() {
            let nothing = self.setup.nothing_stands();
            let absent = if nothing { 1.0 } else { self.setup.prior.absent };
            weights.iter_mut().for_each(|p| *p *= 1.0 - self.setup.prior.absent);
            weights.push(absent);
        }
        Belief::from_probabilities(&weights).expect("settings are checked: each weight is positive")
    }

    /// Returns the user as known before the open interaction, apart from the share of questions
    /// answered: that says nothing about the object, so it counts at once.
    fn person(&self, state: &State) -> Option<Person> {
        let known =
            || state.users.person.clone().unwrap_or_else(|| Person::new(self.setup.model.params()));
        self.planner.uses_user_model().then(known)
    }

    /// Returns the expected `p_l` and `ε` of the user, if they are learned.
    pub fn user_params(&self, state: &State) -> Option<(f64, f64)> {
        let configured = self.setup.model.params();
        let open = state.open.as_ref();
        let params = match open.and_then(|open| open.posterior.speaker()) {
            Some(speaker) if !self.planner.uses_user_model() => speaker.params(configured),
            _ => {
                let open = open.and_then(|open| open.posterior.person().cloned());
                open.or_else(|| self.person(state))?.params(configured)
            }
        };
        Some((params.p_l, params.epsilon))
    }

    /// Returns the posterior before that person says anything.
    pub(super) fn beginning(&self, state: &State, from: &PersonId) -> Posterior {
        let posterior = Posterior::new(self.prior_of(state, from), self.person(state));
        let posterior =
            if self.setup.model.misperceives() { posterior.of_perceived() } else { posterior };
        match self.speaker(state, from) {
            Some(speaker) => posterior.of_speaker(speaker),
            None => posterior,
        }
    }

    /// Updates a posterior by Bayes' rule with one utterance.
    pub(super) fn update(
        &self,
        posterior: &mut Posterior,
        model: &Model,
        (interpretations, gesture, mark): Content<'_>,
    ) {
        posterior.update_mixture(model, interpretations);
        if let (Some(pointing), Some(at)) = (&self.pointing, gesture)
            && let Some(log) = pointing.log_likelihood(at, self.setup.model.hypotheses())
        {
            posterior.weigh(&log);
        }
        if let Some(mark) = mark {
            let hypotheses = self.setup.model.hypotheses();
            posterior.weigh(&mark.log_likelihood(&self.setup.scene, hypotheses));
        }
    }

    /// Returns the observation model given the utterances about the wanted object: the likely truth
    /// of values in doubt. A posterior over the user's perception keeps that itself.
    pub(super) fn learned<'a>(
        &'a self,
        evidence: impl Iterator<Item = &'a Evidence>,
    ) -> Cow<'a, Model> {
        let mut model = Cow::Borrowed(&self.setup.model);
        if model.has_doubts() && !model.misperceives() {
            evidence.for_each(|it| model.to_mut().learn(&it.in_scene(&self.setup.scene)));
        }
        model
    }

    /// Returns the posterior after all evidence of the interaction, in the present scene.
    pub(super) fn fold(&self, state: &State, open: &Interaction) -> Posterior {
        let mut posterior = self.beginning(state, &open.from());
        let mut model = self.learned(std::iter::empty());
        for evidence in open.counting() {
            let interpretations = evidence.in_scene(&self.setup.scene);
            let Evidence { gesture, mark, .. } = evidence;
            self.update(&mut posterior, &model, (&interpretations, *gesture, mark.as_ref()));
            if model.has_doubts() && !model.misperceives() {
                model.to_mut().learn(&interpretations);
            }
        }
        posterior
    }

    /// Records that a question was answered, or was not although there was time.
    pub(super) fn see_answer(&self, state: &mut State, answered: bool) {
        let Some(mut person) = self.person(state) else { return };
        if let Some(open) = &mut state.open {
            open.posterior.see_answer(answered);
        }
        person.see_answer(answered);
        state.users.person = Some(person);
    }
}
