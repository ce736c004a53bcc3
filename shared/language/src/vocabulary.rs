//! English words and phrases of a dialogue about things to fetch, from the folder `vocabulary`.

use std::collections::{HashMap, HashSet};
use std::sync::LazyLock;

use scene::Role;

use crate::token_class::Class;

/// Returns every phrase with its class.
pub(crate) fn phrases() -> impl Iterator<Item = (Class, &'static str)> {
    let mut class = None;
    let lines = include_str!("vocabulary/phrases.txt").lines();
    lines.filter(|line| !line.starts_with('#')).flat_map(move |line| {
        let heading = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        class = heading.map_or(class, |heading| Class::named(class_of(heading)));
        let listed = class.filter(|_| heading.is_none() && !line.is_empty());
        let phrases = line.trim_end_matches(',').split(", ");
        phrases.filter_map(move |phrase| Some((listed?, phrase)))
    })
}

/// Returns the patterns of what halts the arm, each with its section.
pub(crate) fn halting() -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut section = "";
    let lines = include_str!("vocabulary/halting.txt").lines();
    lines.filter(|line| !line.starts_with('#') && !line.is_empty()).filter_map(move |line| {
        match line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            Some(heading) => {
                section = heading;
                None
            }
            None => Some((section, line)),
        }
    })
}

/// Words that mean nearly the same, in groups.
pub(crate) struct Synonyms {
    /// Each with the role of the values that it names.
    groups: Vec<(Role, Vec<&'static str>)>,
    /// The groups that have a word, by their numbers.
    of: HashMap<&'static str, Vec<usize>>,
}

impl Synonyms {
    pub(crate) fn known() -> &'static Self {
        static KNOWN: LazyLock<Synonyms> = LazyLock::new(Synonyms::read);
        &KNOWN
    }

    fn read() -> Self {
        let mut synonyms = Self { groups: Vec::new(), of: HashMap::new() };
        let mut role = Role::Quality;
        let lines = include_str!("vocabulary/synonyms.txt").lines();
        for line in lines.filter(|line| !line.starts_with('#') && !line.is_empty()) {
            match line {
                "[quality]" => role = Role::Quality,
                "[place]" => role = Role::Place,
                "[kind]" => role = Role::Kind,
                group => synonyms.groups.push((role, group.split(", ").collect())),
            }
        }
        for (number, (_, group)) in synonyms.groups.iter().enumerate() {
            group.iter().for_each(|word| synonyms.of.entry(*word).or_default().push(number));
        }
        synonyms
    }

    /// The numbers of the groups that have a word, for values of a role.
    pub(crate) fn with(&self, word: &str, role: Role) -> impl Iterator<Item = usize> {
        let numbers = self.of.get(word).into_iter().flatten();
        numbers.copied().filter(move |number| self.groups[*number].0 == role)
    }

    /// A group, with the role of the values that it names.
    pub(crate) fn group(&self, number: usize) -> &(Role, Vec<&'static str>) {
        &self.groups[number]
    }
}

/// Returns whether a word names a thing, in this scene or not: it is no slip for another one.
pub(crate) fn is_thing(word: &str) -> bool {
    Synonyms::known().with(word, Role::Kind).next().is_some()
}

/// The class of a heading; what follows its name parts the class.
fn class_of(heading: &str) -> &str {
    heading.split(' ').next().unwrap_or(heading)
}

/// Returns whether a word that people ask for is a quality of things: "purple", "wooden".
pub(crate) fn is_unlisted_quality(word: &str) -> bool {
    static QUALITIES: LazyLock<HashSet<&str>> = LazyLock::new(|| {
        let text = include_str!("vocabulary/phrases.txt");
        let section = text.split_once("[Unlisted quality]\n").map_or("", |(_, rest)| rest);
        let section = section.split_once("\n\n").map_or(section, |(section, _)| section);
        section.split([',', '\n']).map(str::trim).filter(|word| !word.is_empty()).collect()
    });
    QUALITIES.contains(word)
}

/// Everyday words that a misspelt value could be taken for; they are never corrected.
pub(crate) fn common_words() -> impl Iterator<Item = &'static str> {
    include_str!("vocabulary/common_words.txt").split_ascii_whitespace()
}

#[cfg(test)]
mod tests {
    use super::{Class, HashMap, phrases};
    use words::Tokens;
    use words::normalise;

    #[test]
    fn phrases_are_written_as_tokens() {
        for (_, phrase) in phrases() {
            let phrase = phrase.trim_end_matches(" .");
            let text = normalise(phrase);
            let words: Vec<&str> = Tokens::of(&text).words.iter().map(|t| t.word).collect();
            assert_eq!(words.join(" "), phrase);
        }
    }

    #[test]
    fn phrases_have_one_class() {
        assert!(phrases().count() > 2_000, "a line without a class is lost");
        let mut parts: HashMap<&str, Class> = HashMap::new();
        for (class, phrase) in phrases() {
            if let Some(other) = parts.insert(phrase, class) {
                panic!("`{phrase}` is listed as {other:?} and as {class:?}");
            }
        }
    }
}
