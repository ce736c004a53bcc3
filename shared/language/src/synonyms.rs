//! Words that people say for one another, whatever the scene: "mug" for a cup.

use std::collections::{BTreeMap, HashMap};
use std::sync::LazyLock;

use scene::{Role, Value};

use crate::relations::words;
use crate::vocabulary::{entries, lines};

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
        for (section, line) in lines(include_str!("vocabulary/synonyms.txt")) {
            let role = match section {
                "kind" => Role::Kind,
                "place" => Role::Place,
                _ => Role::Quality,
            };
            synonyms.groups.push((role, entries(line).collect()));
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

/// Returns whether a word names a thing, in this scene or not, so that it is not a slip.
pub(crate) fn is_thing(word: &str) -> bool {
    Synonyms::known().with(word, Role::Kind).next().is_some()
}

/// Returns common synonyms that scenes do not list ("crimson" for red) of values with places.
pub(crate) fn common_synonyms(all: &[(usize, &Value)]) -> Vec<(usize, &'static str)> {
    let known = Synonyms::known();
    // The value that a group names; `None` for several, as either may be meant.
    let mut named: BTreeMap<usize, Option<usize>> = BTreeMap::new();
    for (place, value) in all {
        for name in std::iter::once(&value.name).chain(&value.synonyms) {
            for group in known.with(&words(name).join(" "), value.role()) {
                let only = named.entry(group).or_insert(Some(*place));
                *only = only.filter(|other| other == place);
            }
        }
    }
    let mut synonyms: Vec<(usize, Role, &str)> = Vec::new();
    for (group, place) in named {
        let (role, words) = known.group(group);
        synonyms.extend(place.iter().flat_map(|it| words.iter().map(|word| (*it, *role, *word))));
    }
    // A bag may be the rucksack or the purse. Of qualities the first group is the closest: navy is
    // dark blue before blue.
    let mut things: HashMap<&str, Option<usize>> = HashMap::new();
    for (place, _, word) in synonyms.iter().filter(|it| it.1 == Role::Kind) {
        let only = things.entry(word).or_insert(Some(*place));
        *only = only.filter(|other| other == place);
    }
    let is_one =
        |(_, role, word): &&(usize, Role, &str)| *role != Role::Kind || things[word].is_some();
    synonyms.iter().filter(is_one).map(|(place, _, word)| (*place, *word)).collect()
}
