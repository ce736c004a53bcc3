//! Places that are relations: "next to the sink" is "by the sink" and "beside it", but not "in" it.

use scene::{Role, Value};
use words::{Tokens, normalise};

use crate::vocabulary::is_phrase;

/// Relations that people say for one another, separated by commas.
const ALIKE: [&str; 10] = [
    "next to, near, near to, by, beside, close to, alongside, adjacent to, right by, right next to, nearby",
    "under, underneath, below, beneath",
    "above, over",
    "on, on top of, atop, upon",
    "in, inside, inside of, within",
    "behind, in back of, at the back of",
    "in front of, before",
    "left of, to the left of, on the left of",
    "right of, to the right of, on the right of",
    "about, on the subject of",
];
/// Relations after which a noun alone is read as a place.
const PREPOSITIONS: &[&str] =
    &["in", "inside", "on", "at", "by", "from", "within", "about", "with"];
/// Articles and possessives that may precede a noun, including none.
const ARTICLES: &[&str] = &["the", "a", "an", "my", "your", "our", "this", "that"];

/// Relations after which a part is named.
const HAVING: [&str; 8] = ["with", "without", "of", "for", "made", "full", "filled", "containing"];

/// Every relation of a place.
fn relations() -> impl Iterator<Item = &'static str> {
    ALIKE.into_iter().flat_map(|alike| alike.split(", "))
}

/// A form of a value, word by word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Form {
    pub(crate) words: Vec<String>,
    /// Whether the phrase is the scene's own, not a similar one.
    pub(crate) own: bool,
}

/// Returns the phrases for a value beyond its name and synonyms: its form in questions, and for a
/// place the same with similar relations. `common`: other words for it.
pub(crate) fn forms<'a>(value: &'a Value, common: impl Iterator<Item = &'a str>) -> Vec<Form> {
    let spoken = words(&value.spoken);
    let names = std::iter::once(&value.name).chain(&value.synonyms).map(String::as_str);
    let names: Vec<Vec<String>> = names.chain(common).map(words).collect();
    if value.role() != Role::Place {
        let bare = without_article(&spoken).to_vec();
        let parts = value.synonyms.iter().filter(|_| value.role() == Role::Part);
        let parts = parts.map(|synonym| words(&value.with_name(&value.spoken, synonym)));
        let new = |words: &Vec<String>| !words.is_empty() && !names.contains(words);
        let forms = std::iter::once(bare).chain(parts).filter(new);
        return forms.map(|words| Form { words, own: true }).collect();
    }
    let Some((relation, noun)) = split(&spoken) else {
        let new = !names.contains(&spoken);
        return new.then_some(Form { words: spoken, own: true }).into_iter().collect();
    };
    let mut forms = Vec::new();
    if is_listed(&spoken) {
        // "at the door" means something else in other scenes.
        forms.push(Form { words: spoken, own: true });
    }
    let is_like = |alike: &&str| alike.split(", ").any(|other| other == relation);
    let alike = ALIKE.into_iter().filter(is_like).flat_map(|alike| alike.split(", "));
    let alike = alike.filter(|other| *other != relation);
    for name in std::iter::once(&noun).chain(names.iter().filter(|name| **name != noun)) {
        for said in std::iter::once(relation).chain(alike.clone()) {
            // "in the dishwasher" is read word by word if the noun is the value's own.
            if PREPOSITIONS.contains(&said) && names.contains(name) {
                continue;
            }
            for article in std::iter::once(None).chain(ARTICLES.iter().map(Some)) {
                let lead = said.split(' ').chain(article.copied()).map(str::to_owned);
                let words = lead.chain(name.iter().cloned()).collect();
                forms.push(Form { words, own: said == relation && *name == noun });
            }
        }
    }
    forms
}

/// Returns whether a phrase for a place or a part beginning with this word names the relation.
pub(crate) fn begins_relation(word: &str) -> bool {
    HAVING.contains(&word) || relations().any(|relation| relation.split(' ').next() == Some(word))
}

/// Returns whether the words begin with a phrase of the language.
fn is_listed(words: &[String]) -> bool {
    (2..=words.len()).any(|length| {
        let phrase = words[..length].join(" ");
        is_phrase(&phrase) && !relations().any(|relation| relation == phrase)
    })
}

/// The longest relation that starts the words, and the noun after it without its article.
fn split(words: &[String]) -> Option<(&'static str, Vec<String>)> {
    let starts = relations().chain(PREPOSITIONS.iter().copied()).filter_map(|relation| {
        let length = relation.split(' ').count();
        let begins = words.len() > length && relation.split(' ').eq(words[..length].iter());
        begins.then_some((length, relation))
    });
    let (length, relation) = starts.max_by_key(|(length, _)| *length)?;
    let noun = without_article(&words[length..]);
    (!noun.is_empty()).then(|| (relation, noun.to_vec()))
}

fn without_article(words: &[String]) -> &[String] {
    match words {
        [article, noun @ ..] if ARTICLES.contains(&article.as_str()) && !noun.is_empty() => noun,
        words => words,
    }
}

/// The words of a scene's text, as an utterance's would be read.
pub(crate) fn words(text: &str) -> Vec<String> {
    let text = normalise(text);
    Tokens::of(&text).words.iter().map(|token| token.word.to_owned()).collect()
}
