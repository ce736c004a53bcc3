//! The rules of the contract that hold for every service.

use std::time::{Duration, Instant};

use messages::{Epoch, Topic, topics};
use service::exit::{Exit, ProcessExit};

use super::bench::EPOCH;
use super::subject::WATCHDOG;
use super::{Broken, Kept, Test};

/// Beats are observed for this long beyond the longest time between two.
const BEAT_MARGIN: Duration = Duration::from_millis(500);
/// Time for a service to notice messages that mean nothing.
const NOTICE: Duration = Duration::from_millis(400);
/// Payload larger than any of a client.
const OVERSIZED_BYTES: usize = 1 << 20;

/// The service becomes ready.
pub(super) fn ready(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let took = test.running()?.ready.unwrap_or_default();
    Ok(Kept::Fact(format!("{} ms after its start", took.as_millis())))
}

/// The service sends heartbeats.
pub(super) fn beats(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let observed = WATCHDOG + BEAT_MARGIN;
    let subject = test.running()?;
    let began = Instant::now();
    subject.beats.clear();
    let has_ended = |subject: &mut super::subject::Subject| subject.exit().is_some();
    if subject.wait(observed, has_ended) {
        return Err(test.died("while nothing happened"));
    }
    let until = Instant::now();
    let times = std::iter::once(began).chain(test.running()?.beats.iter().copied());
    let times: Vec<Instant> = times.chain([until]).collect();
    let gaps = times.windows(2).map(|pair| pair[1].duration_since(pair[0]));
    let longest = gaps.max().unwrap_or_default();
    if longest > WATCHDOG {
        let what = format!("expected WATCHDOG=1 at least every {} s", WATCHDOG.as_secs());
        let found = if times.len() == 2 { "none".to_owned() } else { seconds(longest) };
        let help =
            "send WATCHDOG=1 to $NOTIFY_SOCKET from the main loop, three times in $WATCHDOG_USEC";
        return Err(Broken::new(format!("{what}, found {found}"), help));
    }
    Ok(Kept::Fact(format!(
        "{} in {}, at most {} apart",
        times.len() - 2,
        seconds(observed),
        seconds(longest)
    )))
}

/// Messages carry the epoch of the group and the number of the service's start.
pub(super) fn identity(test: &mut Test<'_>) -> Result<Kept, Broken> {
    test.exercise()?;
    let incarnation = test.running()?.incarnation;
    test.note_written()?;
    let own: Vec<_> = test.written.iter().filter(|one| test.is_of_service(&one.topic)).collect();
    for one in &own {
        let name = one.topic.name;
        let (what, expected, found) = if one.epoch != EPOCH {
            ("epoch", EPOCH.0, one.epoch.0)
        } else if one.incarnation != incarnation {
            ("incarnation", incarnation.into(), one.incarnation.into())
        } else {
            continue;
        };
        let variable = if what == "epoch" { "WHICHONE_EPOCH" } else { "WHICHONE_INCARNATION" };
        return Err(Broken::new(
            format!("{name}: expected messages of {what} {expected}, found {found}"),
            format!("stamp every message with ${variable}; readers drop all others"),
        ));
    }
    match own.len() {
        0 => Ok(Kept::NotApplicable("it has written nothing".to_owned())),
        _ => Ok(Kept::Fact(format!(
            "{} of incarnation {incarnation}",
            scene::count(own.len(), "message")
        ))),
    }
}

/// The service writes only its own topics, and those of clients that its kind takes part in.
pub(super) fn own_topics(test: &mut Test<'_>) -> Result<Kept, Broken> {
    test.exercise()?;
    test.note_written()?;
    let foreign = test.written.iter().find(|one| !test.may_write(&one.topic));
    if let Some(one) = foreign {
        let writer = one.topic.writer.map_or("clients", |writer| writer.name());
        let service = test.bench.service.name();
        let what = format!("it has written to {}, a topic of {writer}", one.topic.name);
        let help = format!(
            "{service} acts by its own topics alone; name others in `writes` of [services.{service}]"
        );
        return Err(Broken::new(what, help));
    }
    Ok(Kept::Fact(scene::count(test.written.len(), "message")))
}

/// Messages that make no sense, and those of another epoch, neither end nor stop it.
pub(super) fn malformed(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let read = test.read_topics();
    if read.is_empty() {
        return Ok(Kept::NotApplicable("it reads no topic that it is known for".to_owned()));
    }
    let mut sent = 0;
    for topic in &read {
        let junk = junk(topic);
        for epoch in [EPOCH, Epoch(EPOCH.0 + 1)] {
            test.running()?;
            test.inject(topic, epoch, &junk)?;
            sent += junk.len();
        }
    }
    test.survives("after messages that make no sense", NOTICE)?;
    test.beats_again("after messages that make no sense")?;
    Ok(Kept::Fact(format!(
        "{} on {}",
        scene::count(sent, "message"),
        scene::count(read.len(), "topic")
    )))
}

/// Returns bytes that are not a message of the topic.
fn junk(topic: &Topic) -> Vec<(&'static str, Vec<u8>)> {
    let layout = (topic.layout)();
    let len = layout.map_or(64, |layout| layout.size);
    let mut noise = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = |_| {
        noise ^= noise << 13;
        noise ^= noise >> 7;
        noise ^= noise << 17;
        noise.to_le_bytes()[0]
    };
    let mut junk = vec![
        ("invalid codes and counts", vec![u8::MAX; len]),
        ("random bytes", (0..len).map(&mut random).collect()),
        ("random bytes again", (0..len).map(&mut random).collect()),
    ];
    if layout.is_none() {
        junk.push(("an empty payload", Vec::new()));
        junk.push(("an oversized payload", (0..OVERSIZED_BYTES).map(random).collect()));
    }
    junk
}

/// The service ends cleanly on request.
pub(super) fn stop(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let patience = test.stop_deadline();
    let subject = test.running()?;
    let asked = Instant::now();
    subject.terminate();
    let exit = subject.await_exit(patience);
    let took = asked.elapsed();
    test.forget();
    ended_cleanly(exit, patience, took, "SIGTERM")
}

/// The service ends when its supervisor is gone.
pub(super) fn orphan(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let patience = test.stop_deadline();
    test.running()?;
    let cut = Instant::now();
    test.bench.end_lifeline();
    let exit = test.running()?.await_exit(patience);
    let took = cut.elapsed();
    test.forget();
    ended_cleanly(exit, patience, took, "the end of file of $WHICHONE_LIFELINE_FD")
}

fn ended_cleanly(
    exit: Option<ProcessExit>,
    patience: Duration,
    took: Duration,
    signal: &str,
) -> Result<Kept, Broken> {
    match exit {
        Some(exit) if exit.is_clean() => {
            Ok(Kept::Fact(format!("{} ms after {signal}", took.as_millis())))
        }
        Some(exit) => {
            let help = "finish what is under way, then exit with code 0";
            Err(Broken::new(format!("expected exit 0 after {signal}, found {exit}"), help))
        }
        None => {
            let what = format!("expected its end within {} s of {signal}", patience.as_secs_f64());
            let help = format!("handle {signal} in the main loop: finish, exit with code 0");
            Err(Broken::new(format!("{what}, found it running"), help))
        }
    }
}

/// A process that was killed starts again, becomes ready, and beats.
pub(super) fn restart(test: &mut Test<'_>) -> Result<Kept, Broken> {
    test.running()?.kill();
    test.forget();
    let began = Instant::now();
    let incarnation = test.running()?.incarnation;
    test.beats_again("after a restart")?;
    let took = began.elapsed();
    Ok(Kept::Fact(format!("incarnation {incarnation}, {} ms", took.as_millis())))
}

/// A time in seconds with one decimal.
pub(super) fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

/// Topics that a service reads by the table.
pub(super) fn table_reads(service: messages::Service) -> impl Iterator<Item = Topic> {
    let all = topics::ALL.into_iter().chain(topics::robot::ALL);
    all.filter(move |topic| topic.readers.contains(&service))
}

/// Help for a process that has ended on its own.
pub(super) fn of_exit(exit: ProcessExit) -> &'static str {
    match exit {
        ProcessExit::Code(code) if code == Exit::Config as i32 => {
            "its configuration or the schema of its messages does not fit: build it with this version"
        }
        ProcessExit::Code(code) if code == Exit::Usage as i32 => "its arguments are wrong",
        ProcessExit::Signal(_) => "it was killed by a signal: see its log",
        _ => "see its log",
    }
}
