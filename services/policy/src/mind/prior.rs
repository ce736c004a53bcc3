//! What is believed before anything is said, and what everything said makes of it.

use super::Mind;
use crate::evidence::Evidence;
use crate::state::{Interaction, State};
use dialogue::Belief;
use settings::PriorObjects;

impl Mind {
    /// The belief of an interaction in which nothing was said.
    pub fn prior(&self, state: &State) -> Belief {
        let objects = self.scene.objects();
        let mut weights = match self.prior.objects {
            PriorObjects::Uniform if self.model.absent().is_none() => {
                return Belief::uniform(objects.len());
            }
            PriorObjects::Uniform => vec![1.0 / objects.len() as f64; objects.len()],
            PriorObjects::History => {
                let names = objects.iter().map(|object| object.name.as_str());
                state.history.prior(names, self.prior.smoothing)
            }
        };
        if self.model.absent().is_some() {
            weights.iter_mut().for_each(|p| *p *= 1.0 - self.prior.absent);
            weights.push(self.prior.absent);
        }
        Belief::from_probabilities(&weights).expect("settings are checked: each weight is positive")
    }

    /// Bayes' rule with one utterance.
    pub(super) fn observe(&self, belief: &mut Belief, evidence: &Evidence) {
        belief.update_mixture(&self.model, &evidence.in_scene(&self.scene));
        if let (Some(pointing), Some(target_m)) = (&self.pointing, evidence.gesture) {
            pointing.observe(belief, target_m);
        }
    }

    /// The belief after everything that is remembered of the interaction. Nothing in it depends on
    /// an earlier scene.
    pub(super) fn fold(&self, state: &State, open: &Interaction) -> Belief {
        let mut belief = self.prior(state);
        open.evidence.iter().for_each(|evidence| self.observe(&mut belief, evidence));
        belief
    }
}
