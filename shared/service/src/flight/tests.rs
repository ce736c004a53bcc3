//! A small reducer through recorder and replay, and the recorder when space is short.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use config::Settings;
use messages::Service;
use tempfile::TempDir;

use super::reader::Flight;
use super::{Beginning, Entry, Head, Report, Ring, Tap, head, list, pack, replay};
use crate::bus::PortError;
use crate::exit::Failure;
use crate::lifecycle::Environment;
use crate::service_loop::{Context, Program, Shell};
use crate::{Effects, Event, Node, NodeError, Time};

/// The number that the reducer panics at.
const UNLUCKY: u32 = 13;

/// Reducer that adds its inputs, journals each sum, and publishes the durable ones.
struct Sum {
    sum: u64,
    durable: u64,
}

impl Node for Sum {
    type Config = ();
    type In<'a> = u32;
    type Out = u64;
    type Record = u64;

    fn recover((): (), records: Vec<u64>) -> Result<Self, NodeError> {
        let sum = records.last().copied().unwrap_or(0);
        Ok(Self { sum, durable: sum })
    }

    fn on(&mut self, event: Event<u32>, _: Time, fx: &mut Effects<u64, u64>) {
        if let Event::Message(number) = event {
            assert_ne!(number, UNLUCKY, "unlucky");
            self.sum += u64::from(number);
            fx.append(self.sum);
        }
        fx.publish(self.durable);
    }

    fn on_durable(&mut self) {
        self.durable = self.sum;
    }

    fn deadline(&self) -> Option<Time> {
        None
    }

    fn checkpoint(&self) -> Option<Vec<u8>> {
        postcard::to_stdvec(&(self.sum, self.durable)).ok()
    }

    fn resume((): (), checkpoint: &[u8]) -> Result<Self, NodeError> {
        let (sum, durable) =
            postcard::from_bytes(checkpoint).map_err(|_| NodeError::foreign_checkpoint())?;
        Ok(Self { sum, durable })
    }
}

struct NoShell;

impl Shell<Sum> for NoShell {
    fn open(_: &Context<'_, u32>) -> Result<Self, Failure> {
        Ok(Self)
    }

    fn drain(&mut self, _: &mut dyn FnMut(u32)) -> Result<(), PortError> {
        Ok(())
    }

    fn publish(&mut self, _: u64) -> Result<(), PortError> {
        Ok(())
    }
}

struct SumProgram;

impl Program for SumProgram {
    const SERVICE: Service = Service::Policy;
    const RECORD: Option<&'static str> = Some("sum/1");
    const ABOUT: &'static str = "adds up";
    type Node = Sum;
    type Shell = NoShell;

    fn config(_: &Environment, _: &Settings) -> Result<(), Failure> {
        Ok(())
    }
}

fn settings() -> Settings {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    Settings::load(&config, None, &[]).unwrap()
}

fn ring(folder: &Path) -> Ring {
    Ring { folder: folder.to_owned(), bytes_max: 1 << 30, free_min: 0 }
}

fn start(ring: Ring, started_wall_ns: u64, records: &[u64]) -> Tap {
    let environment = Environment::nowhere();
    let head = Head::of::<SumProgram>(&environment, &settings(), Time(5), started_wall_ns);
    Tap::start(ring, &head, records)
}

/// Records the reducer from 100 on with these numbers; due ones are durable after every other.
fn record(folder: &Path, numbers: &[u32]) -> PathBuf {
    let mut tap = start(ring(folder), 1, &[60, 100]);
    let mut node = Sum::recover((), vec![60, 100]).unwrap();
    for (i, number) in numbers.iter().enumerate() {
        let (event, mut effects) = (Event::Message(*number), Effects::default());
        let now = Time(10 + i as u64);
        tap.event(&event, now);
        let went = catch_unwind(AssertUnwindSafe(|| node.on(event, now, &mut effects)));
        if went.is_err() {
            break;
        }
        tap.stated(&effects);
        if i % 2 == 1 {
            node.on_durable();
            tap.durable();
        }
        tap.end_pass();
    }
    drop(tap);
    list(folder).unwrap().pop().unwrap()
}

fn replayed(file: &Path) -> Report {
    replay::<SumProgram>(file, &[]).unwrap()
}

#[test]
fn reducer_is_replayed_from_its_journal_on_with_what_was_durable() {
    let folder = tempfile::tempdir().unwrap();
    let file = record(folder.path(), &[1, 2, 3, 4, 5]);
    let report = replayed(&file);
    assert_eq!((report.difference, report.passes, report.events), (None, 5, 5));
    assert_eq!(head(&file).unwrap().record.as_deref(), Some("sum/1"));
    let bytes = fs::metadata(&file).unwrap().len();
    pack(&file).unwrap();
    assert!(fs::metadata(&file).unwrap().len() < bytes);
    assert_eq!(replayed(&file).passes, 5);
}

#[test]
fn passes_in_which_only_time_passed_are_written_with_the_next_or_after_half_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let mut tap = start(ring(folder.path()), 1, &[]);
    let mut node = Sum::recover((), Vec::new()).unwrap();
    let mut pass = |ms: u64, event: Event<u32>| {
        let (now, mut effects) = (Time(ms * 1_000_000), Effects::default());
        tap.event(&event, now);
        node.on(event, now, &mut effects);
        tap.stated(&effects);
        tap.end_pass();
        tap.handed_over()
    };
    let ticks = [100, 200, 300].map(|ms| pass(ms, Event::Tick));
    assert_eq!(ticks, [1; 3], "the beginning alone");
    assert_eq!(pass(350, Event::Message(1)), 2);
    assert_eq!(pass(400, Event::Tick), 2);
    assert_eq!(pass(899, Event::Tick), 2);
    assert_eq!(pass(900, Event::Tick), 3);
    assert_eq!(pass(1000, Event::Tick), 3);
    drop(tap);
    let report = replayed(&list(folder.path()).unwrap()[0]);
    assert_eq!((report.difference, report.passes), (None, 8));
}

#[test]
fn long_flight_goes_on_in_another_file_that_begins_with_the_state() {
    let folder = tempfile::tempdir().unwrap();
    let small = Ring { bytes_max: 2 << 20, ..ring(folder.path()) };
    let mut tap = start(small, 1_000_000, &[]);
    let mut node = Sum::recover((), Vec::new()).unwrap();
    let mut files = 1;
    for i in 0..400_000_u64 {
        let number = 14 + (i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as u32;
        let (event, mut effects) = (Event::Message(number), Effects::default());
        let now = Time(1_000 + i);
        tap.event(&event, now);
        node.on(event, now, &mut effects);
        tap.stated(&effects);
        tap.end_pass();
        if tap.wants_checkpoint() {
            files += 1;
            tap.go_on(&node.checkpoint().unwrap(), now, files * 1_000_000);
        }
        assert!(tap.is_on());
        if files > 8 {
            break;
        }
        wait_for_writer(&tap);
    }
    drop(tap);
    assert!(files > 8, "{files}");
    assert!(sizes(&folder).iter().sum::<u64>() <= 2 << 20, "{:?}", sizes(&folder));
    let flights = list(folder.path()).unwrap();
    assert!((2..9).contains(&flights.len()), "{flights:?}");
    let mut passes = 0;
    for file in &flights {
        let report = replayed(file);
        assert_eq!(report.difference, None);
        passes += report.passes;
    }
    assert!(passes > 10_000, "{passes}");
}

#[test]
fn event_at_which_the_reducer_panics_is_in_the_flight() {
    let folder = tempfile::tempdir().unwrap();
    let report = replayed(&record(folder.path(), &[1, 2, UNLUCKY, 3]));
    let difference = report.difference.unwrap();
    assert_eq!((report.passes, report.events, difference.path.as_str()), (2, 3, "panic"));
    assert!(difference.recomputed.as_str().unwrap().contains("unlucky"), "{difference:?}");
    assert_eq!(difference.before.last().unwrap()["event"]["Message"], UNLUCKY);
}

/// Numbers that do not compress.
fn noise(seed: u64, count: usize) -> Vec<u64> {
    let mut random = vocabulary::Rng::new(seed);
    (0..count).map(|_| random.below(usize::MAX) as u64).collect()
}

/// A real loop has pauses, in which the writer catches up.
fn wait_for_writer(tap: &Tap) {
    while tap.waiting() > 100 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
}

/// Gives the tap passes of 64 KiB until the recording ends, or `passes`.
fn fill(tap: &mut Tap, passes: u64) {
    for pass in 0..passes {
        let event: Event<Vec<u64>> = Event::Message(noise(pass, 8192));
        tap.event(&event, Time(pass));
        tap.stated(&Effects::<(), ()>::default());
        tap.end_pass();
        if !tap.is_on() {
            return;
        }
        wait_for_writer(tap);
    }
}

fn sizes(folder: &TempDir) -> Vec<u64> {
    list(folder.path()).unwrap().iter().map(|file| fs::metadata(file).unwrap().len()).collect()
}

#[test]
fn oldest_flights_give_way_and_a_long_one_ends_at_the_limit() {
    let folder = tempfile::tempdir().unwrap();
    let small = Ring { bytes_max: 4 << 20, ..ring(folder.path()) };
    let other = folder.path().join("speech-0000000000001.flight");
    fs::write(&other, vec![0; 3 << 20]).unwrap();
    for start_number in 1..=3 {
        let mut tap = start(small.clone(), start_number * 1_000_000, &[]);
        fill(&mut tap, 20);
        assert!(tap.is_on());
        drop(tap);
        let own: u64 = sizes(&folder).iter().sum::<u64>() - (3 << 20);
        assert!(own <= 4 << 20, "{own}");
    }
    assert!(other.exists(), "another service's");
    let names: Vec<PathBuf> = list(folder.path()).unwrap();
    assert!(names.len() < 4 && names[0].ends_with("policy-0000000000002.flight"), "{names:?}");

    let mut tap = start(small, 4_000_000, &[]);
    fill(&mut tap, 2_000);
    assert!(!tap.is_on());
    drop(tap);
    let own: u64 = sizes(&folder).iter().sum::<u64>() - (3 << 20);
    assert!((2 << 20..=4 << 20).contains(&own), "{own}");
    // Everything recorded before is whole.
    let last = list(folder.path()).unwrap().remove(0);
    let mut flight = Flight::open(&last).unwrap();
    assert_eq!(flight.first::<Head>().unwrap().started_wall_ns, 4_000_000);
    let beginning = flight.first::<Beginning<Vec<u64>, Vec<u8>>>().unwrap();
    assert_eq!(beginning, Beginning::Journal(Vec::new()));
    let mut events = 0;
    while let Some((entry, _)) = flight.next::<Entry<Event<Vec<u64>>, Effects<(), ()>>>().unwrap() {
        if let Entry::Event(at, Event::Message(numbers)) = entry {
            assert_eq!((at, numbers), (Time(events), noise(events, 8192)));
            events += 1;
        }
    }
    assert!(events > 30 && !flight.is_torn, "{events}");
}

#[test]
fn service_does_without_a_recording_where_there_is_no_space() {
    let folder = tempfile::tempdir().unwrap();
    let full = Ring { free_min: u64::MAX, ..ring(folder.path()) };
    let nowhere = Ring { folder: PathBuf::from("/dev/null/flight"), ..ring(folder.path()) };
    for ring in [full, nowhere] {
        let mut tap = start(ring, 1, &[]);
        // Its thread finds out.
        while tap.is_on() {
            fill(&mut tap, 1);
        }
        drop(tap);
        assert!(sizes(&folder).is_empty());
    }
}
