//! Every word and phrase that means something: the scene's values in all their forms, its noun and
//! attributes, and the classes of the dialogue. Where two would match, the longer phrase wins; of two
//! equally long ones the scene's.

use std::collections::{HashMap, HashSet};

use scene::{AttributeId, Role, Scene, WordId};

use crate::hedges::sureness;
use crate::morphology::inflected;
use crate::normalise::normalise;
use crate::phonetics::skeleton;
use crate::spelling::SpellingIndex;
use crate::token_class::Class;
use crate::tokens::{Gap, Token, Tokens};
use crate::vocabulary;

/// Classes of a word or phrase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sense {
    /// A value, by its place in [`Lexicon::value`].
    Value(u32),
    Class(Class),
    Unknown,
}

/// A value as language sees it.
#[derive(Clone, Debug)]
pub(crate) struct ValueSense {
    pub(crate) word: WordId,
    /// The attributes that have the value; more than one if they share its name.
    pub(crate) attributes: Vec<AttributeId>,
    pub(crate) role: Role,
}

/// The words after the first, and what the whole means.
#[derive(Clone, Debug)]
struct Phrase {
    rest: Box<[Box<str>]>,
    /// Counts only where its clause ends: "it is", but not "it is white".
    closing: bool,
    sense: Sense,
    /// The speaker's confidence.
    sure: f64,
}

/// A phrase found in an utterance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhraseMatch {
    /// Number of words in the phrase.
    pub(crate) words: usize,
    pub(crate) sense: Sense,
    /// The speaker's confidence.
    pub(crate) sure: f64,
}

/// The lexicon of one scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lexicon {
    /// Phrases by first word, longest first.
    phrases: HashMap<String, Vec<Phrase>>,
    values: Vec<ValueSense>,
    spelling: SpellingIndex,
    /// Values of several words, written as one.
    compounds: SpellingIndex,
    /// The value with that skeleton, if it is the only one.
    sounds: HashMap<String, Option<u32>>,
    common: HashSet<&'static str>,
    noun: String,
}

impl Lexicon {
    /// Collects the words of a scene and of the language.
    pub(crate) fn new(scene: &Scene) -> Self {
        let common = vocabulary::common_words().collect();
        let noun = normalise(scene.noun()).into_owned();
        let mut lexicon = Self { common, noun, ..Self::default() };
        lexicon.add_values(scene);
        lexicon.add_names(scene);
        lexicon.add_phrases();
        for phrases in lexicon.phrases.values_mut() {
            phrases.sort_by_key(|phrase| std::cmp::Reverse(phrase.rest.len()));
        }
        lexicon
    }

    /// The value behind a [`Sense::Value`].
    pub(crate) fn value(&self, sense: u32) -> &ValueSense {
        &self.values[sense as usize]
    }

    /// The longest phrase that starts at `at`.
    pub(crate) fn longest(&self, tokens: &[Token<'_>], at: usize) -> Option<PhraseMatch> {
        let after = &tokens[at + 1..];
        let phrases = self.phrases.get(tokens[at].word)?;
        phrases.iter().find_map(|phrase| {
            let words = matched(&phrase.rest, after)?;
            let found = PhraseMatch { words: words + 1, sense: phrase.sense, sure: phrase.sure };
            self.closes(phrase, tokens, at + 1 + words).then_some(found)
        })
    }

    /// The sense of a word that stands alone.
    pub(crate) fn word(&self, word: &str) -> Option<Sense> {
        let phrases = self.phrases.get(word)?;
        phrases.last().filter(|phrase| phrase.rest.is_empty()).map(|phrase| phrase.sense)
    }

    /// The value that the misspelt word must be.
    pub(crate) fn misspelt(&self, word: &str) -> Option<u32> {
        if self.common.contains(word) { None } else { self.spelling.correct(word) }
    }

    /// The value of several words that is one slip away from words written as one.
    pub(crate) fn misspelt_compound(&self, joined: &str) -> Option<u32> {
        self.compounds.correct(joined)
    }

    /// The value one slip away, even from an everyday word.
    pub(crate) fn looks_like(&self, word: &str) -> Option<u32> {
        self.spelling.correct(word)
    }

    /// The only value that sounds like the word, if it has enough consonants to be sure.
    pub(crate) fn sounds_like_long(&self, word: &str) -> Option<u32> {
        const CONSONANTS_MIN: usize = 4;
        let sounds = skeleton(word).filter(|sounds| sounds.len() >= CONSONANTS_MIN)?;
        self.sounds.get(&sounds).copied().flatten()
    }

    /// The only value that sounds like the words one after the other, unstressed "her" as "er".
    pub(crate) fn sounds_like_run<'a>(&self, run: impl Iterator<Item = &'a str>) -> Option<u32> {
        const CONSONANTS_MIN: usize = 3;
        let mut sounds = String::new();
        for word in run {
            let word = skeleton(word)?;
            let word = if sounds.is_empty() { &word } else { word.trim_start_matches(['H', 'A']) };
            let word = if word.chars().next() == sounds.chars().last() {
                &word[1.min(word.len())..]
            } else {
                word
            };
            sounds.push_str(word);
        }
        self.sounds.get(&sounds).copied().flatten().filter(|_| sounds.len() >= CONSONANTS_MIN)
    }

    /// The only value that sounds like the word.
    pub(crate) fn sounds_like(&self, word: &str) -> Option<u32> {
        self.sounds.get(&skeleton(word)?).copied().flatten()
    }

    /// Returns whether a recogniser or a typist could have turned the scene's noun into the word.
    pub(crate) fn is_like_noun(&self, word: &str) -> bool {
        const LETTERS_MAX: usize = 24;
        word.len() <= LETTERS_MAX
            && (strsim::osa_distance(word, &self.noun) <= 1
                || skeleton(word).is_some_and(|sounds| skeleton(&self.noun) == Some(sounds)))
    }

    /// Returns whether the word is everyday English, whatever else it may resemble.
    pub(crate) fn is_common(&self, word: &str) -> bool {
        self.common.contains(word)
    }

    /// Returns whether a closing phrase ends its clause.
    fn closes(&self, phrase: &Phrase, tokens: &[Token<'_>], end: usize) -> bool {
        if !phrase.closing {
            return true;
        }
        let Some(next) = tokens.get(end) else { return true };
        // One word is looked up, or one whole phrase that does not close anything itself: the work
        // stays linear.
        let last = |phrase: &&Phrase| {
            !phrase.closing && matched(&phrase.rest, &tokens[end + 1..]).is_some()
        };
        let phrases = self.phrases.get(next.word).into_iter().flatten();
        next.gap >= Gap::Pause
            || phrases.filter(|phrase| phrase.sense != Sense::Unknown).find(last).is_some_and(
                |next| {
                    use Class::{Courtesy, Filler, Hedge, No, WeakYes, Yes};
                    matches!(
                        next.sense,
                        Sense::Class(Filler | Courtesy | Yes | No | WeakYes | Hedge)
                    )
                },
            )
    }

    fn add_values(&mut self, scene: &Scene) {
        let mut senses: HashMap<WordId, u32> = HashMap::new();
        let mut all = Vec::new();
        for (k, attribute) in scene.attributes().iter().enumerate() {
            for value in &attribute.values {
                let sense = *senses.entry(value.word).or_insert_with(|| {
                    let role = value.role();
                    let attributes = Vec::new();
                    self.values.push(ValueSense { word: value.word, attributes, role });
                    u32::try_from(self.values.len() - 1).expect("words fit into 16 bits")
                });
                self.values[sense as usize].attributes.push(AttributeId::from(k));
                all.push((sense, value));
            }
        }
        // Names before synonyms before forms: what a scene says outright is never overruled.
        for (sense, value) in &all {
            self.add_value(&value.name, *sense);
        }
        for (sense, synonym) in all.iter().flat_map(|(n, v)| v.synonyms.iter().map(|s| (*n, s))) {
            self.add_value(synonym, sense);
        }
        for (sense, value) in &all {
            for text in std::iter::once(&value.name).chain(&value.synonyms) {
                self.add_forms(text, *sense);
            }
        }
    }

    fn add_value(&mut self, text: &str, sense: u32) {
        let words = words(text);
        self.add(&words, Sense::Value(sense));
        if let [word] = &words[..] {
            self.spelling.add(word, sense);
            if let Some(sounds) = skeleton(word).filter(|sounds| sounds.len() > 1) {
                let only = self.sounds.entry(sounds).or_insert(Some(sense));
                *only = only.filter(|other| *other == sense);
            }
        }
    }

    /// Inflections, and compounds written as one word.
    fn add_forms(&mut self, text: &str, sense: u32) {
        let mut words = words(text);
        if words.len() > 1 {
            let joined = words.concat();
            self.spelling.add(&joined, sense);
            self.compounds.add(&joined, sense);
            self.add(&[joined], Sense::Value(sense));
        }
        let quality = words.len() == 1 && self.value(sense).role == Role::Quality;
        let Some(last) = words.pop() else { return };
        for form in inflected(&last, quality) {
            words.push(form);
            self.add(&words, Sense::Value(sense));
            words.pop();
        }
    }

    fn add_names(&mut self, scene: &Scene) {
        let attributes = scene.attributes().iter();
        let attributes = attributes.flat_map(|a| std::iter::once(&a.name).chain(&a.synonyms));
        let noun = std::iter::once((scene.noun(), Class::Head));
        for (name, class) in noun.chain(attributes.map(|name| (name.as_str(), Class::Attribute))) {
            let mut words = words(name);
            self.add(&words, Sense::Class(class));
            let Some(last) = words.pop() else { continue };
            for form in inflected(&last, false) {
                words.push(form);
                self.add(&words, Sense::Class(class));
                words.pop();
            }
        }
    }

    fn add_phrases(&mut self) {
        for (class, phrase) in vocabulary::phrases() {
            let weak = matches!(class, Class::WeakYes | Class::WeakNo) && phrase.contains(' ');
            let (phrase, closing) = match phrase.strip_suffix(" .") {
                Some(phrase) => (phrase, true),
                None => (phrase, weak),
            };
            let words: Vec<String> = phrase.split(' ').map(str::to_owned).collect();
            // "on the left" is a position in a row unless the scene itself knows a left.
            let is_value = |word: &String| matches!(self.word(word), Some(Sense::Value(_)));
            if class != Class::Ordinal || !words.iter().any(is_value) {
                let sure = sureness(class, phrase);
                self.add_phrase(&words, Sense::Class(class), closing, sure);
            }
        }
    }

    fn add(&mut self, words: &[String], sense: Sense) {
        self.add_phrase(words, sense, false, 1.0);
    }

    /// Adds a phrase unless it is taken.
    fn add_phrase(&mut self, words: &[String], sense: Sense, closing: bool, sure: f64) {
        let Some((first, rest)) = words.split_first() else { return };
        let rest: Box<[Box<str>]> = rest.iter().map(|word| word.as_str().into()).collect();
        let phrases = self.phrases.entry(first.clone()).or_default();
        if phrases.iter().all(|phrase| phrase.rest != rest) {
            // A word alone stays last, where `word` looks for it, also before the final sort.
            let at = if rest.is_empty() { phrases.len() } else { 0 };
            phrases.insert(at, Phrase { rest, closing, sense, sure });
        }
    }
}

/// Returns the number of words that the rest of a phrase takes, if it matches. Adverbs may stand
/// inside: "I don't really care".
fn matched(rest: &[Box<str>], after: &[Token<'_>]) -> Option<usize> {
    const ADVERBS: &[&str] =
        &["really", "just", "honestly", "even", "truly", "actually", "also", "still", "maybe"];
    let mut words = 0;
    for word in rest {
        let here = |at: usize| after.get(at).filter(|token| token.gap <= Gap::None);
        let mut token = here(words)?;
        if token.word != &**word && ADVERBS.contains(&token.word) {
            words += 1;
            token = here(words)?;
        }
        if token.word != &**word {
            return None;
        }
        words += 1;
    }
    Some(words)
}

/// The words of a scene's text, as an utterance's would be read.
fn words(text: &str) -> Vec<String> {
    let text = normalise(text);
    Tokens::of(&text).words.iter().map(|token| token.word.to_owned()).collect()
}
