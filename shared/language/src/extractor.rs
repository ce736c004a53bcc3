//! Content of an utterance, given the fates of its values: one pass from left to right.

use words::Gap;

use crate::answer::{self, Answer};
use crate::clauses::{Clause, Topic};
use crate::content::{Asserted, Content};
use crate::fates::{Fates, Polarity};
use crate::intent::{commands, is_conditional};
use crate::lexicon::{Sense, ValueSense};
use crate::negation;
use crate::negation_scope::NegationScope;
use crate::question_words::QuestionWords;
use crate::related::too_much;
use crate::tagger::{Tag, after};
use crate::token_class::{Class, classes};

/// The pass over the tags.
struct Extractor<'a, 't> {
    tags: &'t [Tag<'a>],
    fates: &'t Fates,
    asked: QuestionWords<'a>,
    content: Content<'a>,
    /// The noun phrases that are being ruled out.
    scope: Option<NegationScope<'a>>,
    /// Inside a phrase that names another object: "next to the clear one".
    landmark: bool,
    /// Earlier words have been retracted, and their replacement is still to come.
    corrects: bool,
    /// Number of "or" so far.
    choices: usize,
}

/// Listens to the clauses that are on topic.
pub(crate) fn extract<'a>(
    tags: &[Tag<'a>],
    clauses: &[Clause],
    fates: &Fates,
    asked: QuestionWords<'a>,
) -> Content<'a> {
    let content = Content::default();
    let (scope, landmark, corrects, choices) = (None, false, false, 0);
    let mut extractor =
        Extractor { tags, fates, asked, content, scope, landmark, corrects, choices };
    for clause in clauses {
        extractor.landmark = false;
        if clause.topic == Topic::On {
            clause.span.clone().for_each(|at| extractor.hear(clause, at));
        } else {
            extractor.end_scope();
        }
    }
    extractor.end_scope();
    extractor.content
}

impl<'a> Extractor<'a, '_> {
    fn hear(&mut self, clause: &Clause, at: usize) {
        let tag = &self.tags[at];
        self.pause(tag, at);
        match tag.sense {
            Sense::Value(value) => self.value(at, value),
            Sense::Unknown => {}
            Sense::Class(class) => self.class(clause, at, class),
        }
    }

    fn class(&mut self, clause: &Clause, at: usize, class: Class) {
        match class {
            Class::Determiner | Class::Quantifier | Class::Possessive => self.determiner(),
            Class::Pointer | Class::Question => self.pointer(at),
            Class::Head => self.in_scope(NegationScope::head),
            Class::Preposition => self.in_scope(NegationScope::join),
            Class::Landmark => self.landmark = true,
            Class::Or => {
                self.content.alternatives = true;
                self.choices += usize::from(self.scope.is_none());
                self.in_scope(NegationScope::or);
            }
            Class::And => self.and(at),
            Class::But | Class::Join => self.end_scope(),
            Class::First | Class::It | Class::Be | Class::Fetch | Class::Want => {
                self.landmark = false;
                self.end_scope();
            }
            Class::Not => self.not(clause, at),
            Class::No => self.no(at),
            Class::Repair | Class::Withdraw => self.correct(),
            Class::Cancel | Class::StartOver if commands(self.tags, clause, class) => {
                self.end_scope();
                // "never mind, the red one": nothing said before counts.
                if class == Class::StartOver || !is_conditional(self.tags, at) {
                    self.content.clear();
                }
            }
            Class::Unsure => self.content.answers.push(Answer::Unsure, self.tags, at),
            Class::Pondering => self.content.answers.push(Answer::Pondering, self.tags, at),
            Class::Hedge => self.content.hedged = true,
            _ => {}
        }
        if let Some(answer) = answer::answer(self.tags, clause, at) {
            self.content.answers.push(answer, self.tags, at);
        }
    }

    fn pause(&mut self, tag: &Tag<'_>, at: usize) {
        self.landmark &= !tag.pauses();
        let goes_on = tag.is_any(classes![Or And])
            || at
                .checked_sub(1)
                .is_some_and(|before| self.tags[before].is_any(classes![Or And Not Except]));
        if tag.pauses() && (!goes_on || tag.gap == Gap::Stop) {
            self.end_scope();
        }
    }

    fn value(&mut self, at: usize, value: &'a ValueSense) {
        let tag = &self.tags[at];
        if too_much(self.tags, at).is_some() {
            self.content.answers.push(Answer::No, self.tags, at);
        }
        match self.fates.of(at) {
            Polarity::Wanted if self.landmark => {}
            Polarity::Neither => self.end_scope(),
            Polarity::Denied => self.deny(at, value),
            Polarity::Wanted => {
                self.end_scope();
                if std::mem::take(&mut self.corrects) {
                    self.content.answers.clear();
                }
                let (doubt, choice) = (tag.word_doubt(), self.choices);
                self.content.base.push(Asserted { value, at, doubt, choice });
            }
        }
    }

    fn deny(&mut self, at: usize, value: &'a ValueSense) {
        if self.tags[at].is_located() {
            self.in_scope(NegationScope::join);
        }
        let (doubt, adjacent) =
            (self.tags[at].answer_doubt(), at > 0 && self.tags[at - 1].is_value());
        let is_in = |scope: &mut NegationScope<'a>| scope.value(value, adjacent, doubt);
        if !self.scope.as_mut().is_some_and(is_in) {
            self.end_scope();
            let mut scope = NegationScope::new(negator_doubt(self.tags, at));
            scope.value(value, adjacent, doubt);
            self.scope = Some(scope);
        }
    }

    fn determiner(&mut self) {
        if self.scope.as_mut().is_some_and(|scope| !scope.determiner()) {
            self.end_scope();
        }
    }

    /// "that", "which": a determiner, or the start of a clause about the thing just named.
    fn pointer(&mut self, at: usize) {
        let relative =
            self.tags.get(at + 1).is_some_and(|next| next.is_any(classes![Be Auxiliary Likely]));
        if relative { self.in_scope(NegationScope::join) } else { self.determiner() }
    }

    fn and(&mut self, at: usize) {
        let next = self.tags.get(at + 1);
        let listed = next
            .is_some_and(|next| next.is_value() || next.is_any(classes![Determiner Preposition]));
        if listed { self.in_scope(NegationScope::and) } else { self.end_scope() }
    }

    fn not(&mut self, clause: &Clause, at: usize) {
        self.end_scope();
        if !negation::is_rhetorical(self.tags, clause, at)
            && negation::is_whole_answer(self.tags, clause, at)
        {
            self.content.answers.push(Answer::No, self.tags, at);
        }
    }

    /// An answer, but for "with no metal" and "the red, no, the blue one".
    fn no(&mut self, at: usize) {
        self.end_scope();
        let is_denied = |at: usize| self.fates.of(at) == Polarity::Denied;
        let next = after(self.tags, at).filter(|next| next.is_value());
        let determines = self.tags[at].word == "no" && next.is_some() && is_denied(at + 1);
        let corrects = self.tags[..at].iter().any(Tag::is_value) && self.leads_to_wish(at);
        if corrects {
            self.correct();
        } else if !determines {
            self.content.answers.push(Answer::No, self.tags, at);
        }
    }

    /// Returns whether a value is wanted soon, before the sentence ends or turns.
    fn leads_to_wish(&self, at: usize) -> bool {
        const REACH: usize = 10;
        let rest = self.tags.iter().enumerate().skip(at + 1).take(REACH);
        let ends = |(n, tag): &(usize, &Tag<'_>)| {
            tag.is_any(classes![Not Except]) || *n > at + 1 && tag.gap == Gap::Stop
        };
        let mut values = rest.take_while(|it| !ends(it)).filter(|(_, tag)| tag.is_value());
        values.next().is_some_and(|(n, _)| self.fates.of(n) == Polarity::Wanted)
    }

    fn correct(&mut self) {
        self.end_scope();
        self.landmark = false;
        self.corrects = !self.content.answers.is_empty();
    }

    fn in_scope(&mut self, change: impl FnOnce(&mut NegationScope<'a>)) {
        if let Some(scope) = &mut self.scope {
            change(scope);
        }
    }

    fn end_scope(&mut self) {
        let Some(scope) = self.scope.take() else { return };
        for group in scope.into_groups() {
            if self.asked.is_denied_by(&group.words) {
                self.content.answers.push_negation(group.doubt);
            }
            self.content.exclude(group);
        }
    }
}

/// Probability that the last negation before a value was not said.
fn negator_doubt(tags: &[Tag<'_>], at: usize) -> f64 {
    let negates = |tag: &&Tag<'_>| tag.is_any(classes![Not No Except]);
    tags[..at].iter().rfind(negates).map_or(0.0, Tag::answer_doubt)
}
