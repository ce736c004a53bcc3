//! What is believed before anything is said.

use super::Mind;
use crate::state::State;
use dialogue::{Belief, PriorObjects};

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
}
