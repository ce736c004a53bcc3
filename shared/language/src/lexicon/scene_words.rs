//! The words of a scene in the lexicon: its values in all their forms, its noun and attributes.

use std::collections::HashMap;

use scene::{AttributeId, Role, Scene, Value, WordId};
use words::{Tokens, normalise};

use super::{Lexicon, Meaning, Sense, ValueSense};
use crate::closed_class::{is_answer, is_closed};
use crate::morphology::{inflected, singulars};
use crate::relation_words::by_quality;
use crate::relations::{Form, forms, words};
use crate::synonyms::{common_synonyms, is_thing};
use crate::token_class::Class;
use crate::vocabulary::is_phrase;

/// Letters of the shortest head of a compound, and of the part before it.
const HEAD_LENGTH_MIN: usize = 3;

impl Lexicon {
    /// Adds the words of a scene; what is added first stays.
    pub(super) fn add_scene(&mut self, scene: &Scene) {
        self.add_values(scene);
        self.add_names(scene);
        self.add_parts(scene);
        self.add_heads(scene);
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
                if is_own {
                    self.add_part(part, value.word);
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
            let heads = (HEAD_LENGTH_MIN..).take_while(|at| at + HEAD_LENGTH_MIN <= name.len());
            for head in heads.filter_map(|at| name.get(at..)).filter(|head| is_thing(head)) {
                let is_own = compounds.iter().filter(|it| it.ends_with(head)).count() == 1;
                if is_own {
                    self.add_part(head, value.word);
                }
            }
        }
    }

    /// Adds a part of a value's name, in its forms.
    fn add_part(&mut self, part: &str, word: WordId) {
        if let Some(place) = self.values.iter().position(|it| it.word == word) {
            self.add_inflected(vec![part.to_owned()], false, Meaning::Value(place));
            self.add(&[part.to_owned()], Meaning::Value(place));
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
}

/// Returns whether a name of a scene is an answer as well: "right".
fn names_answer(words: &[String]) -> bool {
    let [word] = words else { return false };
    matches!(Lexicon::own().word(word), Some(Sense::Class(class)) if is_answer(class))
}
