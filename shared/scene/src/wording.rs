//! The words of the robot's questions.

use crate::{Question, Scene};

/// Yes/no wordings of an attribute that brings none.
pub(crate) const ASK_YES_NO: [&str; 1] = ["Is the {attribute} {value}?"];
/// Open wordings of an attribute that brings none.
pub(crate) const ASK_WHICH: [&str; 1] = ["What is the {attribute}?"];
/// Wordings of a scene that brings none for the question what is wanted.
pub(crate) const ASK_WANTED: [&str; 1] = ["Which {noun} would you like?"];
/// Wordings of a scene that brings none for the question about what is pointed at.
pub(crate) const ASK_POINT: [&str; 3] = ["This one?", "Is it this one?", "Do you mean this one?"];

/// Most values that are read out as what there is to choose from.
const CHOICES_MAX: usize = 4;

/// The wordings of the questions that no attribute words; at least one of each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Asks {
    pub(crate) wanted: Vec<String>,
    pub(crate) point: Vec<String>,
}

impl Scene {
    /// What the robot says to ask `question`: "Is it in the dishwasher?", "What colour is it?",
    /// "This one?" (while it points). The usual wording, and the one that durations are reckoned
    /// with.
    ///
    /// # Panics
    /// If the question is not of this scene ([`Scene::contains`]).
    pub fn phrase(&self, question: Question) -> String {
        self.phrase_variant(question, 0, 1)
    }

    /// What the robot says as its `n`-th question (the prompt's number) when it asks `question`
    /// for the `presentation`-th time, from 1. The wordings of a kind are taken in turn; said
    /// again, a question begins with "Sorry", then says what may be answered. The same arguments
    /// give the same words, so that a replay says the same; variant 0 said once is
    /// [`Scene::phrase`].
    ///
    /// # Panics
    /// If the question is not of this scene ([`Scene::contains`]).
    pub fn phrase_variant(&self, question: Question, n: u64, presentation: u32) -> String {
        let wordings = self.wordings(question);
        let at = n % wordings.len() as u64;
        #[expect(clippy::cast_possible_truncation, reason = "below the number of wordings")]
        let plain = self.fill(&wordings[at as usize], question);
        match presentation {
            0 | 1 => plain,
            2 => format!("Sorry: {}", begun_small(&plain)),
            odd if odd % 2 == 1 => self.with_choices(question, plain),
            _ => format!("Once more: {}", begun_small(&plain)),
        }
    }

    fn wordings(&self, question: Question) -> &[String] {
        match question {
            Question::None => &self.asks().wanted,
            Question::Point(_) => &self.asks().point,
            Question::Attribute(k, _) => &self.attributes()[k.index()].ask_yes_no,
            Question::Which(k) => &self.attributes()[k.index()].ask_which,
        }
    }

    /// A wording with its slots filled.
    fn fill(&self, wording: &str, question: Question) -> String {
        let wording = wording.replace("{noun}", self.noun());
        match question {
            Question::None | Question::Point(_) => wording,
            Question::Which(k) => {
                wording.replace("{attribute}", &self.attributes()[k.index()].name)
            }
            Question::Attribute(k, v) => {
                let attribute = &self.attributes()[k.index()];
                let wording = wording.replace("{attribute}", &attribute.name);
                wording.replace("{value}", &attribute.values[v.index()].spoken)
            }
        }
    }

    /// "In the dishwasher: yes or no?", "What colour is it: white, metallic or clear?"
    fn with_choices(&self, question: Question, plain: String) -> String {
        let open = plain.trim_end_matches('?').trim_end();
        match question {
            Question::Attribute(k, v) => {
                let spoken = &self.attributes()[k.index()].values[v.index()].spoken;
                format!("{}: yes or no?", begun_large(spoken))
            }
            Question::Point(_) => format!("{open}: yes or no?"),
            Question::Which(k) => {
                let values = self.attributes()[k.index()].values.iter();
                let values: Vec<&str> = values.map(|value| value.name.as_str()).collect();
                // "Is it small or big?" has said it.
                let said = |value: &&str| open.contains(*value);
                match &values[..] {
                    [first @ .., last]
                        if (1..CHOICES_MAX).contains(&first.len()) && !values.iter().all(said) =>
                    {
                        format!("{open}: {} or {last}?", first.join(", "))
                    }
                    _ => format!("Once more: {}", begun_small(&plain)),
                }
            }
            Question::None => format!("Once more: {}", begun_small(&plain)),
        }
    }
}

/// A sentence that goes on after a colon: "Is it" begins small, "LED" does not.
fn begun_small(text: &str) -> String {
    let mut chars = text.chars();
    match (chars.next(), chars.next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain(text[first.len_utf8()..].chars()).collect()
        }
        _ => text.to_owned(),
    }
}

fn begun_large(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().into_iter().flat_map(char::to_uppercase);
    first.chain(chars).collect()
}

/// The first `{…}` of a wording that is none of the slots and would be read out as it stands.
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
    use super::{begun_large, begun_small};

    #[test]
    fn a_sentence_begins_small_after_a_colon() {
        for (text, small) in [
            ("Is it white?", "is it white?"),
            ("Äpfel?", "äpfel?"),
            ("LED or not?", "LED or not?"),
            ("A?", "A?"),
            ("", ""),
        ] {
            assert_eq!(begun_small(text), small);
        }
        assert_eq!(begun_large("in the dishwasher"), "In the dishwasher");
        assert_eq!(begun_large("éclair"), "Éclair");
    }
}
