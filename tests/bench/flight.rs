//! Cost of the flight recorder: what a pass of the policy takes with it, latencies with and without it, and
//! the size of flights.

use crate::latency::Taps;
use crate::report::Report;
use config::Settings;
use dialogue::manager::Record;
use messages::{Interpretation, MessageRef, Observation, WireReading};
use policy::shell::PolicyProgram;
use policy::{In, PolicyNode};
use scene::{Intent, Reading};
use service::flight::{Head, Ring, Tap, list};
use service::lifecycle::Environment;
use service::service_loop::Program;
use service::{Effects, Event, Node, Time};
use std::path::Path;
use std::time::{Duration, Instant};
use whichone_tests::{Group, settings};

/// Passes of the policy.
const PASSES: u64 = 4_000;
/// Utterances with flights, and as many without.
const UTTERANCES: usize = 200;
/// Rounds in which both are measured in turn, so that a machine that gets busier disturbs both.
const ROUNDS: usize = 4;
const PASS: &str = "policy's pass for an utterance, without disk and topics";
const WITHOUT: &str = "utterance in to decision out without flights";

pub(crate) fn measure(report: &mut Report, quick: bool) {
    let share = if quick { 4 } else { 1 };
    passes(report, PASSES / share);
    latencies(report, UTTERANCES / share as usize);
    sizes(report, quick);
}

/// Time of the main loop: of the reducer, and of its recording in the same passes.
fn passes(report: &mut Report, passes: u64) {
    let settings = settings(&[]);
    let folder = tempfile::tempdir().expect("a folder");
    let environment = Environment::nowhere();
    let head = Head::of::<PolicyProgram>(&environment, &settings, Time(1), 1);
    let ring = Ring { folder: folder.path().to_owned(), bytes_max: 1 << 30, free_min: 0 };
    let mut tap = Tap::start(ring, &head, &[] as &[Record]);
    let config =
        PolicyProgram::config(&environment, &settings).expect("the policy's configuration");
    let mut node = PolicyNode::recover(config, Vec::new()).expect("a first start");
    let (mut reducer_us, mut tap_us) = (Vec::new(), Vec::new());
    for seq in 1..=passes {
        let observation = observation(&settings, seq);
        let event = Event::Message(In::Observation(MessageRef::from(&observation)));
        let (now, mut effects) = (Time(seq << 30), Effects::default());
        let begun = Instant::now();
        tap.event(&event, now);
        let encoded = begun.elapsed();
        node.on(event, now, &mut effects);
        let decided = begun.elapsed();
        tap.stated(&effects);
        tap.durable();
        tap.end_pass();
        let ended = begun.elapsed();
        reducer_us.push((decided - encoded).as_secs_f64() * 1e6);
        tap_us.push((encoded + (ended - decided)).as_secs_f64() * 1e6);
    }
    assert!(tap.is_on(), "the recording has ended");
    drop(tap);
    report.add(PASS, "µs", &reducer_us, "");
    report.add_beside("its recording in the main loop", "µs", &tap_us, PASS, "the same passes");
    let bytes = folder_bytes(folder.path()) as f64 / passes as f64;
    report.add("flight, a pass of the policy for an utterance", "B", &[bytes], "compressed");
}

/// An utterance about a white object, or one that starts over.
fn observation(settings: &Settings, seq: u64) -> Observation {
    let scene = &settings.scene;
    let word = scene.word_named("white").expect("a word of the scene");
    let reading = match seq % 2 {
        1 => Reading { base: vec![word], ..Reading::default() },
        _ => Reading { intent: Intent::Cancel, ..Reading::default() },
    };
    let meant = Interpretation { weight: 1.0, answers: None, reading };
    let scene_key = scene.key();
    let mut observation =
        Observation { seq, scene_key, reading_count: 1, ..Observation::default() };
    observation.readings[0] = WireReading::new(&meant).0;
    observation
}

/// End-to-end latencies of two groups, one of which records flights, in turn.
fn latencies(report: &mut Report, utterances: usize) {
    let groups = ["false", "true"].map(|enabled| {
        let enabled = format!("group.flight.enabled={enabled}");
        let free = "group.flight.free_min_mib=0";
        Group::up(&["dialogue.turns.questions_max=1000", &enabled, free])
    });
    let clients = groups
        .each_ref()
        .map(|group| service::client::Client::join(group.paths()).expect("a running group"));
    let mut taps = clients.each_ref().map(Taps::open);
    let mut samples = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for (taps, samples) in taps.iter_mut().zip(&mut samples) {
            let more = (0..utterances / ROUNDS).map(|n| {
                let moments = taps.utter(n);
                moments[6].saturating_sub(moments[0]) as f64 / 1e6
            });
            samples.extend(more);
        }
    }
    drop(taps);
    drop(clients);
    groups.into_iter().for_each(Group::down);
    let [without, with] = samples;
    report.add(WITHOUT, "ms", &without, "");
    let what = "utterance in to decision out with flights";
    report.add_beside(what, "ms", &with, WITHOUT, "two groups, in turn");
}

/// Growth of the flights in a minute of silence and in a dialogue.
fn sizes(report: &mut Report, quick: bool) {
    for (driver, over) in
        [("", &[][..]), (", Baxter", &["group.services.baxter.nice=0", "arm.driver=baxter"])]
    {
        let mut over = over.to_vec();
        over.extend(["arm.time_scale=1.0", "group.flight.free_min_mib=0"]);
        let group = Group::up(&over);
        let folder = group.paths().flights();
        let watched = Duration::from_secs(if quick { 5 } else { 60 });
        let before = by_service(&folder);
        std::thread::sleep(watched);
        let silent = by_service(&folder);
        group.fetch("get me the bowl", "white2");
        let ended = by_service(&folder);
        for (service, bytes) in &ended {
            let at = |sizes: &[(String, u64)]| {
                sizes.iter().find(|(name, _)| name == service).map_or(0, |(_, bytes)| *bytes)
            };
            let mib_per_hour =
                (at(&silent) - at(&before)) as f64 / f64::from(1 << 20) / watched.as_secs_f64()
                    * 3600.0;
            let what = format!("flight of {service}{driver}");
            report.add(&format!("{what}, idle"), "MiB/h", &[mib_per_hour], "compressed");
            let kib = (bytes - at(&silent)) as f64 / 1024.0;
            report.add(&format!("{what}, a dialogue"), "KiB", &[kib], "compressed");
        }
        group.down();
    }
}

/// Bytes of the flights of each service.
fn by_service(folder: &Path) -> Vec<(String, u64)> {
    let mut sizes: Vec<(String, u64)> = Vec::new();
    for file in list(folder).expect("flights") {
        let bytes = file.metadata().map_or(0, |found| found.len());
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        let service = name.rsplit_once('-').map_or(&*name, |(service, _)| service).to_owned();
        match sizes.iter_mut().find(|(own, _)| *own == service) {
            Some((_, sum)) => *sum += bytes,
            None => sizes.push((service, bytes)),
        }
    }
    sizes
}

fn folder_bytes(folder: &Path) -> u64 {
    by_service(folder).iter().map(|(_, bytes)| bytes).sum()
}
