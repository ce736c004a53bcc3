//! Topic of a clause, judged by its words.

use std::ops::Range;

use scene::Role;

use crate::clauses::{Clause, Topic};
use crate::fates::Fates;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::word_sets::WordSet;

/// A clause and the evidence in its words.
pub(crate) struct ClauseAnalysis<'a> {
    pub(crate) clause: &'a [Tag<'a>],
    /// Number of unknown words.
    pub(crate) unknown: usize,
    /// Number of values.
    pub(crate) values: usize,
}

/// Classes of words that name the scene's objects.
pub(crate) const SCENE_NAMES: &[Class] = classes![Head Attribute];
/// Classes of words that a noun follows.
pub(crate) const ARTICLES: &[Class] = classes![Determiner Quantifier Possessive];

/// Returns the clause in a range of the tags, with its topic. `injected`: the text is addressed to
/// a machine.
pub(crate) fn classify(
    tags: &[Tag<'_>],
    fates: &Fates,
    span: Range<usize>,
    injected: bool,
) -> Clause {
    let clause = &tags[span.clone()];
    let analysis = ClauseAnalysis {
        clause,
        unknown: clause.iter().filter(|tag| tag.is_unknown()).count(),
        values: clause.iter().filter(|tag| tag.is_value()).count(),
    };
    let wishes = span.clone().any(|at| fates.is_wish(at));
    let topic = analysis.topic(injected, wishes);
    let requests = topic == Topic::On && analysis.requests();
    let chore = !injected && analysis.is_chore();
    Clause { span, topic, requests, chore }
}

impl<'a> ClauseAnalysis<'a> {
    pub(crate) fn has(&self, classes: &[Class]) -> bool {
        self.clause.iter().any(|tag| tag.is_any(classes))
    }

    pub(crate) fn next(&self, at: usize) -> Option<&'a Tag<'a>> {
        self.clause.get(at + 1)
    }

    /// The place and class of the first tag that says something.
    pub(crate) fn opening(&self) -> Option<(usize, Class)> {
        const LEADS: &[Class] = classes![Filler Courtesy And But Join Yes No WeakYes Repair Plain];
        let at = self.clause.iter().position(|tag| !tag.is_any(LEADS))?;
        Some((at, self.clause[at].class()?))
    }

    /// `wishes`: a value of it is wanted or denied.
    fn topic(&self, injected: bool, wishes: bool) -> Topic {
        if injected && !self.is_plain_request() || self.is_other_language() {
            Topic::Off
        } else if wishes {
            Topic::On
        } else if self.has(classes![SideTalk]) || self.is_about_others() {
            Topic::Off
        } else if self.asks_about_robot() {
            Topic::AskBack
        } else if self.asks_back() {
            if self.asks_about_something_else() { Topic::Off } else { Topic::AskBack }
        } else {
            Topic::On
        }
    }

    /// "get me the white one": a person requests a thing, whatever else the text says.
    fn is_plain_request(&self) -> bool {
        self.clause.iter().any(|tag| WordSet::Speaker.has(tag.word))
            && self.values > 0
            && !self.has(classes![Injection])
    }

    fn is_other_language(&self) -> bool {
        let foreign = self.clause.iter().filter(|tag| tag.is(Class::OtherLanguage)).count();
        // "die weisse cup bitte": the objects present were meant.
        let ours = self.clause.iter().any(|tag| tag.is_value() && tag.exact);
        !ours && foreign > 0 && 2 * (foreign + self.unknown) >= self.clause.len()
    }

    /// "he said yes".
    fn is_about_others(&self) -> bool {
        // "he small white bowl" is a "the" that was not heard well.
        let of_others =
            |(at, opening)| opening == Class::Third && !self.next(at).is_some_and(Tag::is_value);
        self.opening().is_some_and(of_others) && !self.has(classes![Fetch Want It])
    }

    /// Returns whether the clause names something to fetch.
    fn requests(&self) -> bool {
        let named = self.has(classes![Head Attribute Unlisted Ordinal Other Pointer]);
        self.has(classes![Head Attribute Unlisted])
            || self.has(classes![Fetch Want]) && named
            || self.has(classes![Ordinal Other]) && self.unknown == 0
            || self.clause.windows(2).any(|pair| {
                // "get me …", "penicillin please"
                pair[0].is(Class::Fetch) && WordSet::Me.has(pair[1].word)
                    || pair[0].is_unknown()
                        && WordSet::Please.has(pair[1].word)
                        && self.clause.len() == 2
            })
            || self.clause.windows(3).any(|three| {
                // "I would like a newspaper", "can I have the dinosaur"
                three[0].is(Class::Want) && three[1].is_any(ARTICLES) && three[2].is_unknown()
            })
            || self.is_bare_noun()
    }

    /// "the wok please", "the pepper on the shelf": all that is said names one thing.
    fn is_bare_noun(&self) -> bool {
        let [article, rest @ ..] = self.clause else { return false };
        let named = rest.iter().take_while(|tag| tag.is_unknown()).count();
        let locates = |tag: &Tag<'_>| {
            tag.is_role(Role::Place) || tag.is_any(classes![Preposition Determiner Courtesy Filler])
        };
        WordSet::Article.has(article.word)
            && (1..=2).contains(&named)
            && rest[named..].iter().all(locates)
    }

    /// "put it on the table", "wash the clear bowl", "I want you to fill the mug", "throw it away":
    /// an order about our things, but not to fetch.
    fn is_chore(&self) -> bool {
        const LEADS: &[Class] = classes![
            Filler Courtesy And But Join Yes WeakYes Repair Plain Auxiliary First Second Want Destination
        ];
        let orders = |&at: &usize| {
            let throws_away = WordSet::Throwing.has(self.clause[at].word)
                && self.clause[at..].iter().any(|tag| WordSet::Back.has(tag.word));
            let before = at.checked_sub(1).map(|before| &self.clause[before]);
            let is_noun =
                before.is_some_and(|tag| tag.is_value() || tag.is_any(classes![Determiner First]));
            (self.clause[at].is(Class::Put) || throws_away) && !is_noun
        };
        let Some(verb) = (0..self.clause.len()).find(orders) else { return false };
        let (lead, rest) = self.clause.split_at(verb);
        let says = |class| lead.iter().any(|tag| tag.is(class));
        let is_ours = |(at, tag): (usize, &Tag<'_>)| {
            let is_thing = tag.is_value() && !tag.is_role(Role::Place);
            at == 1 && tag.is(Class::It) || tag.is(Class::Head) || is_thing
        };
        // "I put it in the cabinet" is a report, "I want you to put it there" an order.
        lead.iter().all(|tag| tag.is_any(LEADS))
            && (says(Class::Second) || !says(Class::First) && !says(Class::Want))
            && rest.iter().enumerate().any(is_ours)
    }
}
