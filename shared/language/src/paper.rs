//! The paper's own reading (section 3.6): spot the words, nothing else.

use std::collections::HashMap;

use scene::{Intent, Reading, Response, Scene, WordId};

/// "yes" and its like, as the paper lists them.
const AFFIRMATIVE: [&str; 5] = ["yes", "yeah", "sure", "yup", "yep"];
/// "no" and its like, as the paper lists them.
const NEGATIVE: [&str; 5] = ["no", "nope", "not", "nah", "other"];

/// The value words of a scene, by first word, those of most words first.
#[derive(Clone, Debug)]
pub(crate) struct WordSpotter {
    values: HashMap<String, Vec<(Vec<String>, WordId)>>,
}

impl WordSpotter {
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut values: HashMap<String, Vec<(Vec<String>, WordId)>> = HashMap::new();
        for (w, word) in scene.words().iter().enumerate() {
            let text = word.to_lowercase();
            let words: Vec<String> = words(&text).map(str::to_owned).collect();
            if let Some(first) = words.first() {
                values.entry(first.clone()).or_default().push((words, WordId::from(w)));
            }
        }
        for phrases in values.values_mut() {
            // A stable sort: of two values that read alike the first in the scene is meant.
            phrases.sort_by_key(|(words, _)| std::cmp::Reverse(words.len()));
        }
        Self { values }
    }

    /// `l_b`: every value in the text, as often as it occurs. `l_r`: yes or no if only one of them
    /// was said.
    pub(crate) fn read(&self, text: &str) -> Reading {
        let text = text.to_lowercase();
        let words: Vec<&str> = words(&text).collect();
        let mut base = Vec::new();
        let mut at = 0;
        while at < words.len() {
            let found = self.values.get(words[at]).and_then(|phrases| {
                phrases.iter().find(|(phrase, _)| starts_with(&words[at..], phrase))
            });
            at += match found {
                Some((phrase, word)) => {
                    base.push(*word);
                    phrase.len()
                }
                None => 1,
            };
        }
        let says = |list: &[&str]| words.iter().any(|word| list.contains(word));
        let response = match (says(&AFFIRMATIVE), says(&NEGATIVE)) {
            (true, false) => Response::Yes,
            (false, true) => Response::No,
            _ => Response::None,
        };
        Reading { base, response, intent: Intent::Inform, ..Reading::default() }
    }
}

fn starts_with(words: &[&str], phrase: &[String]) -> bool {
    words.len() >= phrase.len() && words.iter().zip(phrase).all(|(word, expected)| word == expected)
}

/// Runs of letters and digits, with hyphens and apostrophes inside words.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || matches!(c, '-' | '\'' | '\u{2019}')))
        .map(|word| word.trim_matches(['-', '\'', '\u{2019}']))
        .filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{Response, Scene, WordSpotter};

    fn check(text: &str, base: &[&str], response: Response) {
        let json = json!({"objects": [{"name": "a", "attributes": {}}], "values": {
            "color": ["blue", "light blue", "x-aligned"],
        }});
        let scene = Scene::from_json("s", &json).expect("a scene");
        let reading = WordSpotter::new(&scene).read(text);
        let words: Vec<&str> = reading.base.iter().map(|w| &*scene.words()[w.index()]).collect();
        assert_eq!((&words[..], reading.response), (base, response), "{text}");
    }

    #[test]
    fn paper_reader_spots_words() {
        check("Blue, BLUE!", &["blue", "blue"], Response::None);
        check("the light blue x-aligned one", &["light blue", "x-aligned"], Response::None);
        check("x aligned", &[], Response::None);
        check("bluish light", &[], Response::None);
        check("yes no", &[], Response::None);
        check("not the other one", &[], Response::No);
        check("it isn't", &[], Response::None);
        check("sure - yep", &[], Response::Yes);
    }
}
