//! Collects the content of the tags in one pass from left to right, as a person listens.

use words::Gap;

use crate::answer::{self, Answer};
use crate::clauses::{Clause, Topic};
use crate::content::{Asserted, Content, Excluded};
use crate::intent::commands;
use crate::lexicon::{Sense, ValueSense};
use crate::negation::{self, NoUse};
use crate::negation_scope::NegationScope;
use crate::question_words::QuestionWords;
use crate::related::too_much;
use crate::repair;
use crate::tagger::{Tag, after};
use crate::token_class::{Class, classes};

/// The pass over the tags.
struct Extractor<'a, 't> {
    tags: &'t [Tag<'a>],
    asked: QuestionWords<'a>,
    content: Content<'a>,
    scope: Option<NegationScope<'a>>,
    /// Inside a phrase that names another object as a landmark.
    landmark: bool,
    /// Inside a clause that is only wondered about ("not sure if it is white").
    wondering: bool,
    /// A repair that waits for what replaces the words before it.
    repair: Option<repair::Strength>,
    /// Number of "or" so far.
    choices: usize,
}

/// Listens to the clauses that are on topic.
pub(crate) fn extract<'a>(
    tags: &[Tag<'a>],
    clauses: &[Clause],
    asked: QuestionWords<'a>,
) -> Content<'a> {
    let mut extractor = Extractor {
        tags,
        asked,
        content: Content::default(),
        scope: None,
        landmark: false,
        wondering: false,
        repair: None,
        choices: 0,
    };
    for clause in clauses {
        extractor.landmark = false;
        if clause.topic == Topic::On {
            for at in clause.span.clone() {
                extractor.hear(clause, at);
            }
        } else {
            extractor.end_negation();
        }
    }
    extractor.end_negation();
    if extractor.repair == Some(repair::Strength::Hard) && extractor.content.answers.is_empty() {
        // "the red one, scratch that": withdrawn, and nothing put in its place.
        extractor.content.base.clear();
    }
    extractor.content
}

impl<'a> Extractor<'a, '_> {
    fn hear(&mut self, clause: &Clause, at: usize) {
        let tag = &self.tags[at];
        self.pause(tag, at);
        match tag.sense {
            Sense::Value(value) if clause.counts(at) => self.value(at, value),
            Sense::Value(_) => {}
            Sense::Unknown => self.stray(),
            Sense::Class(class) => self.class(clause, at, class),
        }
    }

    fn class(&mut self, clause: &Clause, at: usize, class: Class) {
        match class {
            Class::Determiner | Class::Quantifier | Class::Possessive => self.determiner(),
            Class::Pointer | Class::Question => self.pointer(at),
            Class::Head => self.head(at),
            Class::Preposition => self.in_negation(NegationScope::join),
            Class::Landmark | Class::Than => self.landmark = true,
            Class::Or => {
                self.content.alternatives = true;
                self.choices += usize::from(self.scope.is_none());
                self.in_negation(NegationScope::or);
            }
            Class::And => self.and(at),
            Class::But => {
                self.end_negation();
                self.wondering = false;
            }
            Class::Join => self.end_negation(),
            Class::First | Class::It | Class::Be => self.end_filled_negation(),
            Class::Unlisted => self.in_negation(NegationScope::elsewhere),
            Class::Fetch | Class::Want => self.verb(),
            Class::Not => self.not(clause, at),
            Class::Except => self.deny(at),
            Class::No => self.no(at),
            Class::Repair => self.repair(repair::Strength::Soft),
            Class::Withdraw => self.repair(repair::Strength::Hard),
            Class::Cancel | Class::StartOver if commands(self.tags, clause, class) => self.forget(),
            Class::Unsure => self.unsure(Answer::Unsure, at),
            Class::Pondering => self.unsure(Answer::Pondering, at),
            Class::Indifferent | Class::Unsaid => self.wondering = wonders_after(self.tags, at),
            Class::Hedge => self.content.hedged = true,
            _ => {}
        }
        if let Some(answer) = answer::answer(self.tags, clause, at) {
            self.content.answers.push(answer, self.tags, at);
        }
    }

    fn pause(&mut self, tag: &Tag<'_>, at: usize) {
        if !tag.pauses() {
            return;
        }
        self.landmark = false;
        self.wondering = false;
        let goes_on = tag.is_any(classes![Or And])
            || at
                .checked_sub(1)
                .is_some_and(|before| self.tags[before].is_any(classes![Or And Not Except]));
        if !goes_on || tag.gap == Gap::Stop {
            self.end_filled_negation();
        }
    }

    fn value(&mut self, at: usize, value: &'a ValueSense) {
        let refused = at > 0 && answer::is_wrong_thing(self.tags, at - 1);
        if self.landmark || self.wondering || refused {
            return;
        }
        if too_much(self.tags, at).is_some() {
            self.content.answers.push(Answer::No, self.tags, at);
            return;
        }
        if self.tags[at].is_located() {
            self.in_negation(NegationScope::join);
        }
        if let Some(scope) = &mut self.scope {
            let adjacent = at > 0 && self.tags[at - 1].is_value();
            if scope.value(value, adjacent, self.tags[at].answer_doubt()) {
                return;
            }
            self.end_negation();
        }
        if let Some(strength) = self.repair.take() {
            let new = repair::Replacement::at(self.tags, at);
            let agreed = self.agrees();
            new.replace(&mut self.content.base, strength);
            let asked = matches!(self.asked, QuestionWords::Value(_, asked) if asked == value.word);
            if agreed && !self.agrees() || asked && self.content.answers.denies() {
                // "yes, the pen, no, the marker": the yes goes with the pen; "no, wait, it is
                // black": and the no with what is said now.
                self.content.answers.clear();
            }
            // "not the red one, I mean the red one": taken back in so many words.
            let restated = |group: &Excluded| group.words[..] == [value.word];
            self.content.excluded.retain(|group| !restated(group));
        } else if repair::is_stumble(self.tags, at) {
            let new = repair::Replacement::at(self.tags, at);
            new.replace(&mut self.content.base, repair::Strength::Stumble);
        }
        let doubt = self.tags[at].word_doubt();
        self.content.base.push(Asserted { value, at, doubt, choice: self.choices });
    }

    /// Returns whether the value asked about is among those said.
    fn agrees(&self) -> bool {
        let QuestionWords::Value(_, asked) = self.asked else { return false };
        self.content.base.iter().any(|value| value.word == asked)
    }

    fn determiner(&mut self) {
        if self.scope.as_mut().is_some_and(|scope| !scope.determiner()) {
            self.end_negation();
        }
    }

    /// "that", "which": a determiner, or the start of a clause about what was just named.
    fn pointer(&mut self, at: usize) {
        let relative =
            self.tags.get(at + 1).is_some_and(|next| next.is_any(classes![Be Auxiliary Likely]));
        if relative { self.in_negation(NegationScope::join) } else { self.determiner() }
    }

    /// A noun ends what is denied, but for "anything tight", whose quality follows it.
    fn head(&mut self, at: usize) {
        let indefinite = matches!(self.tags[at].word, "anything" | "something" | "everything");
        if !(indefinite && after(self.tags, at).is_some_and(Tag::is_value)) {
            self.in_negation(NegationScope::head);
        }
    }

    fn and(&mut self, at: usize) {
        self.wondering = false;
        let next = self.tags.get(at + 1);
        let listed = next
            .is_some_and(|next| next.is_value() || next.is_any(classes![Determiner Preposition]));
        if listed { self.in_negation(NegationScope::and) } else { self.end_filled_negation() }
    }

    fn verb(&mut self) {
        self.wondering = false;
        if self.scope.as_ref().is_some_and(|scope| !scope.reaches_verb()) {
            self.end_negation();
        }
    }

    fn stray(&mut self) {
        if self.scope.as_mut().is_some_and(|scope| !scope.stray()) {
            self.end_negation();
        }
    }

    fn not(&mut self, clause: &Clause, at: usize) {
        if negation::is_rhetorical(self.tags, clause, at) {
            return;
        }
        self.deny(at);
        if negation::is_whole_answer(self.tags, clause, at) {
            self.content.answers.push(Answer::No, self.tags, at);
            self.scope = None;
        }
    }

    fn deny(&mut self, at: usize) {
        self.end_negation();
        self.scope = Some(NegationScope::new(self.tags[at].answer_doubt()));
    }

    fn no(&mut self, at: usize) {
        match negation::use_of_no(self.tags, at, &self.content.base, self.asked) {
            NoUse::Answer => {
                self.end_filled_negation();
                self.content.answers.push(Answer::No, self.tags, at);
            }
            NoUse::Repair => self.repair(repair::Strength::Hard),
            NoUse::Determiner => self.deny(at),
        }
    }

    fn repair(&mut self, strength: repair::Strength) {
        self.end_negation();
        self.landmark = false;
        self.repair = Some(self.repair.map_or(strength, |before| before.max(strength)));
    }

    /// "never mind, the red one": nothing said before counts.
    fn forget(&mut self) {
        self.end_negation();
        self.repair = None;
        self.content.clear();
    }

    fn unsure(&mut self, answer: Answer, at: usize) {
        self.content.answers.push(answer, self.tags, at);
        self.wondering = wonders_after(self.tags, at);
    }

    fn in_negation(&mut self, change: impl FnOnce(&mut NegationScope<'a>)) {
        if let Some(scope) = &mut self.scope {
            change(scope);
        }
    }

    /// Ends a scope that has said something; one that has not waits on.
    fn end_filled_negation(&mut self) {
        if self.scope.as_ref().is_some_and(|scope| !scope.is_pending()) {
            self.end_negation();
        }
    }

    fn end_negation(&mut self) {
        let Some(scope) = self.scope.take() else { return };
        for group in scope.into_groups() {
            if self.asked.is_denied_by(&group.words) {
                self.content.answers.push_negation(group.doubt);
            }
            self.content.exclude(group);
        }
    }
}

/// "not sure if it is white", "I don't care what colour", "it doesn't have to be white".
pub(crate) fn wonders_after(tags: &[Tag<'_>], at: usize) -> bool {
    let open = matches!(tags[at].word, "does" | "do" | "need" | "it" | "i" | "at");
    let ends = after(tags, at + 1).is_none_or(|tag| tag.is_any(classes![Courtesy Filler]));
    after(tags, at).is_some_and(|next| {
        // "I don't care which"
        next.is_any(classes![Join Preposition])
            || next.is(Class::Question) && !ends
            || open && (next.is_value() || next.is(Class::Determiner))
    })
}
