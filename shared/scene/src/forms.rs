//! Forms of values in sentences: articles, owners, numbers, and default wordings of questions.

use crate::wording::{ASK_WHICH, ASK_YES_NO};
use crate::{Role, Value};

/// Words that are determiners, as "the".
const DETERMINERS: &[&str] =
    &["the", "my", "your", "his", "her", "its", "our", "their", "this", "that"];
/// Owners in general: "the men's shoe".
const OWNERS_IN_GENERAL: &[&str] =
    &["men", "women", "children", "kid", "boy", "girl", "people", "lady", "gentlemen", "baby"];
const NUMBERS: &[&str] = &[
    "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
    "eleven", "twelve",
];

/// Returns a description with "the": "the red mug", "Anna's mug", "my mug", "the cat's bowl".
pub fn definite(description: &str) -> String {
    let first = description.split(' ').next().unwrap_or_default();
    let is_name = first.starts_with(char::is_uppercase) && first != description;
    let has_own = is_determiner(first) || is_name && owner(first).is_some();
    if has_own { description.to_owned() } else { format!("the {description}") }
}

/// Returns the article spoken before a text: "an hour glass", "a unicorn", "an MP3 player".
pub(crate) fn indefinite(text: &str) -> &'static str {
    let word = text.split([' ', '-']).next().unwrap_or_default();
    let lower = word.to_lowercase();
    let begins = |with: &[&str]| with.iter().any(|with| lower.starts_with(with));
    let Some(first) = word.chars().next() else { return "a" };
    let is_spelt = first.is_uppercase() && !word.chars().any(char::is_lowercase);
    let is_vowel = if first.is_ascii_digit() {
        lower.starts_with('8') || is_eleven_or_eighteen(&lower)
    } else if is_spelt {
        "AEFHILMNORSX".contains(first)
    } else if begins(&["hour", "honest", "honour", "honor", "heir"]) {
        true
    } else {
        let is_consonant = begins(&["uni", "use", "usu", "util", "eu", "ewe", "once"])
            || lower == "one"
            || lower == "ones";
        let is_unlike = ["unin", "unim", "unid"].iter().any(|with| lower.starts_with(with));
        "aeiouàáâäæèéêëìíîïòóôöøùúûü".contains(first.to_lowercase().next().unwrap_or(first))
            && (!is_consonant || is_unlike)
    };
    if is_vowel { "an" } else { "a" }
}

/// "11", "18.5", "11,000"; not "110".
fn is_eleven_or_eighteen(text: &str) -> bool {
    let whole = text.split(|c: char| !c.is_ascii_digit()).next().unwrap_or_default();
    ["11", "18"].contains(&whole)
}

fn is_determiner(word: &str) -> bool {
    DETERMINERS.iter().any(|it| word.eq_ignore_ascii_case(it))
}

/// Returns the owner in a possessive: "anna" for "anna's"; `None` for "men's".
fn owner(word: &str) -> Option<&str> {
    let owner = ["'s", "\u{2019}s"].iter().find_map(|ending| word.strip_suffix(ending))?;
    let is_one = !owner.is_empty() && !owner.contains(' ');
    (is_one && !OWNERS_IN_GENERAL.contains(&owner)).then_some(owner)
}

/// Returns whether a form names an owner, so that it comes first and replaces "the".
pub(crate) fn is_owner(spoken: &str) -> bool {
    let (first, rest) = spoken.split_once(' ').unwrap_or((spoken, ""));
    owner(spoken).is_some() || is_determiner(first) && (rest.is_empty() || owner(rest).is_some())
}

/// Returns whether a form is a bare number other than a year; it needs its attribute: "size 42".
pub(crate) fn is_number(spoken: &str) -> bool {
    let is_year = spoken.len() == 4 && spoken.starts_with(['1', '2']);
    let is_digits = !spoken.is_empty() && spoken.chars().all(|c| c.is_ascii_digit());
    is_digits && !is_year || NUMBERS.contains(&spoken)
}

/// Returns a measure in its form before a noun: "two-year-old" for "two years old".
pub(crate) fn measured(spoken: &str) -> Option<String> {
    let words: Vec<&str> = spoken.split(' ').collect();
    let [number, units, what] = words[..] else { return None };
    let is_measure = ["old", "long", "wide", "high", "tall", "deep", "thick"].contains(&what);
    let unit = units.strip_suffix('s').unwrap_or(units);
    (is_measure && is_number(number)).then(|| format!("{number}-{unit}-{what}"))
}

/// Returns the text after "a", "an" or "some".
pub(crate) fn without_article(text: &str) -> Option<&str> {
    ["a ", "an ", "some "].iter().find_map(|article| text.strip_prefix(article))
}

/// Returns whether a form says how much of a part there is: "a handle", "no handle", "some blue".
pub(crate) fn has_quantity(spoken: &str) -> bool {
    without_article(spoken).is_some() || spoken.starts_with("no ")
}

/// Returns a name with a capital letter for an owner without one: "Anna's" for "anna's".
pub(crate) fn with_capital(spoken: String) -> String {
    match owner(&spoken).and_then(|owner| owner.chars().next()) {
        Some(first) => first.to_uppercase().chain(spoken[first.len_utf8()..].chars()).collect(),
        None => spoken,
    }
}

/// Wordings of questions for an attribute whose file leaves them out.
pub(crate) struct Defaults {
    pub(crate) yes_no: &'static str,
    pub(crate) which: &'static str,
}

/// Returns the default wordings for these values.
pub(crate) fn defaults(values: &[Value]) -> Defaults {
    let all = |role: Role| values.iter().all(|value| value.role() == role);
    let any = |is: fn(&str) -> bool| values.iter().any(|value| is(&value.spoken));
    let (yes_no, which) = if all(Role::Place) {
        ("Is it {value}?", "Where is it?")
    } else if all(Role::Kind) {
        ("Is it {value}?", "What is it?")
    } else if all(Role::Part) && values.iter().all(|value| has_quantity(&value.spoken)) {
        ("Does it have {value}?", "Which {attribute} does it have?")
    } else if all(Role::Part) {
        ("Is it the one {value}?", ASK_WHICH[0])
    } else if all(Role::Quality) && any(is_owner) {
        let is_alone = any(is_determiner);
        (if is_alone { "Is it {value} {noun}?" } else { "Is it {value}?" }, "Whose is it?")
    } else if all(Role::Quality) {
        (ASK_YES_NO[0], ASK_WHICH[0])
    } else {
        ("Is it {value}?", ASK_WHICH[0])
    };
    Defaults { yes_no, which }
}

/// Gives parts the default wording's form: "a green handle", or next to "with a lid" "with no lid".
pub(crate) fn align_parts(values: &mut [Value]) {
    let is_bare = |value: &Value| value.after_noun() != value.spoken;
    let are_parts = values.iter().all(|value| value.role() == Role::Part);
    if are_parts && values.iter().all(is_bare) {
        for value in values.iter_mut().filter(|value| !has_quantity(&value.spoken)) {
            value.spoken = format!("{} {}", indefinite(&value.spoken), value.spoken);
        }
    } else {
        for value in values.iter_mut().filter(|value| is_bare(value)) {
            value.spoken = value.after_noun();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn articles_follow_the_sound() {
        let an = ["hour", "umbrella", "MP3 player", "8-inch", "11 l", "18", "80 cm", "honest"];
        an.iter().for_each(|text| assert_eq!(indefinite(text), "an", "{text}"));
        for text in ["unimportant", "orange", "éclair", "IKEA", "uninsured", "L"] {
            assert_eq!(indefinite(text), "an", "{text}");
        }
        let a = ["unicorn", "one-litre", "110", "USB", "European", "mug", "useful", "", "house"];
        a.iter().for_each(|text| assert_eq!(indefinite(text), "a", "{text}"));
    }

    #[test]
    fn owners_stand_for_the_article() {
        for (description, whole) in [
            ("red mug", "the red mug"),
            ("Anna's mug", "Anna's mug"),
            ("my mug", "my mug"),
            ("the cat's bowl", "the cat's bowl"),
            ("men's shoe", "the men's shoe"),
            ("driver's licence", "the driver's licence"),
            ("Anna's", "the Anna's"),
        ] {
            assert_eq!(definite(description), whole);
        }
    }
}
