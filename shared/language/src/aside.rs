//! Values that describe something else than the wanted object: "red wine", "my shirt is white",
//! "the dishwasher is broken".

use scene::Role;

use crate::cue::{Cue, cues};
use crate::lexicon::Sense;
use crate::marks::Mark;
use crate::topic::{SCENE_NAMES, Sketch};

impl Sketch<'_> {
    /// Values of the clause that describe something else than the wanted object.
    pub(crate) fn aside_values(&self) -> Vec<usize> {
        let fetched = self.has(cues![Fetch]) || self.is_described_noun();
        let errand = self.is_errand();
        let values = self.range.clone().filter(|&at| self.marks[at].value().is_some());
        values
            .filter(|&at| {
                let value = self.marks[at].value().map(|value| self.lexicon.value(value).role);
                match value {
                    Some(Role::Place) => {
                        errand || self.is_destination(at) || self.is_other_place(at)
                    }
                    _ => !fetched && self.modifies_unknown(at) || self.tells_of_unknown(at),
                }
            })
            .collect()
    }

    /// "the small white bold": described so well that the noun can only have been misheard.
    fn is_described_noun(&self) -> bool {
        let clause = self.clause();
        let (Some(first), Some(last)) = (clause.first(), clause.last()) else { return false };
        let opens = first.is(Cue::Determiner) || first.value().is_some();
        let whole = first.word == "the" && clause.len() == self.marks.len();
        opens
            && self.unknown == 1
            && last.sense == Sense::Unknown
            && (self.values > 1 || whole && self.values > 0)
    }

    /// "white house": the noun that the value stands before is not one of ours.
    fn modifies_unknown(&self, at: usize) -> bool {
        let noun = self.marks[at].value().map(|value| self.lexicon.value(value).role);
        let mut unknown = false;
        for mark in &self.marks[at + 1..self.range.end] {
            match mark.sense {
                Sense::Unknown => unknown = true,
                Sense::Value(value) if unknown => {
                    return self.lexicon.value(value).role != Role::Kind;
                }
                Sense::Value(value) => {
                    if self.lexicon.value(value).role == Role::Kind {
                        return false;
                    }
                }
                Sense::Cue(Cue::Head | Cue::Unlisted | Cue::Attribute) => return false,
                // "the long weekend"
                Sense::Cue(Cue::When) => {
                    return unknown || noun != Some(Role::Kind) && mark.word == "weekend";
                }
                Sense::Cue(Cue::And | Cue::Or) if !unknown => {}
                Sense::Cue(_) => break,
            }
        }
        unknown
    }

    /// "my shirt is white": the value is said of something unknown.
    fn tells_of_unknown(&self, at: usize) -> bool {
        let before = &self.marks[self.range.start..at];
        let links = |mark: &Mark<'_>| {
            mark.is(Cue::Be)
                || mark.is_any(cues![Likely Hedge])
                    && matches!(mark.word, "should" | "must" | "might" | "could" | "may" | "ought")
        };
        let Some(be) = before.iter().rposition(links) else { return false };
        let linked = before[be + 1..].iter().all(|mark| {
            mark.is_any(cues![Plain Not Determiner Join And Or Story]) || mark.value().is_some()
        });
        let subject = &before[..be];
        // "my glass is empty", but not "the glass is empty"
        let owned = subject.iter().any(|mark| mark.is(Cue::Possessive));
        let ours = subject.iter().any(|mark| {
            mark.is_any(SCENE_NAMES)
                || mark.is_any(cues![It Pointer])
                || mark.is(Cue::Unlisted) && !owned
                || mark.value().is_some()
        });
        // "my shirt is white", "I am short"
        let theirs = owned && subject.last().is_some_and(|mark| mark.is(Cue::Unlisted))
            || subject.iter().any(|mark| mark.sense == Sense::Unknown)
            || subject.last().is_some_and(|mark| mark.is_any(cues![First Second Third]));
        linked && !ours && theirs
    }

    /// "bring it to the table": where it goes, not where it is.
    fn is_destination(&self, at: usize) -> bool {
        let before = self.marks[self.range.start..at].iter().rev();
        let mut leads = before
            .skip_while(|mark| mark.is_any(cues![Determiner Possessive]) || mark.value().is_some());
        leads.next().is_some_and(|mark| mark.is(Cue::Destination))
    }

    /// "the dishwasher is broken", "sitting at the table": a place that locates nothing of ours.
    fn is_other_place(&self, at: usize) -> bool {
        const BESIDE: &[Cue] = cues![
            Determiner Pointer Filler Courtesy Plain Yes No WeakYes WeakNo It Hedge Likely
            Unsure Not Except And Or But Join Repair Withdraw Want Ordinal
        ];
        let before = &self.marks[self.range.start..at];
        let after = self.marks[at + 1..self.range.end].first();
        if after.is_some_and(|mark| mark.is(Cue::Head)) {
            return false;
        }
        let described = self.has_other_value(at);
        if before.iter().any(|mark| mark.is(Cue::Preposition)) {
            let tied =
                self.has(SCENE_NAMES) || self.has(cues![Fetch It Pointer Unlisted]) || described;
            return self.unknown > 0 && !tied && !self.is_bare_noun();
        }
        // Without a preposition it is named, not used to locate: only as a short answer.
        let named_alone = self.clause().iter().enumerate().all(|(n, mark)| {
            mark.is_any(BESIDE)
                || mark.value().is_some()
                || mark.is(Cue::Be) && (self.range.start + n < at || self.is_judgement(n))
        });
        !described && !named_alone
    }

    /// "drawer is right": the verb before a judgement that ends the clause.
    fn is_judgement(&self, verb: usize) -> bool {
        let rest = &self.clause()[verb + 1..];
        matches!(rest, [judged] if judged.is_any(cues![WeakYes WeakNo]))
    }

    fn has_other_value(&self, at: usize) -> bool {
        self.range.clone().any(|other| {
            let value = self.marks[other].value().map(|value| self.lexicon.value(value).role);
            other != at
                && value.is_some_and(|role| role != Role::Place)
                && !self.modifies_unknown(other)
        })
    }
}
