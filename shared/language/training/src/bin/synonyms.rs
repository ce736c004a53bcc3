//! `cargo run -p reader_training --bin synonyms`: scores words that no scene lists. Each is said in
//! scenes of eight values, with the one that it stands for and without.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::fmt::Write as _;
use std::process::ExitCode;

use language::Reader;
use reader_training::exit_code;
use scene::{Question, Scene};
use vocabulary::{Language, Rng};

const WORDS: &str = include_str!("../../synonyms.txt");
/// Values of a scene, and scenes for each word.
const VALUES: usize = 8;
const SCENES: usize = 6;

/// A value with synonyms that no scene lists.
struct Listed {
    is_thing: bool,
    name: &'static str,
    said: Vec<&'static str>,
}

impl Listed {
    /// Returns whether a word of both may replace either.
    fn is_like(&self, other: &Self) -> bool {
        let words = |it: &Self| it.said.iter().copied().chain([it.name]).collect::<Vec<_>>();
        let others = words(other);
        words(self).iter().any(|word| others.contains(word))
    }
}

fn main() -> ExitCode {
    exit_code(run())
}

fn run() -> Result<(), String> {
    let all = listed()?;
    let mut random = Rng::new(1);
    let (mut tried, mut found, mut wrong) = (0, 0, 0);
    for wanted in &all {
        let is_other = |it: &&Listed| it.is_thing == wanted.is_thing && !it.is_like(wanted);
        let others: Vec<&str> = all.iter().filter(is_other).map(|it| it.name).collect();
        for (said, _) in wanted.said.iter().flat_map(|said| (0..SCENES).map(move |n| (said, n))) {
            let mut names: Vec<&str> = Vec::new();
            while names.len() < VALUES {
                let name = others[random.below(others.len())];
                names.extend((!names.contains(&name)).then_some(name));
            }
            wrong += usize::from(read(&names, wanted.is_thing, said)?.is_some());
            names[0] = wanted.name;
            let read = read(&names, wanted.is_thing, said)?;
            tried += 1;
            found += usize::from(read.as_deref() == Some(wanted.name));
            wrong += usize::from(read.is_some_and(|read| read != wanted.name));
        }
    }
    let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
    println!(
        "{tried} requests  found {:.3}  right of proposed {:.3}  synonyms",
        share(found, tried),
        share(found, found + wrong)
    );
    Ok(())
}

fn listed() -> Result<Vec<Listed>, String> {
    let line = |line: &'static str| {
        let (named, said) = line.split_once(": ")?;
        let (kind, name) = named.split_once(' ')?;
        Some(Listed { is_thing: kind == "n", name, said: said.split(", ").collect() })
    };
    let lines = WORDS.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|text| line(text).ok_or_else(|| format!("expected `n NAME: WORD, …`, found {text}")))
        .collect()
}

/// The value that is read of a request in a scene of these values.
fn read(names: &[&str], is_thing: bool, said: &str) -> Result<Option<String>, String> {
    let role = if is_thing { "kind" } else { "quality" };
    let values: Vec<String> =
        names.iter().map(|name| format!("{{ name = {name:?}, role = {role:?} }}")).collect();
    let mut text = format!(
        "name = 's'\nnoun = 'object'\n[[attributes]]\nname = 'sort'\nvalues = [{}]\n",
        values.join(", ")
    );
    for (n, name) in names.iter().enumerate() {
        let _ = write!(text, "[[objects]]\nname = 'o{n}'\nattributes = {{ sort = {name:?} }}\n");
    }
    let scene =
        Scene::from_toml("synonyms", &text).map_err(|error| format!("{names:?}: {error:?}"))?;
    let request =
        if is_thing { format!("get me the {said}") } else { format!("get me the {said} one") };
    let reading = Reader::new(&scene, Language::Careful).read(&request, Question::None);
    Ok(reading.base.first().map(|word| scene.words()[word.index()].clone()))
}
