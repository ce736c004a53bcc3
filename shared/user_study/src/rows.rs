//! The data as tables for statistics programs, and as JSON.

use std::borrow::Cow;

use serde_json::{Map, Value as Json, json};

use crate::Item;
use crate::Verdict;
use crate::dictionary::{INTERACTIONS, PARTICIPANTS, dictionary};
use crate::distinct;
use crate::event::Source;
use crate::participant::Participant;
use crate::trial::{End, Trial};
use vocabulary::wall_time;

/// The files of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tables {
    /// A row per interaction.
    pub interactions: String,
    /// A row per participant, with the questionnaire.
    pub participants: String,
    /// Data dictionary.
    pub dictionary: String,
}

/// Returns the tables of these participants, in their order. An empty cell is a value that there is
/// not.
pub fn tables(people: &[Participant]) -> Tables {
    let items = items(people);
    let mut interactions = line(INTERACTIONS.iter().map(|column| column.name.to_owned()));
    for person in people {
        for row in trials(person) {
            interactions += &line(row.iter().map(cell_of));
        }
    }
    let asked = items.iter().map(|item| format!("q_{}", item.id));
    let heads = PARTICIPANTS.iter().map(|column| column.name.to_owned());
    let mut participants = line(heads.chain(asked));
    for person in people {
        let answers = items.iter().map(|item| answer(person, item));
        participants += &line(participant(person).into_iter().chain(answers).map(|v| cell_of(&v)));
    }
    Tables { interactions, participants, dictionary: dictionary(&items) }
}

/// Returns the same as one JSON object, with the words said and asked if they were kept, and the
/// protocol that each participant had.
pub fn to_json(people: &[Participant]) -> Json {
    let people = people.iter().map(|person| {
        let names = PARTICIPANTS.iter().map(|column| column.name);
        let mut row = object(names.zip(participant(person)));
        row.insert("answers".to_owned(), Json::Object(person.answers.clone()));
        row.insert("protocol".to_owned(), json!(person.begun.protocol));
        let names = || INTERACTIONS.iter().map(|column| column.name);
        let trials = trials(person).into_iter().zip(&person.trials).map(|(values, trial)| {
            let mut row = object(names().zip(values));
            row.insert("said".to_owned(), said(trial));
            row.insert("asked".to_owned(), asked(trial));
            Json::Object(row)
        });
        row.insert("trials".to_owned(), trials.collect());
        Json::Object(row)
    });
    json!({ "format": "whichone-study", "version": 1, "participants": people.collect::<Vec<_>>() })
}

/// Every item that any of the participants was asked, each id once, in order of appearance.
pub(crate) fn items(people: &[Participant]) -> Vec<Item> {
    let mut items: Vec<Item> = Vec::new();
    for item in people.iter().flat_map(|person| &person.begun.protocol.questionnaire) {
        if items.iter().all(|known| known.id != item.id) {
            items.push(item.clone());
        }
    }
    items
}

fn object<'a>(pairs: impl Iterator<Item = (&'a str, Json)>) -> Map<String, Json> {
    pairs.map(|(name, value)| (name.to_owned(), value)).collect()
}

fn said(trial: &Trial) -> Json {
    let said = trial.said.iter();
    said.map(|it| json!({ "seq": it.seq, "source": it.source, "words": it.words })).collect()
}

fn asked(trial: &Trial) -> Json {
    let asked = trial.asked.iter().map(|question| {
        json!({ "prompt": question.prompt, "times": question.presentation, "words": question.words })
    });
    asked.collect()
}

/// Returns the rows of a participant's interactions. Of deleted data there are none.
fn trials(person: &Participant) -> Vec<Vec<Json>> {
    let mut number = 0;
    let rows = person.trials.iter().enumerate().map(|(n, trial)| {
        number += u32::from(trial.counts());
        row(person, n + 1, trial.counts().then_some(number), trial)
    });
    rows.collect()
}

/// Returns the values in the order of [`INTERACTIONS`].
fn row(person: &Participant, n: usize, number: Option<u32>, trial: &Trial) -> Vec<Json> {
    let counts = trial.counts() && person.status().counts();
    let ending = trial.ending();
    let interaction = ending.map(|ending| ending.interaction).filter(|n| *n > 0);
    let (outcome, fault) = match &trial.end {
        Some(End::Verdict(ending)) => (ending.verdict.name(), None),
        Some(End::Fault(_, why)) => ("fault", Some(why)),
        None => ("unfinished", None),
    };
    let success = trial.verdict().filter(|_| counts).map(|v| u8::from(v == Verdict::Right));
    vec![
        json!(person.id()),
        json!(person.status().name()),
        json!(n),
        json!(number),
        json!(block(person, trial)),
        json!(u8::from(trial.step.practice)),
        json!(u8::from(counts)),
        json!(trial.step.policy),
        json!(trial.drawn.scene),
        json!(trial.drawn.scene_key),
        json!(trial.drawn.object),
        json!(ending.and_then(|ending| ending.object.as_ref())),
        json!(outcome),
        json!(success),
        json!(trial.seconds().map(thousandths)),
        json!(trial.talk_seconds().map(thousandths)),
        json!(trial.questions()),
        json!(trial.repeats()),
        json!(trial.utterances()),
        json!(trial.said_by(Source::Typed)),
        json!(trial.said_by(Source::Voice)),
        json!(interaction),
        json!(utc(trial.drawn_at)),
        json!(trial.started_at.map(utc)),
        json!(trial.ended_at.map(utc)),
        json!(trial.resumed),
        json!(fault),
    ]
}

/// Returns the values in the order of [`PARTICIPANTS`].
fn participant(person: &Participant) -> Vec<Json> {
    let asks = !person.begun.protocol.consent.is_empty();
    let right = person.counted().filter(|trial| trial.verdict() == Some(Verdict::Right)).count();
    let faults = person.trials.iter().filter(|t| matches!(t.end, Some(End::Fault(..)))).count();
    vec![
        json!(person.id()),
        json!(person.status().name()),
        json!(policies(person).join(">")),
        json!(person.counted().count()),
        json!(right),
        json!(faults),
        json!(asks.then_some(u8::from(person.consented))),
        json!(utc(person.begun_at)),
        json!(utc(person.latest_at)),
        json!(format!("{:016x}", person.begun.seed)),
        json!(person.begun.group),
        json!(person.begun.software),
    ]
}

/// Returns the policies of the plan in their order, each once.
fn policies(person: &Participant) -> Vec<&str> {
    distinct(person.begun.plan.iter().map(|step| step.policy.as_str()))
}

fn block(person: &Participant, trial: &Trial) -> Option<usize> {
    policies(person).iter().position(|policy| *policy == trial.step.policy).map(|n| n + 1)
}

fn answer(person: &Participant, item: &Item) -> Json {
    person.answers.get(&item.id).cloned().unwrap_or(Json::Null)
}

/// A moment, milliseconds since 1970.
fn utc(ms: u64) -> String {
    wall_time::text(ms.saturating_mul(1_000_000))
}

fn thousandths(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.collect::<Vec<_>>().join(",") + "\n"
}

fn cell_of(value: &Json) -> String {
    match value {
        Json::Null => String::new(),
        Json::String(text) => cell(text),
        other => other.to_string(),
    }
}

/// Returns a text as a cell (RFC 4180). One that a spreadsheet would calculate has an apostrophe in
/// front, by which it is text there: participants are strangers. Numbers stay numbers.
pub(crate) fn cell(text: &str) -> String {
    let is_formula =
        text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.parse::<f64>().is_err();
    let text = &*if is_formula { Cow::from(format!("'{text}")) } else { Cow::from(text) };
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cell_is_text_to_a_spreadsheet_whatever_it_begins_with() {
        for (text, expected) in [
            (
                "=HYPERLINK(\"http://x.invalid\",\"a\")",
                "\"'=HYPERLINK(\"\"http://x.invalid\"\",\"\"a\"\")\"",
            ),
            ("+1-234", "'+1-234"),
            ("-cmd|' /C calc'!A0", "'-cmd|' /C calc'!A0"),
            ("@SUM(1)", "'@SUM(1)"),
            ("\t=1", "'\t=1"),
            ("\r=1", "\"'\r=1\""),
            ("-3.5", "-3.5"),
            ("+7", "+7"),
            ("it's 1=1", "it's 1=1"),
        ] {
            assert_eq!(cell(text), expected);
        }
        assert_eq!(cell_of(&json!(-2)), "-2");
    }
}
