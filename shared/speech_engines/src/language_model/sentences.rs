//! Sentences about a scene, drawn from templates with a fixed seed.

use scene::{Attribute, Scene, Value};

use super::templates::{COVERAGE, PREPOSITIONS, shapes};
use super::words;
use crate::random::{Rng, below};

/// Sentences that are drawn besides those that cover every word. More do not help: the model's
/// counts are stable to a few percent.
const DRAWN: usize = 4000;

/// Returns sentences about the scene, each a line of words as [`words`] writes them. Equal scenes
/// yield equal sentences in equal order.
pub fn scene_sentences(scene: &Scene) -> Vec<String> {
    let mut generator = Generator::new(scene);
    let shapes = shapes();
    let weights: u32 = shapes.iter().map(|(weight, shapes)| weight * shapes.len() as u32).sum();
    let mut sentences = Vec::with_capacity(DRAWN);
    for _ in 0..DRAWN {
        let at = below(&mut generator.rng, weights as usize) as u32;
        sentences.push(generator.fill(shape_at(&shapes, at)));
    }
    for form in generator.forms() {
        for shape in COVERAGE {
            sentences.push(generator.fill(&shape.replace("{value}", &form)));
        }
    }
    sentences.retain(|sentence| !sentence.is_empty());
    sentences
}

/// Returns the shape at a position of the cumulated weights.
fn shape_at(shapes: &[(u32, Vec<&'static str>)], mut at: u32) -> &'static str {
    for (weight, shapes) in shapes {
        let here = weight * shapes.len() as u32;
        if at < here {
            return shapes[(at / weight) as usize];
        }
        at -= here;
    }
    ""
}

/// Part of speech of an attribute's values.
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
    /// Derives it from the spoken values: "in the cabinet", "a marker", "white".
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

/// Draws sentences.
struct Generator<'a> {
    scene: &'a Scene,
    parts: Vec<Part>,
    rng: Rng,
}

impl<'a> Generator<'a> {
    fn new(scene: &'a Scene) -> Self {
        let parts = scene.attributes().iter().map(Part::of).collect();
        Self { scene, parts, rng: Rng::new(0x5EED) }
    }

    fn below(&mut self, n: usize) -> usize {
        below(&mut self.rng, n)
    }

    fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    fn pick<'t, T>(&mut self, from: &'t [T]) -> Option<&'t T> {
        from.get(self.below(from.len()))
    }

    /// Shuffles after Fisher and Yates.
    fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }

    /// Returns every word or phrase for a value of the scene.
    fn forms(&self) -> Vec<String> {
        let values = self.scene.attributes().iter().flat_map(|a| &a.values);
        values
            .flat_map(|v| std::iter::once(&v.name).chain(&v.synonyms))
            .map(|form| words(form).join(" "))
            .filter(|form| !form.is_empty())
            .collect()
    }

    /// Fills the slots of a shape; a slot that the scene cannot fill empties the sentence.
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

    /// Returns a phrase like "the small white bowl in the cabinet": mostly values of one object,
    /// sometimes a mixture, because people make mistakes and scenes change.
    fn noun_phrase(&mut self) -> String {
        let object = self.below(self.scene.objects().len());
        let mut adjectives = Vec::new();
        let (mut head, mut place) = (None, None);
        for k in 0..self.parts.len() {
            let part = self.parts[k];
            let said = self.chance(if part == Part::Noun { 90 } else { 35 });
            let Some(value) = self.value_of(object, k).filter(|_| said) else { continue };
            match part {
                Part::Adjective => adjectives.push(self.form(value)),
                Part::Noun => head = Some(self.form(value)),
                Part::Place => place = Some(self.place_phrase(value)),
            }
        }
        self.shuffle(&mut adjectives);
        let head = head.unwrap_or_else(|| self.head());
        let article = self.pick(&["the", "the", "the", "the", "the", "the", "a", "that"]);
        let article = article.copied().unwrap_or("the");
        format!("{article} {} {head} {}", adjectives.join(" "), place.unwrap_or_default())
    }

    /// Returns a phrase like "the white one": one or two values before the noun, or a place after.
    fn short_phrase(&mut self) -> String {
        let Some((k, value)) = self.any_value() else { return format!("the {}", self.head()) };
        let form = self.form(value);
        let part = self.parts[k];
        match part {
            Part::Place if self.chance(50) => {
                format!("the one {}", self.place_phrase(value))
            }
            Part::Place => format!("the one from the {form}"),
            Part::Noun => format!("the {form}"),
            Part::Adjective => {
                let second = self.any_value().filter(|(k, _)| self.parts[*k] == Part::Adjective);
                let second = second.filter(|_| self.chance(30)).map(|(_, v)| self.form(v));
                let head = if self.chance(75) { "one".to_owned() } else { self.head() };
                format!("the {form} {} {head}", second.unwrap_or_default())
            }
        }
    }

    /// Returns a complement of "it is": "white", "made of metal", "in the cabinet", "a marker".
    fn predicate(&mut self) -> Option<String> {
        let (k, value) = self.any_value()?;
        let form = if self.chance(40) { value.spoken.clone() } else { self.form(value) };
        let part = self.parts[k];
        Some(match part {
            Part::Place => self.place_phrase(value),
            Part::Noun if form == value.spoken => form,
            Part::Noun => format!("a {form}"),
            Part::Adjective if self.chance(50) => form,
            // From the wording of a question: "Is it made of metal?"
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
        let k = *self.pick(&places)?;
        let value = self.pick(&self.scene.attributes()[k].values)?;
        Some(self.place_phrase(value))
    }

    /// Returns a phrase like "in the dishwasher" (from the scene) or "from the dishwasher".
    fn place_phrase(&mut self, value: &Value) -> String {
        let form = self.form(value);
        let own = value.spoken.replace(&value.name, &form);
        match self.below(10) {
            0..5 => own,
            5..8 => format!("from the {form}"),
            8 => format!("in the {form}"),
            _ => format!("on the {form}"),
        }
    }

    /// Returns the value of an object, occasionally any value of the attribute.
    fn value_of(&mut self, object: usize, k: usize) -> Option<&'a Value> {
        let values = &self.scene.attributes()[k].values;
        if self.chance(20) {
            return self.pick(values);
        }
        self.scene.objects()[object].values[k].map(|v| &values[v.index()])
    }

    /// Returns any value of any attribute.
    fn any_value(&mut self) -> Option<(usize, &'a Value)> {
        let k = self.below(self.parts.len());
        let attribute = self.scene.attributes().get(k)?;
        Some((k, self.pick(&attribute.values)?))
    }

    /// Returns the value's name or one of its synonyms.
    fn form(&mut self, value: &Value) -> String {
        if self.chance(60) {
            return value.name.clone();
        }
        self.pick(&value.synonyms).unwrap_or(&value.name).clone()
    }

    fn head(&mut self) -> String {
        if self.chance(70) { self.scene.noun().to_owned() } else { "one".to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::testing::{bowls, tools};

    #[test]
    fn sentences_contain_every_word_of_every_value() {
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
    fn sentences_are_clean_words_and_deterministic() {
        let sentences = scene_sentences(&tools());
        assert!(sentences.len() > DRAWN);
        for sentence in &sentences {
            assert_eq!(&words(sentence).join(" "), sentence);
            assert!(!sentence.contains(['{', '}']), "{sentence}");
        }
        assert_eq!(sentences, scene_sentences(&tools()));
    }

    #[test]
    fn parts_of_speech_follow_from_the_spoken_values() {
        let parts = |scene: &Scene| scene.attributes().iter().map(Part::of).collect::<Vec<_>>();
        use Part::{Adjective, Noun, Place};
        assert_eq!(parts(&bowls()), [Adjective, Adjective, Adjective, Adjective, Place]);
        assert_eq!(parts(&tools()), [Noun, Adjective, Adjective, Place]);
    }
}
