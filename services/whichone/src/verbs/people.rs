//! `people`: lists, exports and forgets what was learned about people who gave their name.

mod known;

use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::output::{Output, note};
use known::{Errors, PersonRecord, known};
use messages::{FixedText, Forget, PolicyView, Service, topics};
use serde_json::json;
use service::bus::{EncodedReader, Writer};
use service::client::{Client, Polling, random_number};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::printable::one_line;
use service::view::quiet;
use vocabulary::PersonId;

use super::availability::Availability;
use crate::cli::{PeopleArgs, PeopleVerb};

/// Interval at which an order is sent until it is answered.
const RESEND_EVERY: Duration = Duration::from_millis(200);

/// Lists, exports or forgets people.
pub(super) fn people(paths: &GroupPaths, args: &PeopleArgs, out: &mut Output<'_>) -> Outcome {
    match args.what.as_ref().unwrap_or(&PeopleVerb::List) {
        PeopleVerb::List => list(&read(paths)?, out),
        PeopleVerb::Export { person } => {
            let mut people = read(paths)?;
            if let Some(person) = person {
                people.retain(|known| known.name == person.as_str());
                if people.is_empty() {
                    let (name, group) = (one_line(person.as_str()), paths.name());
                    let what = format!("group {group} knows nobody called `{name}`");
                    let help = "help: `whichone people`";
                    return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
                }
            }
            out.json(&people)?;
            Ok(Exit::Ok)
        }
        PeopleVerb::Forget { person, timeout } => {
            // Records of the journal have the name from the first word on, before anything is learned.
            let is_known = read(paths)?.iter().any(|known| known.name == person.as_str());
            forget(paths, person, *timeout)?;
            if out.is_json() {
                out.json(&json!({ "forgotten": person.as_str() }))?;
                return Ok(Exit::Ok);
            }
            let name = one_line(person.as_str());
            out.line(format_args!("{name} is forgotten"))?;
            if !is_known {
                note(format_args!(
                    "nothing was learned about {name}; help: `whichone people` lists names"
                ));
            }
            note(
                "what was said stays for a while in the speech service's journal, in recordings and in flights",
            );
            note("help: docs/people.md says for how long, and how to remove it at once");
            Ok(Exit::Ok)
        }
    }
}

/// Reads who is known from the policy's journal, whether the group runs or not.
fn read(paths: &GroupPaths) -> Result<Vec<PersonRecord>, Failure> {
    let file = paths.journal_file(Service::Policy.name());
    if !file.is_file() {
        let what = format!("group {} has no journal of the policy", paths.name());
        return Err(Failure::new(Exit::NotReached, format!("{what}; help: `whichone up`")));
    }
    known(&file)
        .map_err(|error| Failure::new(Exit::Storage, format!("{}: {error}", file.display())))
}

fn list(people: &[PersonRecord], out: &mut Output<'_>) -> Outcome {
    if out.is_json() {
        out.json(&json!({ "people": people }))?;
        return Ok(Exit::Ok);
    }
    if people.is_empty() {
        out.line("nobody is known by name")?;
    }
    people.iter().try_for_each(|person| out.line(line(person)))?;
    Ok(Exit::Ok)
}

fn line(person: &PersonRecord) -> String {
    let rate = |what: &str, Errors { wrong, of }: &Errors| {
        format!("{what} {wrong:.1} of {of:.1} ({:.0} %)", wrong / of * 100.0)
    };
    let errors = person.errors.iter().map(|(name, errors)| rate(&name.replace('_', "/"), errors));
    let misperceived = person.misperceived.iter().map(|(name, errors)| rate(name, errors));
    let wrong: Vec<String> = errors.chain(misperceived).collect();
    let wrong =
        if wrong.is_empty() { String::new() } else { format!("; wrong: {}", wrong.join(", ")) };
    let deliveries = format!("{} {}", person.deliveries, deliveries(person.deliveries));
    format!("{}  {deliveries}{wrong}", one_line(&person.name))
}

fn deliveries(number: u64) -> &'static str {
    if number == 1 { "delivery" } else { "deliveries" }
}

/// Has the policy forget a person: one order, sent until it is durable.
fn forget(paths: &GroupPaths, person: &PersonId, patience: Duration) -> Result<(), Failure> {
    let client = Client::join(paths)?;
    Availability::now(paths).require(Service::Policy)?;
    let orders: Writer<Forget> = client.bus().writer(&topics::FORGET)?;
    let views: EncodedReader<PolicyView> = client.bus().encoded_reader(&topics::VIEW)?;
    let name = FixedText::new(person.as_str());
    let name = name.map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
    let order = Forget { key: random_number().max(1), person: name, ..Forget::default() };
    let (until, mut polling) = (Instant::now() + patience, Polling::default());
    let mut sent: Option<Instant> = None;
    while Instant::now() < until {
        if sent.is_none_or(|sent| sent.elapsed() >= RESEND_EVERY) {
            quiet(orders.send(&order).map(Some));
            sent = Some(Instant::now());
        }
        if quiet(views.latest()).is_some_and(|view| view.forgot == order.key) {
            return Ok(());
        }
        polling.pause();
    }
    Err(Failure::new(Exit::NotReached, "no answer from the policy; help: `whichone status`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn person_is_a_line_with_deliveries_and_errors() {
        let errors = |wrong, of| Errors { wrong, of };
        let ann = PersonRecord {
            name: "Ann".to_owned(),
            deliveries: 12,
            errors: [("yes_no", errors(1.0, 20.0))].into(),
            misperceived: [("colour".to_owned(), errors(0.5, 5.0))].into(),
            fetched: [("white".to_owned(), 12)].into(),
        };
        assert_eq!(
            line(&ann),
            "Ann  12 deliveries; wrong: yes/no 1.0 of 20.0 (5 %), colour 0.5 of 5.0 (10 %)"
        );
        let bob = PersonRecord {
            name: "Bob".to_owned(),
            deliveries: 1,
            errors: Default::default(),
            misperceived: Default::default(),
            fetched: Default::default(),
        };
        assert_eq!(line(&bob), "Bob  1 delivery");
    }
}
