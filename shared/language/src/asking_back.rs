//! Questions to the robot: "which ones are white", "what can you get me".

use crate::token_class::{Class, classes};
use crate::topic::{ARTICLES, ClauseAnalysis, SCENE_NAMES};
use crate::word_sets::WordSet;

impl ClauseAnalysis<'_> {
    /// Returns whether the clause asks about the robot's activity or its vocabulary.
    pub(crate) fn asks_about_robot(&self) -> bool {
        self.opening().is_some_and(|(_, class)| matches!(class, Class::AskStatus | Class::AskHelp))
    }

    /// Returns whether the clause asks the robot something.
    pub(crate) fn asks_back(&self) -> bool {
        let Some((at, opening)) = self.opening() else { return false };
        let next = self.next(at);
        match opening {
            // "what can you get me" asks about fetching.
            Class::AskBack => {
                WordSet::Asking.has(self.clause[at].word) || !self.has(classes![Fetch])
            }
            // "can you list the bowls"
            Class::Auxiliary => {
                matches!(self.clause[at + 1..], [ref subject, ref verb, ..]
                    if subject.is(Class::Second) && verb.is(Class::AskBack))
            }
            // "which ones are white", but not "what I want" or "what a mess".
            Class::Question => !next.is_some_and(|next| {
                next.is_any(classes![First Possessive Yes No]) || WordSet::Article.has(next.word)
            }),
            // "are you pointing at the clear one", "is the pen on the table"; "there is a pen on the
            // table" states it.
            Class::Be => {
                let is_stated = self.clause[..at].iter().any(|tag| tag.is(Class::Plain));
                let is_ours = self.values > 0 || self.has(SCENE_NAMES);
                !is_stated
                    && next.is_some_and(|subject| {
                        subject.is(Class::Second) && is_ours || subject.is(Class::Determiner)
                    })
            }
            _ => false,
        }
    }

    /// "what is the capital of France", but not "what can you offer me".
    pub(crate) fn asks_about_something_else(&self) -> bool {
        let which = WordSet::OneOfThem.has(self.clause[0].word);
        let to_us =
            self.unknown == 1 && (which || self.clause.iter().any(|tag| WordSet::Me.has(tag.word)));
        self.unknown > 0
            && self.values == 0
            && !self.has(SCENE_NAMES)
            && !to_us
            && !self.asks_for_unknown()
    }

    /// "do you have a novel", "where are my trousers"
    fn asks_for_unknown(&self) -> bool {
        let [have, article, ..] = self.clause else { return false };
        have.is(Class::AskBack) && article.is_any(ARTICLES) && self.unknown == 1
    }
}
