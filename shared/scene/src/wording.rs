//! Wording of the robot's questions.

use std::borrow::Cow;

use crate::describe::enumerate;
use crate::forms::indefinite;
use crate::{AttributeId, Options, Question, Scene, ValueId};

/// Default yes/no wordings of an attribute.
pub(crate) const ASK_YES_NO: [&str; 1] = ["Is the {attribute} {value}?"];
/// Default open wordings of an attribute.
pub(crate) const ASK_WHICH: [&str; 1] = ["What is the {attribute}?"];
/// Default wordings of the first prompt.
pub(crate) const ASK_WANTED: [&str; 1] = ["Which {noun} would you like?"];
/// Default wordings of a pointing question.
pub(crate) const ASK_POINT: [&str; 3] = ["This one?", "Is it this one?", "Do you mean this one?"];

/// Beginnings of a question that was put before.
const LEADS: [&str; 8] = [
    "Once more:",
    "Please tell me:",
    "What I need to know:",
    "Let me ask again:",
    "Again:",
    "I still wonder:",
    "My question was:",
    "Just to be sure:",
];

/// Wordings of questions that are not about an attribute; at least one of each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Asks {
    pub(crate) wanted: Vec<String>,
    pub(crate) point: Vec<String>,
}

impl Scene {
    /// Returns the usual wording of `question`: "Is it in the dishwasher?", "What colour is it?",
    /// "This one?" (while pointing). Durations are calculated with it.
    ///
    /// # Panics
    /// If the question is not of this scene ([`Scene::contains`]).
    pub fn phrase(&self, question: Question) -> String {
        self.phrase_variant(question, 0, 1, &[])
    }

    /// Returns the wording of `question` as the `n`-th prompt, put for the `time`-th time (from 1).
    /// Wordings take turns; a repeated question is shortened, then put as "yes or no?", or lists
    /// `choices`, the answers to an open question that are left (in spoken form; empty if they are
    /// too many), and then begins in another way each time. The result depends on the arguments
    /// alone, so that a replay gives the same words; variant 0, put once, is `phrase`.
    ///
    /// # Panics
    /// If the question is not of this scene ([`Scene::contains`]).
    pub fn phrase_variant(
        &self,
        question: Question,
        n: u64,
        time: u32,
        choices: &[String],
    ) -> String {
        let wordings = self.wordings(question);
        let plain = |n: u64| {
            #[expect(clippy::cast_possible_truncation, reason = "below the number of wordings")]
            let at = (n % wordings.len() as u64) as usize;
            self.fill(&wordings[at], question)
        };
        match time {
            0 | 1 => plain(n),
            2 => self.shortened(question).unwrap_or_else(|| plain(n + 1)),
            3 => self.with_choices(question, &plain(n), choices),
            more => {
                let again = u64::from(more) - 4;
                #[expect(clippy::cast_possible_truncation, reason = "below the number of leads")]
                let lead = (again % LEADS.len() as u64) as usize;
                let wording = plain(n + again + again / LEADS.len() as u64);
                format!("{} {}", LEADS[lead], self.continued(question, &wording))
            }
        }
    }

    /// Returns a wording as it continues after a colon; a value at the start keeps its capital.
    fn continued(&self, question: Question, wording: &str) -> String {
        let values = question.attribute().map(|k| &self.attributes()[k.index()].values);
        let mut values = values.into_iter().flatten();
        match values.any(|value| wording.starts_with(value.spoken.as_str())) {
            true => wording.to_owned(),
            false => in_lower_case(wording),
        }
    }

    fn wordings(&self, question: Question) -> Cow<'_, [String]> {
        Cow::Borrowed(match question {
            Question::None => &self.asks().wanted,
            Question::Point(_) => &self.asks().point,
            Question::Attribute(k, _) => &self.attributes()[k.index()].ask_yes_no,
            Question::Which(k) => &self.attributes()[k.index()].ask_which,
            Question::Choice(k, options) => return Cow::Owned(self.choice_wordings(k, options)),
        })
    }

    /// "White or clear?", "What colour is it: white or clear?", "Is it white or clear?"; of the
    /// attribute's wordings only those that an enumeration fits into.
    fn choice_wordings(&self, k: AttributeId, options: Options) -> Vec<String> {
        let attribute = &self.attributes()[k.index()];
        let listed = self.listed(k, options);
        let lists_values = |wording: &&String| {
            attribute.values.iter().any(|value| wording.contains(value.name.as_str()))
        };
        let open = attribute.ask_which.iter().find(|wording| !lists_values(wording));
        let open = open.map(|open| format!("{}: {listed}?", open.trim_end_matches('?').trim_end()));
        let yes_no = attribute.ask_yes_no.iter().find(|wording| wording.ends_with("{value}?"));
        let yes_no = yes_no.map(|wording| wording.replace("{value}", &listed));
        [Some(format!("{}?", capitalised(&listed))), open, yes_no].into_iter().flatten().collect()
    }

    /// "white, metallic or clear"; with "neither" or "none of them" at the end if an object of the
    /// scene lacks these values.
    fn listed(&self, k: AttributeId, options: Options) -> String {
        let spoken = |v: &ValueId| self.attributes()[k.index()].values[v.index()].spoken.clone();
        let mut all: Vec<String> = options.values().iter().map(spoken).collect();
        let has_option = |value: Option<ValueId>| value.is_some_and(|v| options.contains(v));
        if !self.objects().iter().all(|object| has_option(object.values[k.index()])) {
            all.push(if all.len() == 2 { "neither" } else { "none of them" }.to_owned());
        }
        enumerate(&all, "or")
    }

    /// Fills the slots of a wording.
    fn fill(&self, wording: &str, question: Question) -> String {
        let wording = wording.replace("{noun}", self.noun());
        match question {
            Question::None | Question::Point(_) => wording,
            Question::Which(k) | Question::Choice(k, _) => {
                wording.replace("{attribute}", &self.attributes()[k.index()].name)
            }
            Question::Attribute(k, v) => {
                let attribute = &self.attributes()[k.index()];
                let wording = wording.replace("{attribute}", &attribute.name);
                let spoken = &attribute.values[v.index()].spoken;
                let article = format!(" {} {{value}}", indefinite(spoken));
                let wording = wording.replace(" an {value}", " a {value}");
                wording.replace(" a {value}", &article).replace("{value}", spoken)
            }
        }
    }

    /// "In the dishwasher?", "Which colour?"
    fn shortened(&self, question: Question) -> Option<String> {
        match question {
            Question::Attribute(k, v) => {
                let spoken = &self.attributes()[k.index()].values[v.index()].spoken;
                Some(format!("{}?", capitalised(spoken)))
            }
            Question::Which(k) => Some(format!("Which {}?", self.attributes()[k.index()].name)),
            Question::None | Question::Point(_) | Question::Choice(..) => None,
        }
    }

    /// "White, metallic or clear?", "In the dishwasher: yes or no?"
    fn with_choices(&self, question: Question, plain: &str, choices: &[String]) -> String {
        match (question, choices) {
            (Question::Which(_), [_, _, ..]) => {
                format!("{}?", capitalised(&enumerate(choices, "or")))
            }
            (Question::Attribute(k, v), _) => {
                let spoken = &self.attributes()[k.index()].values[v.index()].spoken;
                format!("{}: yes or no?", capitalised(spoken))
            }
            (Question::Point(_), _) => {
                format!("{}: yes or no?", plain.trim_end_matches('?').trim_end())
            }
            (Question::None | Question::Which(_) | Question::Choice(..), _) => {
                format!("Sorry: {}", self.continued(question, plain))
            }
        }
    }
}

/// Returns a sentence that continues after a colon: "Is it" in lower case, "LED" unchanged.
fn in_lower_case(text: &str) -> String {
    let mut chars = text.chars();
    match (chars.next(), chars.next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain(text[first.len_utf8()..].chars()).collect()
        }
        _ => text.to_owned(),
    }
}

/// Returns a text with a capital first; "iPhone" and "v1.2" have a spelling of their own.
fn capitalised(text: &str) -> String {
    let mut rest = text.split(' ').next().unwrap_or_default().chars().skip(1);
    if rest.any(|c| c.is_uppercase() || c.is_numeric()) {
        return text.to_owned();
    }
    let mut chars = text.chars();
    let first = chars.next().into_iter().flat_map(char::to_uppercase);
    first.chain(chars).collect()
}

/// Returns the first `{…}` of a wording that is not one of the slots.
pub(crate) fn unknown_slot(wording: &str, slots: &[&str]) -> Option<String> {
    let mut rest = wording;
    while let Some(open) = rest.find('{') {
        let after = &rest[open..];
        let end = after.find('}').map_or(after.len(), |close| close + 1);
        let slot = &after[..end];
        if !slots.contains(&slot) {
            return Some(slot.to_owned());
        }
        rest = &after[end..];
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{capitalised, in_lower_case};

    #[test]
    fn a_sentence_continues_in_lower_case_after_a_colon() {
        for (text, small) in [
            ("Is it white?", "is it white?"),
            ("Äpfel?", "äpfel?"),
            ("LED or not?", "LED or not?"),
            ("A?", "A?"),
            ("", ""),
        ] {
            assert_eq!(in_lower_case(text), small);
        }
        assert_eq!(
            [capitalised("iPhone or v1.2"), capitalised("v1.2")],
            ["iPhone or v1.2", "v1.2"]
        );
        assert_eq!(capitalised("in the dishwasher"), "In the dishwasher");
        assert_eq!(capitalised("éclair"), "Éclair");
    }
}
