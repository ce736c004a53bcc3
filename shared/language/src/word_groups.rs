//! Words of similar meaning: a lesson of the judge about one counts for all of its group.

use std::collections::HashMap;
use std::sync::LazyLock;

/// A group on each line, with its words.
const FILE: &str = include_str!("vocabulary/word_groups.txt");

static GROUPS: LazyLock<HashMap<&str, usize>> = LazyLock::new(|| {
    let mut groups = HashMap::new();
    for (number, (_, words)) in listed().enumerate() {
        for word in words.split(' ') {
            groups.entry(word).or_insert(number);
        }
    }
    groups
});

fn listed() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILE.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(": "))
}

/// Returns the number of the group that a word belongs to.
pub(crate) fn group_of(word: &str) -> Option<usize> {
    GROUPS.get(word).copied()
}

/// Returns the words of the group of that name; for the judge's training.
pub fn words_of_group(name: &str) -> Vec<&'static str> {
    let group = listed().find(|(group, _)| *group == name);
    group.map_or_else(Vec::new, |(_, words)| words.split(' ').collect())
}
