//! Plurals of English nouns.

use std::fmt::Display;

/// Nouns whose plural follows no rule; of those without a second form it is the same.
const IRREGULAR: &[(&str, &str)] = &[
    ("man", "men"),
    ("woman", "women"),
    ("child", "children"),
    ("person", "people"),
    ("foot", "feet"),
    ("tooth", "teeth"),
    ("mouse", "mice"),
    ("goose", "geese"),
    ("ox", "oxen"),
    ("die", "dice"),
    ("knife", "knives"),
    ("life", "lives"),
    ("wife", "wives"),
    ("leaf", "leaves"),
    ("loaf", "loaves"),
    ("shelf", "shelves"),
    ("half", "halves"),
    ("calf", "calves"),
    ("wolf", "wolves"),
    ("scarf", "scarves"),
    ("thief", "thieves"),
    ("potato", "potatoes"),
    ("tomato", "tomatoes"),
    ("mango", "mangoes"),
    ("bus", "buses"),
    ("gas", "gases"),
    ("lens", "lenses"),
    ("quiz", "quizzes"),
    ("sheep", "sheep"),
    ("fish", "fish"),
    ("series", "series"),
    ("glasses", "glasses"),
];

/// Returns the plural of a noun or noun phrase: `mugs`, `knives`, `boxes`, `cups of tea`. A noun
/// that ends in a single s is one already: `scissors`.
pub fn plural(noun: &str) -> String {
    for link in [" of ", " with ", " for ", " in "] {
        if let Some((head, rest)) = noun.split_once(link) {
            return format!("{}{link}{rest}", plural(head));
        }
    }
    let (lead, word) = noun.rfind([' ', '-']).map_or(("", noun), |at| noun.split_at(at + 1));
    format!("{lead}{}", of_word(word))
}

/// Returns a number with its noun, e.g. `1 question`, `2 questions`, `0 boxes`.
pub fn count<N: Display + PartialEq + From<u8>>(number: N, noun: &str) -> String {
    if number == N::from(1) { format!("1 {noun}") } else { format!("{number} {}", plural(noun)) }
}

fn of_word(word: &str) -> String {
    if let Some((_, plural)) = IRREGULAR.iter().find(|(one, _)| *one == word) {
        return (*plural).to_owned();
    }
    let ends = |endings: &[&str]| endings.iter().any(|ending| word.ends_with(ending));
    match word.strip_suffix('y') {
        Some(stem) if !stem.ends_with(['a', 'e', 'i', 'o', 'u']) => format!("{stem}ies"),
        _ if ends(&["ss", "x", "z", "ch", "sh", "us", "is"]) => format!("{word}es"),
        _ if word.ends_with('s') => word.to_owned(),
        _ => format!("{word}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::{count, plural};

    #[test]
    fn plurals_are_english() {
        for (one, many) in [
            ("mug", "mugs"),
            ("knife", "knives"),
            ("glass", "glasses"),
            ("box", "boxes"),
            ("berry", "berries"),
            ("tray", "trays"),
            ("brush", "brushes"),
            ("wrench", "wrenches"),
            ("scissors", "scissors"),
            ("pliers", "pliers"),
            ("wine glass", "wine glasses"),
            ("tea-towel", "tea-towels"),
            ("cup of tea", "cups of tea"),
            ("bread knife", "bread knives"),
            ("photo", "photos"),
            ("octopus", "octopuses"),
        ] {
            assert_eq!(plural(one), many);
        }
    }

    #[test]
    fn counts_agree_with_their_nouns() {
        let counts = [count(0_u64, "record"), count(1_u32, "box"), count(2_usize, "box")];
        assert_eq!(counts, ["0 records", "1 box", "2 boxes"]);
        assert_eq!(count(3_u64, "participant with data"), "3 participants with data");
        assert_eq!((count(1.0, "run"), count(2.0, "entry")), ("1 run".into(), "2 entries".into()));
    }
}
