use std::time::{Duration, Instant};

use super::listener::snr_db;
use super::*;
use crate::devices::recogniser::RecogniseError;
use crate::devices::recogniser::{Hypothesis, RejectReason};
use crate::devices::testing::{self, bowls};
use std::ops::Range;

const PATIENCE: Duration = Duration::from_secs(20);

/// Hears the number of samples of the segment as the scene's words, and fails when told to.
struct Stub {
    fails: bool,
}

impl Recogniser for Stub {
    fn recognise(
        &mut self,
        pcm: &[i16],
        _: Range<usize>,
    ) -> Result<Vec<Hypothesis>, RecogniseError> {
        if self.fails {
            return Err(RecogniseError::Failed);
        }
        let word = if pcm.len() > 16_000 { "white" } else { "zebra" };
        let words = vec![(word.to_owned(), 1.0)];
        Ok(vec![Hypothesis { text: word.to_owned(), confidence: 1.0, words }])
    }
}

fn ear(open: impl FnOnce() -> Opened + Send + 'static) -> (Ear, Receiver<EarEvent>) {
    let gate = Gate::new(&bowls(), Gate::THRESHOLD);
    let (ear, events) = Ear::with(open, gate, SegmenterOptions::default(), 10.0);
    assert_eq!(next(&events), EarEvent::State(EarState::Loading));
    (ear, events)
}

fn stub(fails: bool) -> (Ear, Receiver<EarEvent>) {
    let (ear, events) = ear(move || Ok((Box::new(Stub { fails }), vec!["qwz".to_owned()])));
    let unpronounceable = vec!["qwz".to_owned()];
    assert_eq!(next(&events), EarEvent::State(EarState::Ready { unpronounceable }));
    (ear, events)
}

fn next(events: &Receiver<EarEvent>) -> EarEvent {
    events.recv_timeout(PATIENCE).expect("an event in time")
}

#[test]
fn segments_are_heard_in_order_and_rejected_ones_are_kept() {
    let (ear, events) = stub(false);
    let mut sound = vec![0; 16_000];
    sound.extend(testing::voice(1.0));
    sound.extend(vec![0; 16_000]);
    sound.extend(testing::voice(0.3));
    ear.hear(5, Sound::Samples(sound)).unwrap();
    let EarEvent::Heard { id: 5, segments } = next(&events) else { panic!("heard") };
    let [long, short] = segments.as_slice() else { panic!("{segments:?}") };
    assert!((long.onset_s - 1.0).abs() < 0.2 && (long.end_s - 2.0).abs() < 0.2, "{long:?}");
    assert!(matches!(&long.outcome, Outcome::Accepted(h) if h[0].text == "white"), "{long:?}");
    match &short.outcome {
        Outcome::Rejected { text, reason: RejectReason::NotForTheRobot { .. } } => {
            assert_eq!(text, "zebra");
        }
        outcome => panic!("{outcome:?}"),
    }
}

#[test]
fn an_utterance_of_a_stream_is_decoded_as_it_was_cut() {
    let (ear, events) = stub(false);
    let samples = [vec![0; 8_000], testing::voice(1.0), vec![0; 8_000]].concat();
    let at = service::Time(0);
    let cut = Cut { onset: at, end: at, samples, speech: 8_000..24_000 };
    ear.hear(4, Sound::Speech(cut)).unwrap();
    let EarEvent::Heard { id: 4, segments } = next(&events) else { panic!("heard") };
    let [segment] = segments.as_slice() else { panic!("{segments:?}") };
    assert_eq!((segment.onset_s, segment.end_s), (0.5, 1.5));
    assert!(matches!(&segment.outcome, Outcome::Accepted(h) if h[0].text == "white"));
}

#[test]
fn silence_is_heard_without_segments() {
    let (ear, events) = stub(false);
    ear.hear(1, Sound::Samples(vec![0; 32_000])).unwrap();
    assert_eq!(next(&events), EarEvent::Heard { id: 1, segments: Vec::new() });
}

#[test]
fn what_cannot_be_heard_fails_by_name() {
    let (ear, events) = stub(true);
    ear.hear(1, Sound::File("/nonexistent/x.wav".into())).unwrap();
    ear.hear(2, Sound::Samples(testing::voice(1.0))).unwrap();
    match next(&events) {
        EarEvent::Failed { id: 1, error } => assert!(error.contains("x.wav"), "{error}"),
        event => panic!("{event:?}"),
    }
    match next(&events) {
        EarEvent::Failed { id: 2, error } => assert!(error.contains("failed"), "{error}"),
        event => panic!("{event:?}"),
    }
}

#[test]
fn without_a_recogniser_every_sound_is_answered_with_the_reason() {
    let (ear, events) = ear(|| Err("install the package libpocketsphinx3".to_owned()));
    assert!(matches!(next(&events), EarEvent::State(EarState::Off { .. })));
    ear.hear(3, Sound::Samples(vec![0; 16_000])).unwrap();
    match next(&events) {
        EarEvent::Failed { id: 3, error } => {
            assert!(error.contains("libpocketsphinx3"), "{error}");
        }
        event => panic!("{event:?}"),
    }
}

#[test]
fn waiting_sounds_are_bounded_and_wait_for_the_recogniser() {
    let (go, wait) = bounded::<()>(0);
    let (ear, events) = ear(move || {
        wait.recv().map_err(|e| e.to_string())?;
        Ok((Box::new(Stub { fails: false }), Vec::new()))
    });
    let silence = || Sound::Samples(vec![0; 1_600]);
    for id in 0..SOUNDS_MAX as u64 {
        ear.hear(id, silence()).unwrap();
    }
    assert_eq!(ear.hear(99, silence()), Err(HearError::Busy));
    go.send(()).unwrap();
    assert!(matches!(next(&events), EarEvent::State(EarState::Ready { .. })));
    for id in 0..SOUNDS_MAX as u64 {
        assert_eq!(next(&events), EarEvent::Heard { id, segments: Vec::new() });
    }
}

#[test]
fn a_thread_that_broke_down_is_told() {
    let (ear, events) = ear(|| panic!("a broken library"));
    while events.recv_timeout(PATIENCE).is_ok() {}
    // The thread's two ends close one after the other.
    let start = Instant::now();
    while ear.hear(1, Sound::Samples(Vec::new())) != Err(HearError::Gone) {
        assert!(start.elapsed() < PATIENCE);
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn noise_is_measured_around_the_speech() {
    let noise = |n: usize| if n.is_multiple_of(2) { 100 } else { -100 };
    let mut samples: Vec<i16> = (0..32_000).map(noise).collect();
    let speech = 12_000..20_000;
    for n in speech.clone() {
        samples[n] = if n.is_multiple_of(2) { 1_000 } else { -1_000 };
    }
    // The speech's power is 100 times the noise's, of which 99 are the speech itself.
    let snr = snr_db(&samples, &(4_000..28_000), &speech);
    assert!((snr - 10.0 * 99_f32.log10()).abs() < 0.1, "{snr}");
    assert_eq!(snr_db(&samples, &speech, &speech), 60.0);
    assert_eq!(snr_db(&[0; 1_000], &(0..1_000), &(200..800)), 0.0);
}

/// Tells how often it was asked, and waits for leave each time.
struct Slow {
    asked: Sender<usize>,
    leave: Receiver<()>,
    quick: bool,
}

impl Recogniser for Slow {
    fn recognise(
        &mut self,
        pcm: &[i16],
        _: Range<usize>,
    ) -> Result<Vec<Hypothesis>, RecogniseError> {
        self.asked.send(pcm.len()).unwrap();
        self.leave.recv_timeout(PATIENCE).unwrap();
        let text = format!("white {}", pcm.len());
        Ok(vec![Hypothesis { text, confidence: 1.0, words: Vec::new() }])
    }

    fn is_quick(&self) -> bool {
        self.quick
    }
}

fn slow(quick: bool) -> (Ear, Receiver<EarEvent>, Receiver<usize>, Sender<()>) {
    let ((asked, was_asked), (go, leave)) = (unbounded(), unbounded());
    let (ear, events) =
        ear(move || Ok((Box::new(Slow { asked, leave, quick }) as Box<_>, Vec::new())));
    next(&events);
    (ear, events, was_asked, go)
}

fn cut(len: usize) -> Cut {
    let at = service::Time(0);
    Cut { onset: at, end: at, samples: vec![7; len], speech: 0..len }
}

fn text_of(event: &EarEvent) -> (u64, String) {
    match event {
        EarEvent::SoFar { id, text } => (*id, text.clone()),
        EarEvent::Heard { id, segments } => match &segments[0].outcome {
            Outcome::Accepted(heard) => (*id, heard[0].text.clone()),
            Outcome::Rejected { text, .. } => (*id, text.clone()),
        },
        event => panic!("{event:?}"),
    }
}

#[test]
fn what_was_decoded_in_the_pause_is_not_decoded_again() {
    let (ear, events, asked, go) = slow(true);
    ear.expect(1, cut(1_000));
    assert_eq!(asked.recv_timeout(PATIENCE), Ok(1_000));
    ear.hear(1, Sound::Speech(cut(1_000))).unwrap();
    go.send(()).unwrap();
    assert_eq!(text_of(&next(&events)), (1, "white 1000".to_owned()));
    let heard = next(&events);
    assert!(matches!(heard, EarEvent::Heard { id: 1, .. }) && asked.is_empty(), "{heard:?}");
    ear.expect(1, cut(1_000));
    ear.hear(2, Sound::Speech(cut(1_000))).unwrap();
    go.send(()).unwrap();
    assert!(matches!(next(&events), EarEvent::Heard { id: 2, .. }));
    assert_eq!(asked.try_iter().collect::<Vec<_>>(), [1_000], "a hint that is late is left out");
}

#[test]
fn who_goes_on_after_a_pause_is_decoded_as_a_whole() {
    let (ear, events, asked, go) = slow(true);
    ear.expect(1, cut(1_000));
    assert_eq!(asked.recv_timeout(PATIENCE), Ok(1_000));
    let mut other = cut(1_000);
    other.samples[500] = 8;
    ear.hear(1, Sound::Speech(other)).unwrap();
    go.send(()).unwrap();
    go.send(()).unwrap();
    assert_eq!(text_of(&next(&events)), (1, "white 1000".to_owned()));
    assert!(matches!(next(&events), EarEvent::Heard { id: 1, .. }));
    assert_eq!(asked.try_iter().count(), 1, "one sample is another");
}

#[test]
fn what_is_certain_comes_before_what_is_not() {
    let (ear, events, asked, go) = slow(true);
    ear.hear(1, Sound::Speech(cut(1_000))).unwrap();
    assert_eq!(asked.recv_timeout(PATIENCE), Ok(1_000));
    ear.expect(2, cut(2_000));
    ear.expect(2, cut(3_000));
    ear.hear(3, Sound::Speech(cut(4_000))).unwrap();
    (0..3).for_each(|_| go.send(()).unwrap());
    let ids: Vec<u64> = (0..3).map(|_| text_of(&next(&events)).0).collect();
    assert_eq!(ids, [1, 3, 2]);
    assert_eq!(asked.try_iter().collect::<Vec<_>>(), [4_000, 3_000], "of hints the newest");
}

#[test]
fn a_recogniser_that_is_not_quick_waits_for_the_end() {
    let (ear, events, asked, go) = slow(false);
    ear.expect(1, cut(1_000));
    ear.hear(2, Sound::Speech(cut(2_000))).unwrap();
    go.send(()).unwrap();
    assert!(matches!(next(&events), EarEvent::Heard { id: 2, .. }));
    assert_eq!(asked.try_iter().collect::<Vec<_>>(), [2_000]);
}
