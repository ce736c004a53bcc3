//! English of the robot's lines and actions. Nothing else in the dialogue produces text.

mod foreseen;
mod remarks;

use remarks::capitalised;
use scene::{ObjectId, Question, Role, Scene, UnknownWord, definite};
use vocabulary::{ActKind, Action, PickOutcome};

use crate::manager::{Act, Content, Preface};

pub use foreseen::foreseen;

/// Returns the text of an act's line; empty if the act is silent.
pub fn text(scene: &Scene, act: &Act) -> String {
    let content = match &act.line.content {
        Content::Silence => return String::new(),
        Content::Question { variant, time, choices, is_last } => {
            if act.question == Question::None || !scene.contains(act.question) {
                return String::new();
            }
            let question = scene.phrase_variant(act.question, *variant, *time, choices);
            if *is_last { format!("{question} {LAST}") } else { question }
        }
        Content::Wanted(time) => wanted(scene, *time),
        Content::Fetching(object) if is_out_of_reach(scene, act) => {
            format!("You mean {}.", definite(object))
        }
        Content::Fetching(object) => fetching(object, &act.line.preface),
        Content::HeldBack(object) => {
            format!("I stay stopped until you resume. Shall I get {} then?", definite(object))
        }
        Content::AskToRelease(object) => format!("Say yes, and I will get {}.", definite(object)),
        Content::PuttingBack(object) => {
            format!("I will put {} back. Please hold it between my fingers.", definite(object))
        }
        Content::PutBackHeldBack(object) => {
            format!("I stay stopped until you resume. Shall I put {} back then?", definite(object))
        }
        Content::AskToPutBack(object) => {
            format!("Say yes, and I will put {} back.", definite(object))
        }
        Content::PutBackEnded(object, outcome) => put_back_ended(object, *outcome),
        Content::Confirmed => "All right, once you resume.".to_owned(),
        Content::PickEnded(object, outcome) => pick_ended(object, *outcome),
        Content::Remark(it) => remarks::text(scene, it, act.kind),
        Content::Correcting | Content::Cancelled => "All right.".to_owned(),
        // Whether the arm can still leave it turns out only when the pick ends.
        Content::Kept(object) => {
            format!(
                "I cannot put {} back, so I still hold it. Shall I give it to you?",
                definite(object)
            )
        }
        Content::CallingOff => "All right, if it is not too late.".to_owned(),
        Content::Offered(nearest) => offered(nearest),
        Content::Keeping => "It stays with you, unless I already hold it.".to_owned(),
        Content::Forgotten => "I have lost a part of my memory; please ask me again.".to_owned(),
        Content::NotHere => {
            format!("What you want does not seem to be here. {}", remarks::inventory(scene))
        }
        Content::SceneReplaced => "The scene has changed; please ask me again.".to_owned(),
    };
    format!("{}{content}", preface(scene, &act.line.preface))
}

/// Follows the last repetition of a question.
const LAST: &str = "I am here when you need me.";

fn wanted(scene: &Scene, time: u32) -> String {
    match time {
        0 | 1 => "What would you like?".to_owned(),
        2 => scene.phrase(Question::None),
        _ => remarks::example(scene),
    }
}

/// "There are the blue pen and the black pen. Do you want the blue pen?"
fn offered(nearest: &[String]) -> String {
    let Some(first) = nearest.first() else { return String::new() };
    let asks = format!("Do you want {}?", definite(first));
    match nearest.len() {
        1 => asks,
        _ => format!("There are {}. {asks}", remarks::list(nearest, "and")),
    }
}

/// Returns whether the object of a pick is one that can only be talked about. A scene without any
/// place is about words alone: nothing is known to be out of reach.
fn is_out_of_reach(scene: &Scene, act: &Act) -> bool {
    let Some((_, picked)) = act.pick else { return false };
    let picked = scene.objects().get(picked.index());
    picked.is_some_and(|object| object.placement.is_none()) && scene.placed().next().is_some()
}

fn fetching(object: &str, preface: &Preface) -> String {
    let object = definite(object);
    match preface {
        Preface::Left(_) => format!("I will take {object}."),
        _ => format!("I will get {object}."),
    }
}

/// Returns the text of an action, for operators.
pub fn action(scene: &Scene, action: Action) -> String {
    match action {
        Action::Wait => "wait".to_owned(),
        Action::Ask(question) if scene.contains(question) => {
            format!("ask: {}", scene.phrase(question))
        }
        Action::Ask(_) => "ask".to_owned(),
        Action::Pick(object) => match scene.objects().get(object.index()) {
            Some(object) => format!("pick {}", object.name),
            None => "conclude that it is not here".to_owned(),
        },
    }
}

/// Returns the description by which the robot refers to an object.
pub fn object(scene: &Scene, object: ObjectId) -> String {
    scene.describe(object)
}

/// "There are no plates here, only mugs and cups. ", or of a quality that it is not known.
fn unknown(scene: &Scene, UnknownWord { text, role }: &UnknownWord) -> String {
    match role {
        Role::Kind => {
            let all: Vec<ObjectId> = scene.ids().collect();
            let there = scene.plural_nouns(&all);
            format!("There are no {} here, only {there}. ", scene::plural(text))
        }
        Role::Quality => format!("I know of no {text} one here. "),
        Role::Place | Role::Part => format!("I do not know \"{text}\" here. "),
    }
}

fn preface(scene: &Scene, preface: &Preface) -> String {
    match preface {
        Preface::None => String::new(),
        Preface::UnknownWord(word) => unknown(scene, word),
        Preface::ObjectsChanged { gone, new } => {
            let noun = scene.noun();
            format!("{}{}", changed(noun, gone, "gone"), changed(noun, new, "new"))
        }
        Preface::SceneChanged => format!("The {} here have changed. ", scene::plural(scene.noun())),
        Preface::Remark(it) => format!("{} ", remarks::text(scene, it, ActKind::Ask)),
        Preface::InTurn(objects) => {
            let name = |(n, words): (usize, &Vec<String>)| match n.checked_sub(1) {
                Some(before) if objects[before] == *words => "another".to_owned(),
                _ => definite(&remarks::group(scene, words, None)),
            };
            let objects: Vec<String> = objects.iter().enumerate().map(name).collect();
            format!("First {}. ", objects.join(", then "))
        }
        Preface::PickEnded(object, outcome) => format!("{} ", pick_ended(object, *outcome)),
        Preface::PutBackEnded(object, outcome) => format!("{} ", put_back_ended(object, *outcome)),
        Preface::Sorry => "Sorry. ".to_owned(),
        Preface::Left(objects) => {
            let count = remarks::number(objects.len());
            format!("There are {count}: {}. ", remarks::list(objects, "and"))
        }
    }
}

/// Longest description that is said before a question, bytes: it must leave room for the question.
const DESCRIPTION_MAX: usize = 60;

fn changed(noun: &str, objects: &[String], how: &str) -> String {
    match objects {
        [] => String::new(),
        [one] if one.len() <= DESCRIPTION_MAX => {
            format!("{} is {how}. ", capitalised(&definite(one)))
        }
        [_] => format!("One {noun} is {how}. "),
        more => format!("{} {} are {how}. ", more.len(), scene::plural(noun)),
    }
}

fn pick_ended(it: &str, outcome: PickOutcome) -> String {
    let it = definite(it);
    match outcome {
        PickOutcome::Delivered => format!("Here is {it}."),
        PickOutcome::Unreachable => format!("I cannot reach {it}."),
        PickOutcome::Interrupted => {
            format!("I was interrupted while grasping {it}. Please look before you ask again.")
        }
        PickOutcome::Missed => {
            format!("I could not get hold of {it}. It may have moved a little.")
        }
        PickOutcome::Vanished => format!("{} is no longer there.", capitalised(&it)),
        PickOutcome::Blocked => {
            "My arm did not move as it should. Please look before you ask again.".to_owned()
        }
        PickOutcome::Cancelled => "I have left it where it was.".to_owned(),
        // A line of its own asks for the user's decision.
        PickOutcome::Pending | PickOutcome::PutBack | PickOutcome::Kept => String::new(),
    }
}

fn put_back_ended(it: &str, outcome: PickOutcome) -> String {
    let it = definite(it);
    match outcome {
        PickOutcome::PutBack => format!("I have put {it} back."),
        PickOutcome::Cancelled => format!("{} stays with you.", capitalised(&it)),
        PickOutcome::Missed => {
            format!("I could not take hold of {it}. Please hold it between my fingers next time.")
        }
        PickOutcome::Unreachable => format!("I cannot put {it} back where it was."),
        PickOutcome::Pending
        | PickOutcome::Delivered
        | PickOutcome::Interrupted
        | PickOutcome::Vanished
        | PickOutcome::Kept
        | PickOutcome::Blocked => {
            format!("I was interrupted while putting {it} back. Please look before you ask again.")
        }
    }
}
