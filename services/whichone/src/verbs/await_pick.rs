//! `await pick`: the outcome of an interaction, and a simulated user who answers meanwhile.

use std::thread;
use std::time::Instant;

use command_line::Outcome;
use command_line::output::Output;
use laboratory::TruthfulUser;
use messages::{ActKind, Ended, Outcome as How};
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::availability::Lookout;
use super::conversation::{Conversation, LOOK_EVERY};
use super::words;
use crate::cli::AwaitArgs;

pub use waiting::Waiting;

mod waiting;

/// Waits for the outcome of the utterances so far, and prints it.
pub(super) fn await_pick(paths: &GroupPaths, args: &AwaitArgs, out: &mut Output<'_>) -> Outcome {
    let started = Instant::now();
    let mut conversation = Conversation::join(paths)?;
    let mut wanted = args.answer_as.as_deref();
    let mut user = None;
    let reported = Reported::before(paths);
    let mut waiting = Waiting::new(reported.interaction);
    let mut lookout = Lookout::new();
    loop {
        conversation.look()?;
        if let Some(ended) = waiting.look(conversation.latest()) {
            Reported::now(&conversation, ended.interaction.0).remember(paths)?;
            return report(&ended, args.answer_as.as_deref(), out);
        }
        if waiting.is_in_vain(conversation.latest(), reported.utterance) {
            Reported::now(&conversation, reported.interaction).remember(paths)?;
            return report_none(&conversation, started, out);
        }
        if let Some(name) = wanted.take_if(|_| conversation.knows_objects()) {
            let may_be_absent = conversation.may_be_absent();
            let joined = TruthfulUser::new(conversation.scene(), name, may_be_absent);
            user = Some(joined.map_err(|what| Failure::new(Exit::Usage, what))?);
        }
        let answer = |user: &mut TruthfulUser| {
            user.look(conversation.scene());
            user.answer(conversation.latest())
        };
        if let Some(answer) = user.as_mut().and_then(answer) {
            conversation.say(&answer, conversation.latest().prompt())?;
        }
        if let Some(why) = lookout.news(paths) {
            return Err(Failure::new(Exit::NotReached, why));
        }
        if started.elapsed() >= args.timeout {
            return report_timeout(&conversation, started, out);
        }
        thread::sleep(LOOK_EVERY);
    }
}

/// Reports the outcome, with the object that the simulated user wanted, if there is one: only its delivery is a success.
fn report(ended: &Ended, wanted: Option<&str>, out: &mut Output<'_>) -> Outcome {
    let missed = wanted.filter(|wanted| ended.name.as_deref() != Some(*wanted));
    if out.is_json() {
        let mut json = to_json(ended);
        if let Some(wanted) = wanted {
            json["wanted"] = json!(wanted);
        }
        out.json(&json)?;
    } else {
        let wanted = missed.map(|wanted| format!("; wanted {wanted}")).unwrap_or_default();
        out.line(format_args!("{}{wanted}", sentence(ended)))?;
    }
    let is_reached = ended.outcome == How::Delivered && missed.is_none();
    Ok(if is_reached { Exit::Ok } else { Exit::NotReached })
}

/// The outcome for programs.
pub(super) fn to_json(ended: &Ended) -> Json {
    json!({
        "object": ended.name,
        "questions": ended.questions,
        "seconds": ended.seconds,
        "outcome": ended.outcome,
    })
}

/// The outcome for people, e.g. `delivered clear after 2 questions and 14.2 s`.
pub(super) fn sentence(ended: &Ended) -> String {
    let what = match ended.outcome {
        How::Delivered => "delivered",
        How::Refused => "delivered, but refused:",
        How::Failed => "failed to fetch",
        How::Cancelled => "cancelled",
        How::Abandoned => "abandoned: no answer",
        How::SceneChanged => "ended: the scene was changed",
        How::NotHere => "concluded that it is not here",
    };
    let object = ended.name.as_ref().map(|name| format!(" {name}")).unwrap_or_default();
    let questions = scene::count(ended.questions, "question");
    format!("{what}{object} after {questions} and {}", words::time(ended.seconds))
}

/// Reports that the words so far have opened no interaction, with the robot's answer to them.
fn report_none(conversation: &Conversation, started: Instant, out: &mut Output<'_>) -> Outcome {
    let view = conversation.latest().view.as_ref();
    let answer = view.filter(|view| view.decision == ActKind::Say).map(|view| view.text.as_str());
    if out.is_json() {
        out.json(&json!({
            "object": null,
            "questions": 0,
            "seconds": started.elapsed().as_secs_f64(),
            "outcome": "no_pick",
            "answer": answer,
        }))?;
    } else {
        let answer = answer.map(|text| format!("; the robot said \"{text}\"")).unwrap_or_default();
        out.line(format_args!("no pick: the words asked for no object that is here{answer}"))?;
    }
    Ok(Exit::NotReached)
}

fn report_timeout(conversation: &Conversation, started: Instant, out: &mut Output<'_>) -> Outcome {
    let seconds = started.elapsed().as_secs_f64();
    if out.is_json() {
        let questions = conversation.latest().view.as_ref().map_or(0, |view| view.questions);
        out.json(&json!({
            "object": null,
            "questions": questions,
            "seconds": seconds,
            "outcome": "timeout",
            "prompt": conversation.latest().prompt(),
        }))?;
    } else {
        let after = words::time(seconds);
        let what = match conversation.knows_objects() {
            true => "no interaction has ended",
            false => "no object is known to be on the table",
        };
        out.line(format_args!("{what} within {after}; see: whichone watch"))?;
    }
    Ok(Exit::NotReached)
}

/// What earlier awaits of this run have reported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Reported {
    /// The last interaction.
    interaction: u64,
    /// The last utterance that had been applied.
    utterance: u64,
}

impl Reported {
    fn before(paths: &GroupPaths) -> Self {
        let text = std::fs::read_to_string(paths.run().join(AWAITED)).unwrap_or_default();
        let mut numbers = text.split_whitespace().map(|number| number.parse().unwrap_or(0));
        let mut next = || numbers.next().unwrap_or(0);
        Self { interaction: next(), utterance: next() }
    }

    fn now(conversation: &Conversation, interaction: u64) -> Self {
        let utterance = conversation.latest().view.as_ref().map_or(0, |view| view.applied);
        Self { interaction, utterance }
    }

    fn remember(self, paths: &GroupPaths) -> Result<(), Failure> {
        let path = paths.run().join(AWAITED);
        let Self { interaction, utterance } = self;
        safe_files::replace_private(&path, format!("{interaction} {utterance}\n"))
            .map_err(|error| Failure::file(&path, &error))
    }
}

/// File with the numbers of what was reported last.
const AWAITED: &str = "awaited";

#[cfg(test)]
mod tests {
    use super::super::conversation::example;
    use super::*;

    #[test]
    fn await_writes_an_outcome_as_a_sentence() {
        let ended = example::ended(3).view.and_then(|view| view.last).unwrap();
        assert_eq!(sentence(&ended), "delivered clear after 2 questions and 12.5 s");
        let cancelled =
            Ended { outcome: How::Cancelled, questions: 1, object: None, name: None, ..ended };
        assert_eq!(sentence(&cancelled), "cancelled after 1 question and 12.5 s");
    }

    #[test]
    fn delivery_of_another_object_than_the_wanted_one_is_no_success() {
        let ended = example::ended(3).view.and_then(|view| view.last).unwrap();
        let reported = |wanted, json| {
            let mut bytes = Vec::new();
            let exit = report(&ended, wanted, &mut Output::to(&mut bytes, json)).unwrap();
            (exit, String::from_utf8(bytes).unwrap())
        };
        let said = "delivered clear after 2 questions and 12.5 s";
        assert_eq!(reported(None, false), (Exit::Ok, format!("{said}\n")));
        assert_eq!(reported(Some("clear"), false), (Exit::Ok, format!("{said}\n")));
        let missed = format!("{said}; wanted white_small\n");
        assert_eq!(reported(Some("white_small"), false), (Exit::NotReached, missed));
        let (exit, json) = reported(Some("white_small"), true);
        assert!(exit == Exit::NotReached && json.contains(r#""wanted":"white_small""#), "{json}");
    }

    #[test]
    fn await_remembers_what_it_reported_while_the_group_runs() {
        let (_home, paths) = super::super::lab();
        assert_eq!(Reported::before(&paths), Reported::default());
        std::fs::create_dir_all(paths.run()).unwrap();
        let reported = Reported { interaction: 41, utterance: 57 };
        reported.remember(&paths).unwrap();
        assert_eq!(Reported::before(&paths), reported);
        std::fs::write(paths.run().join(AWAITED), "?").unwrap();
        assert_eq!(Reported::before(&paths), Reported::default());
    }
}
