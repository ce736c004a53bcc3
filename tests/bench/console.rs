//! Many pages at one console while dialogues run: its memory over time, what it sends, how old the
//! joints are when they arrive, and how soon the robot answers.

use crate::options::Options;
use crate::peers::resident_mib;
use crate::report::{Report, percentile};
use serde_json::{Value as Json, json};
use service::clock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use whichone_tests::Group;
use whichone_tests::console::{Page, Visitor};

/// Interval between two readings of the memory.
const SAMPLE_EVERY: Duration = Duration::from_secs(5);
/// The bowls that are asked for, in turn.
const BOWLS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];

/// Ends the looking on, also where a dialogue has failed.
struct Ends<'a>(&'a AtomicBool);

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Counts of one page.
#[derive(Default)]
struct Counted {
    frames: u64,
    joints_ms: Vec<f64>,
}

pub(crate) fn measure(report: &mut Report, options: &Options) {
    let short = options.quick || options.wants_all();
    let minutes = options.minutes.unwrap_or(if short { 1 } else { 10 });
    let length = Duration::from_secs(60 * minutes);
    let voice = ["speech.voice=auto", "speech.player=[\"none\"]", "arm.time_scale=20.0"];
    let group = Group::up(&voice);
    let over = AtomicBool::new(false);
    let mut operator = group.page(&Visitor::operator(1));
    let pages: Vec<Page> = (1..options.viewers)
        .map(|n| group.page(&Visitor { role: "viewer", ..Visitor::operator(1 + n as u32) }))
        .collect();
    let (counted, memory, dialogues) = std::thread::scope(|scope| {
        let over = &over;
        let pages: Vec<_> =
            pages.into_iter().map(|page| scope.spawn(move || look_on(page, over))).collect();
        let memory = scope.spawn(|| watch_memory(&group, over));
        let ends = Ends(over);
        let dialogues = converse(&mut operator, length);
        drop(ends);
        let counted: Vec<Counted> =
            pages.into_iter().map(|page| page.join().expect("a page looks to the end")).collect();
        (counted, memory.join().expect("memory is watched"), dialogues)
    });
    let viewers = options.viewers;
    let note = format!("{viewers} pages, {minutes} min, {dialogues} dialogues");
    report.add("console: memory with all pages open", "MiB", &memory, &note);
    let half = memory.len() / 2;
    let drift = percentile(&memory[half..], 0.5) - percentile(&memory[..half.max(1)], 0.5);
    report.add("console: memory, second half less first", "MiB", &[drift], "flat: near 0");
    let ages: Vec<f64> = counted.iter().flat_map(|page| page.joints_ms.iter().copied()).collect();
    report.add("console: age of joints at a page", "ms", &ages, "from the arm's own time");
    let frames: Vec<f64> =
        counted.iter().map(|page| page.frames as f64 / length.as_secs_f64()).collect();
    report.add("console: frames a second to each page", "1/s", &frames, "");
    answers(report, &operator.parts["latency"]);
    drop(operator);
    group.down();
}

/// Asks for one object after another.
fn converse(operator: &mut Page, length: Duration) -> usize {
    let began = Instant::now();
    let mut dialogues = 0;
    while began.elapsed() < length {
        let object = BOWLS[dialogues % BOWLS.len()];
        let said = operator.ask("say", &json!({ "text": "get me the bowl" }));
        let seq = said["seq"].as_u64();
        operator.until_part("dialogue", |dialogue| dialogue["applied"].as_u64() >= seq);
        let last = operator.converse(object);
        assert_eq!(last["object"], object, "{last}");
        operator.messages.clear();
        operator.lines.clear();
        dialogues += 1;
    }
    dialogues
}

fn look_on(mut page: Page, over: &AtomicBool) -> Counted {
    let mut counted = Counted::default();
    while !over.load(Ordering::Relaxed) {
        page.look();
        assert!(page.closed.is_none(), "a page was shut out: {:?}", page.closed);
        let now_ms = clock::now().ns() as f64 / 1e6;
        for message in page.messages.drain(..) {
            if let (Some("joints"), Some(at)) = (message["t"].as_str(), message["at_ms"].as_f64()) {
                counted.joints_ms.push(now_ms - at);
            }
        }
        page.lines.clear();
    }
    counted.frames = page.frames;
    counted
}

/// Resident memory of the console, MiB, until it is over.
fn watch_memory(group: &Group, over: &AtomicBool) -> Vec<f64> {
    let pid = group.pid("console").as_raw_nonzero().get();
    let mut memory = Vec::new();
    let mut next = Instant::now();
    while !over.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(100));
        if Instant::now() < next {
            continue;
        }
        next += SAMPLE_EVERY;
        memory.extend(resident_mib(pid));
    }
    memory
}

/// Response times of the robot, as the console reports them.
fn answers(report: &mut Report, latency: &Json) {
    let stages = ["heard_ms", "understood_ms", "decided_ms", "spoken_ms", "total_ms"];
    let row = |which: &str| {
        let cells = stages.iter().map(|stage| latency[which][stage].to_string());
        std::iter::once(which.to_owned()).chain(cells).collect()
    };
    let note = format!("Reported by the console over the latest 500 of {}.", latency["count"]);
    let title = "End of a typed utterance to the first sound, milliseconds";
    let heads = ["", "text", "meaning", "decision", "sound", "all"];
    report.table(title, note, heads, vec![row("p50"), row("p99")]);
}
