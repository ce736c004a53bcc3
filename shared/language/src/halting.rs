//! Words that halt the arm: orders to stop, requests to wait, and what hurts or endangers somebody.
//!
//! The judgement rests on the robot's own words alone, so that no scene can take them away, and on nothing
//! else: what halts the arm, and what the dialogue takes for an order to stop, is the same. It errs on
//! the side of one halt too many.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::{Arc, LazyLock};

use crate::lexicon::{Lexicon, Sense};
use crate::spelling::shortened;
use crate::token_class::{Class, classes};
use crate::tokens::{Gap, Token, Tokens};
use crate::vocabulary::halting;

/// Where a pattern may match.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Lead,
    /// At the opening of what is said in one breath.
    Command,
    /// Where nothing else is said.
    Alone,
    /// The same, of words that ask to go on.
    Resuming,
    /// Anywhere.
    Danger,
}

impl Place {
    fn named(section: &str) -> Option<Self> {
        Some(match section {
            "leads" => Self::Lead,
            "commands" => Self::Command,
            "alone" => Self::Alone,
            "resuming" => Self::Resuming,
            "dangers" => Self::Danger,
            _ => return None,
        })
    }
}

/// One element of a pattern.
#[derive(Clone, Debug)]
enum Element {
    Words(Arc<HashSet<String>>),
    Any,
    Pause,
    End,
}

/// A sequence without options.
#[derive(Clone, Debug)]
struct Pattern {
    place: Place,
    elements: Vec<Element>,
}

/// The patterns by their first words.
struct Patterns(HashMap<String, Vec<Arc<Pattern>>>);

static PATTERNS: LazyLock<Patterns> = LazyLock::new(Patterns::read);

/// Phrases that say nothing before a command or after it.
const BESIDE: &[Class] = classes![Filler Courtesy No Yes Repair WeakYes And But Join Plain];

/// Returns the places of the words that halt the arm, in their order; none if nothing does.
pub(crate) fn halting_words(tokens: &Tokens<'_>) -> Vec<Range<usize>> {
    Utterance::new(tokens).halting_words()
}

/// Returns whether the words ask to go on after a stop, and nothing else.
pub(crate) fn asks_to_go_on(tokens: &Tokens<'_>) -> bool {
    let beside = classes![Filler Courtesy Yes WeakYes And But Plain];
    Utterance::new(tokens).is_alone(Place::Resuming, beside)
}

struct Utterance<'t, 'a> {
    tokens: &'t [Token<'a>],
    /// What lengthened words may be: "stoooop".
    short: Vec<Option<[String; 2]>>,
    own: &'static Lexicon,
    code: bool,
}

impl<'t, 'a> Utterance<'t, 'a> {
    fn new(tokens: &'t Tokens<'a>) -> Self {
        let own = Lexicon::own();
        let lengthened = |token: &Token<'_>| {
            let is_known = own.word(token.word).is_some() || PATTERNS.0.contains_key(token.word);
            if is_known { None } else { shortened(token.word) }
        };
        let short = tokens.words.iter().map(lengthened).collect();
        Self { tokens: &tokens.words, short, own, code: tokens.code }
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
        if found.is_empty() && !self.asks_or_tells() {
            let is_dangerous = |breath: &Range<usize>| self.is_danger(breath.clone());
            found.extend(self.breaths().filter(is_dangerous));
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
        let mut at = breath.start;
        let mut opens = true;
        while at < breath.end {
            let phrase = self.own.longest(self.tokens, at);
            let phrase_words = phrase.as_ref().map_or(1, |phrase| phrase.words);
            let class = phrase.and_then(|phrase| class(phrase.sense));
            let ends = !opens && self.is_called_out(at, &breath);
            if opens || ends {
                let is_whole = |words: &usize| {
                    *words >= phrase_words
                        && !self.is_joined(at + words, breath.end)
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

    /// "the white one stop", "no not that one stop": called out at the end of a breath.
    fn is_called_out(&self, at: usize, breath: &Range<usize>) -> bool {
        const BEFORE: &[Class] = classes![One Head It No Yes WeakYes Courtesy Filler];
        let before = self.own.word(self.tokens[at - 1].word).and_then(class);
        let negates = |token: &Token<'_>| matches!(token.word, "not" | "never" | "let");
        before.is_some_and(|class| BEFORE.contains(&class))
            && !self.tokens[breath.start..at].iter().any(negates)
    }

    /// "stop sign", "hold it in": what goes on belongs to the words before.
    fn is_joined(&self, at: usize, end: usize) -> bool {
        let Some(next) = self.tokens[..end].get(at) else { return false };
        if next.gap == Gap::Glued {
            return true;
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

    /// Returns whether something is asked for, or told of another day: no danger then, whatever it names.
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
            !self.relates(at, breath.start) && self.longest(Place::Danger, at, end).is_some()
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
        let patterns = self.forms(at).filter_map(|word| PATTERNS.0.get(word)).flatten();
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
                    let fits = |form: &str| words.contains(form);
                    self.forms(at).any(fits).then_some(())?;
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

    /// The word at a place, and what it may be where it was lengthened.
    fn forms(&self, at: usize) -> impl Iterator<Item = &str> {
        let short = self.short[at].iter().flatten().map(String::as_str);
        std::iter::once(self.tokens[at].word).chain(short)
    }
}

fn class(sense: Sense<'_>) -> Option<Class> {
    if let Sense::Class(class) = sense { Some(class) } else { None }
}

impl Patterns {
    fn read() -> Self {
        let mut sets: HashMap<&str, Vec<String>> = HashMap::new();
        let mut patterns = Self(HashMap::new());
        for (section, line) in halting() {
            match (line.split_once(" = "), Place::named(section)) {
                (Some((name, words)), None) => {
                    let words = words.split(',').map(str::trim).filter(|word| !word.is_empty());
                    sets.entry(name).or_default().extend(words.flat_map(forms));
                }
                (_, Some(place)) => {
                    let elements: Vec<(Element, bool)> =
                        line.split(' ').map(|text| element(text, &sets)).collect();
                    patterns.add(place, &elements, Vec::new());
                }
                _ => {}
            }
        }
        patterns
    }

    /// Adds every sequence that the optional elements leave.
    fn add(&mut self, place: Place, rest: &[(Element, bool)], mut before: Vec<Element>) {
        let Some(((element, optional), rest)) = rest.split_first() else {
            return self.index(place, before);
        };
        if *optional {
            self.add(place, rest, before.clone());
        }
        before.push(element.clone());
        self.add(place, rest, before);
    }

    fn index(&mut self, place: Place, elements: Vec<Element>) {
        let Some(Element::Words(first)) = elements.first() else { return };
        let first = first.clone();
        let pattern = Arc::new(Pattern { place, elements });
        for word in first.iter() {
            self.0.entry(word.clone()).or_default().push(pattern.clone());
        }
    }
}

/// Reads an element; returns whether it may be left out.
fn element(text: &str, sets: &HashMap<&str, Vec<String>>) -> (Element, bool) {
    let (text, optional) = text.strip_suffix('?').map_or((text, false), |text| (text, true));
    let element = match text {
        "." => Element::End,
        "_" => Element::Any,
        "," => Element::Pause,
        words => {
            let words = words.split('|').flat_map(|word| match word.strip_prefix('$') {
                Some(set) => sets.get(set).cloned().unwrap_or_default(),
                None => forms(word),
            });
            Element::Words(Arc::new(words.collect()))
        }
    };
    (element, optional)
}

/// The forms of a verb that is marked as one: "pinch", "pinches", "pinched", "pinching".
fn forms(word: &str) -> Vec<String> {
    let Some(verb) = word.strip_suffix('~') else { return vec![word.to_owned()] };
    let stem = verb.strip_suffix('e').unwrap_or(verb);
    let doubled = verb.chars().last().map(|last| format!("{verb}{last}"));
    let stems = std::iter::once(stem.to_owned()).chain(doubled);
    let inflected = stems.flat_map(|stem| ["es", "ed", "ing"].map(|end| format!("{stem}{end}")));
    [verb.to_owned(), format!("{verb}s")].into_iter().chain(inflected).collect()
}
