//! Relations of the wanted object to others, by position or by comparison: "the second from the
//! left", "next to the clear one", "longer".

use std::ops::Range;

use scene::{Measure, Relation, Role, WordId};
use words::Tokens;

use crate::clauses::{Clause, Topic};
use crate::negation::is_denied;
use crate::relation_words::{by_quality, first, ordinal, quality, relation_to, side};
use crate::tagger::{Tag, after, before};
use crate::token_class::{Class, classes};

/// Most words of the noun phrase that a relation is to.
const PHRASE_MAX: usize = 6;
/// Most words between "second" and "from the left".
const ORDER_MAX: usize = 5;

/// A relation in an utterance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Related {
    pub(crate) relation: Relation,
    /// Words of each reference object; empty without one, or if it is the object spoken of.
    pub(crate) to: Vec<Vec<WordId>>,
    /// Range of the relation's tags.
    pub(crate) tags: Range<usize>,
}

impl Related {
    /// Returns whether it is of places, and not of the objects themselves.
    pub(crate) fn is_of_place(&self) -> bool {
        match self.relation {
            Relation::Nth(measure, _) | Relation::More(measure) | Relation::Middle(measure) => {
                !measure.is_of_object()
            }
            Relation::Beside | Relation::Between => true,
        }
    }
}

/// Returns the relations of the wanted object. `placed`: the scene knows the places of objects.
pub(crate) fn related(
    tokens: &Tokens<'_>,
    tags: &[Tag<'_>],
    clauses: &[Clause],
    placed: bool,
) -> Vec<Related> {
    let mut found = Vec::new();
    for clause in clauses.iter().filter(|clause| clause.topic != Topic::Off) {
        let said = Said { tokens, tags: &tags[..clause.span.end] };
        let mut rest = clause.span.clone();
        while let Some(at) = rest.next() {
            let here = said.at(at).filter(|it| placed || !it.is_of_place());
            if let Some(related) = here {
                rest.start = related.tags.end;
                found.push(related);
            }
        }
    }
    found
}

/// "too big": a smaller one is wanted.
pub(crate) fn too_much(tags: &[Tag<'_>], at: usize) -> Option<Relation> {
    let is_too = before(tags, at).is_some_and(|before| before.last == "too");
    let is_noun = after(tags, at).is_some_and(|next| next.is(Class::Head) || next.is_value());
    let measure = quality(tags[at].word).filter(|it| it.is_of_object() && is_too && !is_noun)?;
    Some(Relation::More(measure.reverse()))
}

/// The tags up to the end of a clause.
struct Said<'t, 'a> {
    tokens: &'t Tokens<'a>,
    tags: &'t [Tag<'a>],
}

impl Said<'_, '_> {
    /// The relation whose words begin at a tag.
    fn at(&self, at: usize) -> Option<Related> {
        if let Some(relation) = too_much(self.tags, at) {
            return self.alone(relation, at..at + 1);
        }
        if is_denied(self.tags, at) {
            return None;
        }
        if self.tags[at].is_value() {
            // "smaller" may be a name of a value, and also compare to the object handed over.
            let relation = by_quality(self.tags[at].word).filter(|_| self.is_word(at))?;
            return self.alone(relation, at..at + 1);
        }
        let (phrase, is_word) = (self.phrase(at), self.is_word(at));
        if let Some(relation) = relation_to(&phrase) {
            return self.to_another(relation, at);
        }
        if let Some(n) = ordinal(&phrase) {
            return self.in_order(n, at);
        }
        if phrase == "last" {
            return self.last(at);
        }
        match by_quality(&phrase) {
            Some(Relation::More(measure)) => self.more(measure, at),
            Some(relation) if !self.is_shade(relation, at) => self.alone(relation, at..at + 1),
            Some(_) => None,
            None if is_word => self.word(&phrase, at),
            None => self.on_side(&phrase, at),
        }
    }

    fn alone(&self, relation: Relation, tags: Range<usize>) -> Option<Related> {
        Some(Related { relation, to: Vec::new(), tags })
    }

    fn is_word(&self, at: usize) -> bool {
        self.tags[at].word == self.tags[at].last
    }

    /// The words of a tag.
    fn phrase(&self, at: usize) -> String {
        let begin = self.tags[at].at;
        let end = self.tags.get(at + 1).map_or(begin + 4, |next| next.at.max(begin + 1));
        let words = self.tokens.words.iter().take(end).skip(begin).map(|token| token.word);
        let words: Vec<&str> = words.collect();
        let last = words.iter().rposition(|word| *word == self.tags[at].last).unwrap_or(0);
        words[..=last].join(" ")
    }

    /// "the lighter blue one": a shade of a colour.
    fn is_shade(&self, relation: Relation, at: usize) -> bool {
        let is_light =
            matches!(relation, Relation::Nth(Measure::Light, _) | Relation::More(Measure::Light));
        is_light && after(self.tags, at).is_some_and(|next| next.is_role(Role::Quality))
    }

    /// "next to the cup", "nearest to me".
    fn to_another(&self, relation: Relation, at: usize) -> Option<Related> {
        let person = after(self.tags, at).map(|next| next.word);
        let near = match person {
            Some("you") => Some(Measure::Near),
            Some("me" | "us") => Some(Measure::NearUser),
            _ => None,
        };
        // "close to me" is vague, and "put it next to me" gives a destination.
        let is_where = self.tags[at].word.ends_with("est");
        match near {
            Some(measure) if relation == Relation::Beside && is_where => {
                self.alone(Relation::Nth(measure, 1), at..at + 2)
            }
            Some(_) => None,
            None => {
                let (to, end) = self.objects(at + 1)?;
                Some(Related { relation, to, tags: at..end })
            }
        }
    }

    /// The objects named from a tag on, each by its words, and the tag after them: "it" has none.
    fn objects(&self, from: usize) -> Option<(Vec<Vec<WordId>>, usize)> {
        const PHRASE: &[Class] = classes![Determiner Pointer Possessive Quantifier Head One];
        let (mut to, mut group, mut at) = (Vec::new(), Vec::new(), from);
        while at < self.tags.len().min(from + 2 * PHRASE_MAX) {
            let tag = &self.tags[at];
            let follows = at > from && tag.pauses();
            match tag.value() {
                _ if follows => break,
                Some(value) => group.push(value.word),
                None if tag.is(Class::And) && !group.is_empty() && to.is_empty() => {
                    to.push(std::mem::take(&mut group));
                }
                None if tag.is_any(PHRASE) => {}
                None if tag.is(Class::It) && at == from => return Some((to, at + 1)),
                None if tag.is_unknown() || tag.is(Class::Unlisted) => return None,
                None => break,
            }
            at += 1;
        }
        let is_shown = self.tags.get(from).is_some_and(|tag| tag.is(Class::Pointer));
        match group.is_empty() {
            false => to.push(group),
            // "than that", "than this one"
            true if to.is_empty() && !is_shown => return None,
            true => {}
        }
        Some((to, at))
    }

    /// "second from the left", "the third bowl on the right", "the second largest".
    fn in_order(&self, n: u8, at: usize) -> Option<Related> {
        let next = self.tags.get(at + 1).map(|_| self.phrase(at + 1));
        if let Some(Relation::Nth(measure, 1)) = next.as_deref().and_then(by_quality) {
            return self.alone(Relation::Nth(measure, n), at..at + 2);
        }
        let (measure, _, end) = self.side_after(at)?;
        self.alone(Relation::Nth(measure, n), at..end)
    }

    /// "the last one on the right".
    fn last(&self, at: usize) -> Option<Related> {
        let (measure, is_from, end) = self.side_after(at)?;
        let measure = if is_from { measure.reverse() } else { measure };
        self.alone(Relation::Nth(measure, 1), at..end)
    }

    /// The side named within a few words, whether an order counts from it, and the tag after.
    fn side_after(&self, at: usize) -> Option<(Measure, bool, usize)> {
        let end = self.tags.len().min(at + 1 + ORDER_MAX);
        (at + 1..end).find_map(|place| {
            let phrase = self.phrase(place);
            let is_from = phrase.starts_with("from ");
            let is_of_row = is_from || phrase.starts_with("on the ");
            let measure = side(&phrase).filter(|_| is_of_row && phrase.contains(' '))?;
            Some((measure, is_from, place + 1))
        })
    }

    /// "bigger", "bigger than the red one", "further to the left".
    fn more(&self, measure: Measure, at: usize) -> Option<Related> {
        let is_than = after(self.tags, at).is_some_and(|next| next.is(Class::Than));
        if self.is_shade(Relation::More(measure), at) {
            return None;
        }
        if is_than {
            let (to, end) = self.objects(at + 2)?;
            return Some(Related { relation: Relation::More(measure), to, tags: at..end });
        }
        let is_led = || before(self.tags, at).is_some_and(|it| it.is(Class::Determiner));
        if measure.is_of_object() || measure == Measure::Near && is_led() {
            return self.alone(Relation::More(measure), at..at + 1);
        }
        let side = self.tags.get(at + 1).and_then(|_| side(&self.phrase(at + 1)))?;
        if measure == Measure::Far { self.alone(Relation::More(side), at..at + 2) } else { None }
    }

    /// "leftmost", "furthest to the right", "the left one", "the middle one".
    fn word(&self, word: &str, at: usize) -> Option<Related> {
        if let Some(measure) = first(word) {
            let side_next = self.tags.get(at + 1).and_then(|_| side(&self.phrase(at + 1)));
            return match side_next.filter(|_| measure == Measure::Far) {
                Some(side) => self.alone(Relation::Nth(side, 1), at..at + 2),
                None if word.ends_with("most")
                    || measure == Measure::Far
                    || self.is_of_object(at) =>
                {
                    self.alone(Relation::Nth(measure, 1), at..at + 1)
                }
                None => None,
            };
        }
        let relation = match word {
            "left" => Relation::Nth(Measure::Left, 1),
            "middle" | "center" | "centre" => Relation::Middle(Measure::Left),
            _ => return None,
        };
        if self.is_of_object(at) { self.alone(relation, at..at + 1) } else { None }
    }

    /// "the left bowl", "the middle", but not "the left shelf".
    fn is_of_object(&self, at: usize) -> bool {
        let is_headed = || after(self.tags, at).is_some_and(|it| it.is(Class::Head));
        let is_led = before(self.tags, at).is_some_and(|it| {
            it.is_any(classes![Determiner Possessive]) || it.is_value() && is_headed()
        });
        is_led && !self.leads_to_place(at)
    }

    /// "the left shelf": of a place, known or not.
    fn leads_to_place(&self, at: usize) -> bool {
        after(self.tags, at).is_some_and(|next| {
            next.is_role(Role::Place) || next.is_unknown() || next.is(Class::Unlisted)
        })
    }

    /// "on the left", "at the back".
    fn on_side(&self, phrase: &str, at: usize) -> Option<Related> {
        let is_row = !phrase.starts_with("from ") && !phrase.starts_with("right one");
        let measure = side(phrase).filter(|_| self.tags[at].is(Class::Ordinal) && is_row)?;
        if self.leads_to_place(at) {
            return None;
        }
        let is_more = before(self.tags, at).is_some_and(|before| before.word == "more");
        let relation = if is_more { Relation::More(measure) } else { Relation::Nth(measure, 1) };
        self.alone(relation, at..at + 1)
    }
}
