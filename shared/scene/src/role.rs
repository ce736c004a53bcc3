//! Grammatical roles of values: the position that a value may take next to a noun.

use crate::forms::without_article;

/// Grammatical role of a value: a key of the scene file, or else guessed from the `spoken` form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// "white": stands before a noun, has degrees.
    #[default]
    Quality,
    /// "a marker": is a noun.
    Kind,
    /// "in the dishwasher": stands after the noun.
    Place,
    /// "with nuts", "a green handle": what is in a thing or belongs to it; stands after the noun,
    /// and can be asked for as if it were the thing.
    Part,
}

impl Role {
    /// The names of the roles in a scene file.
    pub(crate) const NAMES: [(&str, Self); 4] = [
        ("quality", Self::Quality),
        ("kind", Self::Kind),
        ("place", Self::Place),
        ("part", Self::Part),
    ];

    /// Guesses the role of a value from its name and its `spoken` form; `shared` is the last word
    /// of the `spoken` forms of its attribute, if common to all, or else the attribute's name.
    pub(crate) fn guess(attribute: &str, name: &str, spoken: &str, shared: &str) -> Self {
        let starts = |relation: &&str| {
            spoken.strip_prefix(*relation).is_some_and(|rest| rest.starts_with(' '))
        };
        if RELATIONS.iter().any(starts) {
            return Self::Place;
        }
        if PLACES.contains(&spoken) {
            return Self::Place;
        }
        if HAVING.iter().any(starts) || starts(&"no") || spoken.starts_with("to ") {
            return Self::Part;
        }
        if spoken.strip_prefix("some ").is_some_and(|rest| rest != name) {
            return Self::Part;
        }
        match without_article(spoken) {
            Some(noun) => {
                // "a green handle", if another one is "a black handle".
                let rest = noun.strip_prefix(name).unwrap_or_default();
                if rest.trim_start() == shared && rest != shared { Self::Part } else { Self::Kind }
            }
            // "green handle" of the attribute "handle", "wrapped in foil".
            None if is_part_of(attribute, spoken) || is_continued(attribute, spoken) => Self::Part,
            None => Self::Quality,
        }
    }
}

/// Returns whether a form is a part named without an article, "green handle" of the attribute
/// "handle"; not of an attribute that is a place, as in "top shelf".
pub(crate) fn is_part_of(attribute: &str, spoken: &str) -> bool {
    let is_place = |place: &&str| attribute.ends_with(*place);
    let is_first = |word: &&str| spoken.strip_prefix(*word).is_some_and(|it| it.starts_with(' '));
    let before = spoken.strip_suffix(attribute).and_then(|before| before.strip_suffix(' '));
    before.is_some_and(|before| !before.is_empty())
        && !PLACE_NOUNS.iter().any(is_place)
        && !RELATIONS.iter().chain(HAVING).any(is_first)
}

/// Returns whether a form is an adjective with its complement: "older than a year". Names of things
/// may have the same words in them: "The Lord of the Rings", "toast on a plate".
fn is_continued(attribute: &str, spoken: &str) -> bool {
    let mut words = spoken.split(' ').skip(1);
    let is_link = |word: &str| ["in", "on", "at", "to", "than", "by", "from"].contains(&word);
    spoken.starts_with(char::is_lowercase)
        && !THING_NOUNS.contains(&attribute)
        && words.any(is_link)
        && !spoken.rsplit(' ').next().is_some_and(is_link)
}

/// Places without a relation.
const PLACES: &[&str] = &[
    "upstairs",
    "downstairs",
    "outside",
    "inside",
    "indoors",
    "outdoors",
    "here",
    "there",
    "nearby",
    "underneath",
    "overhead",
];
/// Attributes that are places of things and not parts of them.
const PLACE_NOUNS: &[&str] = &[
    "place", "location", "position", "room", "shelf", "drawer", "cupboard", "cabinet", "table",
    "tray", "rack", "hook", "bin", "box", "floor", "counter", "bench", "desk", "side", "kind",
    "type", "size",
];
/// Attributes whose values are things.
const THING_NOUNS: &[&str] = &[
    "kind", "type", "item", "object", "thing", "name", "title", "dish", "content", "contents",
    "product",
];

/// Relations of a thing to its location.
const RELATIONS: &[&str] = &[
    "in",
    "on",
    "at",
    "under",
    "underneath",
    "inside",
    "outside",
    "behind",
    "near",
    "by",
    "beside",
    "above",
    "over",
    "below",
    "beneath",
    "between",
    "alongside",
    "against",
    "opposite",
    "from",
    "next to",
    "close to",
    "left of",
    "right of",
    "to the",
];
/// Relations of a thing to its content, material, purpose or subject.
const HAVING: &[&str] = &[
    "with",
    "without",
    "of",
    "for",
    "about",
    "made of",
    "made from",
    "full of",
    "filled with",
    "containing",
];
