//! Words of the robot that a scene uses for its things.

use scene::Scene;
use words::{Tokens, normalise};

use crate::closed_class::is_closed;
use crate::halting::halting_words;
use crate::lexicon::{Lexicon, Sense};
use crate::relations::words;
use crate::token_class::Class;

/// Returns a warning for each name in a scene that is one of the robot's own words. Words that halt
/// the arm, negators, answers and pronouns keep their meaning; others lose it in that scene.
pub(crate) fn own_words(scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    let mut look = |name: &str, of: &str, carrier: Option<&str>| {
        let text = normalise(name);
        let tokens = Tokens::of(&text);
        if !halting_words(&tokens).is_empty() {
            found.push(format!(
                "\"{name}\", {of}, halts the arm where it is said alone; help: choose another name"
            ));
        } else if let Some(carrier) = carrier.filter(|_| is_closed(&words(name))) {
            found.push(format!(
                "\"{name}\", {of}, is understood as \"{carrier} {name}\" only; help: choose another name"
            ));
        } else if let Some(meaning) = meaning(&tokens) {
            found.push(format!(
                "\"{name}\", {of}, no longer means {meaning} in this scene; help: choose another name"
            ));
        }
    };
    look(scene.noun(), "the noun of the scene", None);
    for attribute in scene.attributes() {
        let of_attribute = format!("a name of attribute `{}`", attribute.name);
        let names = std::iter::once(&attribute.name).chain(&attribute.synonyms);
        names.for_each(|name| look(name, &of_attribute, None));
        let of_value = format!("a value of `{}`", attribute.name);
        let names = |value: &'_ scene::Value| {
            std::iter::once(value.name.clone()).chain(value.synonyms.clone()).collect::<Vec<_>>()
        };
        attribute
            .values
            .iter()
            .flat_map(names)
            .for_each(|name| look(&name, &of_value, Some(&attribute.name)));
    }
    found
}

/// Returns whether a name is one of the robot's own words.
pub(crate) fn is_own(name: &str) -> bool {
    let text = normalise(name);
    let tokens = Tokens::of(&text);
    !halting_words(&tokens).is_empty() || is_closed(&words(name)) || meaning(&tokens).is_some()
}

/// Returns the robot's reading of a whole name, if the dialogue uses the name.
fn meaning(tokens: &Tokens<'_>) -> Option<&'static str> {
    tokens.words.first()?;
    let phrase = Lexicon::own().longest(&tokens.words, 0);
    let phrase = phrase.filter(|phrase| phrase.words == tokens.words.len())?;
    let Sense::Class(class) = phrase.sense else { return None };
    Some(match class {
        Class::Yes => "yes",
        Class::No => "no",
        Class::Not => "that something is denied",
        Class::One => "any of the things",
        Class::Unsure => "that the person does not know",
        Class::Indifferent => "that anything will do",
        Class::Cancel => "to cancel the request",
        Class::StartOver => "to start over",
        Class::Repeat => "to repeat the question",
        Class::PutBack => "to put a thing back",
        Class::AskHelp => "to ask for help",
        Class::AskStatus => "to ask what the robot does",
        _ => return None,
    })
}
