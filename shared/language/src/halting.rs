//! Words that halt the arm: orders to stop, requests to wait, and phrases about pain or danger.
//!
//! The judgement rests on the robot's own words alone, so that no scene can take them away, and on
//! nothing else: the words that halt the arm are those that the dialogue takes for an order to
//! stop. It errs on the side of one halt too many.

mod patterns;

use std::ops::{Range, RangeInclusive};

use words::{Gap, Token, Tokens, normalise};

use self::patterns::{Element, PATTERNS, Place, WordNumber};
use crate::lexicon::{Lexicon, Sense};
use crate::spelling::shortened;
use crate::token_class::{Class, classes};

/// Phrases that say nothing before a command or after it.
const BESIDE: &[Class] = classes![Filler Courtesy No Yes Repair WeakYes And But Join Plain];

/// Returns whether the words halt the arm. That is a matter of safety: it depends neither on the
/// scene nor on the language, and the careful reading of such words is always a stop.
pub fn is_stop(text: &str) -> bool {
    !halting_words(&Tokens::of(&normalise(text))).is_empty()
}

/// Returns the positions of the words that halt the arm, in order; empty without such words.
pub(crate) fn halting_words(tokens: &Tokens<'_>) -> Vec<Range<usize>> {
    Utterance::new(tokens).halting_words()
}

/// Returns whether the words ask to continue after a stop, and nothing else.
pub(crate) fn asks_to_go_on(tokens: &Tokens<'_>) -> bool {
    let beside = classes![Filler Courtesy Yes WeakYes And But Plain];
    Utterance::new(tokens).is_alone(Place::Resuming, beside)
}

struct Utterance<'t, 'a> {
    tokens: &'t [Token<'a>],
    /// Numbers of each word, and of its candidates if it was lengthened: "stoooop".
    forms: Vec<[Option<WordNumber>; 3]>,
    /// Places of the patterns that may begin with each token.
    begins: Vec<u8>,
    own: &'static Lexicon,
    code: bool,
}

impl<'t, 'a> Utterance<'t, 'a> {
    fn new(tokens: &'t Tokens<'a>) -> Self {
        let own = Lexicon::own();
        let forms: Vec<_> = tokens.words.iter().map(|token| forms_of(own, token.word)).collect();
        let places = |forms: &[Option<WordNumber>; 3]| {
            forms
                .iter()
                .flatten()
                .fold(0, |places, word| places | PATTERNS.beginnings(*word).places)
        };
        let begins = forms.iter().map(places).collect();
        Self { tokens: &tokens.words, forms, begins, own, code: tokens.code }
    }

    /// Returns whether a pattern of that place may begin there.
    fn may_begin(&self, place: Place, at: usize) -> bool {
        self.begins[at] & place.bit() != 0
    }

    fn halting_words(&self) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        for breath in self.breaths() {
            self.commands(breath, &mut found);
            if self.code {
                break;
            }
        }
        if found.is_empty() && self.is_alone(Place::Alone, classes![Filler Courtesy WeakYes]) {
            found.push(0..self.tokens.len());
        }
        if found.is_empty() {
            let is_dangerous = |breath: &Range<usize>| self.is_danger(breath.clone());
            found.extend(self.breaths().filter(is_dangerous));
            if !found.is_empty() && self.asks_or_tells() {
                found.clear();
            }
        }
        found
    }

    /// The stretches between pauses.
    fn breaths(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let mut start = 0;
        std::iter::from_fn(move || {
            let from = (start < self.tokens.len()).then_some(start)?;
            let more = self.tokens[from + 1..].iter().take_while(|token| !token.pauses());
            start = from + 1 + more.count();
            Some(from..start)
        })
    }

    /// Adds the orders to halt in one breath.
    fn commands(&self, breath: Range<usize>, found: &mut Vec<Range<usize>>) {
        let Some(last) = breath.clone().rfind(|at| self.may_begin(Place::Command, *at)) else {
            return;
        };
        let mut at = breath.start;
        let mut opens = true;
        while at <= last {
            let phrase = self.own.longest(self.tokens, at);
            let phrase_words = phrase.as_ref().map_or(1, |phrase| phrase.words);
            let class = phrase.and_then(|phrase| class(phrase.sense));
            let ends = !opens && self.is_called_out(at, &breath);
            if opens || ends {
                // Cried to whoever can stop the robot, by any name: "stop Robbie".
                let is_cry = opens && PATTERNS.is_in("cries", self.tokens[at].word);
                let is_whole = |words: &usize| {
                    *words >= phrase_words
                        && !self.is_joined(at + words, breath.end, is_cry && *words == 1)
                        && (opens || at + words == breath.end)
                };
                let commands = self.matches(Place::Command, at, breath.end);
                if let Some(words) = commands.filter(is_whole).max() {
                    found.push(at..at + words);
                    at += words;
                    continue;
                }
            }
            let lead = self.longest(Place::Lead, at, breath.end).filter(|_| opens);
            let is_lead = |class: Class| BESIDE.contains(&class);
            let joins =
                class.is_some_and(|class| matches!(class, Class::And | Class::But | Class::Join));
            opens = joins || opens && (lead.is_some() || class.is_some_and(is_lead));
            at += lead.unwrap_or(0).max(phrase_words);
        }
    }

    /// "the white one stop", "what are you doing stop": called out at the end of a breath.
    fn is_called_out(&self, at: usize, breath: &Range<usize>) -> bool {
        const BEFORE: &[Class] = classes![One Head It No Yes WeakYes Courtesy Filler];
        let before = self.own.word(self.tokens[at - 1].word).and_then(class);
        let is_called = before.is_some_and(|class| BEFORE.contains(&class))
            || self.tokens[at].word == "stop" && !self.is_no_order(breath.start, at);
        is_called && !self.is_denied(&self.tokens[breath.start..at])
    }

    /// Returns whether a negator governs the word after these: "don't", "don't ever let it", "I do
    /// not want you to", but not "it's not safe" and "I don't want it". "Can't you" asks for it.
    fn is_denied(&self, before: &[Token<'_>]) -> bool {
        let before = &before[before.len().saturating_sub(8)..];
        let is_in = |set: &str, word: &str| PATTERNS.is_in(set, word);
        let Some(not) = before.iter().rposition(|token| is_in("negators", token.word)) else {
            return false;
        };
        let plain = before[not + 1..].iter().map(|token| token.word);
        let between: Vec<&str> = plain.filter(|word| !is_in("emphasis", word)).collect();
        match between[..] {
            ["you"] => !before[..not].iter().any(|token| is_in("requesting", token.word)),
            [who] | ["let", who] => is_in("subjects", who),
            [want, "to"] => is_in("wishes", want),
            [want, who, "to"] => is_in("wishes", want) && is_in("subjects", who),
            _ => between.is_empty(),
        }
    }

    /// "the bus stop", "did you stop", "how to stop", but not "you should stop": no order.
    fn is_no_order(&self, start: usize, at: usize) -> bool {
        let is_in = |set: &str, back: usize| {
            at >= start + back && PATTERNS.is_in(set, self.tokens[at - back].word)
        };
        let is_told = is_in("subjects", 1) && is_in("asking", 2);
        let is_bidden = is_in("bidding", 1) && is_in("bidden", 2);
        is_in("naming", 1) || is_in("asking", 1) && !is_bidden || is_told
    }

    /// "stop sign", "hold it in": the rest belongs to the words before.
    fn is_joined(&self, at: usize, end: usize, is_cry: bool) -> bool {
        let Some(next) = self.tokens[..end].get(at) else { return false };
        if next.gap == Gap::Glued {
            return true;
        }
        if is_cry {
            return PATTERNS.is_in("compounds", next.word)
                && self.longest(Place::Command, at, end).is_none();
        }
        let is_doing =
            next.word.len() > 4 && (next.word.ends_with("ing") || next.word.ends_with("ly"));
        match self.own.longest(self.tokens, at).and_then(|phrase| class(phrase.sense)) {
            Some(class) => class == Class::Preposition,
            None => !is_doing && self.longest(Place::Command, at, end).is_none(),
        }
    }

    /// "one moment please": patterns of that place, and nothing else but words of the classes.
    fn is_alone(&self, place: Place, beside: &[Class]) -> bool {
        if !(0..self.tokens.len()).any(|at| self.may_begin(place, at)) {
            return false;
        }
        let (mut at, mut found) = (0, false);
        while at < self.tokens.len() {
            let words = self.longest(place, at, self.tokens.len());
            found |= words.is_some();
            if let Some(words) = words.or_else(|| self.longest(Place::Lead, at, self.tokens.len()))
            {
                at += words;
                continue;
            }
            let phrase = self.own.longest(self.tokens, at);
            let is_beside = |class: Class| beside.contains(&class);
            match phrase {
                Some(phrase) if class(phrase.sense).is_some_and(is_beside) => at += phrase.words,
                _ => return false,
            }
        }
        found
    }

    /// Returns whether something is requested, or told of another day: no danger in either case.
    fn asks_or_tells(&self) -> bool {
        let mut at = 0;
        while at < self.tokens.len() {
            let Some(phrase) = self.own.longest(self.tokens, at) else {
                at += 1;
                continue;
            };
            match class(phrase.sense) {
                Some(Class::Want | Class::When) => return true,
                Some(Class::Fetch) if self.is_verb(at) => return true,
                _ => at += phrase.words,
            }
        }
        self.tokens.iter().any(|token| matches!(token.word, "if" | "unless" | "case"))
    }

    /// "hand me", but not "my hand" and "hand stuck".
    fn is_verb(&self, at: usize) -> bool {
        const AFTER: [&str; 12] =
            ["me", "us", "over", "it", "the", "a", "an", "them", "that", "this", "him", "her"];
        let next = self.tokens.get(at + 1);
        self.tokens[at].word != "hand"
            || next.is_some_and(|next| !next.pauses() && AFTER.contains(&next.word))
    }

    fn is_danger(&self, breath: Range<usize>) -> bool {
        let denied = |token: &Token<'_>| matches!(token.word, "not" | "never" | "no" | "without");
        let mut places = breath.clone().take_while(|at| !denied(&self.tokens[*at]));
        let end = self.tokens.len();
        places.any(|at| {
            self.may_begin(Place::Danger, at)
                && !self.relates(at, breath.start)
                && self.longest(Place::Danger, at, end).is_some()
        })
    }

    /// "the dog that hurt the child", but not "oh, that hurt".
    fn relates(&self, at: usize, start: usize) -> bool {
        let Some(before) = self.tokens[start..at].last() else { return false };
        let is_beside = |word: &str| {
            self.own.word(word).and_then(class).is_some_and(|class| BESIDE.contains(&class))
        };
        matches!(before.word, "that" | "who" | "which" | "to")
            || self.tokens[at].word == "that" && !is_beside(before.word)
    }

    /// Number of words of the longest pattern of that place that starts at `at`.
    fn longest(&self, place: Place, at: usize, end: usize) -> Option<usize> {
        self.matches(place, at, end).max()
    }

    /// Number of words of every pattern of that place that starts at `at`.
    fn matches(&self, place: Place, at: usize, end: usize) -> impl Iterator<Item = usize> {
        let begins = self.may_begin(place, at).then(|| self.forms[at].iter().flatten());
        let beginnings = begins.into_iter().flatten().map(|word| PATTERNS.beginnings(*word));
        let patterns = beginnings.flat_map(|it| &it.patterns);
        let of_place = patterns.filter(move |pattern| pattern.place == place);
        of_place.filter_map(move |pattern| self.matched(&pattern.elements, at, end))
    }

    fn matched(&self, elements: &[Element], from: usize, end: usize) -> Option<usize> {
        let mut at = from;
        let mut paused = true;
        for element in elements {
            let pauses = self.tokens[..end].get(at).is_some_and(Token::pauses);
            match element {
                Element::Pause => {
                    pauses.then_some(())?;
                    paused = true;
                    continue;
                }
                Element::End => {
                    self.is_end(at, end).then_some(())?;
                    return Some(at - from);
                }
                _ if at >= end || pauses && !paused => return None,
                Element::Any => {}
                Element::Words(words) => {
                    let fits = |form: &WordNumber| words.binary_search(form).is_ok();
                    self.forms[at].iter().flatten().any(fits).then_some(())?;
                }
            }
            at += 1;
            paused = false;
        }
        Some(at - from)
    }

    /// Returns whether nothing follows but courtesies.
    fn is_end(&self, mut at: usize, end: usize) -> bool {
        while at < end {
            let Some(phrase) = self.own.longest(self.tokens, at) else { return false };
            let ends = |class: Class| {
                matches!(class, Class::Filler | Class::Courtesy | Class::WeakYes | Class::No)
                    || matches!(
                        self.tokens[at].word,
                        "now" | "here" | "there" | "immediately" | "and"
                    )
            };
            let again = self.longest(Place::Command, at, end).is_some();
            if !again && !class(phrase.sense).is_some_and(ends) {
                return false;
            }
            at += phrase.words;
        }
        true
    }
}

/// Returns the numbers of a word, and of its candidates if it is lengthened and unknown.
fn forms_of(own: &Lexicon, word: &str) -> [Option<WordNumber>; 3] {
    let number = |word: &str| PATTERNS.numbers.get(word).copied();
    let begins = |word: WordNumber| PATTERNS.beginnings(word).places != 0;
    let as_it_stands = number(word);
    let is_known = || as_it_stands.is_some_and(begins) || own.word(word).is_some();
    if is_known() {
        return [as_it_stands, None, None];
    }
    match shortened(word) {
        Some([two, one]) => [as_it_stands, number(&two), number(&one)],
        None => [as_it_stands, order_out_of_order(own, word), None],
    }
}

/// "stpo": a word of an order, two letters of which have changed places.
fn order_out_of_order(own: &Lexicon, word: &str) -> Option<WordNumber> {
    const LETTERS: RangeInclusive<usize> = 4..=10;
    if !word.is_ascii() || !LETTERS.contains(&word.len()) || own.lookalikes().is_common(word) {
        return None;
    }
    (1..word.len()).find_map(|at| {
        let mut letters = word.as_bytes().to_vec();
        letters.swap(at - 1, at);
        let mended = std::str::from_utf8(&letters).ok()?;
        let number = PATTERNS.numbers.get(mended).copied()?;
        (PATTERNS.beginnings(number).places & Place::Command.bit() != 0).then_some(number)
    })
}

fn class(sense: Sense<'_>) -> Option<Class> {
    if let Sense::Class(class) = sense { Some(class) } else { None }
}
