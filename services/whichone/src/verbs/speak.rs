//! `say`, `talk` and `point`: submission of utterances and gestures.

use std::time::Duration;

use command_line::Outcome;
use command_line::interrupt::Interrupt;
use command_line::output::{Ink, Output, note};
use messages::{
    GateVerdict, Hypothesis, PromptId, Receipt, ReceiptStatus, SecondState, Service, Sound, Source,
    WireError,
};
use serde::Serialize;
use service::client::{Client, ClientError, submit};
use service::clock;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::printable::one_line;
use service::submission::Submission;
use service::view::Latest;
use service::{Span, Time};
use vocabulary::PersonId;

use super::availability::{AFTER_SPEECH, Availability, Lookout};
use super::conversation::glance;
use super::hearing;
use super::motion::MotionOrders;
use crate::cli::{PointArgs, SayArgs, TalkArgs};

/// Time for the arm to confirm a stop before its words go to the speech service, which may be held up.
const STOPS_WITHIN: Duration = Duration::from_millis(300);

/// Submits an utterance and prints its receipt.
pub(super) fn say(paths: &GroupPaths, args: &SayArgs, out: &mut Output<'_>) -> Outcome {
    let text = args.text.join(" ");
    let spoken = args.began_ago.is_some()
        || args.ended_ago.is_some()
        || !args.alternatives.is_empty()
        || !args.confidence.is_empty();
    let (sound, said) = match spoken {
        true => (transcript(args)?, when(args)?),
        false => (Sound::Text(text.clone()), (clock::now(), Time(0))),
    };
    let is_stop = language::is_stop(&text);
    let seen = PromptId(args.seen.unwrap_or_default());
    // Nothing may keep a stop back.
    if seen > PromptId(0) && !is_stop {
        must_be_said(paths, seen)?;
    }
    let said = Said { sound, said, from: &args.from, seen };
    if !is_stop {
        return give_said(paths, &said, args.timeout, None, out);
    }
    // The stop needs no speech service: it goes to the arm at once, on its own path, and outlives the words.
    let interrupt = Interrupt::listen()?;
    let orders = MotionOrders::open(paths)?;
    orders.stop();
    orders.await_news(STOPS_WITHIN);
    let given = give_said(paths, &said, args.timeout, Some(&interrupt), out);
    orders.finish(&interrupt, Some(args.timeout), given)
}

/// Fails for a prompt that is not known to have been said: the speech service would wait for it.
fn must_be_said(paths: &GroupPaths, seen: PromptId) -> Result<(), Failure> {
    let latest = glance(paths, |latest| latest.view.is_some());
    let is_ahead = |latest: &Latest| latest.view.is_some() && latest.prompt() < seen;
    let Some(latest) = latest.filter(is_ahead) else { return Ok(()) };
    let what = format!("--seen: expected a line that was said, up to {}", latest.prompt());
    Err(Failure::new(Exit::Usage, format!("{what}, found {seen}; help: leave it out")))
}

/// When it was said.
fn when(args: &SayArgs) -> Result<(Time, Time), Failure> {
    let ended = args.ended_ago.unwrap_or_default();
    let began = args.began_ago.unwrap_or(ended);
    if began < ended {
        let what = "expected --began-ago to be at least --ended-ago";
        return Err(Failure::new(Exit::Usage, what));
    }
    let now = clock::now();
    let ago = |time: Duration| now - Span::from_s(time.as_secs_f64());
    Ok((ago(began), ago(ended)))
}

fn transcript(args: &SayArgs) -> Result<Sound, Failure> {
    let others: f64 = args.alternatives.iter().map(|(_, weight)| weight).sum();
    if others >= 1.0 {
        let what = format!("the alternatives weigh {others} and leave nothing of 1 for the text");
        return Err(Failure::new(Exit::Usage, what));
    }
    let (weight, word_confidence) = (1.0 - others, args.confidence.clone());
    let best = Hypothesis { text: args.text.join(" "), weight, word_confidence };
    let others = args.alternatives.iter();
    let others = others
        .map(|(text, weight)| Hypothesis { weight: *weight, ..Hypothesis::certain(text.clone()) });
    Ok(Sound::Transcript { hypotheses: std::iter::once(best).chain(others).collect() })
}

/// Submits a pointing gesture and prints its receipt.
pub(super) fn point(paths: &GroupPaths, args: &PointArgs, out: &mut Output<'_>) -> Outcome {
    let sound = Sound::Point { target_m: [args.x, args.y, args.z], words: args.say.clone() };
    give(paths, sound, args.timeout, out)
}

/// Opens the microphone for one utterance and prints its receipt.
pub(super) fn talk(paths: &GroupPaths, args: &TalkArgs, out: &mut Output<'_>) -> Outcome {
    let longest_s = args.seconds.as_secs_f64();
    if !out.is_json() {
        note("speak now");
    }
    give(paths, Sound::Talk { longest_s }, args.seconds + args.timeout, out)
}

/// Submits a sound and prints its receipts.
pub(super) fn give(
    paths: &GroupPaths,
    sound: Sound,
    timeout: Duration,
    out: &mut Output<'_>,
) -> Outcome {
    let (said, from) = ((clock::now(), Time(0)), &PersonId::default());
    give_said(paths, &Said { sound, said, from, seen: PromptId(0) }, timeout, None, out)
}

/// What was said, when it began and ended, by whom, and the line that they were shown last, 0 if unknown.
struct Said<'a> {
    sound: Sound,
    said: (Time, Time),
    from: &'a PersonId,
    seen: PromptId,
}

fn give_said(
    paths: &GroupPaths,
    Said { sound, said, from, seen }: &Said<'_>,
    timeout: Duration,
    interrupt: Option<&Interrupt>,
    out: &mut Output<'_>,
) -> Outcome {
    let patience = Span::from_s(timeout.as_secs_f64());
    let submission = Submission::new(sound.clone(), *said, clock::now(), patience);
    let mut submission = submission.after(*seen).by(from.as_str());
    // The speech service alone answers, and keeps what the others will need.
    let mut lookout = Lookout::of(&[Service::Speech]).with_shortages();
    loop {
        let services = Availability::request(paths);
        let memory = paths.shm_name().ok();
        let client = Client::join(paths)?;
        let (injections, receipts) = client.submission(sound)?;
        let services = services.wait();
        services.require(Service::Speech)?;
        let mut is_replaced = false;
        let standstill = || {
            if interrupt.is_some_and(Interrupt::is_requested) {
                return Some("interrupted".to_owned());
            }
            let news = lookout.news(paths);
            // A supervisor that was killed has a successor with other shared memory.
            is_replaced = paths.shm_name().is_ok_and(|now| memory.as_ref() != Some(&now));
            if is_replaced { Some(String::new()) } else { news }
        };
        match submit(&injections, &receipts, &mut submission, standstill) {
            Err(ClientError::Standstill(_)) if is_replaced => {}
            receipts => return print_all(&services, &receipts?, out),
        }
    }
}

fn print_all(services: &Availability, receipts: &[Receipt], out: &mut Output<'_>) -> Outcome {
    for receipt in receipts {
        print(receipt, out)?;
    }
    let accepted = |receipt: &Receipt| receipt.status == ReceiptStatus::Accepted;
    if !receipts.iter().any(accepted) {
        return Ok(Exit::NotReached);
    }
    if let Some(why) = services.first_missing(AFTER_SPEECH, |_| true) {
        note(format_args!("it is kept, but nothing follows yet: {why}"));
    }
    Ok(Exit::Ok)
}

/// A receipt with `--json`.
#[derive(Serialize)]
struct Printed<'a> {
    status: ReceiptStatus,
    utterance: Option<u64>,
    note: &'a str,
    source: Source,
    confidence: f32,
    snr_db: f32,
    verdict: GateVerdict,
    gate_score: f32,
    recognisers: Recognisers<'a>,
    onset_ns: u64,
    end_ns: u64,
}

/// What each recogniser thought; empty for text.
#[derive(Serialize)]
struct Recognisers<'a> {
    first: &'a str,
    second: SecondState,
    second_text: &'a str,
}

impl<'a> Recognisers<'a> {
    fn of(receipt: &'a Receipt) -> Result<Self, WireError> {
        Ok(Self {
            first: receipt.first_text.as_str()?,
            second: receipt.second.get(),
            second_text: receipt.second_text.as_str()?,
        })
    }

    /// Returns both views where there are two.
    fn as_text(&self) -> Option<String> {
        let first = one_line(self.first);
        Some(match self.second {
            SecondState::NotAsked => return None,
            SecondState::Late => format!("first recogniser: {first}; the second was too late"),
            SecondState::Heard if self.second_text.is_empty() => {
                format!("first recogniser: {first}; the second heard no words")
            }
            SecondState::Heard => {
                format!("first recogniser: {first}; second: {}", one_line(self.second_text))
            }
        })
    }
}

/// Returns what was heard and not acted on, and why.
fn not_acted_on(receipt: &Receipt, note: &str) -> String {
    match receipt.verdict.get() {
        GateVerdict::NoWords => "heard, but no words were recognised".to_owned(),
        GateVerdict::NoSpeech => {
            format!("heard, but not acted on: {note} (no voice in it)")
        }
        GateVerdict::Covered => {
            format!("heard, but not acted on: {note} (the robot's voice covers the beginning)")
        }
        GateVerdict::Echo => {
            format!("heard, but not acted on: {note} (the robot has just said so itself)")
        }
        GateVerdict::OtherTalk | GateVerdict::Passed => {
            let score = receipt.gate_score;
            format!(
                "heard, but not acted on: {note} (about other things: {score:.2} is below \
                 speech.accept_score_min)"
            )
        }
    }
}

/// Prints the receipt of an utterance.
pub(super) fn print(receipt: &Receipt, out: &mut Output<'_>) -> Result<(), Failure> {
    let unclear = |error: WireError| Failure::new(Exit::NotReached, error.to_string());
    let status = receipt.status.get();
    let source = receipt.source.get();
    let note = receipt.note.as_str().map_err(unclear)?;
    let recognisers = Recognisers::of(receipt).map_err(unclear)?;
    let utterance = receipt.utterance().map(|seq| seq.0);
    if out.is_json() {
        return out.json(&Printed {
            status,
            utterance,
            note,
            source,
            confidence: receipt.confidence,
            snr_db: receipt.snr_db,
            verdict: receipt.verdict.get(),
            gate_score: receipt.gate_score,
            recognisers,
            onset_ns: receipt.onset_ns,
            end_ns: receipt.end_ns,
        });
    }
    let (style, note) = (out.style(), &*one_line(note));
    let spoken = matches!(source, Source::Wav | Source::Microphone);
    match (status, utterance) {
        (ReceiptStatus::Accepted, seq) => {
            let seq = seq.map_or(String::new(), |seq| format!(" as utterance {seq}"));
            let (sure, snr_db) = (receipt.confidence * 100.0, receipt.snr_db);
            let how = format!(" ({sure:.0} % sure, {snr_db:.0} dB above the noise)");
            let how = style.paint(Ink::Dim, if spoken { how } else { String::new() });
            out.line(format_args!("heard{seq}: {note}{how}"))?;
        }
        (ReceiptStatus::NotForMe, _) => {
            out.line(style.paint(Ink::Yellow, not_acted_on(receipt, note)))?;
        }
        (ReceiptStatus::Over, _) if note.is_empty() => {}
        (ReceiptStatus::Over, _) => out.line(style.paint(Ink::Yellow, note))?,
        (ReceiptStatus::Refused, _) => {
            return Err(Failure::new(Exit::NotReached, format!("not accepted: {note}")));
        }
    }
    if let Some(views) = recognisers.as_text() {
        out.line(style.paint(Ink::Dim, views))?;
    }
    let measured = spoken && receipt.snr_db > 0.0;
    match hearing::noise(receipt.snr_db).filter(|_| measured) {
        Some(noise) => out.line(style.paint(Ink::Yellow, noise)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::FixedText;

    #[test]
    fn receipt_says_what_each_recogniser_heard_and_why_nothing_follows() {
        let receipt = |verdict: GateVerdict, second: SecondState, words: &str| Receipt {
            verdict: verdict.code(),
            second: second.code(),
            gate_score: 0.125,
            first_text: FixedText::truncated("the kite"),
            second_text: FixedText::truncated(words),
            ..Receipt::default()
        };
        for (verdict, expected) in [
            (GateVerdict::NoWords, "no words were recognised"),
            (GateVerdict::OtherTalk, "the kite (about other things: 0.12 is below"),
            (GateVerdict::NoSpeech, "the kite (no voice in it)"),
            (GateVerdict::Covered, "the kite (the robot's voice covers the beginning)"),
            (GateVerdict::Echo, "the kite (the robot has just said so itself)"),
        ] {
            let text = not_acted_on(&receipt(verdict, SecondState::NotAsked, ""), "the kite");
            assert!(text.contains(expected), "{text}");
        }
        for (second, words, expected) in [
            (SecondState::NotAsked, "", None),
            (SecondState::Late, "", Some("the kite; the second was too late")),
            (SecondState::Heard, "", Some("the kite; the second heard no words")),
            (SecondState::Heard, "the white", Some("the kite; second: the white")),
        ] {
            let receipt = receipt(GateVerdict::Passed, second, words);
            let text = Recognisers::of(&receipt).unwrap().as_text();
            let expected = expected.map(|text| format!("first recogniser: {text}"));
            assert_eq!(text, expected);
        }
    }
}
