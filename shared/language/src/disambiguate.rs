//! Disambiguates words by their neighbours: "one", "so", misheard values and nouns.

use scene::Role;

use crate::lexicon::{Lexicon, Sense};
use crate::synonyms::is_thing;
use crate::tagger::{Tag, after, before, doubts};
use crate::token_class::{Class, classes};

/// Resolves the tags that depend on their neighbours.
pub(crate) fn disambiguate<'a>(lexicon: &'a Lexicon, tags: &mut [Tag<'a>]) {
    for at in 0..tags.len() {
        let place = Place { tags, at };
        if let Some(class) = place.resolved_class() {
            tags[at].sense = class.map_or(Sense::Unknown, Sense::Class);
        } else if tags[at].is_unknown()
            && let Some((sense, doubt)) = place.misheard(lexicon)
        {
            tags[at].sense = sense;
            tags[at].exact = false;
            tags[at].add_doubt(doubt);
        }
    }
}

/// Resolves words whose meaning depends on the question just asked about a value, if nothing else is said:
/// "it isn't any more" denies it and cancels nothing, and "that's white" means "it's white".
pub(crate) fn resolve_after_question(tags: &mut [Tag<'_>]) {
    const LEADS: &[Class] = classes![Filler Hedge It Be Plain];
    let Some(at) = tags.iter().position(|tag| !tag.is_any(LEADS)) else { return };
    let (tag, rest) = (tags[at], &tags[at + 1..]);
    if let [be, value, ends @ ..] = rest
        && matches!(tag.word, "that" | "this")
        && tag.is_any(classes![Pointer WeakYes])
        && (tag.second == tag.last && be.is(Class::Be) && value.is_value())
        && ends.iter().all(|tag| tag.is_any(classes![Filler Courtesy]))
    {
        let sense = Sense::Class(Class::It);
        tags[at] = Tag { sense, word: "it", second: "it", last: "it", ..tag };
    } else if tag.is(Class::Cancel)
        && (rest.is_empty() && tag.word == "not" && matches!(tag.second, "any" | "anymore"))
    {
        tags[at].sense = Sense::Class(Class::WeakNo);
    }
}

/// Drops "isn't it" after a statement where no pause is heard before it: "that's the one isn't it",
/// but neither "that isn't it" nor "I'm sure the white one isn't it".
pub(crate) fn drop_tag_questions(tags: &mut Vec<Tag<'_>>) {
    while let Some(at) = (0..tags.len()).find(|at| is_tag_question(tags, *at)) {
        tags.drain(at..at + 3);
    }
}

fn is_tag_question(tags: &[Tag<'_>], at: usize) -> bool {
    const NOUN: &[Class] = classes![Determiner Possessive Head One Pointer It Preposition Landmark];
    let [verb, not, it, rest @ ..] = &tags[at..] else { return false };
    let is_tag = verb.is_any(classes![Be Auxiliary]) && not.is(Class::Not) && it.is(Class::It);
    let in_phrase = |tag: &&Tag<'_>| tag.is_value() || tag.is_any(NOUN);
    let phrase = tags[..at].iter().rev().take_while(|tag| is_tag && in_phrase(tag)).count();
    let Some(stated) = (at - phrase).checked_sub(1) else { return false };
    // "It's the one that isn't it", but "that's it, isn't it".
    let is_named = phrase < 2 || !tags[at - 1].is_any(classes![It Pointer]);
    let is_stated = tags[stated].is(Class::Be) && is_named
        || phrase == 0 && tags[stated].is_any(classes![Yes WeakYes])
        || verb.is(Class::Auxiliary) && tags[stated].last == "be";
    let is_relative =
        stated > 1 && tags[stated - 1].is(Class::Pointer) && in_phrase(&&tags[stated - 2]);
    let pauses = tags[stated + 1..at + 3].iter().any(Tag::pauses);
    is_tag && is_stated && !is_relative && !pauses && rest.first().is_none_or(Tag::pauses)
}

/// Words that the noun of a noun phrase may be followed by.
const AFTER_NOUN: &[Class] = classes![Preposition Courtesy Filler Pointer];

/// Returns whether a tag that is not resolved yet is the noun of a thing.
fn is_noun_here(tag: &Tag<'_>) -> bool {
    tag.is(Class::One) || tag.is_noun()
}

/// A tag and the tags next to it in the utterance.
struct Place<'t, 'a> {
    tags: &'t [Tag<'a>],
    at: usize,
}

impl<'a> Place<'_, 'a> {
    fn tag(&self) -> &Tag<'a> {
        &self.tags[self.at]
    }

    /// The tag before, unless there is a pause between.
    fn before(&self) -> Option<&Tag<'a>> {
        before(self.tags, self.at)
    }

    /// The tag after, unless there is a pause between.
    fn after(&self) -> Option<&Tag<'a>> {
        after(self.tags, self.at)
    }

    /// Up to `reach` tags before.
    fn recent(&self, reach: usize) -> &[Tag<'a>] {
        &self.tags[self.at.saturating_sub(reach)..self.at]
    }

    /// The class that the word has here: `None` as listed, `Some(None)` that of an unknown word.
    fn resolved_class(&self) -> Option<Option<Class>> {
        let tag = self.tag();
        let is_determined = || self.before().is_some_and(|before| before.is(Class::Determiner));
        let class = match (tag.class(), tag.word) {
            (None, _) if self.is_asking_verb() => Some(Class::Auxiliary),
            (None, _) => self.is_participle().then_some(Class::Plain),
            (Some(Class::One), _) => {
                Some(if self.is_noun_one() { Class::Head } else { Class::Plain })
            }
            // "non-metal" in English, "non merci" in French.
            (Some(Class::OtherLanguage), "non") => {
                self.after().is_some_and(Tag::is_value).then_some(Class::Not)
            }
            (Some(Class::But), _) => self.is_exception().then_some(Class::Except),
            (Some(Class::Join), "so") => self.is_degree().then_some(Class::Plain),
            (Some(Class::Preposition), "as") => self.comparison(),
            // "the honey please": a thing, not a form of address for the robot.
            (Some(Class::Courtesy), _) if is_determined() => return Some(None),
            (Some(Class::SideTalk), _) => self.is_pause_to_think().then_some(Class::Repair),
            (Some(Class::Put), "leave") => self.leaves_out().then_some(Class::Except),
            _ => None,
        };
        class.map(Some)
    }

    /// "can you", "will it", if a can or a will may be fetched.
    fn is_asking_verb(&self) -> bool {
        let own = Lexicon::own().word(self.tag().word);
        self.tag().is_value()
            && matches!(own, Some(Sense::Class(Class::Auxiliary)))
            && self.after().is_some_and(|next| next.is_any(classes![First Second Third It]))
            && !self.before().is_some_and(|before| before.is_any(classes![Determiner Possessive]))
    }

    /// "one" is an object after "the" or "white", and a number elsewhere.
    fn is_noun_one(&self) -> bool {
        const BEFORE: &[Class] = classes![
            Determiner Pointer Quantifier Unlisted Ordinal Other Possessive Plain Question Filler
            WeakYes WeakNo Not Story Fetch
        ];
        self.before().is_some_and(|b| b.is_value() || b.is_unknown() || b.is_any(BEFORE))
    }

    /// "any bowl but the white one".
    fn is_exception(&self) -> bool {
        let any = |tag: &Tag<'_>| matches!(tag.word, "any" | "every" | "all" | "anyone");
        self.recent(3).iter().any(any)
    }

    /// "so blue", where "so" joins nothing.
    fn is_degree(&self) -> bool {
        let after_verb = self.recent(1).iter().any(|tag| tag.is_any(classes![Be Not]));
        after_verb || self.after().is_some_and(Tag::is_value)
    }

    /// "as big as the metal one": another object follows the second "as".
    fn comparison(&self) -> Option<Class> {
        if self.after().is_some_and(Tag::is_value) {
            return Some(Class::Plain);
        }
        self.recent(1).iter().any(Tag::is_value).then_some(Class::Than)
    }

    /// "the clear one, hang on, the white one": after a pause to think, earlier words are replaced.
    fn is_pause_to_think(&self) -> bool {
        const REACH: usize = 4;
        let names = |tag: &Tag<'_>| tag.is_value() || tag.is_any(classes![Yes No]);
        matches!(self.tag().word, "hang" | "hold" | "one" | "just")
            && self.recent(REACH).iter().any(names)
            && self.tags[self.at + 1..].iter().take(REACH).any(names)
    }

    /// "leave the white one, …", "leave the white one alone", "leave the white one on the counter",
    /// but not "leave the white one on the doorstep".
    fn leaves_out(&self) -> bool {
        let rest = &self.tags[self.at + 1..];
        let phrase = &rest[..rest.iter().position(Tag::pauses).unwrap_or(rest.len())];
        phrase.iter().any(Tag::is_value)
            && phrase.iter().any(is_noun_here)
            && !phrase.iter().any(Tag::is_unknown)
    }

    /// "the shirt draped over the chair", "the pen clipped to the drawer": how a thing is placed.
    fn is_participle(&self) -> bool {
        let word = self.tag().word;
        let leads = |tag: &Tag<'_>| tag.is_any(classes![Preposition Landmark Destination]);
        self.tag().is_unknown()
            && word.len() > 4
            && (word.ends_with("ed") || word.ends_with("ing"))
            && self.before().is_some_and(Tag::is_noun)
            && self.after().is_some_and(leads)
    }

    /// The known word for which an unknown one was misheard or misspelt, with its doubt.
    fn misheard(&self, lexicon: &'a Lexicon) -> Option<(Sense<'a>, f64)> {
        if lexicon.lookalikes().is_like_noun(self.tag().word) && self.ends_noun_phrase() {
            return Some((Sense::Class(Class::Head), 0.0));
        }
        if is_thing(self.tag().word) {
            return None;
        }
        self.misheard_description(lexicon).or_else(|| self.misheard_place(lexicon))
    }

    /// "the small white bold": the position of the noun.
    fn ends_noun_phrase(&self) -> bool {
        self.before().is_some_and(Tag::is_value) && self.may_end_noun_phrase()
    }

    fn may_end_noun_phrase(&self) -> bool {
        self.after().is_none_or(|tag| tag.is_any(AFTER_NOUN))
    }

    /// "the wide bowl", "the red ranch": at a value's position, the one that sounds or looks alike.
    fn misheard_description(&self, lexicon: &'a Lexicon) -> Option<(Sense<'a>, f64)> {
        let (word, lookalikes) = (self.tag().word, lexicon.lookalikes());
        let sounding = lookalikes.sounds_like(word).map(|value| (value, doubts::SOUND));
        let looking = || lookalikes.looks_like(word).map(|value| (value, doubts::EVERYDAY));
        let (value, doubt) = sounding.or_else(looking)?;
        let value = lexicon.value(value);
        let belongs = match value.role {
            Role::Quality => self.is_where_a_quality_belongs(),
            Role::Kind => self.is_where_a_kind_belongs(),
            Role::Part => self.is_where_a_quality_belongs() || self.is_where_a_kind_belongs(),
            Role::Place => false,
        };
        belongs.then_some((Sense::Value(value), doubt))
    }

    /// Inside a noun phrase: after "the", "get" or another value.
    fn is_described(&self) -> bool {
        self.before().is_some_and(|b| b.is_value() || b.is_any(classes![Determiner Fetch]))
    }

    /// "the … bowl".
    fn is_where_a_quality_belongs(&self) -> bool {
        self.is_described() && self.after().is_some_and(is_noun_here)
    }

    /// "the red …", "get me the …".
    fn is_where_a_kind_belongs(&self) -> bool {
        let asked_for = || self.recent(4).iter().any(|tag| tag.is_any(classes![Fetch Want]));
        self.ends_noun_phrase() || self.may_end_noun_phrase() && self.is_described() && asked_for()
    }

    /// "on the counted", "in the draw": at the end of the sentence, the place that sounds alike.
    fn misheard_place(&self, lexicon: &'a Lexicon) -> Option<(Sense<'a>, f64)> {
        let [preposition, determiner] = self.recent(2) else { return None };
        let stands = preposition.is(Class::Preposition)
            && determiner.word == "the"
            && self.after().is_none_or(|tag| tag.is_any(classes![Courtesy Filler]));
        let (word, lookalikes) = (self.tag().word, lexicon.lookalikes());
        let value = lookalikes.looks_like(word).or_else(|| lookalikes.sounds_like(word))?;
        let value = lexicon.value(value);
        (stands && value.is_place()).then_some((Sense::Value(value), doubts::EVERYDAY))
    }
}
