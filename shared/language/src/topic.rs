//! What a clause is about, judged by the words in it.

use std::ops::Range;

use scene::Role;

use crate::clauses::{Clause, Topic};
use crate::cue::{Cue, cues};
use crate::lexicon::{Lexicon, Sense};
use crate::marks::Mark;
use crate::tokens::Gap;

/// A clause and what its words give away.
pub(crate) struct Sketch<'a> {
    pub(crate) lexicon: &'a Lexicon,
    pub(crate) marks: &'a [Mark<'a>],
    pub(crate) range: Range<usize>,
    pub(crate) unknown: usize,
    pub(crate) values: usize,
}

impl<'a> Sketch<'a> {
    pub(crate) fn of(lexicon: &'a Lexicon, marks: &'a [Mark<'a>], range: Range<usize>) -> Self {
        let clause = &marks[range.clone()];
        let unknown = clause.iter().filter(|mark| mark.sense == Sense::Unknown).count();
        let values = clause.iter().filter(|mark| mark.value().is_some()).count();
        Self { lexicon, marks, range, unknown, values }
    }

    pub(crate) fn clause(&self) -> &'a [Mark<'a>] {
        &self.marks[self.range.clone()]
    }

    pub(crate) fn has(&self, cues: &[Cue]) -> bool {
        self.clause().iter().any(|mark| mark.is_any(cues))
    }

    /// The first mark that is not a filler, as a cue.
    fn opening(&self) -> Option<(usize, Cue)> {
        const LEADS: &[Cue] = cues![Filler Courtesy And But Join Yes No WeakYes Repair Plain];
        let at = self.clause().iter().position(|mark| !mark.is_any(LEADS))?;
        self.clause()[at].cue().map(|cue| (at, cue))
    }

    pub(crate) fn judge(self, before: Option<&Clause>, injected: bool) -> Clause {
        let aside = self.aside_values();
        let topic = self.topic(before, injected, aside.len());
        let requests = topic == Topic::On && self.requests();
        Clause { marks: self.range, topic, requests, aside }
    }

    fn topic(&self, before: Option<&Clause>, injected: bool, aside: usize) -> Topic {
        if injected && !self.is_plain_request() {
            return Topic::Off;
        }
        let strange = self.unknown > 0 || self.values == self.places();
        if self.is_errand() && strange && !self.has(cues![Head]) {
            return Topic::Off;
        }
        if self.has(cues![Aside]) || self.is_other_language() || self.is_story() {
            return Topic::Off;
        }
        if self.asks_back(before) {
            // "what can you offer me", but not "what is the capital of France"
            let which = self.clause().first().is_some_and(|mark| mark.word == "which");
            let to_us =
                self.unknown == 1 && (which || self.clause().iter().any(|mark| mark.word == "me"));
            let strange = self.unknown > 0 && self.values == 0 && !self.has(SCENE_NAMES) && !to_us;
            return if strange { Topic::Off } else { Topic::AskBack };
        }
        let named = self.has(SCENE_NAMES);
        let wished = self.has(cues![Fetch]) || self.has(cues![Unlisted]) && !self.owns_unlisted();
        if aside > 0 && aside == self.values && !named && !wished {
            return Topic::Off;
        }
        // "I painted it white, blue and green": what goes on in a list stays in it.
        let listed = self.marks[self.range.start].gap < Gap::Stop && self.is_fragment();
        let after_aside =
            before.is_some_and(|before| before.topic == Topic::Off && !before.aside.is_empty());
        if listed && after_aside && self.values > 0 {
            return Topic::Off;
        }
        let wanted = self.has(cues![Want]) && self.values > aside;
        let tied = named
            || wanted
            || self.has(cues![Fetch It])
            || self.points()
            || self.is_bare_noun()
            || self.denies_by_far();
        let elsewhere = self.unknown > 0 && self.has(cues![Unlisted]) && self.has(cues![Be]);
        if (self.unknown > 1 || elsewhere) && !tied { Topic::Off } else { Topic::On }
    }

    /// "not in a month of sundays"
    fn denies_by_far(&self) -> bool {
        let clause = self.clause();
        self.values == 0
            && matches!(clause, [not, how, ..] if not.is(Cue::Not) && how.is(Cue::Preposition))
    }

    /// "that one", but not "this phone".
    fn points(&self) -> bool {
        let clause = self.clause();
        clause.iter().enumerate().any(|(at, mark)| {
            mark.is(Cue::Pointer)
                && clause.get(at + 1).is_none_or(|next| next.sense != Sense::Unknown)
        })
    }

    /// "get me the white one": a person asks for a thing, whatever else the text says.
    fn is_plain_request(&self) -> bool {
        let words = self.clause().iter().map(|mark| mark.word);
        let for_me = words.into_iter().any(|word| matches!(word, "me" | "i"));
        for_me && self.values > 0 && self.has(cues![Fetch Want]) && !self.has(cues![Injection])
    }

    fn is_other_language(&self) -> bool {
        // Articles that are slips of an English finger elsewhere.
        let article = |mark: &Mark<'_>| matches!(mark.word, "de" | "da" | "te");
        let foreign = self.clause().iter().filter(|mark| mark.is(Cue::OtherLanguage)).count();
        let articles = self.clause().iter().filter(|mark| article(mark)).count();
        foreign > 0 && 2 * (foreign + articles + self.unknown) >= self.clause().len()
    }

    /// "I had a big breakfast", "my shirt is white", "he said yes".
    fn is_story(&self) -> bool {
        let Some((at, opening)) = self.opening() else { return false };
        if self.has(cues![Fetch Want]) {
            return false;
        }
        let about_it = self.has(cues![It]) || self.has_the_one() || self.confirms();
        let told = self.has(cues![Story]) && !about_it;
        match opening {
            Cue::Story | Cue::When => !about_it,
            // "shall we go out for coffee"
            Cue::Auxiliary => {
                let ours = self.clause().get(at + 1).is_some_and(|next| next.is(Cue::First));
                ours && matches!(self.clause()[at].word, "shall" | "should")
            }
            Cue::First => told || self.has(cues![When]) && !about_it,
            // "he small white bowl" is a "the" that was not heard well.
            Cue::Third => {
                let described =
                    self.clause().get(at + 1).is_some_and(|mark| mark.value().is_some());
                !about_it && !described
            }
            // "my bowl is the white one" is about the bowl.
            Cue::Possessive => {
                let ours = self.clause().get(at + 1).is_some_and(|owned| {
                    owned.is_any(SCENE_NAMES) || owned.value().is_some() || self.owns_kind(at + 1)
                });
                told || !ours && !about_it && self.unknown > 0
            }
            _ => false,
        }
    }

    /// "my silk shirt": the noun that ends what stands here is one of ours.
    fn owns_kind(&self, at: usize) -> bool {
        let phrase = self.clause()[at..].iter().enumerate().take_while(|(n, mark)| {
            (*n == 0 || mark.gap <= Gap::None)
                && (mark.sense == Sense::Unknown || mark.value().is_some())
        });
        let noun = phrase.last().and_then(|(_, mark)| mark.value());
        noun.is_some_and(|value| self.lexicon.value(value).role == Role::Kind)
    }

    /// "my glass is empty": a thing of the kind, but not one of ours.
    fn owns_unlisted(&self) -> bool {
        let pairs = self.clause().windows(2);
        pairs.into_iter().any(|pair| pair[0].is(Cue::Possessive) && pair[1].is(Cue::Unlisted))
    }

    /// "put it on the table", "empty the dishwasher": an order, but not to fetch.
    pub(crate) fn is_errand(&self) -> bool {
        let clause = self.clause();
        clause.iter().enumerate().any(|(at, mark)| {
            let before = at.checked_sub(1).map(|before| &clause[before]);
            let object = clause.get(at + 1).is_some_and(|next| {
                next.is_any(cues![Determiner Possessive It Pointer])
                    || next.sense == Sense::Unknown
                    || mark.word == "clear"
            });
            mark.is(Cue::Put)
                && object
                && !before.is_some_and(|before| {
                    before.value().is_some() || before.is_any(cues![Determiner First])
                })
        })
    }

    fn places(&self) -> usize {
        let values = self.clause().iter().filter_map(Mark::value);
        values.filter(|&value| self.lexicon.value(value).role == Role::Place).count()
    }

    /// "that's the one" and the like, whatever is told after it.
    fn confirms(&self) -> bool {
        let shown = |mark: &Mark<'_>| matches!(mark.word, "that" | "this" | "it");
        self.clause().iter().any(|mark| mark.is_any(cues![Yes WeakYes No]) && shown(mark))
    }

    /// "one", "ones" as what the clause is about.
    fn has_the_one(&self) -> bool {
        self.clause().iter().any(|mark| mark.is(Cue::Head) && mark.word.starts_with("one"))
    }

    fn asks_back(&self, before: Option<&Clause>) -> bool {
        let opens = before.is_none_or(|before| {
            let lead = &self.marks[before.marks.clone()];
            self.marks[self.range.start].gap == Gap::Stop || !lead.iter().any(is_content)
        });
        let Some((at, opening)) = self.opening().filter(|_| opens) else { return false };
        let next = self.clause().get(at + 1);
        match opening {
            Cue::AskBack => !self.has(cues![Fetch]) || at_question(self.clause(), at),
            // "can you list the bowls"
            Cue::Auxiliary => {
                let then = self.clause().get(at + 2);
                next.is_some_and(|next| next.is(Cue::Second))
                    && then.is_some_and(|then| then.is(Cue::AskBack))
            }
            Cue::Question => self.is_question(at),
            Cue::Be => self.asks_whether(at),
            _ => false,
        }
    }

    /// "are you pointing at the clear one", "is the pen on the table".
    fn asks_whether(&self, at: usize) -> bool {
        // "there is a pen on the table" states it.
        if self.clause()[..at].iter().any(|mark| mark.is(Cue::Plain)) {
            return false;
        }
        let rest = &self.clause()[at + 1..];
        let value = |mark: &Mark<'_>| mark.value().is_some();
        match rest {
            [subject, ..] if subject.is(Cue::Second) => {
                rest.iter().any(value) || self.has(SCENE_NAMES)
            }
            [subject, about @ ..] if subject.is(Cue::Determiner) => {
                let place = about.iter().position(|mark| mark.is(Cue::Preposition));
                place.is_some_and(|at| {
                    about[..at].iter().any(value) && about[at..].iter().any(value)
                })
            }
            _ => false,
        }
    }

    /// "the allen key please": the noun is something that people ask for.
    fn ends_unlisted(&self) -> bool {
        let last = self.clause().iter().rev().find(|mark| !mark.is_any(cues![Courtesy Filler]));
        last.is_some_and(|mark| mark.is(Cue::Unlisted))
    }

    /// "which ones are white", but not "what I want" or "what a mess".
    fn is_question(&self, at: usize) -> bool {
        let next = self.clause().get(at + 1);
        let relative = next.is_some_and(|next| {
            next.is_any(cues![First Possessive Yes No]) || matches!(next.word, "a" | "an")
        });
        // "what can you bring", "which tools can you reach"
        let turns = self.clause()[at..].windows(2).any(|pair| {
            pair[0].is(Cue::Auxiliary) && pair[1].is_any(cues![Second It Third Pointer])
        });
        let inverted =
            (turns || next.is_some_and(|next| next.is(Cue::Auxiliary))) && !self.has(cues![Not]);
        !relative && (inverted || !self.has(cues![Fetch]))
    }

    /// "the wok please", "the pepper on the shelf": all that is said names one thing.
    pub(crate) fn is_bare_noun(&self) -> bool {
        let clause = self.clause();
        let opens = clause.first().is_some_and(|mark| matches!(mark.word, "the" | "a" | "an"));
        let unknown = |mark: &&Mark<'_>| mark.sense == Sense::Unknown;
        let named = clause.iter().skip(1).take_while(unknown).count();
        let rest = &clause[(named + 1).min(clause.len())..];
        let place = |mark: &Mark<'_>| {
            mark.value().is_some_and(|value| self.lexicon.value(value).role == Role::Place)
        };
        let located = rest
            .iter()
            .all(|mark| place(mark) || mark.is_any(cues![Preposition Determiner Courtesy Filler]));
        opens && clause.len() == self.marks.len() && (1..=2).contains(&named) && located
    }

    /// Only parts of a noun phrase: "blue", "the green one".
    fn is_fragment(&self) -> bool {
        const VERBS: &[Cue] = cues![Fetch Want Be Auxiliary First Second It Yes No Repair];
        !self.has(VERBS)
    }

    /// Whether the clause names something to fetch.
    fn requests(&self) -> bool {
        let fetches = || {
            let clause = self.clause();
            let verb = clause.iter().position(|mark| mark.is(Cue::Fetch));
            verb.is_some_and(|at| clause.get(at + 1).is_some_and(|next| next.word == "me"))
        };
        let named = self.has(cues![Head Attribute Unlisted Ordinal Other Pointer]);
        let verb = self.has(cues![Fetch Want]);
        self.has(SCENE_NAMES)
            || self.has(cues![Unlisted])
                && (self.unknown == 0 || self.is_fragment() && self.ends_unlisted())
            || verb && named
            || fetches()
            || self.is_bare_noun()
            || self.has(cues![Ordinal Other]) && self.unknown == 0
    }
}

/// Words that name the scene's objects.
pub(crate) const SCENE_NAMES: &[Cue] = cues![Head Attribute];

fn is_content(mark: &Mark<'_>) -> bool {
    mark.sense == Sense::Unknown
        || mark.value().is_some()
        || mark.is_any(cues![Head Fetch Want Unlisted])
}

/// "what can you get me": the fetching is what is asked about.
fn at_question(clause: &[Mark<'_>], at: usize) -> bool {
    matches!(clause[at].word, "what" | "which" | "how" | "why" | "do" | "did")
}
