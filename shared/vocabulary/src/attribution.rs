//! Attribution of utterances to the questions that they answer: the rule, and its result.

use serde::{Deserialize, Serialize};

use crate::ids::{PromptId, UtteranceSeq};

/// How an utterance is attributed to a question.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attribution {
    /// Counts the utterance for each question by the question's weight.
    #[default]
    Mixture,
    /// Counts the utterance for the latest question said when it began.
    Onset,
    /// Assigns the utterance to the question pending when the recogniser's result arrives, as naive
    /// systems do; kept for comparison.
    Naive,
}

/// The questions that an utterance was attributed to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Attributed {
    /// The utterance; 0 before the first.
    pub utterance: UtteranceSeq,
    /// Probability that it answers each presentation of a question, where that is above 0.
    pub questions: Vec<QuestionShare>,
    /// Probability that it answers no question.
    pub none: f64,
}

impl Attributed {
    /// Returns the share of a prompt, all its presentations together.
    pub fn share(&self, prompt: PromptId) -> f64 {
        self.questions.iter().filter(|it| it.prompt == prompt).map(|it| it.share).sum()
    }
}

/// Share of one presentation of a question in an utterance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct QuestionShare {
    /// The prompt.
    pub prompt: PromptId,
    /// Which presentation of it.
    pub presentation: u32,
    /// Probability that the utterance answers it.
    pub share: f64,
}
