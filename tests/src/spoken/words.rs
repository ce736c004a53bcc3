//! What a person who wants one object says: a first imprecise request, true answers in varied
//! words, now and then more than was asked or a second thought.

use dialogue::Rng;
use language::{Language, Reader};
use scene::{AttributeId, ObjectId, Question, Role, Scene, ValueId};

/// Probability of naming a value by a synonym, where it has one.
const SYNONYM: f64 = 0.15;
/// How many values the request names, by probability: none, one, two.
const REQUEST: [f64; 3] = [0.5, 0.35, 0.15];
/// Manners of an answer, by probability: plain, with the value, with another value, and in place
/// of yes or no a description.
const MANNERS: [f64; 4] = [0.6, 0.25, 0.1, 0.05];
/// Probability of another remark after an answer.
const SECOND_THOUGHT: f64 = 0.06;

/// Wordings of one question that people know.
const WORDINGS: u64 = 4;

const VERBS: [&str; 5] = ["get me", "bring me", "please get me", "i want", "hand me"];
const YES: [&str; 5] = ["yes", "yeah", "yes it is", "yes please", "sure"];
const NO: [&str; 4] = ["no", "nope", "no it is not", "no it isn't"];

/// What a question is about, as a person understands it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// Whether the object has this value.
    Whether(AttributeId, ValueId),
    /// Which value the object has.
    Which(AttributeId),
    /// Something else: what is wanted at all.
    Open,
}

/// Somebody who wants one object.
pub struct Person {
    scene: Scene,
    reader: Reader,
    wanted: ObjectId,
    rng: Rng,
}

type Value = (AttributeId, ValueId);

impl Person {
    /// Somebody who wants that object; the same seed says the same.
    pub fn new(scene: &Scene, wanted: ObjectId, rng: Rng) -> Self {
        let reader = Reader::new(scene, Language::Careful);
        Self { scene: scene.clone(), reader, wanted, rng }
    }

    /// What the robot's words ask.
    pub fn understand(&self, words: &str) -> Asked {
        let mut parts = words.split_inclusive(['.', '?', '!']).map(str::trim);
        let question = parts.rfind(|part| part.ends_with('?')).unwrap_or(words);
        let reading = self.reader.read(question, Question::None);
        let value = |word: &String| {
            let attributes = self.scene.attributes().iter().enumerate();
            let mut found = attributes.filter_map(|(k, attribute)| {
                let v = attribute.values.iter().position(|value| value.name == *word)?;
                Some((AttributeId::from(k), ValueId::from(v)))
            });
            found.next()
        };
        let words = reading.base.iter().map(|word| &self.scene.words()[word.index()]);
        let values: Vec<Value> = words.filter_map(value).collect();
        match values.as_slice() {
            [(k, v)] => Asked::Whether(*k, *v),
            [(k, _), rest @ ..] if rest.iter().all(|(other, _)| other == k) => Asked::Which(*k),
            _ => self.asked_about(question),
        }
    }

    /// An open question names its attribute, or is worded as the scene words it.
    fn asked_about(&self, question: &str) -> Asked {
        let lower = question.to_lowercase();
        for (k, attribute) in self.scene.attributes().iter().enumerate() {
            let k = AttributeId::from(k);
            let wording = |n| self.scene.phrase_variant(Question::Which(k), n, 1).to_lowercase();
            let is_worded = (0..WORDINGS).any(|n| lower.contains(&wording(n)));
            let is_named = std::iter::once(&attribute.name).chain(&attribute.synonyms);
            if is_worded || is_named.into_iter().any(|name| lower.contains(&name.to_lowercase())) {
                return Asked::Which(k);
            }
        }
        Asked::Open
    }

    /// The first words.
    pub fn request(&mut self) -> String {
        let count = self.number(&REQUEST);
        let mut values = self.own_values();
        values.truncate(count);
        format!("{} the {}", self.one_of(&VERBS), self.object(&values))
    }

    /// The request once more, in plain words: the robot did not react.
    pub fn request_again(&mut self) -> String {
        format!("get me the {}", self.scene.noun())
    }

    /// A true answer.
    pub fn answer(&mut self, asked: Asked) -> String {
        match asked {
            Asked::Whether(k, v) => self.yes_or_no((k, v)),
            Asked::Which(k) => match self.value_of(k) {
                Some(value) if self.chance(0.5) => self.word(value),
                Some(value) => self.statement(value),
                None => "i don't know".to_owned(),
            },
            Asked::Open => {
                let mut values = self.own_values();
                values.truncate(2);
                format!("the {}", self.object(&values))
            }
        }
    }

    /// A remark after an answer, seldom, and how long after it, seconds.
    pub fn second_thought(&mut self) -> Option<(f64, String)> {
        if !self.chance(SECOND_THOUGHT) {
            return None;
        }
        let value = self.own_values().first().copied()?;
        let pause_s = 0.9 + 1.6 * self.rng.uniform();
        Some((pause_s, self.statement(value)))
    }

    /// A reaction time: log-normal, seconds.
    pub fn reaction_s(&mut self) -> f64 {
        preflight::log_normal(&mut self.rng, 0.9, 0.55)
    }

    fn yes_or_no(&mut self, (k, v): Value) -> String {
        let yes = self.scene.has(self.wanted, k, v);
        let plain = self.one_of(if yes { &YES } else { &NO });
        let own = self.value_of(k);
        let other = self.own_values().into_iter().find(|(other, _)| *other != k);
        match (self.number(&MANNERS), own, other) {
            (1, Some(own), _) => {
                let said = self.statement(own);
                format!("{} {said}", if yes { "yes" } else { "no" })
            }
            (2, _, Some(other)) => {
                let said = self.predicate(other);
                format!("{} and it is {said}", if yes { "yes" } else { "no" })
            }
            (3, Some(own), _) => self.statement(own),
            _ => plain.to_owned(),
        }
    }

    /// "it is white", "the white one", "the one in the cabinet".
    fn statement(&mut self, value: Value) -> String {
        let role = self.scene.attributes()[value.0.index()].values[value.1.index()].role();
        let said = self.predicate(value);
        match role {
            Role::Place if self.chance(0.5) => format!("the one {said}"),
            Role::Quality if self.chance(0.5) => format!("the {said} one"),
            _ => format!("it is {said}"),
        }
    }

    fn object(&mut self, values: &[Value]) -> String {
        let (mut before, mut after) = (Vec::new(), Vec::new());
        for &value in values {
            let said = self.predicate(value);
            match self.scene.attributes()[value.0.index()].values[value.1.index()].role() {
                Role::Place => after.push(said),
                Role::Quality | Role::Kind => before.push(said),
            }
        }
        before.push(self.scene.noun().to_owned());
        before.extend(after);
        before.join(" ")
    }

    fn predicate(&mut self, value: Value) -> String {
        let word = self.word(value);
        let of = &self.scene.attributes()[value.0.index()].values[value.1.index()];
        of.spoken.replace(&of.name, &word)
    }

    fn word(&mut self, (k, v): Value) -> String {
        let value = self.scene.attributes()[k.index()].values[v.index()].clone();
        if !value.synonyms.is_empty() && self.chance(SYNONYM) {
            return value.synonyms[self.rng.below(value.synonyms.len())].clone();
        }
        value.name
    }

    fn value_of(&self, k: AttributeId) -> Option<Value> {
        let v = self.scene.object(self.wanted).values.get(k.index()).copied().flatten()?;
        Some((k, v))
    }

    /// The wanted object's values that tell objects apart, in any order.
    fn own_values(&mut self) -> Vec<Value> {
        let attributes = self.scene.attributes().iter().enumerate();
        let telling = attributes.filter(|(_, attribute)| attribute.values.len() > 1);
        let telling: Vec<AttributeId> = telling.map(|(k, _)| AttributeId::from(k)).collect();
        let mut values: Vec<Value> = telling.into_iter().filter_map(|k| self.value_of(k)).collect();
        for n in (1..values.len()).rev() {
            values.swap(n, self.rng.below(n + 1));
        }
        values
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.rng.uniform() < probability
    }

    fn one_of(&mut self, list: &[&'static str]) -> &'static str {
        list[self.rng.below(list.len())]
    }

    fn number(&mut self, probabilities: &[f64]) -> usize {
        let mut left = self.rng.uniform();
        for (n, p) in probabilities.iter().enumerate() {
            left -= p;
            if left < 0.0 {
                return n;
            }
        }
        probabilities.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bowls() -> Scene {
        crate::settings(&[]).scene
    }

    fn person(scene: &Scene, wanted: &str, seed: u64) -> Person {
        let wanted = scene.object_named(wanted).unwrap();
        Person::new(scene, wanted, Rng::new(seed))
    }

    #[test]
    fn every_question_of_the_scene_is_understood_from_its_words() {
        let scene = bowls();
        let person = person(&scene, "white", 1);
        for (k, attribute) in scene.attributes().iter().enumerate() {
            let k = AttributeId::from(k);
            for v in (0..attribute.values.len()).map(ValueId::from) {
                let question = Question::Attribute(k, v);
                for (n, presentation) in (0..WORDINGS).flat_map(|n| (1..5).map(move |p| (n, p))) {
                    let words = scene.phrase_variant(question, n, presentation);
                    assert_eq!(person.understand(&words), Asked::Whether(k, v), "{words}");
                }
                let words = format!("I do not know \"red\" here. {}", scene.phrase(question));
                assert_eq!(person.understand(&words), Asked::Whether(k, v), "{words}");
            }
            for n in 0..WORDINGS {
                let words = scene.phrase_variant(Question::Which(k), n, 1);
                assert_eq!(person.understand(&words), Asked::Which(k), "{words}");
            }
        }
        assert_eq!(person.understand("Which bowl would you like?"), Asked::Open);
    }

    /// Whatever is said is true: it never rules out what is wanted.
    #[test]
    fn answers_are_true() {
        let scene = bowls();
        let reader = Reader::new(&scene, Language::Careful);
        let model = dialogue::Model::new(&scene, dialogue::Params::default());
        for seed in 0..600 {
            let name = &scene.objects()[(seed % 6) as usize].name;
            let mut person = person(&scene, name, seed);
            let k = AttributeId::from((seed / 6 % 5) as usize);
            let v = ValueId::from(person.rng.below(scene.attributes()[k.index()].values.len()));
            let question = Question::Attribute(k, v);
            let said = person.answer(Asked::Whether(k, v));
            let reading = reader.read(&said, question);
            let mut belief = dialogue::Belief::uniform(6);
            let wanted = scene.object_named(name).unwrap();
            belief.update(&model, question, &reading);
            let best = belief.probabilities().iter().copied().fold(0.0, f64::max);
            let own = belief.probabilities()[wanted.index()];
            assert!(own > 0.9 * best, "seed {seed}: {question:?} of {name}: {said}, {reading:?}");
        }
    }

    #[test]
    fn the_same_seed_says_the_same() {
        let scene = bowls();
        let said = |seed| {
            let mut person = person(&scene, "metal", seed);
            (0..20).map(|_| person.request()).collect::<Vec<_>>()
        };
        assert_eq!(said(4), said(4));
        assert_ne!(said(4), said(5));
    }
}
