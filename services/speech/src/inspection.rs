//! Listing and verification of the speech service's journal.

use std::collections::HashSet;

use messages::Source;
use scene::count;
use service::Time;
use service::exit::Failure;
use service::inspection::{Part, SharedFacts};
use service::journal_set::NUMBERS_SKIPPED;
use vocabulary::Presentation;

use crate::record::Record;

/// When a record was written.
pub(crate) fn recorded_at(record: &Record) -> Time {
    match record {
        Record::Accepted(accepted) => accepted.accepted,
        Record::Presented(presentation) => presentation.ended.unwrap_or(presentation.began),
        Record::StopOrdered(given) | Record::StopSettled(given) => *given,
    }
}

/// Renders a record as one line.
pub(crate) fn line(record: &Record) -> String {
    match record {
        Record::Accepted(accepted) => {
            let words = accepted.hypotheses.first().map(|best| format!("\"{}\"", best.text));
            let pointed = accepted
                .gesture
                .map(|[x, y, z]| format!("pointing at x {x:.3} m, y {y:.3} m, z {z:.3} m"));
            let said: Vec<String> = words.into_iter().chain(pointed).collect();
            let source = source(accepted.origin.source);
            let from = &accepted.origin.from;
            let from = if from.is_nobody() { String::new() } else { format!(" from {from}") };
            format!("utterance {} accepted {source}{from}: {}", accepted.seq, said.join(", "))
        }
        Record::Presented(presentation) => {
            let Presentation { prompt, number, complete, .. } = *presentation;
            let how = if complete { "spoken to its end" } else { "interrupted" };
            format!("line {prompt} {how} (presentation {number})")
        }
        Record::StopOrdered(_) => "stop ordered".to_owned(),
        Record::StopSettled(_) => "stop carried out, or overruled by a later order".to_owned(),
    }
}

fn source(source: Source) -> &'static str {
    match source {
        Source::Text => "as text",
        Source::Wav => "from a file",
        Source::Microphone => "from the microphone",
        Source::Browser => "from a browser's recogniser",
        Source::Gesture => "as a gesture",
    }
}

/// Verifies that utterances are numbered without a gap and accepted once.
pub(crate) fn verify(parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
    let mut last = None;
    let mut keys = HashSet::new();
    for part in parts {
        for (seq, record) in part.numbered() {
            let Record::Accepted(accepted) = record else { continue };
            let number = accepted.seq.0;
            // A rotated journal repeats utterances that were not applied yet.
            let again = last.is_some_and(|last| number <= last) && seq_in_snapshot(part, seq);
            if again {
                continue;
            }
            if last.is_some_and(|last| number != last + 1 && !is_first_after(last, number)) {
                let last = last.unwrap_or(0);
                return Err(part.broken(seq, format!("utterance {number} follows {last}")));
            }
            if !keys.insert((accepted.key, accepted.segment.0)) {
                return Err(part.broken(seq, format!("utterance {number} was accepted before")));
            }
            last = Some(number);
        }
    }
    let accepted = count(last.unwrap_or(0) % NUMBERS_SKIPPED, "utterance");
    Ok(vec![format!("{accepted} accepted once and without a gap")])
}

/// Returns whether numbering skipped between the two, because a journal was set aside.
fn is_first_after(last: u64, number: u64) -> bool {
    number > last && number % NUMBERS_SKIPPED == 1
}

/// The last utterance accepted.
pub(crate) fn shared_facts(parts: &[Part<Record>]) -> SharedFacts {
    let accepted = parts.iter().flat_map(|part| part.records()).filter_map(|record| match record {
        Record::Accepted(accepted) => Some(accepted.seq.0),
        _ => None,
    });
    SharedFacts { utterance: accepted.max().unwrap_or(0), ..SharedFacts::default() }
}

/// Returns whether the record belongs to the snapshot at the beginning of a rotated journal.
fn seq_in_snapshot(part: &Part<Record>, seq: u64) -> bool {
    part.first_seq() > 1 && {
        let before = part.numbered().take_while(|(n, _)| *n <= seq);
        before.into_iter().all(|(_, record)| matches!(record, Record::Accepted(_)))
    }
}
