//! Values that describe something else than the wanted object: "red wine", "my shirt is white",
//! "the dishwasher is broken".

use scene::Role;

use crate::lexicon::Sense;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::topic::{ClauseAnalysis, SCENE_NAMES};

impl ClauseAnalysis<'_> {
    /// Values of the clause that describe something else than the wanted object.
    pub(crate) fn distractors(&self) -> Vec<usize> {
        let fetched = self.has(classes![Fetch]) || self.is_described_noun();
        let errand = self.is_errand();
        let values = self.range.clone().filter(|&at| self.tags[at].value().is_some());
        values
            .filter(|&at| {
                let value = self.tags[at].value().map(|value| self.lexicon.value(value).role);
                match value {
                    Some(Role::Place) => {
                        errand || self.is_destination(at) || self.is_other_place(at)
                    }
                    _ => !fetched && self.modifies_unknown(at) || self.describes_unknown(at),
                }
            })
            .collect()
    }

    /// "the small white bold": described so well that the noun can only have been misheard.
    fn is_described_noun(&self) -> bool {
        let clause = self.clause();
        let (Some(first), Some(last)) = (clause.first(), clause.last()) else { return false };
        let opens = first.is(Class::Determiner) || first.value().is_some();
        let whole = first.word == "the" && clause.len() == self.tags.len();
        opens
            && self.unknown == 1
            && last.sense == Sense::Unknown
            && (self.values > 1 || whole && self.values > 0)
    }

    /// "white house": the noun that the value stands before is not one of ours.
    fn modifies_unknown(&self, at: usize) -> bool {
        let noun = self.tags[at].value().map(|value| self.lexicon.value(value).role);
        let mut unknown = false;
        for tag in &self.tags[at + 1..self.range.end] {
            match tag.sense {
                Sense::Unknown => unknown = true,
                Sense::Value(value) if unknown => {
                    return self.lexicon.value(value).role != Role::Kind;
                }
                Sense::Value(value) => {
                    if self.lexicon.value(value).role == Role::Kind {
                        return false;
                    }
                }
                Sense::Class(Class::Head | Class::Unlisted | Class::Attribute) => return false,
                // "the long weekend"
                Sense::Class(Class::When) => {
                    return unknown || noun != Some(Role::Kind) && tag.word == "weekend";
                }
                Sense::Class(Class::And | Class::Or) if !unknown => {}
                Sense::Class(_) => break,
            }
        }
        unknown
    }

    /// "my shirt is white": the value is said of something unknown.
    fn describes_unknown(&self, at: usize) -> bool {
        let before = &self.tags[self.range.start..at];
        let links = |tag: &Tag<'_>| {
            tag.is(Class::Be)
                || tag.is_any(classes![Likely Hedge])
                    && matches!(tag.word, "should" | "must" | "might" | "could" | "may" | "ought")
        };
        let Some(be) = before.iter().rposition(links) else { return false };
        let linked = before[be + 1..].iter().all(|tag| {
            tag.is_any(classes![Plain Not Determiner Join And Or Story]) || tag.value().is_some()
        });
        let subject = &before[..be];
        // "my glass is empty", but not "the glass is empty"
        let owned = subject.iter().any(|tag| tag.is(Class::Possessive));
        let ours = subject.iter().any(|tag| {
            tag.is_any(SCENE_NAMES)
                || tag.is_any(classes![It Pointer])
                || tag.is(Class::Unlisted) && !owned
                || tag.value().is_some()
        });
        // "my shirt is white", "I am short"
        let theirs = owned && subject.last().is_some_and(|tag| tag.is(Class::Unlisted))
            || subject.iter().any(|tag| tag.sense == Sense::Unknown)
            || subject.last().is_some_and(|tag| tag.is_any(classes![First Second Third]));
        linked && !ours && theirs
    }

    /// "bring it to the table": where it goes, not where it is.
    fn is_destination(&self, at: usize) -> bool {
        let before = self.tags[self.range.start..at].iter().rev();
        let mut leads = before
            .skip_while(|tag| tag.is_any(classes![Determiner Possessive]) || tag.value().is_some());
        leads.next().is_some_and(|tag| tag.is(Class::Destination))
    }

    /// "the dishwasher is broken", "sitting at the table": a place that locates nothing of ours.
    fn is_other_place(&self, at: usize) -> bool {
        const BESIDE: &[Class] = classes![
            Determiner Pointer Filler Courtesy Plain Yes No WeakYes WeakNo It Hedge Likely
            Unsure Not Except And Or But Join Repair Withdraw Want Ordinal
        ];
        let before = &self.tags[self.range.start..at];
        let after = self.tags[at + 1..self.range.end].first();
        if after.is_some_and(|tag| tag.is(Class::Head)) {
            return false;
        }
        let described = self.has_other_value(at);
        if before.iter().any(|tag| tag.is(Class::Preposition)) {
            let tied =
                self.has(SCENE_NAMES) || self.has(classes![Fetch It Pointer Unlisted]) || described;
            return self.unknown > 0 && !tied && !self.is_bare_noun();
        }
        // Without a preposition it is named, not used to locate: only as a short answer.
        let named_alone = self.clause().iter().enumerate().all(|(n, tag)| {
            tag.is_any(BESIDE)
                || tag.value().is_some()
                || tag.is(Class::Be) && (self.range.start + n < at || self.is_judgement(n))
        });
        !described && !named_alone
    }

    /// "drawer is right": the verb before a judgement that ends the clause.
    fn is_judgement(&self, verb: usize) -> bool {
        let rest = &self.clause()[verb + 1..];
        matches!(rest, [judged] if judged.is_any(classes![WeakYes WeakNo]))
    }

    fn has_other_value(&self, at: usize) -> bool {
        self.range.clone().any(|other| {
            let value = self.tags[other].value().map(|value| self.lexicon.value(value).role);
            other != at
                && value.is_some_and(|role| role != Role::Place)
                && !self.modifies_unknown(other)
        })
    }
}
