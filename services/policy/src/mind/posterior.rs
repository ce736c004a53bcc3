//! What is believed in an open interaction: about the wanted object alone, or about the person who
//! answers as well, where the planner makes use of that.

use super::Mind;
use crate::evidence::Evidence;
use crate::state::{Interaction, State};
use dialogue::Posterior;
use dialogue::user_model::Person;

/// Answers after which a person's reaction time counts as known.
const ACQUAINTED: u32 = 5;
/// How far the response window follows a person, as shares of the one configured.
const WINDOW: (f64, f64) = (0.25, 2.0);

/// As it stands in an interaction.
pub(super) fn of(open: &Interaction) -> Posterior {
    match &open.joint {
        Some(joint) => Posterior::ObjectAndPerson(joint.clone()),
        None => Posterior::Object(open.belief()),
    }
}

/// Puts it into an interaction.
pub(super) fn store(posterior: Posterior, open: &mut Interaction) {
    open.belief = posterior.belief().log_weights().to_vec();
    open.joint = match posterior {
        Posterior::Object(_) => None,
        Posterior::ObjectAndPerson(joint) => Some(joint),
    };
}

impl Mind {
    /// Whether the person is learned about.
    pub(super) fn learns(&self) -> bool {
        self.planner.minds_the_person()
    }

    /// The person as known before the open interaction, but for how often questions were answered:
    /// that says nothing about the object, so it counts at once.
    pub(super) fn person(&self, state: &State) -> Option<Person> {
        let known = || state.person.clone().unwrap_or_else(|| Person::new(self.model.params()));
        self.learns().then(known)
    }

    /// What is expected of the person: `p_l` and `ε`.
    pub(crate) fn expects(&self, state: &State) -> Option<(f64, f64)> {
        let open = state.open.as_ref().and_then(|open| open.joint.as_ref());
        let person = open.map(|joint| joint.person().clone()).or_else(|| self.person(state))?;
        let params = person.params(self.model.params());
        Some((params.p_l, params.epsilon))
    }

    /// What is believed before anything is said.
    pub(super) fn beginning(&self, state: &State) -> Posterior {
        Posterior::new(self.prior(state), self.person(state))
    }

    /// Bayes' rule with one utterance.
    pub(super) fn observe(&self, posterior: &mut Posterior, evidence: &Evidence) {
        let heard = evidence.in_scene(&self.scene);
        let gesture = self.pointing.as_ref().zip(evidence.gesture);
        let gesture =
            gesture.and_then(|(pointing, at)| pointing.log_likelihood(at, self.model.hypotheses()));
        posterior.update_mixture(&self.model, &heard);
        gesture.iter().for_each(|log| posterior.weigh(log));
    }

    /// What is believed after everything that is remembered of the interaction. Nothing in it
    /// depends on an earlier scene.
    pub(super) fn fold(&self, state: &State, open: &Interaction) -> Posterior {
        let mut posterior = self.beginning(state);
        open.evidence.iter().for_each(|evidence| self.observe(&mut posterior, evidence));
        posterior
    }

    /// Takes note that a question was answered, or was not although there was time.
    pub(super) fn see_answer(&self, state: &mut State, answered: bool) {
        let Some(person) = self.person(state) else { return };
        let see = |person: &mut Person| person.see_answer(answered);
        let joint = state.open.as_mut().and_then(|open| open.joint.as_mut());
        joint.into_iter().for_each(|joint| see(joint.person_mut()));
        see(state.person.insert(person));
    }

    /// Seconds after a question in which an answer is waited for: those configured, or, of somebody
    /// who was seen to answer a few times, those in which this person does.
    pub(crate) fn response_window_s(&self, state: &State) -> f64 {
        let configured = self.turns.response_window_s;
        // Somebody who was seen to type may type the next answer, too.
        let known = state.timing.typed.or(state.timing.spoken);
        known.filter(|reaction| reaction.seen() >= ACQUAINTED).map_or(configured, |reaction| {
            reaction.patience_s().clamp(configured * WINDOW.0, configured * WINDOW.1)
        })
    }
}
