//! Words as they are written in books and subtitles, the training data of networks.

use scene::Scene;

/// Values of the scene in the example: more make each utterance slower.
const VALUES_MAX: usize = 24;

/// Returns words as a written sentence, with a blank before it: "no i want it" → " No, I want it."
pub(super) fn sentence(words: &str) -> String {
    let mut text = String::from(" ");
    for (n, word) in words.split_whitespace().enumerate() {
        let answer = n == 1 && matches!(text.as_str(), " No" | " Yes" | " Yeah" | " Nope");
        text.push_str(if answer {
            ", "
        } else if n > 0 {
            " "
        } else {
            ""
        });
        match word {
            _ if n == 0 => capitalise(word, &mut text),
            "i" | "i'm" | "i'd" | "i'll" | "i've" => capitalise(word, &mut text),
            _ => text.push_str(word),
        }
    }
    text.push('.');
    text
}

fn capitalise(word: &str, text: &mut String) {
    let mut rest = word.chars();
    text.extend(rest.next().into_iter().flat_map(char::to_uppercase));
    text.push_str(rest.as_str());
}

/// Returns an example of a dialogue with each value of the scene once. Lists of questions and
/// answers would be repeated as if they had been said.
pub(super) fn example(scene: &Scene) -> String {
    let values = scene.attributes().iter().flat_map(|attribute| &attribute.values);
    let mut values: Vec<&str> = values.map(|value| value.spoken.as_str()).collect();
    values.truncate(VALUES_MAX);
    let noun = scene.noun();
    let values = values.join(" ");
    format!(" Get me the {noun}, please. Is it this one? No. Yes. No, the {values} {noun}.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::bowls;

    #[test]
    fn sentence_is_written_as_in_subtitles() {
        for (words, expected) in [
            ("yes", " Yes."),
            ("no the white one", " No, the white one."),
            ("no i want it", " No, I want it."),
            ("the i", " The I."),
        ] {
            assert_eq!(sentence(words), expected);
        }
    }

    #[test]
    fn example_contains_every_value_once() {
        let text = example(&bowls());
        for value in ["white", "plastic", "in the cabinet"] {
            assert_eq!(text.matches(value).count(), 1, "{text}");
        }
    }
}
