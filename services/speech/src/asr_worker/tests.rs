use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

use speech_engines::audio::write_wav;
use speech_engines::recogniser::{RecogniseError, Recognition};
use speech_engines::testing::{self, bowls};

use super::*;
use crate::{Hypothesis, Recognised, RecognisedSegment};

const PATIENCE: Duration = Duration::from_secs(20);

/// Reports each call with its number of samples, waits for permission if it has to, and recognises
/// "white" in long segments, else "zebra".
struct Stub {
    calls: Sender<usize>,
    permission: Option<Receiver<()>>,
    is_quick: bool,
    fails: bool,
}

impl Recogniser for Stub {
    fn recognise(&mut self, pcm: &[i16], _: Range<usize>) -> Recognition {
        // A test that does not count calls has dropped the other end.
        let _ = self.calls.send(pcm.len());
        if let Some(permission) = &self.permission {
            permission.recv_timeout(PATIENCE).unwrap();
        }
        if self.fails {
            return Err(RecogniseError("no model".to_owned()));
        }
        let word = if pcm.len() > 16_000 || self.permission.is_some() { "white" } else { "zebra" };
        Ok(vec![Hypothesis::certain(word)].into())
    }

    fn is_quick(&self) -> bool {
        self.is_quick
    }
}

fn worker(
    open: impl FnOnce() -> Result<Opened, String> + Send + 'static,
) -> (AsrWorker, Receiver<In<'static>>) {
    worker_within(PATIENCE, open)
}

fn worker_within(
    patience: Duration,
    open: impl FnOnce() -> Result<Opened, String> + Send + 'static,
) -> (AsrWorker, Receiver<In<'static>>) {
    let segmenter = SegmenterOptions::default();
    let limits = Limits { segmenter, longest_s: 10.0, patience };
    let (worker, events) = AsrWorker::with(move |_, _| open(), limits);
    assert_eq!(next(&events), In::RecogniserState(EarState::Loading));
    (worker, events)
}

fn gate() -> Gate {
    Gate::new(&bowls(), Gate::THRESHOLD)
}

fn alone(stub: impl Recogniser + 'static) -> Opened {
    let unpronounceable = vec!["qwz".to_owned()];
    Opened { first: Box::new(stub), second: None, unpronounceable, gate: gate() }
}

fn ready(fails: bool) -> (AsrWorker, Receiver<In<'static>>) {
    let stub = Stub { calls: unbounded().0, permission: None, is_quick: false, fails };
    let (worker, events) = worker(move || Ok(alone(stub)));
    assert_eq!(next(&events), In::RecogniserState(EarState::Ready));
    (worker, events)
}

fn next(events: &Receiver<In<'static>>) -> In<'static> {
    events.recv_timeout(PATIENCE).expect("an event in time")
}

fn result(events: &Receiver<In<'static>>) -> Recognised {
    match next(events) {
        In::Recognised(recognised) => recognised,
        event => panic!("expected a result, found {event:?}"),
    }
}

fn file(path: &Path) -> RecognitionInput {
    RecognitionInput::File(path.display().to_string())
}

fn text(segment: &RecognisedSegment) -> &str {
    match &segment.hypotheses {
        Ok(hypotheses) => &hypotheses[0].text,
        Err(rejected) => &rejected.text,
    }
}

#[test]
fn asr_worker_recognises_the_segments_of_a_file_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let quiet = vec![0; 16_000];
    let (long, short) = (testing::voice(1.0), testing::voice(0.3));
    write_wav(&path, &[&quiet[..], &long, &quiet, &short].concat()).unwrap();
    let (worker, events) = ready(false);
    worker.submit(5, file(&path)).unwrap();
    write_wav(&folder.path().join("quiet.wav"), &[0; 32_000]).unwrap();
    worker.submit(6, file(&folder.path().join("quiet.wav"))).unwrap();
    let recognised = result(&events);
    let segments = recognised.segments.unwrap();
    let [long, short] = &segments[..] else { panic!("{segments:?}") };
    assert!((long.span_s.0 - 1.0).abs() < 0.2 && (long.span_s.1 - 2.0).abs() < 0.2, "{long:?}");
    assert!(long.hypotheses.is_ok() && short.hypotheses.is_err(), "{segments:?}");
    assert_eq!((recognised.sound, text(long), text(short)), (5, "white", "zebra"));
    assert_eq!(result(&events), Recognised { sound: 6, segments: Ok(Vec::new()) });
}

#[test]
fn asr_worker_recognises_a_segment_of_a_stream_as_a_whole() {
    let (worker, events) = ready(false);
    let samples = [vec![0; 8_000], testing::voice(1.0), vec![0; 8_000]].concat();
    let at = service::Time(0);
    let segment = SpeechSegment { onset: at, end: at, samples, speech: 8_000..24_000 };
    worker.submit(4, RecognitionInput::Speech(segment)).unwrap();
    let segments = result(&events).segments.unwrap();
    let [segment] = &segments[..] else { panic!("{segments:?}") };
    assert_eq!((segment.span_s, text(segment)), ((0.5, 1.5), "white"));
}

mod doubt;

#[test]
fn asr_worker_reports_failures_with_their_reason() {
    let (failing, events) = ready(true);
    failing.submit(1, file(Path::new("/nonexistent/x.wav"))).unwrap();
    assert!(result(&events).segments.unwrap_err().contains("x.wav"));
    failing.submit(2, RecognitionInput::Speech(segment(1_000))).unwrap();
    assert!(result(&events).segments.unwrap_err().contains("failed"));
    let (off, events) = worker(|| Err("install the package libpocketsphinx3".to_owned()));
    assert!(matches!(next(&events), In::RecogniserState(EarState::Off)));
    off.submit(3, RecognitionInput::Speech(segment(1_000))).unwrap();
    let recognised = result(&events);
    assert_eq!(recognised.sound, 3);
    assert!(recognised.segments.unwrap_err().contains("libpocketsphinx3"));
}

#[test]
fn asr_worker_bounds_its_queue_while_the_recogniser_loads() {
    let (go, wait) = bounded::<()>(0);
    let (worker, events) = worker(move || {
        wait.recv().map_err(|e| e.to_string())?;
        let stub = Stub { calls: unbounded().0, permission: None, is_quick: true, fails: false };
        Ok(alone(stub))
    });
    let input = || RecognitionInput::Speech(segment(1_600));
    for sound in 0..WAITING_MAX as u64 {
        worker.submit(sound, input()).unwrap();
    }
    assert_eq!(worker.submit(99, input()), Err(QueueError::Full));
    go.send(()).unwrap();
    assert!(matches!(next(&events), In::RecogniserState(EarState::Ready)));
    for sound in 0..WAITING_MAX as u64 {
        assert_eq!(result(&events).sound, sound);
    }
}

#[test]
fn asr_worker_reports_a_crash_of_its_thread() {
    let (worker, events) = worker(|| panic!("a broken library"));
    while events.recv_timeout(PATIENCE).is_ok() {}
    // The two ends of the thread close one after the other.
    let start = Instant::now();
    while worker.submit(1, RecognitionInput::Speech(segment(1))) != Err(QueueError::Closed) {
        assert!(start.elapsed() < PATIENCE);
        thread::sleep(Duration::from_millis(5));
    }
}

/// Starts a worker whose decoding waits for permission.
fn waiting(is_quick: bool) -> (AsrWorker, Receiver<In<'static>>, Receiver<usize>, Sender<()>) {
    let ((calls, called), (go, permission)) = (unbounded(), unbounded());
    let stub = Stub { calls, permission: Some(permission), is_quick, fails: false };
    let (worker, events) = worker(move || Ok(alone(stub)));
    next(&events);
    (worker, events, called, go)
}

fn segment(len: usize) -> SpeechSegment {
    let at = service::Time(0);
    SpeechSegment { onset: at, end: at, samples: vec![7; len], speech: 0..len }
}

fn submit(worker: &AsrWorker, sound: u64, len: usize) {
    worker.submit(sound, RecognitionInput::Speech(segment(len))).unwrap();
}

#[test]
fn asr_worker_reuses_an_early_result_of_the_very_same_samples() {
    let (worker, events, called, go) = waiting(true);
    worker.decode_early(1, segment(1_000));
    assert_eq!(called.recv_timeout(PATIENCE), Ok(1_000));
    submit(&worker, 1, 1_000);
    go.send(()).unwrap();
    let In::EarlyResult { sound: 1, at, result: Some(early) } = next(&events) else { panic!() };
    assert_eq!((at, text(&early)), (segment(1_000).closing(Duration::ZERO), "white"));
    assert_eq!(result(&events).sound, 1);
    assert!(called.is_empty());
    worker.decode_early(1, segment(1_000));
    submit(&worker, 2, 1_000);
    go.send(()).unwrap();
    assert_eq!(result(&events).sound, 2);
    assert_eq!(called.try_iter().collect::<Vec<_>>(), [1_000], "a late hint is ignored");
    worker.decode_early(3, segment(1_000));
    assert_eq!(called.recv_timeout(PATIENCE), Ok(1_000));
    let mut other = segment(1_000);
    other.samples[500] = 8;
    worker.submit(3, RecognitionInput::Speech(other)).unwrap();
    (0..2).for_each(|_| go.send(()).unwrap());
    assert!(matches!(next(&events), In::EarlyResult { sound: 3, .. }));
    assert_eq!(result(&events).sound, 3);
    assert_eq!(called.try_iter().count(), 1, "one sample differs");
}

#[test]
fn asr_worker_prefers_inputs_to_hints() {
    let (worker, events, called, go) = waiting(true);
    submit(&worker, 1, 1_000);
    assert_eq!(called.recv_timeout(PATIENCE), Ok(1_000));
    worker.decode_early(2, segment(2_000));
    worker.decode_early(2, segment(3_000));
    submit(&worker, 3, 4_000);
    (0..3).for_each(|_| go.send(()).unwrap());
    assert_eq!((result(&events).sound, result(&events).sound), (1, 3));
    assert!(matches!(next(&events), In::EarlyResult { sound: 2, .. }));
    assert_eq!(called.try_iter().collect::<Vec<_>>(), [4_000, 3_000], "the newest hint");
}

#[test]
fn asr_worker_ignores_hints_for_a_slow_recogniser() {
    let (worker, events, called, go) = waiting(false);
    worker.decode_early(1, segment(1_000));
    submit(&worker, 2, 2_000);
    go.send(()).unwrap();
    assert_eq!(result(&events).sound, 2);
    assert_eq!(called.try_iter().collect::<Vec<_>>(), [2_000]);
}

/// A motion stop must not wait for a recording.
#[test]
fn asr_worker_decodes_what_is_said_before_the_rest_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let one = [vec![0; 16_000], testing::voice(1.0)].concat();
    write_wav(&path, &[&one[..], &one, &one].concat()).unwrap();
    let (worker, events, called, go) = waiting(true);
    (0..WAITING_MAX as u64).for_each(|sound| worker.submit(sound, file(&path)).unwrap());
    called.recv_timeout(PATIENCE).unwrap();
    submit(&worker, 99, 1_000);
    (0..3 * WAITING_MAX + 1).for_each(|_| go.send(()).unwrap());
    assert_eq!(result(&events).sound, 99);
    for sound in 0..WAITING_MAX as u64 {
        let recognised = result(&events);
        assert_eq!((recognised.sound, recognised.segments.unwrap().len()), (sound, 3));
    }
}

/// A disk that was full as the service started.
#[test]
fn recogniser_without_room_is_opened_once_there_is_some() {
    let (closed, mut tries) = (AtomicBool::new(false), 0);
    let short = || RecogniserUnavailable::Short("no room".to_owned());
    let opened = with_room(&closed, || {
        tries += 1;
        if tries < 3 { Err(short()) } else { Ok(tries) }
    });
    assert_eq!(opened, Ok(3));
    let missing = || RecogniserUnavailable::Missing("no library".to_owned());
    assert_eq!(with_room::<u32>(&closed, || Err(missing())), Err("no library".to_owned()));
    closed.store(true, Ordering::SeqCst);
    assert_eq!(with_room::<u32>(&closed, || Err(short())), Err("no room".to_owned()));
}
