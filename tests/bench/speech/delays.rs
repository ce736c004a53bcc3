//! How long after the voice a result is there, by recognisers, on an idle and on a busy machine.

use super::Ears;
use super::conditions::QUIET;
use super::corpus::Corpus;
use super::voices::Voices;
use crate::peers::resident_mib;
use crate::report::{Report, percentile};
use ::speech_engines::recogniser::RecogniserUnavailable;
use ::speech_engines::vad::SegmenterOptions;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use whichone_tests::spoken::second_model;

/// Every how many sentences of the main corpus one is heard, in one voice.
const EVERY: usize = 3;
/// From the voice until when a second opinion is waited for: the shipped open pause.
const PATIENCE: Duration = Duration::from_millis(960);

/// Adds the delays of the first recogniser and, with a model, of both.
pub(super) fn measure(report: &mut Report, voices: &Voices) -> Result<(), RecogniserUnavailable> {
    let corpus = Corpus::main();
    let mut rows = Vec::new();
    for with_second in [false, true] {
        if with_second && second_model().is_none() {
            continue;
        }
        let before_mib = own_memory_mib();
        let mut ears = Ears::open_with(&corpus, with_second.then(second_model).flatten())?;
        let name = if with_second { "both" } else { "the first alone" };
        // The first utterances wait for the model.
        hear(&mut ears, &corpus, voices, 10 * EVERY, Duration::from_secs(60));
        let memory = format!("{:.0}", own_memory_mib() - before_mib);
        for (machine, is_busy) in [("idle", false), ("busy", true)] {
            let heard =
                among_busy_loops(is_busy, || hear(&mut ears, &corpus, voices, EVERY, PATIENCE));
            rows.push(row([name, machine], &heard, &memory));
        }
    }
    let heads = [
        "recognisers",
        "machine",
        "utterances",
        "voice's end to result, ms, p50",
        "p95",
        "second asked",
        "then to result, ms, p50",
        "p95",
        "within the closing pause",
        "too late",
        "memory, MiB",
    ];
    let note = "Decoding begins 32 ms behind the detected end of the voice. Busy: one endless loop for each \
                processor beside it. Too late: after the open pause, so that the first recogniser's \
                opinion counted. Memory: what the process grew by, by then.";
    report.table("Spoken input, delays", note, heads, rows);
    Ok(())
}

/// One utterance: seconds from the voice's end to the result, whether the second recogniser was asked
/// and whether it was late.
struct Delay {
    s: f64,
    asked: bool,
    late: bool,
}

fn hear(
    ears: &mut Ears,
    corpus: &Corpus,
    voices: &Voices,
    every: usize,
    patience: Duration,
) -> Vec<Delay> {
    let early_s = SegmenterOptions::default().early_roll_s;
    let mut delays = Vec::new();
    for n in (0..corpus.sentences.len()).step_by(every) {
        let clip = corpus.clip(voices, n, n % corpus.voices.len(), &QUIET);
        let listener = &mut ears.listeners[corpus.sentences[n].scene];
        listener.patience = patience.saturating_sub(Duration::from_secs_f64(early_s));
        if let Some(heard) = listener.hear(&clip).last() {
            let late_s = heard.speech.end as f64 - clip.speech.end as f64;
            let end_s = late_s / f64::from(::speech_engines::audio::RATE_HZ);
            let s = end_s + early_s + heard.took_s.0;
            delays.push(Delay { s, asked: heard.asked, late: heard.late });
        }
    }
    delays
}

fn row(names: [&str; 2], heard: &[Delay], memory: &str) -> Vec<String> {
    let closing_s = SegmenterOptions::default().closing_pause_s;
    let ms = |of: &dyn Fn(&&Delay) -> bool| -> Vec<f64> {
        heard.iter().filter(of).map(|delay| delay.s * 1e3).collect()
    };
    let (all, asked) = (ms(&|_| true), ms(&|delay| delay.asked));
    let at = |of: &[f64], share| match of.is_empty() {
        true => String::new(),
        false => format!("{:.0}", percentile(of, share)),
    };
    let share = |part: usize, of: usize| match of {
        0 => String::new(),
        of => format!("{:.0} %", 100.0 * part as f64 / of as f64),
    };
    let in_time = asked.iter().filter(|ms| **ms <= closing_s * 1e3).count();
    let late = heard.iter().filter(|delay| delay.late).count();
    let mut row: Vec<String> = names.map(str::to_owned).into();
    row.extend([heard.len().to_string(), at(&all, 0.5), at(&all, 0.95)]);
    row.extend([share(asked.len(), heard.len()), at(&asked, 0.5), at(&asked, 0.95)]);
    row.extend([share(in_time, asked.len()), share(late, asked.len()), memory.to_owned()]);
    row
}

/// Does something, beside a busy loop for each processor or not.
fn among_busy_loops<T>(is_busy: bool, work: impl FnOnce() -> T) -> T {
    let done = AtomicBool::new(!is_busy);
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..processors {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let result = work();
        done.store(true, Ordering::Relaxed);
        result
    })
}

fn own_memory_mib() -> f64 {
    resident_mib(std::process::id() as i32).unwrap_or(f64::NAN)
}
