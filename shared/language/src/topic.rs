//! Topic of a clause, judged by its words.

use std::ops::Range;

use scene::Role;

use crate::answer::is_wrong_thing;
use crate::clauses::{Clause, Topic};
use crate::fates::Fates;
use crate::related::too_much;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// A clause, the evidence in its words, and the clause before it.
pub(crate) struct ClauseAnalysis<'a> {
    pub(crate) clause: &'a [Tag<'a>],
    /// Whether the clause is all that was said.
    pub(crate) is_everything: bool,
    pub(crate) previous_tags: &'a [Tag<'a>],
    /// Number of unknown words.
    pub(crate) unknown: usize,
    /// Number of values.
    pub(crate) values: usize,
}

/// Classes of words that name the scene's objects.
pub(crate) const SCENE_NAMES: &[Class] = classes![Head Attribute];

/// Returns the clause in a range of the tags, with its topic. `injected`: the text is addressed to
/// a machine.
pub(crate) fn classify(
    tags: &[Tag<'_>],
    fates: &Fates,
    span: Range<usize>,
    previous: Option<&Clause>,
    injected: bool,
) -> Clause {
    let clause = &tags[span.clone()];
    let analysis = ClauseAnalysis {
        clause,
        is_everything: clause.len() == tags.len(),
        previous_tags: previous.map_or(&[], |previous| &tags[previous.span.clone()]),
        unknown: clause.iter().filter(|tag| tag.is_unknown()).count(),
        values: clause.iter().filter(|tag| tag.is_value()).count(),
    };
    let wishes = span.clone().filter(|at| fates.is_neither(*at)).count() < analysis.values;
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
            return Topic::Off;
        }
        if wishes {
            return Topic::On;
        }
        if self.is_unrelated_errand() || self.has(classes![SideTalk]) || self.is_story() {
            return Topic::Off;
        }
        if self.asks_about_robot() {
            return Topic::AskBack;
        }
        if self.asks_back() {
            return if self.asks_about_something_else() { Topic::Off } else { Topic::AskBack };
        }
        if self.describes_something_else() || self.is_strange() { Topic::Off } else { Topic::On }
    }

    /// "get me the white one": a person requests a thing, whatever else the text says.
    fn is_plain_request(&self) -> bool {
        self.clause.iter().any(|tag| matches!(tag.word, "me" | "i"))
            && self.values > 0
            && self.has(classes![Fetch Want])
            && !self.has(classes![Injection])
    }

    fn is_other_language(&self) -> bool {
        // Articles that are slips of an English finger elsewhere.
        let article = |tag: &&Tag<'_>| matches!(tag.word, "de" | "da" | "te");
        let foreign = self.clause.iter().filter(|tag| tag.is(Class::OtherLanguage)).count();
        let articles = self.clause.iter().filter(article).count();
        // "die weisse cup bitte": the objects present were meant.
        let ours = self.clause.iter().any(|tag| tag.is_value() && tag.exact);
        !ours && foreign > 0 && 2 * (foreign + articles + self.unknown) >= self.clause.len()
    }

    /// "I had a big breakfast", "my shirt is white", "he said yes".
    fn is_story(&self) -> bool {
        let Some((at, opening)) = self.opening() else { return false };
        if self.has(classes![Fetch Want]) {
            return false;
        }
        let about_it = self.has(classes![It]) || self.has_the_one();
        let is_story = self.has(classes![Story]) && !about_it;
        match opening {
            Class::Story | Class::When => !about_it,
            // "shall we go out for coffee"
            Class::Auxiliary => {
                matches!(self.clause[at].word, "shall" | "should")
                    && self.next(at).is_some_and(|next| next.is(Class::First))
            }
            Class::First => is_story || self.has(classes![When]) && !about_it,
            // "he small white bowl" is a "the" that was not heard well.
            Class::Third => !about_it && !self.next(at).is_some_and(Tag::is_value),
            // "my bowl is the white one" is about the bowl.
            Class::Possessive => {
                is_story || self.unknown > 0 && !about_it && !self.owns_ours(at + 1)
            }
            _ => false,
        }
    }

    /// Returns whether the clause is about "one" or "ones".
    fn has_the_one(&self) -> bool {
        self.clause.iter().any(|tag| tag.is(Class::Head) && tag.word.starts_with("one"))
    }

    /// "my bowl", "my silk shirt": the word here, or the phrase's last noun, names one of ours.
    fn owns_ours(&self, at: usize) -> bool {
        let Some(owned) = self.clause.get(at) else { return false };
        let phrase = self.clause[at..].iter().enumerate().take_while(|(n, tag)| {
            (*n == 0 || !tag.pauses()) && (tag.is_unknown() || tag.is_value())
        });
        owned.is_any(SCENE_NAMES)
            || owned.is_value()
            || phrase.last().is_some_and(|(_, noun)| noun.is_role(Role::Kind))
    }

    /// "my glass is empty": a thing of the kind, but not one of ours.
    fn owns_unlisted(&self) -> bool {
        let mut pairs = self.clause.windows(2);
        pairs.any(|pair| pair[0].is(Class::Possessive) && pair[1].is(Class::Unlisted))
    }

    /// "my shirt is white": it says nothing about our things, and requests nothing.
    fn describes_something_else(&self) -> bool {
        // "wrong spoon", "too big"
        let is_refused =
            |at| is_wrong_thing(self.clause, at) || too_much(self.clause, at).is_some();
        let wished = self.has(classes![Fetch])
            || self.has(classes![Unlisted]) && !self.owns_unlisted()
            || (0..self.clause.len()).any(is_refused);
        self.values > 0 && !self.has(SCENE_NAMES) && !wished
    }

    /// Strange words, and nothing that ties them to the wanted object.
    fn is_strange(&self) -> bool {
        let elsewhere = self.unknown > 0 && self.has(classes![Unlisted]) && self.has(classes![Be]);
        let tied = self.has(SCENE_NAMES)
            || self.has(classes![Fetch It])
            || self.points()
            || self.is_bare_noun();
        (self.unknown > 1 || elsewhere) && !tied
    }

    /// Returns whether the words point, as "that one", but not "this phone".
    fn points(&self) -> bool {
        let mut tags = self.clause.iter().enumerate();
        tags.any(|(at, tag)| tag.is(Class::Pointer) && !self.next(at).is_some_and(Tag::is_unknown))
    }

    /// "the wok please", "the pepper on the shelf": all that is said names one thing.
    pub(crate) fn is_bare_noun(&self) -> bool {
        let [article, rest @ ..] = self.clause else { return false };
        let named = rest.iter().take_while(|tag| tag.is_unknown()).count();
        let locates = |tag: &Tag<'_>| {
            tag.is_role(Role::Place) || tag.is_any(classes![Preposition Determiner Courtesy Filler])
        };
        matches!(article.word, "the" | "a" | "an")
            && self.is_everything
            && (1..=2).contains(&named)
            && rest[named..].iter().all(locates)
    }

    /// Only parts of a noun phrase: "blue", "the green one".
    fn is_fragment(&self) -> bool {
        !self.has(classes![Fetch Want Be Auxiliary First Second It Yes No Repair])
    }

    /// Returns whether the clause names something to fetch.
    fn requests(&self) -> bool {
        let named = self.has(classes![Head Attribute Unlisted Ordinal Other Pointer]);
        self.has(SCENE_NAMES)
            || self.has(classes![Unlisted])
                && (self.unknown == 0 || self.is_fragment() && self.ends_unlisted())
            || self.has(classes![Fetch Want]) && named
            || self.wants_unknown()
            || self.is_unknown_please()
            || self.fetches_for_me()
            || self.is_bare_noun()
            || self.has(classes![Ordinal Other]) && self.unknown == 0
    }

    /// "I would like a newspaper", "can I have the dinosaur".
    fn wants_unknown(&self) -> bool {
        let verb = self.clause.iter().position(|tag| {
            tag.is(Class::Want) && matches!(tag.last, "like" | "have" | "get" | "want" | "need")
        });
        let Some([article, rest @ ..]) = verb.map(|at| &self.clause[at + 1..]) else {
            return false;
        };
        let named = rest.iter().take_while(|tag| tag.is_unknown()).count();
        article.is_any(classes![Determiner Quantifier Possessive])
            && named == self.unknown
            && (1..=2).contains(&named)
            && rest[named..].iter().all(|tag| tag.is_any(classes![Courtesy Filler]))
    }

    /// "penicillin please"
    fn is_unknown_please(&self) -> bool {
        matches!(self.clause, [thing, please] if thing.is_unknown() && please.word == "please")
            && self.is_everything
    }

    /// "get me …"
    fn fetches_for_me(&self) -> bool {
        let verb = self.clause.iter().position(|tag| tag.is(Class::Fetch));
        verb.and_then(|at| self.next(at)).is_some_and(|next| next.word == "me")
    }

    /// "the allen key please": the noun is something that people ask for.
    fn ends_unlisted(&self) -> bool {
        let last = self.clause.iter().rev().find(|tag| !tag.is_any(classes![Courtesy Filler]));
        last.is_some_and(|tag| tag.is(Class::Unlisted))
    }
}
