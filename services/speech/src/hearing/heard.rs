//! Views of the recognisers on an utterance.

use messages::Hypothesis;
use serde::{Deserialize, Serialize};
use speech_engines::recogniser::{FirstView, Opinion};

/// The views of one utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    /// The first recogniser's view.
    pub first: FirstView,
    /// The second recogniser's view.
    pub second: SecondView,
}

/// The second recogniser's view of one utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SecondView {
    /// No second recogniser was asked, or needed.
    NotAsked,
    /// The opinion was too late.
    Late,
    /// The second recogniser's opinion.
    Heard(Opinion),
}

impl Heard {
    /// Returns the hypotheses of all recognisers, best first.
    pub fn hypotheses(&self) -> Vec<Hypothesis> {
        match &self.second {
            SecondView::Heard(opinion) => opinion.combined_with(&self.first.hypotheses),
            SecondView::NotAsked | SecondView::Late => self.first.hypotheses.clone(),
        }
    }
}
