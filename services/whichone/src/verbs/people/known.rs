//! What was learned about people, for themselves and for operators to read.

use std::collections::BTreeMap;
use std::path::Path;

use dialogue::manager::{KnownPerson, Record};
use dialogue::{Channel, Count};
use journal::JournalOpenError;
use serde::Serialize;

/// What was learned about a person.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct PersonRecord {
    /// The name that they gave.
    pub(super) name: String,
    /// Deliveries that they did not refuse.
    pub(super) deliveries: u64,
    /// Errors by channel: `yes_no`, `open`, `choice`, `words`, `heard`; only those that were used.
    pub(super) errors: BTreeMap<&'static str, Errors>,
    /// Values taken for another one, by attribute.
    pub(super) misperceived: BTreeMap<String, Errors>,
    /// Deliveries by object.
    pub(super) fetched: BTreeMap<String, u64>,
}

/// Expected number of errors: what a person has said is right or wrong with a probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Errors {
    /// Expected number of wrong ones.
    pub(super) wrong: f64,
    /// Number of all.
    pub(super) of: f64,
}

impl From<&Count> for Errors {
    fn from(count: &Count) -> Self {
        Self { wrong: count.wrong, of: count.all() }
    }
}

impl From<&KnownPerson> for PersonRecord {
    fn from(known: &KnownPerson) -> Self {
        let used = |(channel, count): (Channel, &Count)| {
            (count.all() > 0.0).then(|| (name(channel), count.into()))
        };
        let attributes = known.attributes.iter();
        let fetched = known.fetched.iter();
        Self {
            name: known.id.to_string(),
            deliveries: known.deliveries,
            errors: Channel::ALL.into_iter().zip(&known.channels).filter_map(used).collect(),
            misperceived: attributes.map(|(name, count)| (name.clone(), count.into())).collect(),
            fetched: fetched.map(|(name, count)| (name.to_owned(), count)).collect(),
        }
    }
}

fn name(channel: Channel) -> &'static str {
    match channel {
        Channel::YesNo => "yes_no",
        Channel::Open => "open",
        Channel::Choice => "choice",
        Channel::Words => "words",
        Channel::Heard => "heard",
    }
}

/// Returns the people whom the policy of this journal knows, the one seen last at the end. Its writer may live.
///
/// # Errors
/// No journal, or one that cannot be read.
pub(super) fn known(journal: &Path) -> Result<Vec<PersonRecord>, JournalOpenError> {
    let reading = journal::read::<Record>(journal)?;
    let latest = reading.records.last();
    Ok(latest.iter().flat_map(|record| record.state.people().iter()).map(Into::into).collect())
}
