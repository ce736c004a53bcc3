//! The languages that a reader of utterances reads in.

use serde::{Deserialize, Serialize};

/// Options of the reader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// Word spotting, exactly as in section 3.6 of the paper.
    Paper,
    /// A careful extractor: synonyms, negation with scope, repairs, intents.
    #[default]
    Careful,
}
