//! One interaction of very many utterances: what the group keeps of it, and how long a restart takes.

use crate::options::Options;
use crate::peers::resident_mib;
use crate::report::Report;
use crate::start::restart;
use messages::{Injection, Receipt, Sound, topics};
use service::client::{Client, deliver};
use service::clock;
use service::{Span, Time};
use std::path::Path;
use std::time::Instant;
use whichone_tests::Group;

/// Utterances where nothing else is said: alone, and among everything else.
const UTTERANCES: (u64, u64) = (20_000, 1_000);
/// Clients that speak at the same time.
const CLIENTS: u64 = 4;
/// Looks at the group, at equal distances.
const LOOKS: u64 = 4;
/// What a user says who never decides.
const SAID: [&str; 4] = ["the white one", "the metal one", "no", "the plastic one"];

pub(crate) fn measure(report: &mut Report, options: &Options) {
    let usual = if options.wants_all() { UTTERANCES.1 } else { UTTERANCES.0 };
    let utterances = options.utterances.unwrap_or(usual);
    let group = Group::up(&[
        "dialogue.turns.questions_max=1000",
        "group.restart.backoff_first_ms=1",
        "group.restart.backoff_max_ms=2",
    ]);
    // Nothing is fetched, so that the interaction stays open.
    group.must(&["stop-motion"]);
    let mut rows = Vec::new();
    for look in 1..=LOOKS {
        let began = Instant::now();
        speak(&group, utterances / LOOKS);
        let a_second = (utterances / LOOKS) as f64 / began.elapsed().as_secs_f64();
        let bytes = |name| journal_bytes(&group.paths().journal(), name);
        let megabytes = |bytes: u64| format!("{:.1}", bytes as f64 / 1e6);
        let resident = memory(&group);
        let restart_ms = restart(&group, "policy");
        rows.push(vec![
            (look * utterances / LOOKS).to_string(),
            format!("{a_second:.0}"),
            megabytes(bytes("speech")),
            megabytes(bytes("policy")),
            resident,
            format!("{restart_ms:.0}"),
            memory(&group),
        ]);
    }
    let heads = [
        "utterances",
        "a second",
        "speech's journals, MB",
        "policy's journals, MB",
        "policy's memory, MiB",
        "kill to ready, ms",
        "then memory, MiB",
    ];
    let note = format!(
        "One open interaction, {CLIENTS} clients at once, each waiting for its receipt. Journals: with the \
         files that a journal continued from."
    );
    report.table("Long interactions", note, heads, rows);
    group.down();
}

/// Has the clients say so many utterances.
fn speak(group: &Group, utterances: u64) {
    std::thread::scope(|scope| {
        for client in 0..CLIENTS {
            scope.spawn(move || {
                let bus = Client::join(group.paths()).expect("a running group");
                let bus = bus.bus();
                let receipts = bus.reader::<Receipt>(&topics::RECEIPT).expect("receipts");
                let writer = bus.encoded_writer::<Injection>(&topics::INJECTION);
                let writer = writer.expect("injections");
                for n in (client..utterances).step_by(CLIENTS as usize) {
                    let sound = Sound::Text(SAID[n as usize % SAID.len()].to_owned());
                    let said = (clock::now(), Time(0));
                    let patience = Span::from_ms(60_000);
                    let told = deliver(&writer, &receipts, sound, said, patience, || None);
                    told.expect("a receipt");
                }
            });
        }
    });
}

/// Resident memory of the policy, MiB.
fn memory(group: &Group) -> String {
    let pid = group.pid("policy").as_raw_nonzero().get();
    resident_mib(pid).map_or(String::new(), |mib| format!("{mib:.1}"))
}

/// Bytes of a journal and of the files that it continued from.
fn journal_bytes(folder: &Path, name: &str) -> u64 {
    let files = std::fs::read_dir(folder).expect("a folder of journals").flatten();
    let is_part = |file: &std::fs::DirEntry| {
        file.file_name().to_string_lossy().starts_with(&format!("{name}.journal"))
    };
    files.filter(is_part).filter_map(|file| file.metadata().ok()).map(|meta| meta.len()).sum()
}
