//! Statements about our things, which ask for none of them: "the clear bowl is in the cabinet".

use scene::Role;

use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::topic::ClauseAnalysis;

impl ClauseAnalysis<'_> {
    /// Returns whether the clause says something of a thing that it describes, or what the speaker did
    /// with it. "The bowl is clear" describes the bowl that is wanted, and so does "I put it there".
    pub(crate) fn states(&self) -> bool {
        const LEADS: &[Class] = classes![Filler And But Join Plain];
        if self.is_for_speaker() {
            return false;
        }
        let leads = self.clause.iter().take_while(|tag| tag.is_any(LEADS)).count();
        // "I like the clear bowl" is no statement: a recogniser loses the "'d" of "I'd like".
        match &self.clause[leads..] {
            [i, put, rest @ ..] if i.is(Class::First) && put.is(Class::Put) => {
                let noun = noun_phrase(rest);
                is_described(noun) && rest[noun.len()..].iter().any(|tag| tag.is_role(Role::Place))
            }
            [i, love, rest @ ..] if i.is(Class::First) && matches!(love.word, "love" | "hate") => {
                is_described(rest)
            }
            // "there is a clear bowl in the cabinet"
            [be, rest @ ..]
                if be.is(Class::Be) && leads > 0 && self.clause[leads - 1].word == "there" =>
            {
                let noun = noun_phrase(rest);
                is_described(noun) && rest[noun.len()..].iter().any(|tag| tag.is_role(Role::Place))
            }
            rest => {
                let (subject, rest) = rest.split_at(noun_phrase(rest).len());
                is_described(subject) && is_predicate(rest)
            }
        }
    }

    /// "there is a clear bowl on the counter for me": asked for.
    fn is_for_speaker(&self) -> bool {
        let is_for_me =
            |pair: &[Tag<'_>]| pair[0].word == "for" && matches!(pair[1].word, "me" | "us");
        self.clause.windows(2).any(is_for_me)
    }
}

/// The noun phrase that opens the tags.
fn noun_phrase<'t, 'a>(tags: &'t [Tag<'a>]) -> &'t [Tag<'a>] {
    const PARTS: &[Class] = classes![Determiner Pointer Possessive Head];
    let is_part = |tag: &&Tag<'_>| tag.is_any(PARTS) || tag.is_value() && !tag.is_role(Role::Place);
    &tags[..tags.iter().take_while(is_part).count()]
}

/// "the clear bowl", "a red mug": a noun with a quality, and nothing else.
fn is_described(tags: &[Tag<'_>]) -> bool {
    let is_noun = |tag: &Tag<'_>| {
        tag.is_role(Role::Kind) || tag.is(Class::Head) && !tag.word.starts_with("one")
    };
    tags.first().is_some_and(|tag| tag.is_any(classes![Determiner Pointer Possessive]))
        && tags.last().is_some_and(is_noun)
        && tags.iter().any(|tag| tag.is_role(Role::Quality))
        && noun_phrase(tags).len() == tags.len()
}

/// "is in the cabinet", "is not small", but not "is what I want", "would be fine" and "is needed".
fn is_predicate(tags: &[Tag<'_>]) -> bool {
    const PARTS: &[Class] = classes![Determiner Preposition Not Plain Attribute Hedge And Or];
    let is_part = |tag: &Tag<'_>| {
        tag.is_value() || tag.is_any(PARTS) && !matches!(tag.word, "needed" | "wanted")
    };
    matches!(tags, [be, rest @ ..] if be.is(Class::Be) && !rest.is_empty() && rest.iter().all(is_part))
}
