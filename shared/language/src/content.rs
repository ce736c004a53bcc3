//! Content of an utterance: values asserted, groups ruled out, answers given.

use std::ops::Deref;

use scene::WordId;

use crate::answer::Answers;
use crate::lexicon::ValueSense;

/// A value that the wanted object is said to have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asserted<'a> {
    pub(crate) value: &'a ValueSense,
    /// Index of the value's tag.
    pub(crate) at: usize,
    /// Probability that something else was meant.
    pub(crate) doubt: f64,
    /// Number of "or" before the value.
    pub(crate) choice: usize,
}

impl Deref for Asserted<'_> {
    type Target = ValueSense;

    fn deref(&self) -> &ValueSense {
        self.value
    }
}

/// A group of values that is ruled out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Excluded {
    pub(crate) words: Vec<WordId>,
    /// Probability that the value was not said.
    pub(crate) doubt: f64,
}

/// Content of an utterance.
#[derive(Debug, Default)]
pub(crate) struct Content<'a> {
    /// Values that the wanted object is said to have.
    pub(crate) base: Vec<Asserted<'a>>,
    /// Groups that are ruled out.
    pub(crate) excluded: Vec<Excluded>,
    /// Answers in the order given.
    pub(crate) answers: Answers,
    /// "maybe": the words do not amount to an answer.
    pub(crate) hedged: bool,
    /// "red or blue": alternatives, not a description.
    pub(crate) alternatives: bool,
    /// Values that a question is about: "is the clear one white or metallic".
    pub(crate) asked: Vec<WordId>,
}

impl Content<'_> {
    /// Adds a group that is ruled out.
    pub(crate) fn exclude(&mut self, group: Excluded) {
        // "the red one, no, not the red one": the scope remains valid.
        if let [word] = group.words[..] {
            self.base.retain(|value| value.word != word);
        }
        match self.excluded.iter_mut().find(|known| known.words == group.words) {
            // Asserted twice, it is doubted as the surer one is.
            Some(known) => known.doubt = known.doubt.min(group.doubt),
            None => self.excluded.push(group),
        }
    }

    /// Retracts everything said so far.
    pub(crate) fn clear(&mut self) {
        self.base.clear();
        self.excluded.clear();
        self.answers.clear();
    }
}
