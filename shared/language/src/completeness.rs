//! How complete an utterance in progress is: whether its speaker will continue after a pause.
//!
//! The judgement is about words alone, and cautious: a text that may continue is not complete.

use ::vocabulary::Language;
use scene::{Intent, Question, Reading, Response, Role, Scene};
use words::{Tokens, normalise};

use crate::reader::Reader;
use crate::tagger::{Tag, tag};
use crate::token_class::{Class, classes};

/// How complete an utterance is, the most complete first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Completeness {
    /// The utterance answers the question, or describes one object: the rest hardly matters.
    Complete,
    /// The utterance can be whole, but people often add to it: "no", "get me the bowl".
    Sufficient,
    /// Neither.
    Unclear,
    /// The last words need others after them: "the big", "it is on", "um".
    Open,
}

/// Judges the utterances about one scene. Holds all that it needs of the scene.
#[derive(Clone, Debug)]
pub struct CompletenessJudge {
    reader: Reader,
}

impl CompletenessJudge {
    /// Prepares for a scene.
    pub fn new(scene: &Scene) -> Self {
        // Whichever reading the dialogue uses, this one covers the most phrases.
        Self { reader: Reader::new(scene, Language::Careful) }
    }

    /// Judges the words so far of an utterance that follows `question`.
    pub fn judge(&self, text: &str, question: Question) -> Completeness {
        let normal = normalise(text);
        let tokens = Tokens::of(&normal);
        let tags = tag(self.reader.lexicon(), &tokens);
        let spoken = match tags.iter().rposition(|tag| !tag.is(Class::Courtesy)) {
            // "please" alone, or nothing yet.
            None => return Completeness::Unclear,
            Some(last) => &tags[..=last],
        };
        let is_polite = spoken.len() < tags.len();
        let words: Vec<&str> = tokens.words.iter().map(|token| token.word).collect();
        if !is_polite && (is_open(spoken) || begins_statement(&words, spoken)) {
            return Completeness::Open;
        }
        if spoken.last().is_some_and(|last| last.is_unknown() || last.is(Class::Plain)) {
            return Completeness::Unclear;
        }
        let reading = self.reader.read(text, question);
        match reading.intent {
            Intent::Stop | Intent::StopAndCancel => Completeness::Complete,
            Intent::Inform | Intent::GoOn => self.judge_content(spoken, &reading, question),
            Intent::Cancel
            | Intent::StartOver
            | Intent::Greet
            | Intent::Thank
            | Intent::PutBack => Completeness::Sufficient,
            // Questions to the robot, and words that are not meant for it.
            _ => Completeness::Unclear,
        }
    }

    fn judge_content(
        &self,
        tags: &[Tag<'_>],
        reading: &Reading,
        question: Question,
    ) -> Completeness {
        let is_described = !reading.base.is_empty();
        let candidates = self.reader.questions().suited(&reading.base, &reading.excluded);
        let is_unique = is_described && candidates == 1;
        let names_asked = is_described && candidates > 0 && self.answers(reading, question);
        let ends_in_noun = tags.last().is_some_and(ends_noun_phrase);
        let is_asked = question != Question::None;
        // "I don't know", "I don't care".
        let is_unsure = tags.last().is_some_and(|it| it.is_any(classes![Unsure Indifferent]));
        match reading.response {
            Response::Yes if is_asked && (!is_described || candidates > 0) => {
                Completeness::Complete
            }
            // "No": a correction may follow.
            Response::No if is_asked && !names_asked && !is_unique => Completeness::Sufficient,
            _ if names_asked || is_unique && ends_in_noun => Completeness::Complete,
            _ if is_asked && !is_described && is_unsure => Completeness::Complete,
            _ if ends_in_noun && candidates > 0 => Completeness::Sufficient,
            _ => Completeness::Unclear,
        }
    }

    /// Returns whether the words name a value of the attribute asked about.
    fn answers(&self, reading: &Reading, question: Question) -> bool {
        let values = question.attribute().map_or(&[][..], |k| self.reader.questions().of(k));
        reading.base.iter().any(|word| values.contains(word))
    }
}

/// Returns whether something must follow the last word.
fn is_open(tags: &[Tag<'_>]) -> bool {
    const LEADS: &[Class] = classes![
        Determiner Possessive Preposition Destination Landmark Than And Or But Join First Auxiliary
        Fetch Want Put Not Except Filler Quantifier Repair Attribute Hedge
    ];
    let [before @ .., last] = tags else { return true };
    // "It is not", "it does": an answer; "not" and "is" alone lead on.
    let is_answer = before.iter().any(|tag| tag.is_any(classes![Yes No]));
    let ellipsis = last.is_any(classes![Be Not Auxiliary])
        && before.iter().any(|tag| tag.is_any(classes![It Pointer First]));
    if ellipsis && (is_answer || last.is(Class::Not)) {
        return false;
    }
    if last.is_any(LEADS) || last.is(Class::Be) {
        return true;
    }
    let follows = |class| before.last().is_some_and(|tag| tag.is(class));
    if last.word == "me" && follows(Class::Fetch)
        || last.is(Class::Second) && follows(Class::Auxiliary)
    {
        return true;
    }
    // "The big", "a small white": the noun is missing.
    let is_modifier =
        |tag: &Tag<'_>| tag.is_role(Role::Quality) || tag.is_any(classes![Ordinal Other Unlisted]);
    if !is_modifier(last) {
        return false;
    }
    let lead = before.iter().rev().find(|tag| !is_modifier(tag) && !tag.is(Class::Plain));
    let is_place = last.is(Class::Ordinal)
        && before.iter().any(|tag| tag.is_any(classes![Preposition Destination]));
    !is_place && lead.is_some_and(|lead| lead.is_any(classes![Determiner Possessive Quantifier]))
}

/// "It is", "no it has": an answer after a yes alone ("yes it is").
fn begins_statement(words: &[&str], tags: &[Tag<'_>]) -> bool {
    let [earlier @ .., "it" | "that" | "they" | "which", "is" | "has" | "was" | "are"] = words
    else {
        return false;
    };
    earlier.is_empty() || !tags.first().is_some_and(|first| first.is(Class::Yes))
}

/// Returns whether a description can end here: with its noun or its place.
fn ends_noun_phrase(last: &Tag<'_>) -> bool {
    last.is_any(classes![Head One]) || last.is_value() && !last.is_role(Role::Quality)
}

#[cfg(test)]
mod tests {
    use super::Completeness::{Open, Sufficient};
    use super::*;
    use crate::tests::scene;
    use crate::tests::table::question;

    /// Cases in the six bowls: attribute asked about, or with its value, `?` completeness: texts.
    const CASES: &str = "\
color=white? Complete: yes, yeah, yes please, yes it is, yep, yes the white one, it is white, the white one
color=white? Complete: no it is clear, no the clear one, no the metallic one please, I don't know, i do not care
color=white? Sufficient: no, nope, no it is not, it is not, no not white, no the big one
color=white? Open: no the, no it is, no it is on the, no the big, yes the, yes but, um, no um, no it is in, it is
color=white? Open: no the shiny, no I want, no get me, no I mean
color? Complete: white, it is white, the white one, metallic, silver, I don't know
color? Sufficient: the small one
color? Open: it is, the, it is a, the white, well, it has, um the
color? Unclear: , please, xylophone
location? Complete: on the counter, it is in the cabinet, the counter, the one in the dishwasher
location? Open: on, on the, it is on, it is in the, next to the, it is next to, behind
? Complete: the clear bowl, get me the clear bowl, bring me the big white bowl please, the small bowl on the counter
? Complete: get me the clear one, stop
? Sufficient: get me the bowl, the bowl, the white bowl, I want the big bowl, a bowl please, the bowl on the counter
? Sufficient: the white one, forget it
? Open: get me, get me the, the big, the small white, I want, can you, can you get me a, the bowl on, the bowl on the
? Open: the white bowl in the, the one next to the, a white bowl and, um, please get me the, the bowl that is
? Open: not the, the red one or, the bowl from, bring me my, the other, hand me a big, the bowl with, i would like
? Unclear: yes, hello there, white, what";

    #[test]
    fn completeness_of_words_in_their_place() {
        let scene = scene("bowls");
        let judge = CompletenessJudge::new(&scene);
        let mut wrong = Vec::new();
        for (asked, rest) in CASES.lines().filter_map(|line| line.split_once("? ")) {
            let (expected, texts) = rest.split_once(": ").expect("texts");
            for text in texts.split(", ") {
                let judged = format!("{:?}", judge.judge(text, question(&scene, asked)));
                if judged != expected {
                    wrong.push(format!("{asked}? {text}: expected {expected}, found {judged}"));
                }
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    /// No beginning of a sentence is complete only because of the words that are still to come.
    #[test]
    fn completeness_of_beginnings_of_sentences_is_never_early() {
        for name in ["bowls", "tools", "garments", "pantry"] {
            let scene = scene(name);
            let judge = CompletenessJudge::new(&scene);
            for attribute in scene.attributes() {
                for value in &attribute.values {
                    let noun = scene.noun();
                    let place =
                        value.spoken.split_once(' ').filter(|_| value.role() == Role::Place);
                    let Some((preposition, rest)) = place else { continue };
                    let whole = format!("get me the {noun} {preposition} {rest}");
                    let at = whole.len() - rest.len();
                    let article = rest.split(' ').next().filter(|word| *word == "the");
                    let to = article.map_or(at, |article| at + article.len());
                    assert_eq!(judge.judge(&whole[..to], Question::None), Open, "{name}: {whole}");
                    let judged = judge.judge(&whole, Question::None);
                    assert!(judged <= Sufficient, "{name}: {whole}: {judged:?}");
                }
            }
        }
    }
}
