//! What the robot says besides its questions.

use crate::state::Heard;
use dialogue::Action;
use messages::PickOutcome;
use scene::{ObjectId, Scene};

/// A remark on a word that the scene does not have, to go before the next question.
pub(super) fn unknown(heard: &Heard) -> String {
    if heard.unknown.is_empty() {
        String::new()
    } else {
        format!("I do not know \"{}\" here. ", heard.unknown)
    }
}

/// What the robot says as it sets out.
pub(super) fn fetching(scene: &Scene, object: ObjectId) -> String {
    format!("I will get the {}.", scene.describe(object))
}

/// What the robot says when the arm is done.
pub(super) fn ended(scene: &Scene, object: ObjectId, outcome: PickOutcome) -> String {
    let it = scene.describe(object);
    match outcome {
        PickOutcome::Delivered => format!("Here is the {it}."),
        PickOutcome::Unreachable => format!("I cannot reach the {it}."),
        PickOutcome::Interrupted => {
            format!("I was interrupted while grasping the {it}. Please look before you ask again.")
        }
        PickOutcome::Missed => {
            format!("I could not get hold of the {it}. It may have moved a little.")
        }
        PickOutcome::Blocked => {
            "My arm did not move as it should. Please look before you ask again.".to_owned()
        }
        PickOutcome::Cancelled => "I have left it where it was.".to_owned(),
        PickOutcome::Pending => String::new(),
    }
}

/// What there is to choose from.
pub(super) fn inventory(scene: &Scene) -> String {
    let values = scene.attributes().iter().filter(|k| k.values.len() > 1).map(|k| {
        let names: Vec<&str> = k.values.iter().map(|v| v.name.as_str()).collect();
        format!("{} {}", k.name, names.join(" or "))
    });
    let values: Vec<String> = values.collect();
    format!("I see {} {}s: {}.", scene.objects().len(), scene.noun(), values.join(", "))
}

/// What the robot says when it concludes that the wanted object is not here.
pub(super) fn not_here(scene: &Scene) -> String {
    format!("What you want does not seem to be here. {}", inventory(scene))
}

/// What is gone and what is new, each in words, to go before the next question. Short: it must
/// leave room for that question.
pub(super) fn changes(noun: &str, gone: &[String], new: &[String]) -> String {
    let tell = |objects: &[String], what: &str| match objects {
        [] => String::new(),
        [one] if one.len() <= WORDS_MAX => format!("The {one} is {what}. "),
        [_] => format!("One {noun} is {what}. "),
        more => format!("{} {noun}s are {what}. ", more.len()),
    };
    format!("{}{}", tell(gone, "gone"), tell(new, "new"))
}

/// Longest description that is said before a question, bytes.
const WORDS_MAX: usize = 60;

/// An action for people to read.
pub(super) fn action(scene: &Scene, action: Action) -> String {
    match action {
        Action::Wait => "wait".to_owned(),
        Action::Ask(question) => format!("ask: {}", scene.phrase(question)),
        Action::Pick(object) => match scene.objects().get(object.index()) {
            Some(object) => format!("pick {}", object.name),
            None => "conclude that it is not here".to_owned(),
        },
    }
}
