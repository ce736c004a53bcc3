//! Patterns of words that halt the arm, read from `vocabulary/halting.txt`.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock};

use crate::vocabulary::halting;

/// Position at which a pattern may match.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Lead,
    /// At the opening of a phrase said in one breath.
    Command,
    /// As the only words.
    Alone,
    /// As the only words, of a request to continue.
    Resuming,
    /// Anywhere.
    Danger,
}

impl Place {
    /// The place among others in a set.
    pub(super) fn bit(self) -> u8 {
        1 << self as u8
    }

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
pub(super) enum Element {
    /// Any of these words, in the order of their numbers.
    Words(Arc<[WordNumber]>),
    Any,
    Pause,
    End,
}

/// A sequence without options.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    pub(super) place: Place,
    pub(super) elements: Vec<Element>,
}

/// Position of a word in [`Patterns::words`].
pub(super) type WordNumber = u16;

/// The words of all patterns. A word of an utterance is looked up once, and compared by its number.
#[derive(Default)]
pub(super) struct Patterns {
    pub(super) numbers: HashMap<String, WordNumber>,
    words: Vec<Beginnings>,
    /// Sets of words by their names.
    sets: HashMap<&'static str, Vec<String>>,
}

/// The patterns that begin with one word.
#[derive(Default)]
pub(super) struct Beginnings {
    /// The set of their places: most words begin none, and are passed over by it.
    pub(super) places: u8,
    pub(super) patterns: Vec<Arc<Pattern>>,
}

pub(super) static PATTERNS: LazyLock<Patterns> = LazyLock::new(Patterns::read);

impl Patterns {
    fn read() -> Self {
        let mut sets: HashMap<&'static str, Vec<String>> = HashMap::new();
        let mut patterns = Self::default();
        for (section, line) in halting() {
            match (line.split_once(" = "), Place::named(section)) {
                (Some((name, words)), None) => {
                    let words = words.split(',').map(str::trim).filter(|word| !word.is_empty());
                    sets.entry(name).or_default().extend(words.flat_map(forms));
                }
                (_, Some(place)) => {
                    let elements: Vec<(Element, bool)> =
                        line.split(' ').map(|text| patterns.element(text, &sets)).collect();
                    patterns.add(place, &elements, Vec::new());
                }
                _ => {}
            }
        }
        patterns.sets = sets;
        patterns
    }

    /// Returns whether a set has the word.
    pub(super) fn is_in(&self, set: &str, word: &str) -> bool {
        self.sets.get(set).is_some_and(|words| words.iter().any(|it| it == word))
    }

    pub(super) fn beginnings(&self, word: WordNumber) -> &Beginnings {
        &self.words[usize::from(word)]
    }

    fn number(&mut self, word: String) -> WordNumber {
        *self.numbers.entry(word).or_insert_with(|| {
            self.words.push(Beginnings::default());
            (self.words.len() - 1) as WordNumber
        })
    }

    /// Reads an element; returns whether it may be left out.
    fn element(&mut self, text: &str, sets: &HashMap<&str, Vec<String>>) -> (Element, bool) {
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
                let mut numbers: Vec<WordNumber> = words.map(|word| self.number(word)).collect();
                numbers.sort_unstable();
                numbers.dedup();
                Element::Words(numbers.into())
            }
        };
        (element, optional)
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
            let beginnings = &mut self.words[usize::from(*word)];
            beginnings.places |= place.bit();
            beginnings.patterns.push(pattern.clone());
        }
    }
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
