//! What the recurrent judge reads of an utterance: the question, then its elements, each as rows of embeddings.

use crate::features::{
    Context, Element, asks_politely, begins, hash, kind, kind_of, letters, mix, sort, text, text_of,
};
use crate::recurrent::{EMBEDDINGS, Sequence};

/// Most elements; a longer utterance is cut off around its value words.
const ELEMENTS_MAX: usize = 64;

/// Rows of an element or a value word.
#[derive(Default)]
struct Rows(Vec<u32>);

impl Rows {
    fn add(&mut self, name: &[u8], parts: &[u64]) {
        let hash = parts.iter().fold(hash(name.iter().copied()), |hash, part| mix(hash, *part));
        self.0.push((hash >> 16) as u32 % EMBEDDINGS as u32);
    }
}

/// Returns what the recurrent judge reads.
pub(crate) fn sequence(context: &Context<'_>, phrases: &[usize]) -> Sequence {
    let mut question = Rows::default();
    question.add(b"question", &[context.question(None).0]);
    question.add(b"polite", &[u64::from(asks_politely(context.tags))]);
    let mut sequence = Sequence { elements: vec![question.0], values: Vec::new() };
    let mut places = Vec::new();
    for element in context.elements.iter().take(ELEMENTS_MAX) {
        if let Element::Phrase(number) = element {
            places.push((*number, sequence.elements.len()));
        }
        sequence.elements.push(context.element(element));
    }
    for (number, phrase) in phrases.iter().enumerate() {
        let place = places.iter().find(|place| place.0 == *phrase).map_or(0, |place| place.1);
        sequence.values.push((place, context.value(number)));
    }
    sequence
}

impl Context<'_> {
    fn element(&self, element: &Element<'_>) -> Vec<u32> {
        let mut rows = Rows::default();
        let is = Some(element);
        rows.add(b"kind", &[kind(is)]);
        match element {
            Element::Pause => {}
            Element::Phrase(number) => self.noun_phrase(&mut rows, *number),
            Element::Word(tag) => {
                rows.add(b"text", &[text(is)]);
                rows.add(b"sort", &[sort(is)]);
                rows.add(b"letters", &[letters(is)]);
                let word = tag.word.as_bytes();
                rows.add(b"head", &[hash(word.iter().copied().take(4))]);
                rows.add(b"tail", &[hash(word.iter().copied().rev().take(3))]);
            }
        }
        rows.0
    }

    fn noun_phrase(&self, rows: &mut Rows, number: usize) {
        let span = &self.spans[number];
        let tags = &self.tags[span.clone()];
        rows.add(b"begins", &[tags.first().map_or(0, begins)]);
        for tag in tags.iter().filter(|tag| !tag.is_value()) {
            rows.add(b"in", &[text_of(tag)]);
            rows.add(b"in kind", &[kind_of(tag)]);
        }
        let values = self.found.iter().enumerate().filter(|(_, found)| span.contains(&found.0));
        for (n, (at, word)) in values {
            rows.add(b"role", &[self.role(*at)]);
            rows.add(b"asked", &[u64::from(self.question(Some(*word)).1)]);
            for (relation, side) in self.relations(n) {
                rows.add(b"relation", &[relation, side]);
            }
        }
    }

    /// What is known of a value word besides its place.
    fn value(&self, number: usize) -> Vec<u32> {
        let mut rows = Rows::default();
        let (at, word) = self.found[number];
        let own = &self.tags[at];
        let (kind, is_asked) = self.question(Some(word));
        rows.add(b"own role", &[self.role(at)]);
        rows.add(b"own exact", &[u64::from(own.exact)]);
        rows.add(b"own asked", &[kind, u64::from(is_asked)]);
        let before = at.checked_sub(1).map(|at| &self.tags[at]);
        rows.add(b"own before", &[before.filter(|_| !own.pauses()).map_or(0, begins)]);
        for (relation, side) in self.relations(number) {
            rows.add(b"own relation", &[relation, side]);
        }
        rows.0
    }

    fn role(&self, at: usize) -> u64 {
        self.tags[at].value().map_or(9, |value| value.role as u64)
    }
}
