//! Questions to the robot: "which ones are white", "what can you get me".

use words::Gap;

use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::topic::{ClauseAnalysis, SCENE_NAMES};

impl ClauseAnalysis<'_> {
    /// Returns whether the clause asks about the robot's activity or its vocabulary.
    pub(crate) fn asks_about_robot(&self) -> bool {
        self.opening().is_some_and(|(_, class)| matches!(class, Class::AskStatus | Class::AskHelp))
            && !self.has(classes![Fetch Want Story])
            && self.values == 0
    }

    /// Returns whether the clause asks the robot something.
    pub(crate) fn asks_back(&self) -> bool {
        let opens = self.clause[0].gap == Gap::Stop || !self.previous_tags.iter().any(is_content);
        let Some((at, opening)) = self.opening().filter(|_| opens) else { return false };
        match opening {
            // "what can you get me" asks about fetching.
            Class::AskBack => {
                let asks =
                    ["what", "which", "how", "why", "do", "did"].contains(&self.clause[at].word);
                asks || !self.has(classes![Fetch])
            }
            // "can you list the bowls"
            Class::Auxiliary => {
                matches!(self.clause[at + 1..], [ref subject, ref verb, ..]
                    if subject.is(Class::Second) && verb.is(Class::AskBack))
            }
            Class::Question => self.is_question(at),
            Class::Be => self.asks_whether(at),
            _ => false,
        }
    }

    /// "what is the capital of France", but not "what can you offer me".
    pub(crate) fn asks_about_something_else(&self) -> bool {
        let which = self.clause[0].word == "which";
        let to_us = self.unknown == 1 && (which || self.clause.iter().any(|tag| tag.word == "me"));
        self.unknown > 0
            && self.values == 0
            && !self.has(SCENE_NAMES)
            && !to_us
            && !self.asks_for_unknown()
    }

    /// "do you have a novel", "where are my trousers"
    fn asks_for_unknown(&self) -> bool {
        let [have, article, rest @ ..] = self.clause else { return false };
        have.is(Class::AskBack)
            && (matches!((have.word, have.last), ("do", "have") | ("have", "got"))
                || have.word == "where")
            && article.is_any(classes![Determiner Quantifier Possessive])
            && self.unknown == 1
            && rest.first().is_some_and(Tag::is_unknown)
            && rest[1..].iter().all(|tag| tag.is_any(classes![Courtesy Filler Plain]))
    }

    /// "are you pointing at the clear one", "is the pen on the table".
    fn asks_whether(&self, at: usize) -> bool {
        // "there is a pen on the table" states it.
        if self.clause[..at].iter().any(|tag| tag.is(Class::Plain)) {
            return false;
        }
        let [subject, rest @ ..] = &self.clause[at + 1..] else { return false };
        if subject.is(Class::Second) {
            return rest.iter().any(Tag::is_value) || self.has(SCENE_NAMES);
        }
        let place = rest.iter().position(|tag| tag.is(Class::Preposition));
        // "is the red book thick"
        let ends_in_value = || {
            let noun = rest.iter().position(Tag::is_noun);
            // "is it long or short"
            let says = |tag: &Tag<'_>| tag.is_value() || tag.is(Class::Or);
            noun.is_some_and(|at| at + 1 < rest.len() && rest[at + 1..].iter().all(says))
        };
        subject.is(Class::Determiner)
            && (ends_in_value()
                || place.is_some_and(|at| {
                    rest[..at].iter().any(Tag::is_value) && rest[at..].iter().any(Tag::is_value)
                }))
    }

    /// "which ones are white", but not "what I want" or "what a mess".
    fn is_question(&self, at: usize) -> bool {
        let next = self.next(at);
        let relative = next.is_some_and(|next| {
            next.is_any(classes![First Possessive Yes No]) || matches!(next.word, "a" | "an")
        });
        // "what can you bring", "which tools can you reach"
        let turns = self.clause[at..].windows(2).any(|pair| {
            pair[0].is(Class::Auxiliary) && pair[1].is_any(classes![Second It Third Pointer])
        });
        let inverted = (turns || next.is_some_and(|next| next.is(Class::Auxiliary)))
            && !self.has(classes![Not]);
        !relative && (inverted || !self.has(classes![Fetch]))
    }
}

fn is_content(tag: &Tag<'_>) -> bool {
    tag.is_unknown() || tag.is_value() || tag.is_any(classes![Head Fetch Want Unlisted])
}
