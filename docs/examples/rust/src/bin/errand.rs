//! A client: asks for something, answers for a user who wants one object, and reports what came of it.
//!
//! target/debug/errand "get me the bowl" clear

use std::process::ExitCode;
use std::time::Duration;

use lab::{FAVOURITE, Favourite};
use whichone_sdk::client::Client;
use whichone_sdk::{Exit, Failure, ObjectId, Question, Scene};

const PATIENCE: Duration = Duration::from_secs(120);

/// The answer of a user who wants this object; none to an open question.
fn answer(question: Question, wanted: ObjectId, scene: &Scene) -> Option<&str> {
    let yes = match question {
        Question::Point(object) => object == wanted,
        Question::Attribute(attribute, value) => scene.has(wanted, attribute, value),
        Question::Choice(attribute, options) => {
            let values = &scene.attributes()[attribute.index()].values;
            let own = scene.object(wanted).values[attribute.index()];
            let own = own.filter(|value| options.contains(*value));
            return Some(own.map_or("none of them", |value| &values[value.index()].name));
        }
        _ => return None,
    };
    Some(if yes { "yes" } else { "no" })
}

fn run(request: &str, name: &str) -> Result<(), Failure> {
    let mut client = Client::join()?;
    let scene = client.scene().clone();
    let wanted = scene.object_named(name).ok_or_else(|| {
        let names: Vec<&str> = scene.objects().iter().map(|object| &*object.name).collect();
        Failure::new(Exit::Usage, format!("no object `{name}`; help: one of {}", names.join(", ")))
    })?;
    let favourites = client.bus().encoded_reader::<Favourite>(&FAVOURITE)?;
    let said = client.say(request)?;
    let mut answered = (0, 0);
    loop {
        let state = client.next_change()?;
        favourites.drain_in_turn(|one| println!("      ({} {:.2})", one.name, one.probability))?;
        if let Some((prompt, question)) = state.open_question().filter(|one| one.0 != answered) {
            answered = prompt;
            println!("robot {}", state.dialogue.text);
            if let Some(text) = answer(question, wanted, &scene) {
                println!("you   {text}");
                client.say(text)?;
            }
        }
        if state.dialogue.applied >= said && state.dialogue.interaction == 0 {
            break;
        }
    }
    match client.await_pick(PATIENCE)? {
        Some(ended) => println!("{:?} {}", ended.outcome, ended.name.unwrap_or_default()),
        None => println!("it asked for nothing that is here"),
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [request, name] = &arguments[..] else {
        eprintln!("usage: errand REQUEST OBJECT");
        return Exit::Usage.code();
    };
    match run(request, name) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit.code()
        }
    }
}
