//! `say`, `point` and `listen`: giving the robot something to hear or see.

use std::path::Path;
use std::time::Duration;

use node::Span;
use protocol::{Receipt, ReceiptStatus, Sound, Source};
use runtime::client::Client;
use runtime::exit::Exit;
use runtime::group::GroupPaths;
use serde_json::json;

use super::hearing;
use crate::cli::{PointArgs, TalkArgs};
use crate::output::{Ink, Output, note};
use crate::trouble::{Outcome, Trouble};

/// Says words, and tells whether they were accepted.
pub(super) fn say(
    paths: &GroupPaths,
    words: &[String],
    timeout: Duration,
    out: &mut Output<'_>,
) -> Outcome {
    give(paths, Sound::Text(words.join(" ")), timeout, out)
}

/// Points at a place, and tells whether that was accepted.
pub(super) fn point(paths: &GroupPaths, args: &PointArgs, out: &mut Output<'_>) -> Outcome {
    let patience = Span::from_s(args.timeout.as_secs_f64());
    let client = Client::join(paths)?;
    tell_all(&client.point([args.x, args.y, args.z], &args.say, patience)?, out)
}

/// Plays a file to the robot, and tells what was heard in it.
pub(super) fn listen(
    paths: &GroupPaths,
    file: &Path,
    timeout: Duration,
    out: &mut Output<'_>,
) -> Outcome {
    let absolute = file.canonicalize().map_err(|error| Trouble::file(file, &error))?;
    std::fs::File::open(&absolute).map_err(|error| Trouble::file(file, &error))?;
    let path = absolute.into_os_string().into_string().map_err(|path| {
        let what = format!("{}: the path is not UTF-8; rename the file", path.display());
        Trouble::new(Exit::Usage, what)
    })?;
    give(paths, Sound::Wav(path), timeout, out)
}

/// Opens the microphone for one utterance, and tells what was heard.
pub(super) fn talk(paths: &GroupPaths, args: &TalkArgs, out: &mut Output<'_>) -> Outcome {
    let longest_s = args.seconds.as_secs_f64();
    if !out.is_json() {
        note("speak now");
    }
    give(paths, Sound::Talk { longest_s }, args.seconds + args.timeout, out)
}

fn give(paths: &GroupPaths, sound: Sound, timeout: Duration, out: &mut Output<'_>) -> Outcome {
    let client = Client::join(paths)?;
    let receipts = client.inject(sound, Span::from_s(timeout.as_secs_f64()))?;
    tell_all(&receipts, out)
}

fn tell_all(receipts: &[Receipt], out: &mut Output<'_>) -> Outcome {
    for receipt in receipts {
        tell(receipt, out)?;
    }
    let accepted = |receipt: &Receipt| receipt.status == ReceiptStatus::Accepted.code();
    Ok(if receipts.iter().any(accepted) { Exit::Ok } else { Exit::NotReached })
}

fn tell(receipt: &Receipt, out: &mut Output<'_>) -> Result<(), Trouble> {
    let unclear = |error: protocol::WireError| Trouble::new(Exit::NotReached, error.to_string());
    let status = ReceiptStatus::from_code(receipt.status).map_err(unclear)?;
    let source = Source::from_code(receipt.source).map_err(unclear)?;
    let note = receipt.note.as_str().map_err(unclear)?;
    let utterance = receipt.utterance().map(|seq| seq.0);
    if out.is_json() {
        return out.json(&json!({
            "status": status, "utterance": utterance, "note": note, "source": source,
            "confidence": receipt.confidence, "snr_db": receipt.snr_db,
            "onset_ns": receipt.onset_ns, "end_ns": receipt.end_ns,
        }));
    }
    let style = out.style();
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
            let told = format!("heard, but not meant for the robot: {note}");
            out.line(style.paint(Ink::Yellow, told))?;
        }
        (ReceiptStatus::Refused, _) => {
            return Err(Trouble::new(Exit::NotReached, format!("not accepted: {note}")));
        }
    }
    match hearing::noise(receipt.snr_db).filter(|_| spoken) {
        Some(noise) => out.line(style.paint(Ink::Yellow, noise)),
        None => Ok(()),
    }
}
