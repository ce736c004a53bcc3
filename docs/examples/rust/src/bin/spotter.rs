//! A grounder that spots the scene's own words, yes and no.
//!
//! whichone conform grounding -- target/debug/spotter
//! whichone swap grounding -- target/debug/spotter

use std::process::ExitCode;

use whichone_sdk::grounding::{self, Grounder, certain};
use whichone_sdk::{Hypothesis, Question, Reading, Response, Scene, WordId};

const AFFIRMATIVE: [&str; 5] = ["yes", "yeah", "sure", "yup", "yep"];
const NEGATIVE: [&str; 5] = ["no", "nope", "not", "nah", "other"];

struct Spotter;

impl Grounder for Spotter {
    fn read(&mut self, heard: &Hypothesis, _: Question, scene: &Scene) -> Vec<(f64, Reading)> {
        let text = heard.text.to_lowercase();
        let said: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '-').collect();
        let said: Vec<&str> = said.into_iter().filter(|word| !word.is_empty()).collect();
        let one_of = |words: &[&str]| said.iter().any(|word| words.contains(word));
        let response = match (one_of(&AFFIRMATIVE), one_of(&NEGATIVE)) {
            (true, false) => Response::Yes,
            (false, true) => Response::No,
            _ => Response::None,
        };
        certain(Reading { base: spotted(&said, scene), response, ..Reading::default() })
    }
}

/// The scene's words, in the order in which they were said; of several that fit, the longest one.
fn spotted(mut said: &[&str], scene: &Scene) -> Vec<WordId> {
    let mut base = Vec::new();
    while !said.is_empty() {
        let fits = |(_, word): &(usize, &String)| {
            let words: Vec<String> = word.split(' ').map(str::to_lowercase).collect();
            said.len() >= words.len() && words.iter().zip(said).all(|(a, b)| a == b)
        };
        let longest = scene.words().iter().enumerate().filter(fits);
        let longest = longest.max_by_key(|(_, word)| word.split(' ').count());
        base.extend(longest.map(|(number, _)| WordId::from(number)));
        said = &said[longest.map_or(1, |(_, word)| word.split(' ').count())..];
    }
    base
}

fn main() -> ExitCode {
    grounding::run(Spotter)
}
