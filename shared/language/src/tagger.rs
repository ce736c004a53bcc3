//! Words to tags: each word or phrase with the part that it plays, misspelt, misheard and split
//! values included.

use scene::Role;
use words::{Gap, Token, Tokens};

use crate::closed_class::{is_answer, is_closed_class, misspelt};
use crate::disambiguate::{disambiguate, drop_tag_questions};
use crate::halting::halting_words;
use crate::lexicon::{Lexicon, Sense, ValueSense};
use crate::question_words::QuestionWords;
use crate::relations::begins_relation;
use crate::spelling::shortened;
use crate::token_class::{Class, classes};

/// A word or phrase, its sense, and the pause before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tag<'a> {
    pub(crate) sense: Sense<'a>,
    pub(crate) gap: Gap,
    /// First word of the tag.
    pub(crate) word: &'a str,
    /// Place of its first word in the utterance.
    pub(crate) at: usize,
    /// Second word of the tag; the first one again if there is only one.
    pub(crate) second: &'a str,
    /// Last word of the tag; the first one again if there is only one.
    pub(crate) last: &'a str,
    /// Stands in the lexicon as it was said or typed.
    pub(crate) exact: bool,
    /// Probability that something else was said: the recogniser's doubt, and that of taking the
    /// word for another.
    pub(crate) doubt: f64,
    /// Confidence that the words were said.
    pub(crate) sure: f64,
}

/// Sense of the words at some position.
#[derive(Clone, Copy, Debug)]
struct Found<'a> {
    words: usize,
    sense: Sense<'a>,
    /// Sense of the rest of a single word: "bowl" of "whitebowl".
    second: Option<Sense<'a>>,
    doubt: f64,
    sure: f64,
}

impl<'a> Found<'a> {
    /// One word, without doubt.
    fn word(sense: Sense<'a>) -> Self {
        Self { words: 1, sense, second: None, doubt: 0.0, sure: 1.0 }
    }
}

/// Doubts of taking a word for another, judged.
pub(crate) mod doubts {
    /// One slip of the finger in a word that means nothing else, and no other value as near.
    pub(crate) const SLIP: f64 = 0.02;
    /// An everyday word one slip away, at the position of a value.
    pub(crate) const EVERYDAY: f64 = 0.3;
    /// The same consonants, at the position of a value.
    pub(crate) const SOUND: f64 = 0.3;
    /// Several words with the consonants of one value.
    pub(crate) const APART: f64 = 0.2;
}

impl<'a> Tag<'a> {
    /// The tag of the token at `at`.
    fn of(tokens: &[Token<'a>], at: usize, found: &Found<'a>) -> Self {
        let run = &tokens[at..tokens.len().min(at + found.words)];
        let least = run.iter().map(|token| token.confidence).fold(1.0, f32::min);
        let Token { word, gap, .. } = tokens[at];
        let second = run.get(1).map_or(word, |token| token.word);
        let last = run.last().map_or(word, |token| token.word);
        let exact = found.doubt == 0.0;
        let (sense, sure) = (found.sense, found.sure);
        let mut tag = Self { sense, gap, word, at, second, last, exact, doubt: 0.0, sure };
        tag.add_doubt(1.0 - f64::from(least));
        tag.add_doubt(found.doubt);
        tag
    }

    pub(crate) fn add_doubt(&mut self, doubt: f64) {
        self.doubt = 1.0 - (1.0 - self.doubt) * (1.0 - doubt);
    }

    /// Probability that the scene word behind the tag was not meant.
    pub(crate) fn word_doubt(&self) -> f64 {
        1.0 - (1.0 - self.doubt) * self.sure
    }

    /// Probability that an answer or a scope was not given: half of those that were not are right
    /// by chance.
    pub(crate) fn answer_doubt(&self) -> f64 {
        1.0 - (1.0 - self.doubt) * (2.0 * self.sure - 1.0)
    }

    pub(crate) fn class(&self) -> Option<Class> {
        if let Sense::Class(class) = self.sense { Some(class) } else { None }
    }

    pub(crate) fn is(&self, class: Class) -> bool {
        self.class() == Some(class)
    }

    pub(crate) fn is_any(&self, classes: &[Class]) -> bool {
        self.class().is_some_and(|class| classes.contains(&class))
    }

    pub(crate) fn value(&self) -> Option<&'a ValueSense> {
        if let Sense::Value(value) = self.sense { Some(value) } else { None }
    }

    pub(crate) fn is_value(&self) -> bool {
        self.value().is_some()
    }

    /// Returns whether it is a value of this role.
    pub(crate) fn is_role(&self, role: Role) -> bool {
        self.value().is_some_and(|value| value.role == role)
    }

    /// Returns whether it is a place or a part with its relation: "next to the sink", "with nuts".
    pub(crate) fn is_located(&self) -> bool {
        (self.is_role(Role::Place) || self.is_role(Role::Part))
            && self.word != self.last
            && begins_relation(self.word)
    }

    /// Returns whether it is the noun of a thing.
    pub(crate) fn is_noun(&self) -> bool {
        self.is(Class::Head) || self.is_role(Role::Kind)
    }

    pub(crate) fn is_unknown(&self) -> bool {
        matches!(self.sense, Sense::Unknown)
    }

    /// Returns whether there is a pause before it.
    pub(crate) fn pauses(&self) -> bool {
        self.gap >= Gap::Pause
    }
}

/// The tag before `at`, unless there is a pause between them.
pub(crate) fn before<'t, 'a>(tags: &'t [Tag<'a>], at: usize) -> Option<&'t Tag<'a>> {
    tags[..at].last().filter(|_| !tags[at].pauses())
}

/// The tag after `at`, unless there is a pause between them.
pub(crate) fn after<'t, 'a>(tags: &'t [Tag<'a>], at: usize) -> Option<&'t Tag<'a>> {
    tags.get(at + 1).filter(|next| !next.pauses())
}

/// Fewest letters of a value that may be written as several words.
const JOINED_LETTERS_MIN: usize = 6;
/// Most letters of a word that is tried as two run together.
const RUN_ON_LETTERS_MAX: usize = 24;

/// The tags of an utterance.
pub(crate) fn tag<'a>(lexicon: &'a Lexicon, tokens: &Tokens<'a>) -> Vec<Tag<'a>> {
    // No word of the scene takes these away.
    let mut halting = halting_words(tokens).into_iter().peekable();
    let tokens = &lexicon.unmarked(&tokens.words);
    let mut tags: Vec<Tag<'a>> = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        if let Some(words) = halting.next_if(|words| words.start <= at) {
            let stop = Found { words: words.len(), ..Found::word(Sense::Class(Class::Stop)) };
            tags.push(Tag::of(tokens, at, &stop));
            at = words.end;
            continue;
        }
        let described = tags.last().is_some_and(|tag| tag.is_value() || tag.is(Class::Determiner));
        let end = halting.peek().map_or(tokens.len(), |words| words.start);
        let found = find(lexicon, &tokens[..end], at, described);
        let tag = Tag::of(tokens, at, &found);
        tags.push(tag);
        tags.extend(found.second.map(|sense| Tag { sense, gap: Gap::Glued, ..tag }));
        at += found.words;
    }
    disambiguate(lexicon, &mut tags);
    drop_tag_questions(&mut tags);
    tags
}

/// Returns whether an utterance is an answer and nothing else, whatever its words name in a scene
/// ("that's right"), unless they name a value asked about.
pub(crate) fn answers_alone(
    tokens: &Tokens<'_>,
    in_scene: &[Tag<'_>],
    asked: QuestionWords<'_>,
) -> bool {
    let is_asked = |tag: &Tag<'_>| match (asked, tag.value()) {
        (QuestionWords::Value(_, word), Some(value)) => value.word == word,
        _ => false,
    };
    if in_scene.iter().any(is_asked) {
        return false;
    }
    let tags = tag(Lexicon::own(), tokens);
    let answers = |tag: &Tag<'_>| tag.class().is_some_and(is_answer);
    tags.iter().any(answers)
        && tags.iter().all(|tag| answers(tag) || tag.is_any(classes![Filler Courtesy]))
}

/// Returns the sense of the words from `at` on; `described`: inside a noun phrase.
fn find<'a>(lexicon: &'a Lexicon, tokens: &[Token<'_>], at: usize, described: bool) -> Found<'a> {
    let here = &tokens[at..];
    let phrase = lexicon.longest(tokens, at);
    if phrase.is_none_or(|phrase| phrase.words == 1)
        && let Some(found) = written_apart(lexicon, here)
    {
        return found;
    }
    if let Some(phrase) = phrase {
        return Found { words: phrase.words, sure: phrase.sure, ..Found::word(phrase.sense) };
    }
    guessed(lexicon, here[0].word)
        .or_else(|| heard_apart(lexicon, here, described))
        .unwrap_or(Found::word(Sense::Unknown))
}

/// The first two or three words without a pause between them.
fn runs<'t, 'a>(tokens: &'t [Token<'a>]) -> impl Iterator<Item = &'t [Token<'a>]> {
    let runs = (2..=3).filter_map(|words| tokens.get(..words));
    runs.filter(|run| !run[1..].iter().any(Token::pauses))
}

/// Returns whether a negator or an answer is among the words: no value is read in its place.
fn denies(lexicon: &Lexicon, run: &[Token<'_>]) -> bool {
    run.iter().any(|token| {
        let sense = lexicon.word(token.word);
        matches!(sense, Some(Sense::Class(Class::Not | Class::Except | Class::No | Class::Yes)))
    })
}

fn joined(run: &[Token<'_>]) -> String {
    run.iter().map(|token| token.word).collect()
}

/// "dish washer", "screw driver": neighbours that together are one value.
fn written_apart<'a>(lexicon: &'a Lexicon, tokens: &[Token<'_>]) -> Option<Found<'a>> {
    runs(tokens).filter(|run| !denies(lexicon, run)).find_map(|run| {
        let letters: usize = run.iter().map(|token| token.word.len()).sum();
        if !(JOINED_LETTERS_MIN..=RUN_ON_LETTERS_MAX).contains(&letters) {
            return None;
        }
        let (words, joined) = (run.len(), joined(run));
        if let Some(sense @ Sense::Value(_)) = lexicon.word(&joined) {
            return Some(Found { words, ..Found::word(sense) });
        }
        let whole = matches!(lexicon.word(run[0].word), Some(Sense::Value(_)));
        // "me a cup" is not a slip of "tea cup", nor "a felt tip" of "felt tip".
        let ends = matches!(lexicon.word(run[words - 1].word), Some(Sense::Value(_)));
        let listed = match lexicon.word(run[0].word) {
            Some(Sense::Class(class)) => ends || is_closed_class(class),
            _ => false,
        };
        let fits = !(whole || listed);
        let value = lexicon.lookalikes().misspelt_compound(&joined).filter(|_| fits)?;
        let sense = Sense::Value(lexicon.value(value));
        Some(Found { words, doubt: doubts::SLIP, ..Found::word(sense) })
    })
}

/// "mark her", "cab in it": neighbours that together sound like one long value; a shorter one if a
/// noun phrase continues (`described`).
fn heard_apart<'a>(
    lexicon: &'a Lexicon,
    tokens: &[Token<'_>],
    described: bool,
) -> Option<Found<'a>> {
    let lookalikes = lexicon.lookalikes();
    runs(tokens).filter(|run| !denies(lexicon, run)).find_map(|run| {
        let value = lookalikes.sounds_like_long(&joined(run)).or_else(|| {
            let words = run.iter().map(|token| token.word);
            lookalikes.sounds_like_run(words).filter(|_| described)
        })?;
        let sense = Sense::Value(lexicon.value(value));
        Some(Found { words: run.len(), doubt: doubts::APART, ..Found::word(sense) })
    })
}

/// A word that the lexicon lacks in this form: lengthened, misspelt, or two run together.
fn guessed<'a>(lexicon: &'a Lexicon, word: &str) -> Option<Found<'a>> {
    let lookalikes = lexicon.lookalikes();
    let short = if lookalikes.is_common(word) { None } else { shortened(word) };
    if let Some(sense) = short.iter().flatten().find_map(|candidate| lexicon.word(candidate)) {
        return Some(Found::word(sense));
    }
    if let Some(value) = lookalikes.misspelt(word) {
        let sense = Sense::Value(lexicon.value(value));
        return Some(Found { doubt: doubts::SLIP, ..Found::word(sense) });
    }
    if let Some(class) = misspelt(word).filter(|_| !lookalikes.is_common(word)) {
        return Some(Found { doubt: doubts::SLIP, ..Found::word(Sense::Class(class)) });
    }
    if let Some(stem) = word.strip_suffix('s')
        && let Some(sense @ Sense::Class(Class::Unlisted | Class::Story)) = lexicon.word(stem)
    {
        return Some(Found::word(sense));
    }
    // "honestly", "immediately": an adverb changes no meaning here.
    if word.len() > 4 && word.ends_with("ly") {
        return Some(Found::word(Sense::Class(Class::Plain)));
    }
    run_on(lexicon, word)
}

/// "whitebowl", "nonmetal": a value and its neighbour, run together.
fn run_on<'a>(lexicon: &'a Lexicon, word: &str) -> Option<Found<'a>> {
    let is_common = lexicon.lookalikes().is_common(word);
    if !word.is_ascii() || word.len() > RUN_ON_LETTERS_MAX || is_common {
        return None;
    }
    (3..word.len().saturating_sub(2)).find_map(|at| {
        let (left, right) = word.split_at(at);
        let mut second = lexicon.word(right)?;
        let first = match second {
            Sense::Value(_) if left == "non" => Sense::Class(Class::Not),
            _ => lexicon.word(left).filter(|sense| matches!(sense, Sense::Value(_)))?,
        };
        match second {
            Sense::Value(_) | Sense::Class(Class::Head) => {}
            Sense::Class(Class::One) => second = Sense::Class(Class::Head),
            _ => return None,
        }
        Some(Found { second: Some(second), ..Found::word(first) })
    })
}
