//! Topic of a clause, judged by its words.

use std::ops::Range;

use scene::Role;

use crate::clauses::{Clause, Topic};
use crate::lexicon::{Lexicon, Sense};
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::tokens::Gap;

/// A clause and what its words give away.
pub(crate) struct ClauseAnalysis<'a> {
    pub(crate) lexicon: &'a Lexicon,
    pub(crate) tags: &'a [Tag<'a>],
    pub(crate) range: Range<usize>,
    pub(crate) unknown: usize,
    pub(crate) values: usize,
}

impl<'a> ClauseAnalysis<'a> {
    pub(crate) fn of(lexicon: &'a Lexicon, tags: &'a [Tag<'a>], range: Range<usize>) -> Self {
        let clause = &tags[range.clone()];
        let unknown = clause.iter().filter(|tag| tag.sense == Sense::Unknown).count();
        let values = clause.iter().filter(|tag| tag.value().is_some()).count();
        Self { lexicon, tags, range, unknown, values }
    }

    pub(crate) fn clause(&self) -> &'a [Tag<'a>] {
        &self.tags[self.range.clone()]
    }

    pub(crate) fn has(&self, classes: &[Class]) -> bool {
        self.clause().iter().any(|tag| tag.is_any(classes))
    }

    /// The first tag that is not a filler, as a class.
    fn opening(&self) -> Option<(usize, Class)> {
        const LEADS: &[Class] = classes![Filler Courtesy And But Join Yes No WeakYes Repair Plain];
        let at = self.clause().iter().position(|tag| !tag.is_any(LEADS))?;
        self.clause()[at].class().map(|class| (at, class))
    }

    pub(crate) fn classify(self, before: Option<&Clause>, injected: bool) -> Clause {
        let distractors = self.distractors();
        let topic = self.topic(before, injected, distractors.len());
        let requests = topic == Topic::On && self.requests();
        Clause { span: self.range, topic, requests, distractors }
    }

    fn topic(&self, before: Option<&Clause>, injected: bool, distractors: usize) -> Topic {
        if injected && !self.is_plain_request() {
            return Topic::Off;
        }
        let strange = self.unknown > 0 || self.values == self.places();
        if self.is_errand() && strange && !self.has(classes![Head]) {
            return Topic::Off;
        }
        if self.has(classes![SideTalk]) || self.is_other_language() || self.is_story() {
            return Topic::Off;
        }
        if self.asks_back(before) {
            // "what can you offer me", but not "what is the capital of France"
            let which = self.clause().first().is_some_and(|tag| tag.word == "which");
            let to_us =
                self.unknown == 1 && (which || self.clause().iter().any(|tag| tag.word == "me"));
            let strange = self.unknown > 0 && self.values == 0 && !self.has(SCENE_NAMES) && !to_us;
            return if strange { Topic::Off } else { Topic::AskBack };
        }
        let named = self.has(SCENE_NAMES);
        let wished =
            self.has(classes![Fetch]) || self.has(classes![Unlisted]) && !self.owns_unlisted();
        if distractors > 0 && distractors == self.values && !named && !wished {
            return Topic::Off;
        }
        // "I painted it white, blue and green": a continued list keeps its topic.
        let listed = self.tags[self.range.start].gap < Gap::Stop && self.is_fragment();
        let after_distractors = before
            .is_some_and(|before| before.topic == Topic::Off && !before.distractors.is_empty());
        if listed && after_distractors && self.values > 0 {
            return Topic::Off;
        }
        let wanted = self.has(classes![Want]) && self.values > distractors;
        let tied = named
            || wanted
            || self.has(classes![Fetch It])
            || self.points()
            || self.is_bare_noun()
            || self.denies_by_far();
        let elsewhere = self.unknown > 0 && self.has(classes![Unlisted]) && self.has(classes![Be]);
        if (self.unknown > 1 || elsewhere) && !tied { Topic::Off } else { Topic::On }
    }

    /// "not in a month of sundays"
    fn denies_by_far(&self) -> bool {
        let clause = self.clause();
        self.values == 0
            && matches!(clause, [not, how, ..] if not.is(Class::Not) && how.is(Class::Preposition))
    }

    /// "that one", but not "this phone".
    fn points(&self) -> bool {
        let clause = self.clause();
        clause.iter().enumerate().any(|(at, tag)| {
            tag.is(Class::Pointer)
                && clause.get(at + 1).is_none_or(|next| next.sense != Sense::Unknown)
        })
    }

    /// "get me the white one": a person asks for a thing, whatever else the text says.
    fn is_plain_request(&self) -> bool {
        let words = self.clause().iter().map(|tag| tag.word);
        let for_me = words.into_iter().any(|word| matches!(word, "me" | "i"));
        for_me
            && self.values > 0
            && self.has(classes![Fetch Want])
            && !self.has(classes![Injection])
    }

    fn is_other_language(&self) -> bool {
        // Articles that are slips of an English finger elsewhere.
        let article = |tag: &Tag<'_>| matches!(tag.word, "de" | "da" | "te");
        let foreign = self.clause().iter().filter(|tag| tag.is(Class::OtherLanguage)).count();
        let articles = self.clause().iter().filter(|tag| article(tag)).count();
        foreign > 0 && 2 * (foreign + articles + self.unknown) >= self.clause().len()
    }

    /// "I had a big breakfast", "my shirt is white", "he said yes".
    fn is_story(&self) -> bool {
        let Some((at, opening)) = self.opening() else { return false };
        if self.has(classes![Fetch Want]) {
            return false;
        }
        let about_it = self.has(classes![It]) || self.has_the_one() || self.confirms();
        let is_story = self.has(classes![Story]) && !about_it;
        match opening {
            Class::Story | Class::When => !about_it,
            // "shall we go out for coffee"
            Class::Auxiliary => {
                let ours = self.clause().get(at + 1).is_some_and(|next| next.is(Class::First));
                ours && matches!(self.clause()[at].word, "shall" | "should")
            }
            Class::First => is_story || self.has(classes![When]) && !about_it,
            // "he small white bowl" is a "the" that was not heard well.
            Class::Third => {
                let described = self.clause().get(at + 1).is_some_and(|tag| tag.value().is_some());
                !about_it && !described
            }
            // "my bowl is the white one" is about the bowl.
            Class::Possessive => {
                let ours = self.clause().get(at + 1).is_some_and(|owned| {
                    owned.is_any(SCENE_NAMES) || owned.value().is_some() || self.owns_kind(at + 1)
                });
                is_story || !ours && !about_it && self.unknown > 0
            }
            _ => false,
        }
    }

    /// "my silk shirt": the noun that ends what stands here is one of ours.
    fn owns_kind(&self, at: usize) -> bool {
        let phrase = self.clause()[at..].iter().enumerate().take_while(|(n, tag)| {
            (*n == 0 || tag.gap <= Gap::None)
                && (tag.sense == Sense::Unknown || tag.value().is_some())
        });
        let noun = phrase.last().and_then(|(_, tag)| tag.value());
        noun.is_some_and(|value| self.lexicon.value(value).role == Role::Kind)
    }

    /// "my glass is empty": a thing of the kind, but not one of ours.
    fn owns_unlisted(&self) -> bool {
        let pairs = self.clause().windows(2);
        pairs.into_iter().any(|pair| pair[0].is(Class::Possessive) && pair[1].is(Class::Unlisted))
    }

    /// "put it on the table", "empty the dishwasher": an order, but not to fetch.
    pub(crate) fn is_errand(&self) -> bool {
        let clause = self.clause();
        clause.iter().enumerate().any(|(at, tag)| {
            let before = at.checked_sub(1).map(|before| &clause[before]);
            let object = clause.get(at + 1).is_some_and(|next| {
                next.is_any(classes![Determiner Possessive It Pointer])
                    || next.sense == Sense::Unknown
                    || tag.word == "clear"
            });
            tag.is(Class::Put)
                && object
                && !before.is_some_and(|before| {
                    before.value().is_some() || before.is_any(classes![Determiner First])
                })
        })
    }

    fn places(&self) -> usize {
        let values = self.clause().iter().filter_map(Tag::value);
        values.filter(|&value| self.lexicon.value(value).role == Role::Place).count()
    }

    /// "that's the one" and the like, whatever story follows.
    fn confirms(&self) -> bool {
        let shown = |tag: &Tag<'_>| matches!(tag.word, "that" | "this" | "it");
        self.clause().iter().any(|tag| tag.is_any(classes![Yes WeakYes No]) && shown(tag))
    }

    /// "one", "ones" as what the clause is about.
    fn has_the_one(&self) -> bool {
        self.clause().iter().any(|tag| tag.is(Class::Head) && tag.word.starts_with("one"))
    }

    fn asks_back(&self, before: Option<&Clause>) -> bool {
        let opens = before.is_none_or(|before| {
            let lead = &self.tags[before.span.clone()];
            self.tags[self.range.start].gap == Gap::Stop || !lead.iter().any(is_content)
        });
        let Some((at, opening)) = self.opening().filter(|_| opens) else { return false };
        let next = self.clause().get(at + 1);
        match opening {
            Class::AskBack => !self.has(classes![Fetch]) || at_question(self.clause(), at),
            // "can you list the bowls"
            Class::Auxiliary => {
                let then = self.clause().get(at + 2);
                next.is_some_and(|next| next.is(Class::Second))
                    && then.is_some_and(|then| then.is(Class::AskBack))
            }
            Class::Question => self.is_question(at),
            Class::Be => self.asks_whether(at),
            _ => false,
        }
    }

    /// "are you pointing at the clear one", "is the pen on the table".
    fn asks_whether(&self, at: usize) -> bool {
        // "there is a pen on the table" states it.
        if self.clause()[..at].iter().any(|tag| tag.is(Class::Plain)) {
            return false;
        }
        let rest = &self.clause()[at + 1..];
        let value = |tag: &Tag<'_>| tag.value().is_some();
        match rest {
            [subject, ..] if subject.is(Class::Second) => {
                rest.iter().any(value) || self.has(SCENE_NAMES)
            }
            [subject, about @ ..] if subject.is(Class::Determiner) => {
                let place = about.iter().position(|tag| tag.is(Class::Preposition));
                place.is_some_and(|at| {
                    about[..at].iter().any(value) && about[at..].iter().any(value)
                })
            }
            _ => false,
        }
    }

    /// "the allen key please": the noun is something that people ask for.
    fn ends_unlisted(&self) -> bool {
        let last = self.clause().iter().rev().find(|tag| !tag.is_any(classes![Courtesy Filler]));
        last.is_some_and(|tag| tag.is(Class::Unlisted))
    }

    /// "which ones are white", but not "what I want" or "what a mess".
    fn is_question(&self, at: usize) -> bool {
        let next = self.clause().get(at + 1);
        let relative = next.is_some_and(|next| {
            next.is_any(classes![First Possessive Yes No]) || matches!(next.word, "a" | "an")
        });
        // "what can you bring", "which tools can you reach"
        let turns = self.clause()[at..].windows(2).any(|pair| {
            pair[0].is(Class::Auxiliary) && pair[1].is_any(classes![Second It Third Pointer])
        });
        let inverted = (turns || next.is_some_and(|next| next.is(Class::Auxiliary)))
            && !self.has(classes![Not]);
        !relative && (inverted || !self.has(classes![Fetch]))
    }

    /// "the wok please", "the pepper on the shelf": all that is said names one thing.
    pub(crate) fn is_bare_noun(&self) -> bool {
        let clause = self.clause();
        let opens = clause.first().is_some_and(|tag| matches!(tag.word, "the" | "a" | "an"));
        let unknown = |tag: &&Tag<'_>| tag.sense == Sense::Unknown;
        let named = clause.iter().skip(1).take_while(unknown).count();
        let rest = &clause[(named + 1).min(clause.len())..];
        let place = |tag: &Tag<'_>| {
            tag.value().is_some_and(|value| self.lexicon.value(value).role == Role::Place)
        };
        let located = rest
            .iter()
            .all(|tag| place(tag) || tag.is_any(classes![Preposition Determiner Courtesy Filler]));
        opens && clause.len() == self.tags.len() && (1..=2).contains(&named) && located
    }

    /// Only parts of a noun phrase: "blue", "the green one".
    fn is_fragment(&self) -> bool {
        const VERBS: &[Class] = classes![Fetch Want Be Auxiliary First Second It Yes No Repair];
        !self.has(VERBS)
    }

    /// Returns whether the clause names something to fetch.
    fn requests(&self) -> bool {
        let fetches = || {
            let clause = self.clause();
            let verb = clause.iter().position(|tag| tag.is(Class::Fetch));
            verb.is_some_and(|at| clause.get(at + 1).is_some_and(|next| next.word == "me"))
        };
        let named = self.has(classes![Head Attribute Unlisted Ordinal Other Pointer]);
        let verb = self.has(classes![Fetch Want]);
        self.has(SCENE_NAMES)
            || self.has(classes![Unlisted])
                && (self.unknown == 0 || self.is_fragment() && self.ends_unlisted())
            || verb && named
            || fetches()
            || self.is_bare_noun()
            || self.has(classes![Ordinal Other]) && self.unknown == 0
    }
}

/// Words that name the scene's objects.
pub(crate) const SCENE_NAMES: &[Class] = classes![Head Attribute];

fn is_content(tag: &Tag<'_>) -> bool {
    tag.sense == Sense::Unknown
        || tag.value().is_some()
        || tag.is_any(classes![Head Fetch Want Unlisted])
}

/// "what can you get me": the fetching is what is asked about.
fn at_question(clause: &[Tag<'_>], at: usize) -> bool {
    matches!(clause[at].word, "what" | "which" | "how" | "why" | "do" | "did")
}
