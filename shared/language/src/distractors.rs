//! Values that describe something else than the wanted object: "red wine", "my shirt is white",
//! "the dishwasher is broken".

use scene::Role;

use crate::lexicon::Sense;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::topic::{ClauseAnalysis, SCENE_NAMES};

impl ClauseAnalysis<'_> {
    /// Places in the clause of the values that describe something else than the wanted object.
    pub(crate) fn distractors(&self) -> Vec<usize> {
        let fetched = self.has(classes![Fetch]) || self.brings() || self.is_described_noun();
        let errand = self.is_errand();
        let describes_other = |&at: &usize| {
            if self.clause[at].is_role(Role::Place) {
                errand || self.is_destination(at) || self.is_other_place(at)
            } else {
                !fetched && self.modifies_unknown(at) || self.describes_unknown(at)
            }
        };
        let values = (0..self.clause.len()).filter(|&at| self.clause[at].is_value());
        values.filter(describes_other).collect()
    }

    /// "the small white bold": described so well that the noun can only have been misheard.
    fn is_described_noun(&self) -> bool {
        let [first, .., last] = self.clause else { return false };
        let whole = first.word == "the" && self.is_everything;
        (first.is(Class::Determiner) || first.is_value())
            && self.unknown == 1
            && last.is_unknown()
            && (self.values > 1 || whole && self.values > 0)
    }

    /// "white house": the noun that the value stands before is not one of ours.
    fn modifies_unknown(&self, at: usize) -> bool {
        let mut unknown = false;
        for tag in &self.clause[at + 1..] {
            match tag.sense {
                Sense::Unknown => unknown = true,
                Sense::Value(value) if unknown => return value.role != Role::Kind,
                Sense::Value(value) if value.role == Role::Kind => return false,
                Sense::Class(Class::Head | Class::Unlisted | Class::Attribute) => return false,
                // "the long weekend"
                Sense::Class(Class::When) => {
                    let is_noun = self.clause[at].is_role(Role::Kind);
                    return unknown || !is_noun && tag.word == "weekend";
                }
                Sense::Value(_) => {}
                Sense::Class(Class::And | Class::Or) if !unknown => {}
                Sense::Class(_) => break,
            }
        }
        unknown
    }

    /// "my shirt is white": the value is said of something unknown.
    fn describes_unknown(&self, at: usize) -> bool {
        const BETWEEN: &[Class] = classes![Plain Not Determiner Join And Or Story];
        let links = |tag: &Tag<'_>| {
            tag.is(Class::Be)
                || tag.is_any(classes![Likely Hedge])
                    && matches!(tag.word, "should" | "must" | "might" | "could" | "may" | "ought")
        };
        let Some(be) = self.clause[..at].iter().rposition(links) else { return false };
        let subject = &self.clause[..be];
        // "my glass is empty", but not "the glass is empty"
        let owned = subject.iter().any(|tag| tag.is(Class::Possessive));
        let is_ours = |tag: &Tag<'_>| {
            tag.is_value()
                || tag.is_any(classes![Head Attribute It Pointer])
                || tag.is(Class::Unlisted) && !owned
        };
        // "my shirt is white", "I am short"
        let is_other = |last: &Tag<'_>| {
            owned && last.is(Class::Unlisted) || last.is_any(classes![First Second Third])
        };
        self.clause[be + 1..at].iter().all(|tag| tag.is_any(BETWEEN) || tag.is_value())
            && !subject.iter().any(is_ours)
            && (subject.last().is_some_and(is_other) || subject.iter().any(Tag::is_unknown))
    }

    /// "bring it to the table": where it goes, not where it is.
    fn is_destination(&self, at: usize) -> bool {
        let in_phrase =
            |tag: &&Tag<'_>| tag.is_any(classes![Determiner Possessive]) || tag.is_value();
        let lead = self.clause[..at].iter().rev().find(|tag| !in_phrase(tag));
        lead.is_some_and(|tag| tag.is(Class::Destination))
    }

    /// "the dishwasher is broken", "sitting at the table": a place that locates nothing of ours.
    fn is_other_place(&self, at: usize) -> bool {
        if self.next(at).is_some_and(|next| next.is(Class::Head)) {
            return false;
        }
        let is_described = self.is_described_beside(at);
        let located = self.clause[at].is_located();
        if located || self.clause[..at].iter().any(|tag| tag.is(Class::Preposition)) {
            let tied = is_described
                || self.has(SCENE_NAMES)
                || self.has(classes![Fetch It Pointer Unlisted]);
            return self.unknown > 0 && !tied && !self.is_bare_noun();
        }
        // Without a preposition it is named, not used to locate: only as a short answer.
        !is_described && !self.is_short_answer(at)
    }

    /// The place at `at`, and nothing else but what an answer may contain.
    fn is_short_answer(&self, at: usize) -> bool {
        const BESIDE: &[Class] = classes![
            Determiner Pointer Filler Courtesy Plain Yes No WeakYes WeakNo It Hedge Likely
            Unsure Pondering Not Except And Or But Join Repair Withdraw Want Ordinal
        ];
        // "drawer is right": the verb before a judgement that ends the clause.
        let judges = |verb: usize| {
            let rest = &self.clause[verb + 1..];
            matches!(rest, [judged] if judged.is_any(classes![WeakYes WeakNo]))
        };
        self.clause.iter().enumerate().all(|(n, tag)| {
            tag.is_any(BESIDE) || tag.is_value() || tag.is(Class::Be) && (n < at || judges(n))
        })
    }

    /// Returns whether a value other than a place describes one of ours.
    fn is_described_beside(&self, at: usize) -> bool {
        (0..self.clause.len()).any(|other| {
            let tag = &self.clause[other];
            let is_description = tag.is_value() && !tag.is_role(Role::Place);
            other != at && is_description && !self.modifies_unknown(other)
        })
    }
}
