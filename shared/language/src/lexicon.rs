//! Every word and phrase that means something: the scene's values in all their forms, its noun and
//! attributes, and the classes of the dialogue. If two match, the longer phrase wins; of two
//! equally long ones the scene's.

mod scene_words;

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::sync::LazyLock;

use scene::{AttributeId, Role, Scene, WordId};
use words::{Gap, Token};

use crate::hedges::sureness;
use crate::lookalikes::Lookalikes;
use crate::token_class::Class;
use crate::vocabulary::phrases;
use crate::word_sets::WordSet;

/// Meaning of a word or phrase.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sense<'a> {
    Value(&'a ValueSense),
    Class(Class),
    Unknown,
}

/// A value in the reader's representation.
#[derive(Clone, Debug)]
pub(crate) struct ValueSense {
    pub(crate) word: WordId,
    /// The attributes that have the value; more than one if they share its name.
    pub(crate) attributes: Vec<AttributeId>,
    pub(crate) role: Role,
    /// Whether the attribute has no more than two values.
    pub(crate) one_of_two: bool,
}

impl ValueSense {
    /// Returns whether two values belong to the same attribute.
    pub(crate) fn rivals(&self, other: &Self) -> bool {
        self.attributes.iter().any(|k| other.attributes.contains(k))
    }

    /// Returns whether the value is a location.
    pub(crate) fn is_place(&self) -> bool {
        self.role == Role::Place
    }
}

/// A phrase found in an utterance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhraseMatch<'a> {
    /// Number of words in the phrase.
    pub(crate) words: usize,
    pub(crate) sense: Sense<'a>,
    /// The speaker's confidence.
    pub(crate) sure: f64,
}

/// A [`Sense`] inside the lexicon: a value is a place in [`Lexicon::values`].
#[derive(Clone, Copy, Debug)]
enum Meaning {
    Value(usize),
    Class(Class),
}

/// The words after the first, and the meaning of the whole phrase.
#[derive(Clone, Debug)]
struct Phrase {
    rest: Box<[Box<str>]>,
    /// Counts only at the end of a clause: "it is", but not "it is white".
    closing: bool,
    meaning: Meaning,
    /// The speaker's confidence.
    sure: f64,
}

/// The lexicon of one scene.
#[derive(Clone, Debug)]
pub(crate) struct Lexicon {
    /// Phrases by first word, longest first.
    phrases: HashMap<String, Vec<Phrase>>,
    values: Vec<ValueSense>,
    lookalikes: Lookalikes,
    /// Words of the scene between which it writes a mark: "A/B", "Dr. Lee".
    marked: HashMap<String, Vec<String>>,
    /// Whether a word of the scene may be an answer as well: "right".
    answers: bool,
}

impl Lexicon {
    /// Collects the words of a scene and of the language.
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut lexicon = Self::empty(scene.noun());
        lexicon.add_scene(scene);
        lexicon.add_language();
        lexicon
    }

    /// The words of the language alone: the robot's own, whatever the scene.
    pub(crate) fn own() -> &'static Self {
        static OWN: LazyLock<Lexicon> = LazyLock::new(|| {
            let mut own = Lexicon::empty("");
            own.add_language();
            own
        });
        &OWN
    }

    fn empty(noun: &str) -> Self {
        let lookalikes = Lookalikes::new(noun);
        let (phrases, marked) = (HashMap::new(), HashMap::new());
        Self { phrases, values: Vec::new(), lookalikes, marked, answers: false }
    }

    fn add_language(&mut self) {
        self.add_phrases();
        for phrases in self.phrases.values_mut() {
            phrases.sort_by_key(|phrase| Reverse(phrase.rest.len()));
        }
    }

    /// Words that are not in the lexicon, but nearly are.
    pub(crate) fn lookalikes(&self) -> &Lookalikes {
        &self.lookalikes
    }

    /// The value that is a word of the scene.
    pub(crate) fn value_of(&self, word: WordId) -> Option<&ValueSense> {
        self.values.iter().find(|value| value.word == word)
    }

    /// The value at a place that [`Lookalikes`] found.
    pub(crate) fn value(&self, place: usize) -> &ValueSense {
        &self.values[place]
    }

    /// The longest phrase that starts at `at`.
    pub(crate) fn longest(&self, tokens: &[Token<'_>], at: usize) -> Option<PhraseMatch<'_>> {
        let after = &tokens[at + 1..];
        self.phrases.get(tokens[at].word)?.iter().find_map(|phrase| {
            let words = 1 + matched(&phrase.rest, after)?;
            let found = PhraseMatch { words, sense: self.sense(phrase), sure: phrase.sure };
            (!phrase.closing || self.ends_clause(tokens, at + words)).then_some(found)
        })
    }

    /// Returns the sense of a lone word.
    pub(crate) fn word(&self, word: &str) -> Option<Sense<'_>> {
        let shortest = self.phrases.get(word)?.last()?;
        shortest.rest.is_empty().then(|| self.sense(shortest))
    }

    fn sense(&self, phrase: &Phrase) -> Sense<'_> {
        match phrase.meaning {
            Meaning::Value(place) => Sense::Value(&self.values[place]),
            Meaning::Class(class) => Sense::Class(class),
        }
    }

    /// Returns whether a clause ends before `end`: at the end of the text or a pause, or because a
    /// remark follows.
    fn ends_clause(&self, tokens: &[Token<'_>], end: usize) -> bool {
        use Class::{Courtesy, Filler, Hedge, No, WeakYes, Yes};
        let Some(next) = tokens.get(end) else { return true };
        // One word is looked up, or one whole phrase that does not close anything itself: the work
        // stays linear.
        let fits = |phrase: &&Phrase| {
            !phrase.closing && matched(&phrase.rest, &tokens[end + 1..]).is_some()
        };
        let is_remark = |phrase: &Phrase| {
            let Meaning::Class(class) = phrase.meaning else { return false };
            matches!(class, Filler | Courtesy | Yes | No | WeakYes | Hedge)
        };
        let mut phrases = self.phrases.get(next.word).into_iter().flatten();
        next.pauses() || phrases.find(fits).is_some_and(is_remark)
    }

    /// Returns the meaning of a whole phrase.
    fn meaning(&self, words: &[String]) -> Option<Meaning> {
        let (first, rest) = words.split_first()?;
        let is_it = |phrase: &&Phrase| phrase.rest.iter().map(|it| &**it).eq(rest);
        self.phrases.get(first)?.iter().find(is_it).map(|phrase| phrase.meaning)
    }

    /// The tokens without the pauses that are marks within the scene's own words.
    pub(crate) fn unmarked<'t, 'a>(&self, tokens: &'t [Token<'a>]) -> Cow<'t, [Token<'a>]> {
        let is_marked = |before: &Token<'_>, token: &Token<'_>| {
            let after = self.marked.get(before.word).filter(|_| token.pauses());
            after.is_some_and(|after| after.iter().any(|word| word == token.word))
        };
        let mut tokens = Cow::Borrowed(tokens);
        for at in 1..tokens.len() {
            if is_marked(&tokens[at - 1], &tokens[at]) {
                tokens.to_mut()[at].gap = Gap::None;
            }
        }
        tokens
    }

    /// Returns whether one of the scene's words may be an answer as well: "right".
    pub(crate) fn may_answer(&self) -> bool {
        self.answers
    }

    fn add_phrases(&mut self) {
        for (class, phrase) in phrases() {
            let weak = matches!(class, Class::WeakYes | Class::WeakNo) && phrase.contains(' ');
            let (phrase, closing) = match phrase.strip_suffix(" .") {
                Some(phrase) => (phrase, true),
                None => (phrase, weak),
            };
            let words: Vec<String> = phrase.split(' ').map(str::to_owned).collect();
            // "on the left" is a position in a row unless the scene itself knows a left.
            let is_value = |word: &String| matches!(self.word(word), Some(Sense::Value(_)));
            let describes = match &words[..] {
                // "that is right", where something is right of the others
                [it, is, said] if WordSet::It.has(it) && WordSet::Is.has(is) => is_value(said),
                words => class == Class::Ordinal && words.iter().any(is_value),
            };
            if !describes {
                let sure = sureness(class, phrase);
                self.add_phrase(&words, Meaning::Class(class), closing, sure);
            }
        }
    }

    fn add(&mut self, words: &[String], meaning: Meaning) {
        self.add_phrase(words, meaning, false, 1.0);
    }

    /// Adds a phrase unless it is taken.
    fn add_phrase(&mut self, words: &[String], meaning: Meaning, closing: bool, sure: f64) {
        let Some((first, rest)) = words.split_first() else { return };
        let rest: Box<[Box<str>]> = rest.iter().map(|word| word.as_str().into()).collect();
        let phrases = self.phrases.entry(first.clone()).or_default();
        if phrases.iter().all(|phrase| phrase.rest != rest) {
            // A word alone stays last, where `word` looks for it, also before the final sort.
            let at = if rest.is_empty() { phrases.len() } else { 0 };
            phrases.insert(at, Phrase { rest, closing, meaning, sure });
        }
    }
}

/// Returns the number of words that the rest of a phrase takes, if it matches. Adverbs may be
/// inside: "I don't really care".
fn matched(rest: &[Box<str>], after: &[Token<'_>]) -> Option<usize> {
    let mut words = 0;
    for word in rest {
        let here = |at: usize| after.get(at).filter(|token| !token.pauses());
        let mut token = here(words)?;
        if token.word != &**word && WordSet::Adverb.has(token.word) {
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
