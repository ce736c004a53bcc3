//! English of the robot's remarks: answers to questions of the user.

use scene::{Attribute, AttributeId, ObjectId, Role, Scene, Value, ValueId, definite};
use vocabulary::ActKind;

use crate::manager::{AboutObjects, Reason, Remark};

/// Length of a list from which it is cut short, bytes: a line has room for 244, and a question may
/// follow.
const LIST_MAX: usize = 120;
/// Most objects that are enumerated; different ones would not fit into that length.
const LISTED_MAX: usize = 30;

/// Returns the text of a remark within an act of that kind.
pub(super) fn text(scene: &Scene, remark: &Remark, kind: ActKind) -> String {
    let text = match remark {
        Remark::Stopped => "I have stopped. Release the motion stop to go on.".to_owned(),
        Remark::StopUnconfirmed => {
            "The arm has not confirmed the stop. Use the robot's emergency stop.".to_owned()
        }
        Remark::StillStopped => {
            "The motion stop is on. Press Resume on the page, or run: whichone resume-motion"
                .to_owned()
        }
        Remark::Inventory => inventory(scene),
        Remark::Greeting => "Hello!".to_owned(),
        Remark::Goodbye => "Goodbye!".to_owned(),
        Remark::Welcome => "You are welcome.".to_owned(),
        Remark::Help => {
            format!("I can get things for you. {} You can also say \"stop\".", example(scene))
        }
        Remark::NotUnderstood => {
            let sorry = "Sorry, I did not understand that.";
            match kind {
                ActKind::Say => format!("{sorry} {}", example(scene)),
                _ => sorry.to_owned(),
            }
        }
        Remark::AllRight => "All right.".to_owned(),
        Remark::Unknown(thing) => super::unknown(scene, thing).trim_end().to_owned(),
        Remark::NothingToPutBack => "I have nothing to put back.".to_owned(),
        Remark::Idle => "I am waiting.".to_owned(),
        Remark::Fetching(object) => format!("I am getting the {object}."),
        Remark::Leaving(object) => format!("I leave the {object}, if it is not too late."),
        Remark::TooLate(object) => format!("It was too late to leave the {object}. Here it is."),
        Remark::OnlyFetches(offered) => only_fetches(scene, offered.as_deref()),
        Remark::PuttingBack(object) => format!("I am putting the {object} back."),
        Remark::PutBackInTurn(fetched, object) => {
            format!("I am getting the {fetched}. Then I will put the {object} back.")
        }
        Remark::Objects { asked, words, objects } => about_objects(scene, *asked, words, objects),
        Remark::Why(reason) => why(reason),
    };
    let invites = matches!(remark, Remark::Greeting | Remark::Idle | Remark::OnlyFetches(None));
    let invites = invites && kind == ActKind::Say;
    if invites { format!("{text} What would you like?") } else { text }
}

/// "I can only fetch things and put them back. Shall I get the red mug?"
fn only_fetches(scene: &Scene, offered: Option<&str>) -> String {
    let only = "I can only fetch things and put them back.";
    match offered.and_then(|name| scene.object_named(name)) {
        Some(object) => format!("{only} Shall I get {}?", definite(&scene.describe(object))),
        None => only.to_owned(),
    }
}

/// "You can say what you want, for example: the red mug."
pub(super) fn example(scene: &Scene) -> String {
    let object = definite(&scene.describe(ObjectId(0)));
    format!("You can say what you want, for example: {object}.")
}

/// Returns the list of things to choose from.
pub(super) fn inventory(scene: &Scene) -> String {
    let values = scene.attributes().iter().filter(|k| k.values.len() > 1).map(|k| {
        let names: Vec<&str> = k.values.iter().map(|v| v.name.as_str()).collect();
        format!("{} {}", word_for(k), names.join(" or "))
    });
    let values: Vec<String> = values.collect();
    format!("I see {} {}: {}.", scene.objects().len(), all_nouns(scene), values.join(", "))
}

/// The word for an attribute in the scene's own question for it: "colour" of "What colour is it?".
fn word_for(attribute: &Attribute) -> &str {
    let asks = |word: &&String| {
        let mut words = attribute
            .ask_which
            .iter()
            .flat_map(|question| question.split(|c: char| !c.is_alphanumeric()));
        words.any(|said| said.eq_ignore_ascii_case(word))
    };
    std::iter::once(&attribute.name)
        .chain(&attribute.synonyms)
        .find(asks)
        .unwrap_or(&attribute.name)
}

/// "mugs and cups": everything that there is.
fn all_nouns(scene: &Scene) -> String {
    let all: Vec<ObjectId> = scene.ids().collect();
    scene.plural_nouns(&all)
}

fn about_objects(scene: &Scene, asked: AboutObjects, words: &[String], names: &[String]) -> String {
    let objects: Vec<ObjectId> = names.iter().filter_map(|name| scene.object_named(name)).collect();
    let group = group(scene, words, Some(&objects));
    let listed = || {
        let list = match objects[..] {
            [one] => definite(&scene.describe(one)),
            // Telling each from all others takes the square of their number.
            [..] if objects.len() > LISTED_MAX => return None,
            _ => scene.list(&objects, "and"),
        };
        if list.len() > LIST_MAX { None } else { Some(list) }
    };
    let count = number(objects.len());
    match (asked, &objects[..]) {
        (AboutObjects::Whether, []) => format!("No, there are no {group} here."),
        (_, []) => format!("There are no {group} here."),
        (AboutObjects::Where, _) => {
            values(scene, &objects, "somewhere here", |_, value| value.role() == Role::Place)
        }
        (AboutObjects::Either, _) => values(scene, &objects, "neither", |attribute, _| {
            attribute.values.iter().filter(|value| words.contains(&value.name)).count() > 1
        }),
        (AboutObjects::Whether, _) => format!("Yes, I see {}.", listed().unwrap_or(group)),
        (AboutObjects::Which, _) => format!("I see {}.", listed().unwrap_or(group)),
        (AboutObjects::Count, [one]) => {
            format!("There is one: {}.", definite(&scene.describe(*one)))
        }
        (AboutObjects::Count, _) => match listed() {
            Some(list) => format!("There are {count} {group}: {list}."),
            None => format!("There are {count} {group}."),
        },
    }
}

/// "red cups on the shelf": the described kind; in plural for these objects, or else singular.
pub(super) fn group(scene: &Scene, words: &[String], plural_of: Option<&[ObjectId]>) -> String {
    let attributes = scene.attributes().iter().enumerate();
    let values = attributes.flat_map(|(k, attribute)| {
        let said = attribute.values.iter().enumerate();
        let said = said.filter(|(_, value)| words.contains(&value.name));
        said.map(move |(v, value)| ((k.into(), v.into()), value))
    });
    let (said, values): (Vec<(AttributeId, ValueId)>, Vec<&Value>) = values.unzip();
    let kind = values.iter().find(|value| value.role() == Role::Kind);
    match plural_of {
        None => scene.compose(&said),
        Some([]) => {
            let kind = kind.map_or(scene.noun(), |value| value.bare());
            scene.compose_around(&scene::plural(kind), &said)
        }
        Some(objects) => scene.compose_around(&scene.plural_nouns(objects), &said),
    }
}

/// "It is on the shelf.", "One is short and one is long."
fn values(
    scene: &Scene,
    objects: &[ObjectId],
    unknown: &str,
    is_asked: impl Fn(&Attribute, &Value) -> bool,
) -> String {
    let value = |object: &ObjectId| -> Option<&str> {
        let values = scene.attributes().iter().zip(&scene.object(*object).values);
        let mut values = values.filter_map(|(k, v)| Some((k, &k.values[(*v)?.index()])));
        values.find(|(k, value)| is_asked(k, value)).map(|(_, value)| value.spoken.as_str())
    };
    let mut by_value: Vec<(&str, usize)> = Vec::new();
    for value in objects.iter().map(|object| value(object).unwrap_or(unknown)) {
        match by_value.iter_mut().find(|(known, _)| *known == value) {
            Some((_, count)) => *count += 1,
            None => by_value.push((value, 1)),
        }
    }
    if let ([(value, _)], [_]) = (&by_value[..], objects) {
        return format!("It is {value}.");
    }
    let clause = |(value, count): &(&str, usize)| {
        let verb = if *count == 1 { "is" } else { "are" };
        format!("{} {verb} {value}", number(*count))
    };
    let clauses: Vec<String> = by_value.iter().map(clause).collect();
    format!("{}.", capitalised(&joined(&clauses)))
}

fn why(reason: &Reason) -> String {
    match reason {
        Reason::Between(objects) => match &objects[..] {
            [] | [_] => "Because I want to be sure.".to_owned(),
            more => format!("Because it could be {}.", list(more, "or")),
        },
        Reason::Said(words) => format!("Because you said {}.", joined(words)),
        Reason::Likeliest => "Because it seems the likeliest one.".to_owned(),
        Reason::None => "I am waiting for your request; there is no other reason.".to_owned(),
    }
}

/// "the red mug, the blue mug and 3 more"
pub(super) fn list(descriptions: &[String], conjunction: &str) -> String {
    let mut items: Vec<String> = Vec::new();
    let mut length = 0;
    for description in descriptions {
        length += description.len() + "the , ".len();
        if length > LIST_MAX {
            items.push(format!("{} more", descriptions.len() - items.len()));
            break;
        }
        items.push(definite(description));
    }
    joined_with(&items, conjunction)
}

fn joined(items: &[String]) -> String {
    joined_with(items, "and")
}

fn joined_with(items: &[String], conjunction: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} {conjunction} {last}", first.join(", ")),
    }
}

/// Returns a number as people say it, in words if small.
pub(super) fn number(n: usize) -> String {
    const WORDS: [&str; 13] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    WORDS.get(n).map_or_else(|| n.to_string(), |word| (*word).to_owned())
}

pub(super) fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().into_iter().flat_map(char::to_uppercase);
    first.chain(chars).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the remark about `count` identical mugs.
    fn counted(count: usize) -> String {
        let mug =
            |n| format!("[[objects]]\nname = \"m{n}\"\nattributes = {{ colour = \"red\" }}\n");
        let mugs: String = (0..count).map(mug).collect();
        let head = "name = \"s\"\nnoun = \"mug\"\n[[attributes]]\nname = \"colour\"\n";
        let scene = Scene::from_toml("s", &format!("{head}values = [\"red\"]\n{mugs}")).unwrap();
        let names: Vec<String> = (0..count).map(|n| format!("m{n}")).collect();
        about_objects(&scene, AboutObjects::Count, &["red".to_owned()], &names)
    }

    #[test]
    fn attributes_are_named_as_the_scenes_questions_name_them() {
        let attribute = "name = \"color\"\nsynonyms = [\"colour\"]\nvalues = [\"red\", \"blue\"]";
        let mug = |color: &str| {
            format!("[[objects]]\nname = \"{color}\"\nattributes = {{ color = \"{color}\" }}\n")
        };
        let asked = |question: &str| {
            let head = format!("name = \"s\"\nnoun = \"mug\"\n[[attributes]]\n{attribute}\n");
            let mugs = mug("red") + &mug("blue");
            let text = format!("{head}ask_which = \"{question}\"\n{mugs}");
            inventory(&Scene::from_toml("s", &text).unwrap())
        };
        assert_eq!(asked("What colour is it?"), "I see 2 mugs: colour red or blue.");
        assert_eq!(asked("What color is it?"), "I see 2 mugs: color red or blue.");
        assert_eq!(asked("Red or blue?"), "I see 2 mugs: color red or blue.");
    }

    #[test]
    fn many_objects_are_counted_and_not_enumerated() {
        assert_eq!(counted(2), "There are two red mugs: the mug.");
        let many = counted(LISTED_MAX + 1);
        assert!(many.ends_with("red mugs."), "{many}");
    }
}
