//! Sentences about a scene, drawn from templates with a fixed seed.

use scene::{Attribute, Scene, Value};

use super::templates::{COVER, PREPOSITIONS, SHAPES};
use super::words;
use crate::devices::random::SplitMix;

/// Sentences that are drawn; those that cover every word come on top. More bring no more: the
/// model's counts are stable to a few percent.
const DRAWN: usize = 4000;

/// Sentences about the scene, each a line of words as [`words`] writes them. Equal scenes yield
/// equal sentences, in the same order.
pub fn scene_sentences(scene: &Scene) -> Vec<String> {
    let mut speaker = Speaker::new(scene);
    let weights: u32 = SHAPES.iter().map(|(weight, shapes)| weight * shapes.len() as u32).sum();
    let mut sentences = Vec::with_capacity(DRAWN);
    for _ in 0..DRAWN {
        let shape = speaker.shape(weights);
        sentences.push(speaker.fill(shape));
    }
    for form in speaker.forms() {
        for shape in COVER {
            let shape = shape.replace("{value}", &form);
            sentences.push(speaker.fill(&shape));
        }
    }
    sentences.retain(|sentence| !sentence.is_empty());
    sentences
}

/// The part that an attribute's values play in a sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Before the noun: "the white bowl".
    Adjective,
    /// Instead of the noun: "the marker".
    Noun,
    /// After the noun: "the bowl in the cabinet".
    Place,
}

impl Part {
    /// Read off how questions name the values: "in the cabinet", "a marker", "white".
    fn of(attribute: &Attribute) -> Self {
        let begins = |with: &[&str]| {
            (attribute.values.iter())
                .any(|v| v.spoken.split_once(' ').is_some_and(|(first, _)| with.contains(&first)))
        };
        if begins(PREPOSITIONS) {
            Self::Place
        } else if begins(&["a", "an"]) {
            Self::Noun
        } else {
            Self::Adjective
        }
    }
}

/// Draws what to say.
struct Speaker<'a> {
    scene: &'a Scene,
    parts: Vec<Part>,
    random: SplitMix,
}

impl<'a> Speaker<'a> {
    fn new(scene: &'a Scene) -> Self {
        let parts = scene.attributes().iter().map(Part::of).collect();
        Self { scene, parts, random: SplitMix::new(0x5EED) }
    }

    fn shape(&mut self, weights: u32) -> &'static str {
        let mut at = self.random.below(weights as usize) as u32;
        for (weight, shapes) in SHAPES {
            let here = weight * shapes.len() as u32;
            if at < here {
                return shapes[(at / weight) as usize];
            }
            at -= here;
        }
        ""
    }

    /// Every word or phrase for a value of the scene.
    fn forms(&self) -> Vec<String> {
        let values = self.scene.attributes().iter().flat_map(|a| &a.values);
        values
            .flat_map(|v| std::iter::once(&v.name).chain(&v.synonyms))
            .map(|form| words(form).join(" "))
            .filter(|form| !form.is_empty())
            .collect()
    }

    /// The shape with its slots filled; a slot that the scene cannot fill empties the sentence.
    fn fill(&mut self, shape: &str) -> String {
        let mut said = String::new();
        for piece in shape.split_inclusive('}') {
            let (text, slot) = piece.split_once('{').unwrap_or((piece, ""));
            said.push_str(text);
            if slot.is_empty() {
                continue;
            }
            let Some(phrase) = self.slot(slot.trim_end_matches('}')) else {
                return String::new();
            };
            said.push_str(&phrase);
        }
        words(&said).join(" ")
    }

    fn slot(&mut self, slot: &str) -> Option<String> {
        match slot {
            "np" => Some(self.noun_phrase()),
            "one" => Some(self.short_phrase()),
            "is" => self.predicate(),
            "place" => self.place(),
            "value" => self.any_value().map(|(_, v)| self.form(v)),
            "noun" => Some(self.scene.noun().to_owned()),
            _ => None,
        }
    }

    /// "the small white bowl in the cabinet": mostly values of one object, at times a mixture,
    /// because people err and scenes change.
    fn noun_phrase(&mut self) -> String {
        let object = self.random.below(self.scene.objects().len());
        let mut adjectives = Vec::new();
        let (mut head, mut place) = (None, None);
        for k in 0..self.parts.len() {
            let part = self.parts[k];
            let said = self.random.chance(if part == Part::Noun { 90 } else { 35 });
            let Some(value) = self.value_of(object, k).filter(|_| said) else { continue };
            match part {
                Part::Adjective => adjectives.push(self.form(value)),
                Part::Noun => head = Some(self.form(value)),
                Part::Place => place = Some(self.place_phrase(value)),
            }
        }
        self.random.shuffle(&mut adjectives);
        let head = head.unwrap_or_else(|| self.head());
        let article = self.random.pick(&["the", "the", "the", "the", "the", "the", "a", "that"]);
        let article = article.copied().unwrap_or("the");
        format!("{article} {} {head} {}", adjectives.join(" "), place.unwrap_or_default())
    }

    /// "the white one": one or two values before the noun, or a place after it.
    fn short_phrase(&mut self) -> String {
        let Some((k, value)) = self.any_value() else { return format!("the {}", self.head()) };
        let form = self.form(value);
        match self.parts[k] {
            Part::Place if self.random.chance(50) => {
                format!("the one {}", self.place_phrase(value))
            }
            Part::Place => format!("the one from the {form}"),
            Part::Noun => format!("the {form}"),
            Part::Adjective => {
                let second = self.any_value().filter(|(k, _)| self.parts[*k] == Part::Adjective);
                let second = second.filter(|_| self.random.chance(30)).map(|(_, v)| self.form(v));
                let head = if self.random.chance(75) { "one".to_owned() } else { self.head() };
                format!("the {form} {} {head}", second.unwrap_or_default())
            }
        }
    }

    /// What follows "it is": "white", "made of metal", "in the cabinet", "a marker".
    fn predicate(&mut self) -> Option<String> {
        let (k, value) = self.any_value()?;
        let form = if self.random.chance(40) { value.spoken.clone() } else { self.form(value) };
        Some(match self.parts[k] {
            Part::Place => self.place_phrase(value),
            Part::Noun if form == value.spoken => form,
            Part::Noun => format!("a {form}"),
            Part::Adjective if self.random.chance(50) => form,
            // As the robot asks: "Is it made of metal?"
            Part::Adjective => {
                let wordings = &self.scene.attributes()[k].ask_yes_no;
                let asked = wordings.iter().find_map(|asked| asked.strip_prefix("Is it "));
                let asked = asked.map(|a| a.trim_end_matches('?').replace("{value}", &form));
                asked.filter(|a| !a.contains('{')).unwrap_or(form)
            }
        })
    }

    fn place(&mut self) -> Option<String> {
        let places: Vec<usize> =
            (0..self.parts.len()).filter(|&k| self.parts[k] == Part::Place).collect();
        let k = *self.random.pick(&places)?;
        let value = self.random.pick(&self.scene.attributes()[k].values)?;
        Some(self.place_phrase(value))
    }

    /// "in the dishwasher" as the scene says it, "in the dish washer", "from the dishwasher".
    fn place_phrase(&mut self, value: &Value) -> String {
        let form = self.form(value);
        let own = value.spoken.replace(&value.name, &form);
        match self.random.below(10) {
            0..5 => own,
            5..8 => format!("from the {form}"),
            8 => format!("in the {form}"),
            _ => format!("on the {form}"),
        }
    }

    /// The value of an object, or now and then any value of the attribute.
    fn value_of(&mut self, object: usize, k: usize) -> Option<&'a Value> {
        let values = &self.scene.attributes()[k].values;
        if self.random.chance(20) {
            return self.random.pick(values);
        }
        self.scene.objects()[object].values[k].map(|v| &values[v.index()])
    }

    /// Any value of any attribute.
    fn any_value(&mut self) -> Option<(usize, &'a Value)> {
        let k = self.random.below(self.parts.len());
        let attribute = self.scene.attributes().get(k)?;
        Some((k, self.random.pick(&attribute.values)?))
    }

    /// The value's name, or as often any of its synonyms.
    fn form(&mut self, value: &Value) -> String {
        if self.random.chance(60) {
            return value.name.clone();
        }
        self.random.pick(&value.synonyms).unwrap_or(&value.name).clone()
    }

    fn head(&mut self) -> String {
        if self.random.chance(70) { self.scene.noun().to_owned() } else { "one".to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::devices::testing::{bowls, tools};

    #[test]
    fn every_word_for_every_value_is_said() {
        for scene in [bowls(), tools()] {
            let sentences = scene_sentences(&scene);
            let said: BTreeSet<&str> = sentences.iter().flat_map(|s| s.split(' ')).collect();
            let forms = scene.attributes().iter().flat_map(|a| &a.values);
            for form in forms.flat_map(|v| std::iter::once(&v.name).chain(&v.synonyms)) {
                for word in words(form) {
                    assert!(said.contains(word.as_str()), "{word} of {}", scene.name());
                }
            }
            for word in ["yes", "no", "not", "stop", "repeat", "never", "over", scene.noun()] {
                assert!(said.contains(word), "{word}");
            }
        }
    }

    #[test]
    fn sentences_are_clean_words_and_always_the_same() {
        let sentences = scene_sentences(&tools());
        assert!(sentences.len() > DRAWN);
        for sentence in &sentences {
            assert_eq!(&words(sentence).join(" "), sentence);
            assert!(!sentence.contains(['{', '}']), "{sentence}");
        }
        assert_eq!(sentences, scene_sentences(&tools()));
    }

    #[test]
    fn parts_of_speech_are_read_off_the_questions() {
        let parts = |scene: &Scene| scene.attributes().iter().map(Part::of).collect::<Vec<_>>();
        use Part::{Adjective, Noun, Place};
        assert_eq!(parts(&bowls()), [Adjective, Adjective, Adjective, Adjective, Place]);
        assert_eq!(parts(&tools()), [Noun, Adjective, Adjective, Place]);
    }
}
