//! Readings of one utterance's content.

use scene::{Doubt, Intent, Reading, Reference, Response, WordId};

use crate::clauses::Clause;
use crate::content::{Asserted, Content};
use crate::objects::objects;
use crate::question_words::{QuestionWords, SceneQuestions};
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// Most readings of one utterance.
pub const READINGS_MAX: usize = 4;
/// Most further objects that "all" means, and most values in a question.
const MORE_MAX: usize = 4;

/// An utterance after parsing.
pub(crate) struct ParsedUtterance<'a> {
    pub(crate) content: Content<'a>,
    /// The answer and the probability that it was not given.
    pub(crate) response: (Response, f64),
    pub(crate) intent: Intent,
    pub(crate) refers: Reference,
    /// Words of each object that it refers to.
    pub(crate) to: Vec<Vec<WordId>>,
    pub(crate) asked: QuestionWords<'a>,
    pub(crate) tags: Vec<Tag<'a>>,
    pub(crate) clauses: Vec<Clause>,
    pub(crate) questions: &'a SceneQuestions,
    /// Text that no person says.
    pub(crate) code: bool,
}

impl ParsedUtterance<'_> {
    /// The best reading.
    pub(crate) fn reading(&self) -> Reading {
        let objects = match self.intent {
            Intent::Inform if !self.is_relation() => objects(&self.tags, &self.content, self.asked),
            _ => vec![self.content.base.clone()],
        };
        let objects: Vec<_> = objects.into_iter().map(each_once).collect();
        let words = |object: &Vec<Asserted<'_>>| -> Vec<WordId> {
            object.iter().map(|value| value.word).collect()
        };
        let mut reading = self.reading_of(&objects[0]);
        if self.is_relation() {
            return reading;
        }
        reading.further = objects.iter().skip(1).map(words).collect();
        reading.further.extend(self.content.asked.iter().take(MORE_MAX).map(|word| vec![*word]));
        if objects.len() == 1
            && reading.response == Response::None
            && let Some(more) = self.more_of_them()
        {
            // "both cups": whichever comes first.
            reading.further = vec![words(&objects[0]); more];
            reading.response = Response::DoesNotMatter;
        }
        reading
    }

    fn is_relation(&self) -> bool {
        matches!(self.refers, Reference::Relation(_))
    }

    /// Number of further objects of the same description: "both cups", "two red mugs", "three
    /// bowls", "all the cars", "the socks, both of them".
    fn more_of_them(&self) -> Option<usize> {
        let request = self.intent == Intent::Inform
            && self.asked.is_nothing()
            && self.content.excluded.is_empty();
        let (first, last) = self.described().filter(|_| request)?;
        let lead = |tag: &&Tag<'_>| {
            tag.is_value() || tag.is_any(classes![Determiner Possessive Preposition])
        };
        let before = self.tags[..first].iter().rposition(|tag| !lead(&tag));
        let is_led = before.is_some_and(|at| at + 1 < first);
        let count = before.filter(|at| self.tags[*at].is(Class::Quantifier));
        if count.is_some_and(|at| self.is_one_of(at)) {
            return None;
        }
        let count = count.map(|at| &self.tags[at]);
        let last = &self.tags[last..];
        let of_them = last.windows(3).find(|three| {
            three[0].is(Class::Quantifier) && three[1].word == "of" && three[2].is(Class::It)
        });
        let count = count.or(of_them.map(|three| &three[0]))?;
        match count.word {
            // "a pair of scissors" is one thing.
            "pair" => {
                (!self.content.base.iter().any(|it| self.questions.is_plural(it.word))).then_some(1)
            }
            "both" | "two" | "couple" => Some(1),
            "three" => Some(2),
            "four" => Some(3),
            "five" | "six" | "seven" | "eight" | "nine" | "ten" => Some(MORE_MAX),
            "all" if is_led || of_them.is_some() => {
                let words: Vec<WordId> = self.content.base.iter().map(|it| it.word).collect();
                let more = self.questions.suited(&words, &[]).saturating_sub(1);
                (1..=MORE_MAX).contains(&more).then_some(more)
            }
            _ => None,
        }
    }

    /// "one of the two", "either of the two": the number at `at` counts those to choose from.
    fn is_one_of(&self, at: usize) -> bool {
        let lead = |tag: &&Tag<'_>| tag.is_any(classes![Determiner Pointer Possessive]);
        let leads = self.tags[..at].iter().rev().take_while(lead).count();
        let [.., one, of] = &self.tags[..at - leads] else { return false };
        of.word == "of" && matches!(one.last, "one" | "either" | "any")
    }

    /// Positions of the first and last word that describe the wanted object, or else of its noun.
    fn described(&self) -> Option<(usize, usize)> {
        if let [first, ..] = &self.content.base[..] {
            return Some((first.at, self.content.base.last()?.at));
        }
        let is_noun = |tag: &Tag<'_>| tag.is(Class::Head) && !tag.word.starts_with("one");
        let mut requests = self.clauses.iter().filter(|clause| clause.requests);
        let noun = requests.find_map(|it| it.span.clone().find(|at| is_noun(&self.tags[*at])))?;
        Some((noun, noun))
    }

    fn reading_of(&self, base: &[Asserted<'_>]) -> Reading {
        let (response, doubt) = self.response;
        // Without a question an answer must be alone: "great, thanks" and "okay, get it" are not.
        let is_asked = !self.asked.is_nothing();
        let may_answer = is_asked || response == Response::DoesNotMatter;
        let requests = self.clauses.iter().any(|clause| clause.requests);
        let is_mere = self.intent == Intent::Inform && self.refers == Reference::None && !requests;
        let answered = if may_answer { self.intent != Intent::None } else { is_mere };
        let excluded = &self.content.excluded;
        Reading {
            base: base.iter().map(|value| value.word).collect(),
            response: if answered { response } else { Response::None },
            excluded: excluded.iter().map(|group| group.words.clone()).collect(),
            intent: self.intent,
            refers: self.refers,
            further: self.to.clone(),
            doubt: Doubt {
                base: known(base.iter().map(|value| value.doubt)),
                excluded: known(excluded.iter().map(|group| group.doubt)),
                response: if answered && response != Response::None { doubt } else { 0.0 },
            },
        }
    }

    /// Every reading with its weight, best first.
    pub(crate) fn readings(&self) -> Vec<(f64, Reading)> {
        let best = self.reading();
        let choices = self.choices();
        if !choices.is_empty() {
            let weight = 1.0 / (choices.len() + 1) as f64;
            let readings = choices.iter().map(|base| self.reading_of(base));
            return std::iter::once(best).chain(readings).map(|one| (weight, one)).collect();
        }
        if self.may_take_back(&best) {
            let doubt = Doubt { response: 0.0, ..best.doubt.clone() };
            let correction = Reading { response: Response::None, doubt, ..best.clone() };
            return vec![(0.5, best), (0.5, correction)];
        }
        vec![(1.0, best)]
    }

    /// "red or blue": each with the words about both; empty without a choice.
    fn choices(&self) -> Vec<Vec<Asserted<'_>>> {
        let base = &self.content.base;
        let Some(at) = base.windows(2).position(|pair| pair[0].choice != pair[1].choice) else {
            return Vec::new();
        };
        let (left, right) = (&base[at], &base[at + 1]);
        if !left.rivals(right) {
            let parts = [&base[..=at], &base[at + 1..]];
            return parts.map(<[_]>::to_vec).into();
        }
        let members: Vec<&Asserted<'_>> = base.iter().filter(|one| one.rivals(left)).collect();
        let chosen = |member: &&Asserted<'_>| {
            let others = |one: &&Asserted<'_>| !one.rivals(left) || one.word == member.word;
            base.iter().filter(others).copied().collect()
        };
        members.iter().take(READINGS_MAX - 1).map(chosen).collect()
    }

    /// "no, yellow", in answer to "A screwdriver or pliers?": neither of them, or another colour than the user said before.
    /// Lacking figures, both are as likely.
    fn may_take_back(&self, best: &Reading) -> bool {
        let QuestionWords::Choice(options) = self.asked else { return false };
        let is_offered = |word: &WordId| options.contains(&Some(*word));
        let concerns =
            |value: &Asserted<'_>| self.questions.values_beside(value).iter().any(is_offered);
        let base = &self.content.base;
        best.response == Response::No && !base.is_empty() && !base.iter().any(concerns)
    }
}

/// The values of an object, each once: "the red mug, no wait, the red cup".
fn each_once(values: Vec<Asserted<'_>>) -> Vec<Asserted<'_>> {
    let mut once: Vec<Asserted<'_>> = Vec::new();
    for value in values {
        match once.iter_mut().find(|known| known.word == value.word) {
            Some(known) => known.doubt = known.doubt.min(value.doubt),
            None => once.push(value),
        }
    }
    once
}

/// The doubts up to the last that is one.
fn known(doubts: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut doubts: Vec<f64> = doubts.collect();
    let known = doubts.iter().rposition(|doubt| *doubt != 0.0).map_or(0, |last| last + 1);
    doubts.truncate(known);
    doubts
}
