//! Self-repair: "the red, no, the blue one". What is said after the repair replaces what it
//! competes with, and leaves the rest standing.

use scene::Role;
use words::Gap;

use crate::content::Asserted;
use crate::lexicon::ValueSense;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// Strength with which the words before are taken back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Strength {
    /// "the red uh blue one".
    Stumble,
    /// "sorry", "I mean".
    Soft,
    /// "no", "scratch that".
    Hard,
}

/// The values that follow a repair, up to the end of their noun phrase.
#[derive(Debug)]
pub(crate) struct Replacement<'a> {
    values: Vec<&'a ValueSense>,
    /// Starts with a determiner: a noun phrase of its own, not a word put in another's place.
    whole: bool,
    /// "it is …": a statement that adds rather than replaces.
    statement: bool,
    /// "the small one": the noun, and what else was said of it, are those before.
    anaphoric: bool,
}

impl<'a> Replacement<'a> {
    /// The replacement whose first value is at `at`.
    pub(crate) fn at(tags: &[Tag<'a>], at: usize) -> Self {
        const REACH: usize = 12;
        let ends = |tag: &Tag<'_>| {
            tag.gap == Gap::Stop
                || tag.is_any(classes![Repair Withdraw No Not Except But Landmark Than])
        };
        let after = tags[at + 1..].iter().take(REACH).take_while(|tag| !ends(tag));
        let head = after.clone().find(|tag| tag.is(Class::Head));
        let values = std::iter::once(&tags[at]).chain(after).filter_map(Tag::value);
        let lead = tags[..at].iter().rev().take_while(|tag| !ends(tag)).take(3);
        let lead: Vec<&Tag<'_>> = lead.collect();
        Self {
            values: values.collect(),
            whole: lead.first().is_some_and(|tag| tag.is(Class::Determiner)),
            statement: lead.iter().any(|tag| tag.is(Class::Be)),
            anaphoric: head.is_some_and(|tag| tag.word.starts_with("one")),
        }
    }

    /// Takes out of `base` what the replacement stands in for.
    pub(crate) fn replace(&self, base: &mut Vec<Asserted<'a>>, strength: Strength) {
        if let Some(from) = self.retraced(base).filter(|_| strength > Strength::Stumble) {
            let mut at = 0..;
            base.retain(|old| at.next() < Some(from) || old.is_place());
        }
        let rival = |old: &ValueSense| self.values.iter().any(|new| old.rivals(new));
        if base.iter().any(|old| rival(old)) {
            // "the blue pen, no, the marker": another kind of thing, the rest goes with the old.
            let renamed = self.whole && strength > Strength::Stumble && self.renames(base);
            base.retain(|old| !rival(old) && (!renamed || old.is_place()));
        } else if strength == Strength::Hard || strength == Strength::Soft && !self.statement {
            // "the white one, no, the metal one": nothing in common, so one for the other; but
            // "…, no, in the cabinet" only says where.
            if self.values.iter().any(|new| !new.is_place()) {
                base.retain(|old| old.is_place());
            }
        }
    }

    /// "the small white, I mean the small metal bowl": the speaker returns to a word said before
    /// and continues from there (Levelt 1983, "retracing").
    fn retraced(&self, base: &[Asserted<'_>]) -> Option<usize> {
        let first = self.values.first().filter(|_| !self.anaphoric)?;
        base.iter().position(|old| old.word == first.word)
    }

    fn renames(&self, base: &[Asserted<'_>]) -> bool {
        let is_kind = |value: &ValueSense| value.role == Role::Kind;
        let is_new = |old: &Asserted<'_>| self.values.iter().all(|new| new.word != old.word);
        let mut kinds = base.iter().filter(|old| is_kind(old)).peekable();
        self.values.iter().all(|new| is_kind(new)) && kinds.peek().is_some() && kinds.all(is_new)
    }
}

/// "the red uh blue one", "the red one uh the blue one": a hesitation between rivals. "the red …
/// the blue one": a noun phrase broken off and begun again.
pub(crate) fn is_stumble(tags: &[Tag<'_>], at: usize) -> bool {
    const REACH: usize = 6;
    let Some(new) = tags[at].value() else { return false };
    let (mut hesitated, mut begun, mut ended) = (false, false, false);
    for tag in tags[..at].iter().rev().take(REACH) {
        if let Some(old) = tag.value() {
            return (hesitated || begun && !ended) && old.rivals(new);
        }
        match tag.class() {
            Some(Class::Filler) => hesitated = true,
            Some(Class::Determiner) => begun |= tag.gap == Gap::Pause,
            Some(Class::Head) => ended = true,
            _ => return false,
        }
    }
    false
}
