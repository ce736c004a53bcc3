//! What the judge looks at around a value word: words and classes near it, the other values, and the question.
//!
//! A feature is the number of a row of weights; which one, a hash decides.

use scene::{StableHash, WordId};

use crate::question_words::QuestionWords;
use crate::recurrent::Sequence;
use crate::sequence::sequence;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::word_groups::group_of;

/// Number of rows.
pub const ROWS: usize = 1 << 16;
/// Words that belong to a noun phrase, besides its values.
const NOUN_PHRASE: &[Class] =
    classes![Determiner Possessive Pointer Quantifier Head One Attribute Unlisted Ordinal];
/// Most value words of an utterance that are judged; a longer list of them is no description.
pub(crate) const MENTIONS_MAX: usize = 16;
/// Most elements on each side that count.
const FAR: usize = 32;
/// Number of elements on each side whose places count.
const NEAR: usize = 4;

/// A value word to be judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Example {
    /// Its tag.
    pub(crate) at: usize,
    /// The scene's word.
    pub word: WordId,
    /// The words as they were said, in plain lower case; empty unless they are asked for.
    pub surface: String,
    /// Number of its noun phrase in the utterance: the values of one phrase share their fate.
    pub phrase: usize,
    /// Its features, each a row of weights.
    pub rows: Vec<u32>,
}

/// What the judge looks at in an utterance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// The value words, each with the rows of the linear part.
    pub examples: Vec<Example>,
    /// What the recurrent part reads.
    pub sequence: Sequence,
}

/// One element of an utterance as the judge sees it.
#[derive(Clone, Copy)]
pub(crate) enum Element<'a> {
    Pause,
    /// A noun phrase with a value, by its number.
    Phrase(usize),
    Word(&'a Tag<'a>),
}

/// Returns what the judge looks at in an utterance that follows a question.
pub(crate) fn features(tags: &[Tag<'_>], asked: QuestionWords<'_>) -> Features {
    let value = |(at, tag): (usize, &Tag<'_>)| Some((at, tag.value()?.word));
    let found: Vec<(usize, WordId)> =
        tags.iter().enumerate().filter_map(value).take(MENTIONS_MAX).collect();
    let spans = phrases(tags, &found);
    let elements = elements(tags, &spans);
    let context = Context { tags, asked, found: &found, spans: &spans, elements: &elements };
    let example = |(number, (at, word)): (usize, &(usize, WordId))| {
        let phrase = spans.iter().position(|span| span.contains(at)).unwrap_or(0);
        let rows = context.features(number, phrase, &spans[phrase]);
        Example { at: *at, word: *word, surface: String::new(), phrase, rows }
    };
    let examples: Vec<Example> = found.iter().enumerate().map(example).collect();
    let phrases: Vec<usize> = examples.iter().map(|example| example.phrase).collect();
    let sequence = sequence(&context, &phrases);
    Features { examples, sequence }
}

/// The noun phrases that hold values, as ranges of tags.
fn phrases(tags: &[Tag<'_>], found: &[(usize, WordId)]) -> Vec<std::ops::Range<usize>> {
    let belongs = |at: usize| tags[at].is_value() || tags[at].is_any(NOUN_PHRASE);
    let mut spans: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, ..) in found {
        if spans.last().is_some_and(|span| span.contains(at)) {
            continue;
        }
        let least = spans.last().map_or(0, |span| span.end);
        let mut start = *at;
        while start > least && !tags[start].pauses() && belongs(start - 1) {
            start -= 1;
        }
        let mut end = *at + 1;
        // A determiner begins the next phrase.
        let begins =
            |at: usize| tags[at].pauses() || tags[at].is_any(classes![Determiner Possessive]);
        while end < tags.len() && belongs(end) && !begins(end) {
            end += 1;
        }
        spans.push(start..end);
    }
    spans
}

fn elements<'a>(tags: &'a [Tag<'a>], spans: &[std::ops::Range<usize>]) -> Vec<Element<'a>> {
    let mut elements = Vec::new();
    let (mut at, mut pauses) = (0, false);
    while let Some(tag) = tags.get(at) {
        // "the blue uh the black pen"
        pauses |= tag.pauses() || tag.is(Class::Filler);
        let phrase = spans.iter().position(|span| span.start == at);
        at = phrase.map_or(at + 1, |number| spans[number].end);
        if phrase.is_none() && tag.is_any(classes![Filler Courtesy]) {
            continue;
        }
        // A pause stands between two elements: that before a last "please" is none.
        if std::mem::take(&mut pauses) && !elements.is_empty() {
            elements.push(Element::Pause);
        }
        elements.push(phrase.map_or(Element::Word(tag), Element::Phrase));
    }
    elements
}

/// An utterance with its value words, their noun phrases, and its elements.
pub(crate) struct Context<'a> {
    pub(crate) tags: &'a [Tag<'a>],
    pub(crate) asked: QuestionWords<'a>,
    /// Tag and word of each value word.
    pub(crate) found: &'a [(usize, WordId)],
    pub(crate) spans: &'a [std::ops::Range<usize>],
    pub(crate) elements: &'a [Element<'a>],
}

impl Context<'_> {
    fn features(&self, number: usize, phrase: usize, span: &std::ops::Range<usize>) -> Vec<u32> {
        let (at, word) = self.found[number];
        let mut rows = Rows(Vec::with_capacity(200));
        let place =
            self.elements.iter().position(|it| matches!(it, Element::Phrase(n) if *n == phrase));
        let place = place.unwrap_or(0);
        let before: Vec<_> = self.elements[..place].iter().rev().take(FAR).copied().collect();
        let after = &self.elements[place + 1..];
        let after = &after[..after.len().min(FAR)];
        rows.add(b"bias", &[]);
        for (side, elements) in [(b"L", &before[..]), (b"R", after)] {
            Self::side(&mut rows, side[0], elements);
        }
        Self::both(&mut rows, &before, after);
        self.phrase(&mut rows, span, at);
        self.others(&mut rows, number);
        self.answers(&mut rows, word);
        rows.0
    }

    /// One side of the phrase, nearest first.
    fn side(rows: &mut Rows, side: u8, elements: &[Element<'_>]) {
        let kind = |n: usize| kind(elements.get(n));
        let text = |n: usize| text(elements.get(n));
        let sort = |n: usize| sort(elements.get(n));
        for n in 0..NEAR {
            rows.add(b"sort", &[u64::from(side), n as u64, sort(n)]);
            rows.add(b"kind", &[u64::from(side), n as u64, kind(n)]);
            rows.add(b"text", &[u64::from(side), n as u64, text(n)]);
            rows.add(b"letters", &[u64::from(side), n as u64, letters(elements.get(n))]);
        }
        let side = u64::from(side);
        rows.add(b"kinds2", &[side, kind(0), kind(1)]);
        rows.add(b"kinds3", &[side, kind(0), kind(1), kind(2)]);
        rows.add(b"sorts2", &[side, sort(0), sort(1)]);
        rows.add(b"sorts3", &[side, sort(0), sort(1), sort(2)]);
        rows.add(b"text sort", &[side, text(0), sort(1)]);
        rows.add(b"sort text", &[side, sort(0), text(1)]);
        rows.add(b"texts2", &[side, text(0), text(1)]);
        rows.add(b"texts3", &[side, text(0), text(1), text(2)]);
        rows.add(b"text1+2", &[side, text(1), text(2)]);
        rows.add(b"mixed2", &[side, kind(0), text(1)]);
        let breath = elements.iter().take_while(|it| !matches!(it, Element::Pause)).count();
        rows.add(b"breath", &[side, breath.min(6) as u64]);
        for (n, element) in elements.iter().enumerate() {
            let is_near = u64::from(n < breath);
            let (kind, text) = (self::kind(Some(element)), self::text(Some(element)));
            rows.add(b"bag kind", &[side, is_near, kind]);
            rows.add(b"bag text", &[side, is_near, text]);
            let sort = self::sort(Some(element));
            if sort != kind {
                rows.add(b"bag sort", &[side, is_near, sort]);
            }
            rows.add(b"anywhere", &[text]);
            let next = elements.get(n + 1);
            rows.add(b"bag two", &[side, is_near, text, self::text(next)]);
        }
    }

    fn both(rows: &mut Rows, before: &[Element<'_>], after: &[Element<'_>]) {
        let kinds = |side: &[Element<'_>], n: usize| kind(side.get(n));
        let texts = |side: &[Element<'_>], n: usize| text(side.get(n));
        let sorts = |side: &[Element<'_>], n: usize| sort(side.get(n));
        rows.add(b"kind kind", &[kinds(before, 0), kinds(after, 0)]);
        rows.add(b"sort sort", &[sorts(before, 0), sorts(after, 0)]);
        let four = [sorts(before, 1), sorts(before, 0), sorts(after, 0), sorts(after, 1)];
        rows.add(b"four sorts", &four);
        rows.add(b"text text", &[texts(before, 0), texts(after, 0)]);
        rows.add(b"text kind", &[texts(before, 0), kinds(after, 0)]);
        rows.add(b"kind text", &[kinds(before, 0), texts(after, 0)]);
        let four = [kinds(before, 1), kinds(before, 0), kinds(after, 0), kinds(after, 1)];
        rows.add(b"four kinds", &four);
        let four = [texts(before, 1), texts(before, 0), texts(after, 0), texts(after, 1)];
        rows.add(b"four texts", &four);
        rows.add(b"right texts", &[texts(before, 0), texts(after, 0), texts(after, 1)]);
        let first = before.last().or(after.first());
        rows.add(b"first", &[text(first)]);
        rows.add(b"last", &[text(after.last().or(before.first()))]);
    }

    fn phrase(&self, rows: &mut Rows, span: &std::ops::Range<usize>, at: usize) {
        let tags = &self.tags[span.clone()];
        for tag in tags.iter().filter(|tag| !tag.is_value()) {
            rows.add(b"in kind", &[kind_of(tag)]);
            rows.add(b"in text", &[text_of(tag)]);
        }
        let own = &self.tags[at];
        let role = own.value().map_or(9, |value| value.role as u64);
        rows.add(b"role", &[role]);
        rows.add(b"exact", &[u64::from(own.exact)]);
        let count = tags.iter().filter(|tag| tag.is_value()).count();
        rows.add(b"values", &[count as u64]);
        rows.add(b"begins", &[tags.first().map_or(0, begins)]);
    }

    fn others(&self, rows: &mut Rows, number: usize) {
        for (relation, side) in self.relations(number) {
            rows.add(b"other", &[side, relation]);
        }
        rows.add(b"polite", &[u64::from(asks_politely(self.tags))]);
        rows.add(b"mentions", &[self.found.len().min(5) as u64, number.min(5) as u64]);
    }

    /// How each other value word is related to one, and on which side it stands.
    pub(crate) fn relations(&self, number: usize) -> impl Iterator<Item = (u64, u64)> {
        let own = self.tags[self.found[number].0].value();
        let others = self.found.iter().enumerate().filter(move |(n, _)| *n != number);
        others.map(move |(n, (at, word))| {
            let rivals = own.zip(self.tags[*at].value()).is_some_and(|(own, it)| own.rivals(it));
            let is_same = *word == self.found[number].1;
            (u64::from(rivals) + 2 * u64::from(is_same), u64::from(n > number))
        })
    }

    /// The kind of the question, and whether it names a word.
    pub(crate) fn question(&self, word: Option<WordId>) -> (u64, bool) {
        match self.asked {
            QuestionWords::Nothing => (0, false),
            QuestionWords::Object(words) => (1, word.is_some_and(|word| words.contains(&word))),
            QuestionWords::PerceivedObject => (2, false),
            QuestionWords::Value(_, asked) => (3, word == Some(asked)),
            QuestionWords::Attribute | QuestionWords::Choice(_) => (4, false),
        }
    }

    fn answers(&self, rows: &mut Rows, word: WordId) {
        let (kind, is_asked) = self.question(Some(word));
        let asked = [kind, u64::from(is_asked)];
        rows.add(b"question", &asked);
        for answer in self.tags.iter().filter(|tag| tag.is_any(classes![Yes No WeakYes WeakNo])) {
            rows.add(b"answer", &[asked[0], asked[1], kind_of(answer)]);
        }
    }
}

/// "please", or thanks at the end: what stands beside it is asked for. Thanks at the beginning are for
/// what was done before.
pub(crate) fn asks_politely(tags: &[Tag<'_>]) -> bool {
    const ASKING: [&str; 15] = [
        "please", "pls", "plz", "pleez", "pleeze", "pleaze", "plees", "pliz", "kindly", "if",
        "when", "would", "could", "will", "be",
    ];
    const THANKS: [&str; 8] = ["thanks", "thank", "thx", "ty", "cheers", "ta", "many", "much"];
    let says = |tag: &Tag<'_>, words: &[&str]| tag.is(Class::Courtesy) && words.contains(&tag.word);
    tags.iter().any(|tag| says(tag, &ASKING)) || tags.last().is_some_and(|tag| says(tag, &THANKS))
}

pub(crate) fn kind(element: Option<&Element<'_>>) -> u64 {
    match element {
        None => 1,
        Some(Element::Pause) => 2,
        Some(Element::Phrase(_)) => 3,
        Some(Element::Word(tag)) => kind_of(tag),
    }
}

pub(crate) fn kind_of(tag: &Tag<'_>) -> u64 {
    match tag.class() {
        Some(class) => 16 + class as u64,
        None if tag.is_value() => 4,
        None => 5,
    }
}

/// The word that begins a phrase.
pub(crate) fn begins(tag: &Tag<'_>) -> u64 {
    if tag.is_value() { 4 } else { text_of(tag) }
}

/// Its group of like words, else its kind.
pub(crate) fn sort(element: Option<&Element<'_>>) -> u64 {
    let group = match element {
        Some(Element::Word(tag)) if tag.word == tag.last => group_of(tag.word),
        _ => None,
    };
    group.map_or_else(|| kind(element), |group| 256 + group as u64)
}

pub(crate) fn text(element: Option<&Element<'_>>) -> u64 {
    match element {
        Some(Element::Word(tag)) => text_of(tag),
        other => kind(other),
    }
}

pub(crate) fn text_of(tag: &Tag<'_>) -> u64 {
    let mut hash = hash(tag.word.bytes());
    if tag.last != tag.word {
        hash = mix(hash, self::hash(tag.last.bytes()));
    }
    hash
}

/// A word without the order of its letters: two of them change places in a slip of the finger.
pub(crate) fn letters(element: Option<&Element<'_>>) -> u64 {
    let Some(Element::Word(tag)) = element else { return kind(element) };
    let mut letters: Vec<u8> = tag.word.bytes().filter(|byte| *byte != b'\'').collect();
    letters.sort_unstable();
    hash(letters.into_iter())
}

pub(crate) fn hash(bytes: impl Iterator<Item = u8>) -> u64 {
    let mut hash = StableHash::default();
    bytes.for_each(|byte| hash.bytes(&[byte]));
    hash.value()
}

pub(crate) fn mix(one: u64, other: u64) -> u64 {
    let mixed = (one.rotate_left(25) ^ other).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed ^ (mixed >> 29)
}

/// Rows of weights.
struct Rows(Vec<u32>);

impl Rows {
    fn add(&mut self, name: &[u8], parts: &[u64]) {
        let hash = parts.iter().fold(hash(name.iter().copied()), |hash, part| mix(hash, *part));
        self.0.push((hash >> 16) as u32 % ROWS as u32);
    }
}
