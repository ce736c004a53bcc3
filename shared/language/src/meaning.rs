//! What the marks add up to: values asserted, groups ruled out, answers given. One pass from left
//! to right, as a listener goes.

use std::ops::Deref;

use scene::{Role, WordId};

use crate::answer::{self, Answer, Answers};
use crate::asked::Asked;
use crate::clauses::{Clause, Topic};
use crate::cue::{Cue, cues};
use crate::denial::Denial;
use crate::intent::commands;
use crate::lexicon::{Lexicon, Sense, ValueSense};
use crate::marks::Mark;
use crate::negation::{self, NoUse};
use crate::repair;
use crate::tokens::Gap;

/// A value that the wanted object is said to have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Said<'a> {
    value: &'a ValueSense,
    /// Probability that something else was meant.
    pub(crate) doubt: f64,
    /// How many times "or" was said before it.
    pub(crate) choice: usize,
}

impl Deref for Said<'_> {
    type Target = ValueSense;

    fn deref(&self) -> &ValueSense {
        self.value
    }
}

/// A group of values that is ruled out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Denied {
    pub(crate) words: Vec<WordId>,
    /// Probability that this was not said.
    pub(crate) doubt: f64,
}

/// What an utterance says.
#[derive(Debug, Default)]
pub(crate) struct Meaning<'a> {
    /// Values that the wanted object is said to have.
    pub(crate) base: Vec<Said<'a>>,
    /// Groups that are ruled out.
    pub(crate) excluded: Vec<Denied>,
    /// Answers in the order given.
    pub(crate) answers: Answers,
    /// "maybe": what is said does not amount to an answer.
    pub(crate) hedged: bool,
    /// "red or blue": alternatives, not a description.
    pub(crate) alternatives: bool,
}

/// The pass over the marks.
struct Listener<'a, 'm> {
    lexicon: &'a Lexicon,
    marks: &'m [Mark<'m>],
    asked: Asked<'a>,
    meaning: Meaning<'a>,
    denial: Option<Denial<'a>>,
    /// Inside a phrase that names another object as a landmark.
    landmark: bool,
    /// Inside a clause that is only wondered about ("not sure if it is white").
    wondering: bool,
    /// A repair that waits for what replaces the words before it.
    repair: Option<repair::Strength>,
    /// How many times "or" was said.
    choices: usize,
}

/// Listens to the clauses that are on topic.
pub(crate) fn listen<'a>(
    lexicon: &'a Lexicon,
    marks: &[Mark<'_>],
    clauses: &[Clause],
    asked: Asked<'a>,
) -> Meaning<'a> {
    let mut listener = Listener {
        lexicon,
        marks,
        asked,
        meaning: Meaning::default(),
        denial: None,
        landmark: false,
        wondering: false,
        repair: None,
        choices: 0,
    };
    for clause in clauses {
        listener.landmark = false;
        if clause.topic == Topic::On {
            for at in clause.marks.clone() {
                listener.hear(clause, at);
            }
        } else {
            listener.end_denial();
        }
    }
    listener.end_denial();
    if listener.repair == Some(repair::Strength::Hard) && listener.meaning.answers.is_empty() {
        // "the red one, scratch that": withdrawn, and nothing put in its place.
        listener.meaning.base.clear();
    }
    listener.meaning
}

impl<'a> Listener<'a, '_> {
    fn hear(&mut self, clause: &Clause, at: usize) {
        let mark = &self.marks[at];
        self.pause(mark, at);
        match mark.sense {
            Sense::Value(value) if clause.counts(at) => self.value(at, self.lexicon.value(value)),
            Sense::Value(_) => {}
            Sense::Unknown => self.stray(),
            Sense::Cue(cue) => self.cue(clause, at, cue),
        }
    }

    fn cue(&mut self, clause: &Clause, at: usize, cue: Cue) {
        match cue {
            Cue::Determiner | Cue::Quantifier | Cue::Possessive => self.determiner(),
            Cue::Pointer | Cue::Question => self.pointer(at),
            Cue::Head => self.head(at),
            Cue::Preposition => self.on_denial(Denial::join),
            Cue::Landmark | Cue::Than => self.landmark = true,
            Cue::Or => {
                self.meaning.alternatives = true;
                self.choices += usize::from(self.denial.is_none());
                self.on_denial(Denial::or);
            }
            Cue::And => self.and(at),
            Cue::But => {
                self.end_denial();
                self.wondering = false;
            }
            Cue::Join => self.end_denial(),
            Cue::First | Cue::It | Cue::Be => self.end_said_denial(),
            Cue::Unlisted => self.on_denial(Denial::elsewhere),
            Cue::Fetch | Cue::Want => self.verb(),
            Cue::Not => self.not(clause, at),
            Cue::Except => self.deny(at),
            Cue::No => self.no(at),
            Cue::Repair => self.repair(repair::Strength::Soft),
            Cue::Withdraw => self.repair(repair::Strength::Hard),
            Cue::Cancel | Cue::StartOver if commands(self.marks, clause, cue) => self.forget(),
            Cue::Unsure => self.unsure(at),
            Cue::Indifferent => self.wondering = self.wonders_after(at),
            Cue::Hedge => self.meaning.hedged = true,
            _ => {}
        }
        if let Some(answer) = answer::answer(self.marks, clause, at) {
            self.meaning.answers.push(answer, self.marks, at);
        }
    }

    fn pause(&mut self, mark: &Mark<'_>, at: usize) {
        if mark.gap < Gap::Pause {
            return;
        }
        self.landmark = false;
        self.wondering = false;
        let goes_on = mark.is_any(cues![Or And])
            || at
                .checked_sub(1)
                .is_some_and(|before| self.marks[before].is_any(cues![Or And Not Except]));
        if !goes_on || mark.gap == Gap::Stop {
            self.end_said_denial();
        }
    }

    fn value(&mut self, at: usize, value: &'a ValueSense) {
        if self.landmark || self.wondering {
            return;
        }
        if let Some(denial) = &mut self.denial {
            let adjacent = at > 0 && self.marks[at - 1].value().is_some();
            if denial.value(value, adjacent, self.marks[at].answer_doubt()) {
                return;
            }
            self.end_denial();
        }
        if let Some(strength) = self.repair.take() {
            let new = repair::Replacement::at(self.lexicon, self.marks, at);
            let agreed = self.agrees();
            new.replace(&mut self.meaning.base, strength);
            let asked = matches!(self.asked, Asked::Value(_, asked) if asked == value.word);
            if agreed && !self.agrees() || asked && self.meaning.answers.denies() {
                // "yes, the pen, no, the marker": the yes goes with the pen; "no, wait, it is
                // black": and the no with what is said now.
                self.meaning.answers.clear();
            }
            // "not the red one, I mean the red one": taken back in so many words.
            let restated = |group: &Denied| group.words[..] == [value.word];
            self.meaning.excluded.retain(|group| !restated(group));
        } else if repair::is_stumble(self.lexicon, self.marks, at) {
            let new = repair::Replacement::at(self.lexicon, self.marks, at);
            new.replace(&mut self.meaning.base, repair::Strength::Stumble);
        }
        let doubt = self.marks[at].word_doubt();
        self.meaning.base.push(Said { value, doubt, choice: self.choices });
    }

    /// Whether the value asked about is among those said.
    fn agrees(&self) -> bool {
        let Asked::Value(_, asked) = self.asked else { return false };
        self.meaning.base.iter().any(|value| value.word == asked)
    }

    fn determiner(&mut self) {
        if self.denial.as_mut().is_some_and(|denial| !denial.determiner()) {
            self.end_denial();
        }
    }

    /// "that", "which": a determiner, or the start of a clause about what was just named.
    fn pointer(&mut self, at: usize) {
        let relative =
            self.marks.get(at + 1).is_some_and(|next| next.is_any(cues![Be Auxiliary Likely]));
        if relative { self.on_denial(Denial::join) } else { self.determiner() }
    }

    /// A noun ends what is denied, but for "anything tight", whose quality follows it.
    fn head(&mut self, at: usize) {
        let indefinite = matches!(self.marks[at].word, "anything" | "something" | "everything");
        let next = self.marks.get(at + 1).filter(|next| next.gap <= Gap::None);
        if !(indefinite && next.is_some_and(|next| next.value().is_some())) {
            self.on_denial(Denial::head);
        }
    }

    fn and(&mut self, at: usize) {
        self.wondering = false;
        let next = self.marks.get(at + 1);
        let listed = next.is_some_and(|next| {
            next.value().is_some() || next.is_any(cues![Determiner Preposition])
        });
        if listed { self.on_denial(Denial::and) } else { self.end_said_denial() }
    }

    fn verb(&mut self) {
        self.wondering = false;
        if self.denial.as_ref().is_some_and(|denial| !denial.reaches_verb()) {
            self.end_denial();
        }
    }

    fn stray(&mut self) {
        if self.denial.as_mut().is_some_and(|denial| !denial.stray()) {
            self.end_denial();
        }
    }

    fn not(&mut self, clause: &Clause, at: usize) {
        if negation::is_rhetorical(self.marks, clause, at) {
            return;
        }
        self.deny(at);
        if negation::is_whole_answer(self.marks, clause, at) {
            self.meaning.answers.push(Answer::No, self.marks, at);
            self.denial = None;
        }
    }

    fn deny(&mut self, at: usize) {
        self.end_denial();
        self.denial = Some(Denial::new(self.marks[at].answer_doubt()));
    }

    fn no(&mut self, at: usize) {
        match negation::use_of_no(self.lexicon, self.marks, at, &self.meaning.base, self.asked) {
            NoUse::Answer => {
                self.end_said_denial();
                self.meaning.answers.push(Answer::No, self.marks, at);
            }
            NoUse::Repair => self.repair(repair::Strength::Hard),
            NoUse::Determiner => self.deny(at),
        }
    }

    fn repair(&mut self, strength: repair::Strength) {
        self.end_denial();
        self.landmark = false;
        self.repair = Some(self.repair.map_or(strength, |before| before.max(strength)));
    }

    /// "never mind, the red one": nothing said before counts.
    fn forget(&mut self) {
        self.end_denial();
        self.repair = None;
        self.meaning.base.clear();
        self.meaning.excluded.clear();
        self.meaning.answers.clear();
    }

    fn unsure(&mut self, at: usize) {
        self.meaning.answers.push(Answer::Unsure, self.marks, at);
        self.wondering = self.wonders_after(at);
    }

    /// "not sure if it is white", "I don't care what colour", "it doesn't have to be white".
    fn wonders_after(&self, at: usize) -> bool {
        let next = self.marks.get(at + 1).filter(|next| next.gap <= Gap::None);
        let open = matches!(self.marks[at].word, "does" | "do" | "need" | "it" | "i" | "at");
        next.is_some_and(|next| {
            next.is_any(cues![Join Question Preposition])
                || open && (next.value().is_some() || next.is(Cue::Determiner))
        })
    }

    fn on_denial(&mut self, change: impl FnOnce(&mut Denial<'a>)) {
        if let Some(denial) = &mut self.denial {
            change(denial);
        }
    }

    /// Ends a denial that has said something; one that has not waits on.
    fn end_said_denial(&mut self) {
        if self.denial.as_ref().is_some_and(|denial| !denial.is_pending()) {
            self.end_denial();
        }
    }

    fn end_denial(&mut self) {
        let Some(denial) = self.denial.take() else { return };
        for group in denial.into_groups() {
            if self.asked.is_denied_by(&group.words) {
                self.meaning.answers.push_denial(group.doubt);
            }
            // "the red one, no, not the red one": the denial stands.
            if let [word] = group.words[..] {
                self.meaning.base.retain(|value| value.word != word);
            }
            let known = self.meaning.excluded.iter_mut().find(|known| known.words == group.words);
            match known {
                // Said twice, it is doubted as the surer one is.
                Some(known) => known.doubt = known.doubt.min(group.doubt),
                None => self.meaning.excluded.push(group),
            }
        }
    }
}

/// Whether two values say something about the same attribute.
pub(crate) fn rivals(a: &ValueSense, b: &ValueSense) -> bool {
    a.attributes.iter().any(|k| b.attributes.contains(k))
}

/// Whether a value says where something is.
pub(crate) fn is_place(value: &ValueSense) -> bool {
    value.role == Role::Place
}
