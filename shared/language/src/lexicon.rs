//! Every word and phrase that means something: the scene's values in all their forms, its noun and
//! attributes, and the classes of the dialogue. If two match, the longer phrase wins; of two
//! equally long ones the scene's.

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::sync::LazyLock;

use scene::{AttributeId, Role, Scene, Value, WordId};
use words::{Gap, Token, Tokens, normalise};

use crate::closed_class::{is_answer, is_closed};
use crate::hedges::sureness;
use crate::lookalikes::Lookalikes;
use crate::morphology::{inflected, singulars};
use crate::relation_words::by_quality;
use crate::relations::{Form, forms, words};
use crate::synonyms::{common_synonyms, is_thing};
use crate::token_class::Class;
use crate::vocabulary::{is_phrase, phrases};

/// Letters of the shortest head of a compound, and of the part before it.
const HEAD_LENGTH_MIN: usize = 3;

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
        lexicon.add_values(scene);
        lexicon.add_names(scene);
        lexicon.add_parts(scene);
        lexicon.add_heads(scene);
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

    fn add_values(&mut self, scene: &Scene) {
        let mut places: HashMap<WordId, usize> = HashMap::new();
        let mut all = Vec::new();
        let own = scene.attributes().iter().enumerate().filter(|(_, it)| !it.by_place);
        for (k, attribute) in own {
            for value in &attribute.values {
                let place = *places.entry(value.word).or_insert_with(|| {
                    let (word, role, attributes) = (value.word, value.role(), Vec::new());
                    let one_of_two = attribute.values.len() <= 2;
                    self.values.push(ValueSense { word, attributes, role, one_of_two });
                    self.values.len() - 1
                });
                self.values[place].attributes.push(AttributeId::from(k));
                all.push((place, value));
            }
        }
        // Names before synonyms before forms: explicit statements of a scene are never overruled.
        let names = all.iter().map(|(place, value)| (*place, &value.name));
        let synonyms = all.iter().flat_map(|(n, v)| v.synonyms.iter().map(|s| (*n, s)));
        for (place, name) in names.chain(synonyms) {
            self.add_marks(name);
            if is_closed(&words(name)) {
                self.add_closed(scene, name, place);
            } else {
                self.add_value(name, place);
            }
        }
        let mut common = common_synonyms(&all);
        common.retain(|(place, synonym)| self.may_stand_for(scene, &words(synonym), *place));
        let forms = |(place, value): &(usize, &Value)| {
            let place = *place;
            let also = common.iter().filter(|(other, _)| *other == place);
            forms(value, also.map(|(_, synonym)| *synonym))
                .into_iter()
                .map(move |form| (place, form))
        };
        let forms: Vec<(usize, Form)> = all.iter().flat_map(forms).collect();
        let (own, alike): (Vec<_>, Vec<_>) = forms.into_iter().partition(|(_, form)| form.own);
        for (place, form) in own.into_iter().chain(alike) {
            self.add(&form.words, Meaning::Value(place));
        }
        for (place, value) in &all {
            let names = std::iter::once(&value.name).chain(&value.synonyms);
            for name in names.filter(|name| !is_closed(&words(name))) {
                self.add_value_forms(name, *place);
            }
        }
        for (place, synonym) in common {
            self.add_value(synonym, place);
            self.add_value_forms(synonym, place);
        }
    }

    /// Returns whether words that the scene does not list may stand for a value: they name nothing
    /// else and are not a phrase of the dialogue. "Wooden spoon" is two values if "wooden" is.
    fn may_stand_for(&self, scene: &Scene, synonym: &[String], place: usize) -> bool {
        let attributes = scene.attributes().iter().map(|attribute| attribute.name.as_str());
        let is_name = attributes.chain([scene.noun()]).any(|name| words(name) == synonym);
        let own = Lexicon::own().meaning(synonym);
        let is_dialogue = own.is_some_and(|own| !matches!(own, Meaning::Class(Class::Unlisted)));
        let is_other = |word: &String| matches!(self.meaning(std::slice::from_ref(word)), Some(Meaning::Value(other)) if other != place);
        let lead = &synonym[..synonym.len().saturating_sub(1)];
        !is_name && !is_dialogue && !lead.iter().any(is_other)
    }

    /// Returns the meaning of a whole phrase.
    fn meaning(&self, words: &[String]) -> Option<Meaning> {
        let (first, rest) = words.split_first()?;
        let is_it = |phrase: &&Phrase| phrase.rest.iter().map(|it| &**it).eq(rest);
        self.phrases.get(first)?.iter().find(is_it).map(|phrase| phrase.meaning)
    }

    /// "number one", "one" being a name for any of the things.
    fn add_closed(&mut self, scene: &Scene, name: &str, place: usize) {
        let attributes = self.values[place].attributes.clone();
        let names = attributes.iter().map(|k| scene.attributes()[k.index()].name.as_str());
        for carrier in names.chain([scene.noun()]) {
            self.add(&words(&format!("{carrier} {name}")), Meaning::Value(place));
        }
    }

    /// Notes the words of a scene's text that a mark parts.
    fn add_marks(&mut self, text: &str) {
        let text = normalise(text);
        let tokens = Tokens::of(&text).words;
        for pair in tokens.windows(2).filter(|pair| pair[1].pauses()) {
            let [one, other] = [pair[0].word, pair[1].word].map(str::to_owned);
            self.marked.entry(one).or_default().push(other);
        }
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

    fn add_value(&mut self, text: &str, place: usize) {
        let words = words(text);
        self.answers |= names_answer(&words);
        self.add(&words, Meaning::Value(place));
        if let [word] = &words[..] {
            self.lookalikes.add_word(word, place);
        }
    }

    /// Inflections, and compounds written as one word.
    fn add_value_forms(&mut self, text: &str, place: usize) {
        let words = words(text);
        if words.len() > 1 {
            let joined = words.concat();
            self.lookalikes.add_compound(&joined, place);
            self.add(&[joined], Meaning::Value(place));
        }
        let quality = words.len() == 1 && self.values[place].role == Role::Quality;
        let Some((last, lead)) = words.split_last() else { return };
        let singulars = singulars(last).into_iter();
        let singulars: Vec<String> =
            singulars.filter(|form| !self.lookalikes.is_common(form)).collect();
        for form in inflected(last, quality).into_iter().chain(singulars) {
            // Of three sizes "smaller" need not be small.
            if self.values[place].one_of_two || by_quality(&form).is_none() {
                self.add(&[lead, &[form]].concat(), Meaning::Value(place));
            }
        }
    }

    /// "teddy" for a teddy bear, "syrup" for cough syrup: a part of a name that is in no other
    /// value, and no word of a dialogue. Only the last part may be an everyday word.
    fn add_parts(&mut self, scene: &Scene) {
        let values = || scene.attributes().iter().flat_map(|attribute| &attribute.values);
        let spoken: Vec<Vec<String>> =
            values().map(|value| words(&format!("{} {}", value.name, value.spoken))).collect();
        for value in values().filter(|value| value.role() != Role::Place) {
            let name = words(&value.name);
            let parts = name.iter().enumerate().filter(|_| name.len() > 1);
            for (at, part) in parts {
                let owners = spoken.iter().filter(|words| words.contains(part)).count();
                let is_last = at + 1 == name.len();
                let is_own = part.len() > 2
                    && owners == 1
                    && (is_last || !self.lookalikes.is_common(part))
                    && !is_phrase(part);
                let place = self.values.iter().position(|it| it.word == value.word);
                if let Some(place) = place.filter(|_| is_own) {
                    self.add_inflected(vec![part.clone()], false, Meaning::Value(place));
                    self.add(std::slice::from_ref(part), Meaning::Value(place));
                }
            }
        }
    }

    /// "light" for a flashlight: the end of a compound, if no other value ends with it.
    fn add_heads(&mut self, scene: &Scene) {
        let values = || scene.attributes().iter().flat_map(|attribute| &attribute.values);
        let compounds: Vec<String> =
            values().filter_map(|value| words(&value.name).pop()).collect();
        for value in values().filter(|value| value.role() == Role::Kind) {
            let name = words(&value.name).pop().unwrap_or_default();
            let place = self.values.iter().position(|it| it.word == value.word);
            let heads = (HEAD_LENGTH_MIN..).take_while(|at| at + HEAD_LENGTH_MIN <= name.len());
            for head in heads.filter_map(|at| name.get(at..)).filter(|head| is_thing(head)) {
                let is_own = compounds.iter().filter(|it| it.ends_with(head)).count() == 1;
                if let Some(place) = place.filter(|_| is_own) {
                    self.add_inflected(vec![head.to_owned()], false, Meaning::Value(place));
                    self.add(&[head.to_owned()], Meaning::Value(place));
                }
            }
        }
    }

    fn add_names(&mut self, scene: &Scene) {
        let attributes = scene.attributes().iter().filter(|it| !it.by_place);
        let attributes = attributes.flat_map(|a| std::iter::once(&a.name).chain(&a.synonyms));
        let noun = std::iter::once((scene.noun(), Class::Head));
        for (name, class) in noun.chain(attributes.map(|name| (name.as_str(), Class::Attribute))) {
            let words = words(name);
            self.add(&words, Meaning::Class(class));
            self.add_inflected(words, false, Meaning::Class(class));
        }
    }

    /// Adds the phrase with every inflection of its last word.
    fn add_inflected(&mut self, mut words: Vec<String>, quality: bool, meaning: Meaning) {
        let Some(last) = words.pop() else { return };
        for form in inflected(&last, quality) {
            words.push(form);
            self.add(&words, meaning);
            words.pop();
        }
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
                [it, is, said] if matches!(&**it, "that" | "it") && is == "is" => is_value(said),
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
    const ADVERBS: &[&str] =
        &["really", "just", "honestly", "even", "truly", "actually", "also", "still", "maybe"];
    let mut words = 0;
    for word in rest {
        let here = |at: usize| after.get(at).filter(|token| !token.pauses());
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

/// Returns whether a name of a scene is an answer as well: "right".
fn names_answer(words: &[String]) -> bool {
    let [word] = words else { return false };
    matches!(Lexicon::own().word(word), Some(Sense::Class(class)) if is_answer(class))
}
