//! Tests with a doubtful first recogniser.

use super::*;
use crate::hearing::SecondView;
use service::clock;
use speech_engines::recogniser::Opinion;
use speech_engines::recogniser::second_opinion::{Limit, Network};

/// Says "white" or "right" and is in doubt; in short sounds it says "stop".
struct Unsure;

impl Recogniser for Unsure {
    fn recognise(&mut self, pcm: &[i16], _: Range<usize>) -> Recognition {
        let of = |text, weight| Hypothesis { weight, ..Hypothesis::certain(text) };
        let best = if pcm.len() < 8_000 { "stop" } else { "right" };
        Ok(vec![of(best, 0.6), of("white", 0.4)].into())
    }

    fn is_quick(&self) -> bool {
        true
    }
}

/// Reports the samples that it hears, and is sure of "white" once it is permitted to be.
struct Sure {
    heard: Sender<usize>,
    permission: Receiver<()>,
}

impl Network for Sure {
    fn opinion(
        &mut self,
        samples: &[i16],
        candidates: &dyn Fn() -> Option<Vec<String>>,
        limit: &Limit,
    ) -> Option<Opinion> {
        self.heard.send(samples.len()).unwrap();
        while self.permission.try_recv().is_err() {
            if limit.is_over() {
                return None;
            }
            thread::sleep(Duration::from_millis(1));
        }
        let candidates = candidates()?;
        let ln_p = |text: &String| if text == "white" { 0.0 } else { -20.0 };
        let ln_likelihood = candidates.iter().map(ln_p).collect();
        Some(Opinion { text: "white".to_owned(), ln_own: 0.0, ln_likelihood, no_speech: 0.0 })
    }
}

/// Starts a worker with an unsure first recogniser; returns also the lengths of the second one's
/// segments, and its permission to answer within `patience`. It may decide alone.
fn unsure(
    decides: bool,
    patience: Duration,
) -> (AsrWorker, Receiver<In<'static>>, Receiver<usize>, Sender<()>) {
    let ((heard, hears), (go, permission)) = (unbounded(), unbounded());
    let sure: Box<dyn Network + Send> = Box::new(Sure { heard, permission });
    let second = match decides {
        true => SecondOpinion::deciding(move || sure),
        false => SecondOpinion::with(move || Some(sure)),
    };
    let opened = Opened { second: Some(second), ..alone(Unsure) };
    let (worker, events) = worker_within(patience, move || Ok(opened));
    next(&events);
    (worker, events, hears, go)
}

/// Returns a segment that has just ended, with a pause behind it.
fn paused(speech: usize, pause: usize) -> SpeechSegment {
    let end = clock::now();
    SpeechSegment { onset: end, end, samples: vec![7; speech + pause], speech: 0..speech }
}

fn early(events: &Receiver<In<'static>>) -> RecognisedSegment {
    match next(events) {
        In::EarlyResult { result: Some(result), .. } => *result,
        event => panic!("expected an early result, found {event:?}"),
    }
}

fn answer(events: &Receiver<In<'static>>) -> RecognisedSegment {
    result(events).segments.unwrap().remove(0)
}

#[test]
fn asr_worker_asks_the_second_recogniser_where_the_first_is_in_doubt() {
    let (worker, events, hears, go) = unsure(false, PATIENCE);
    worker.decode_early(1, paused(16_000, 512));
    assert!(early(&events).awaits_second);
    let end = paused(16_000, 3_200);
    worker.decode_early(1, end.clone());
    assert!(early(&events).awaits_second);
    go.send(()).unwrap();
    let last = early(&events);
    assert!(!last.awaits_second && text(&last) == "white", "{last:?}");
    worker.submit(1, RecognitionInput::Speech(end)).unwrap();
    assert_eq!(answer(&events), last);
    assert_eq!(hears.try_iter().collect::<Vec<_>>(), [16_512], "it is asked once");
    assert!(
        matches!(last.heard.second, SecondView::Heard(_)) && last.heard.first.hypotheses.len() == 2
    );
}

/// Both listen at once, to save time.
#[test]
fn both_recognisers_listen_at_once() {
    let ((heard, hears), (go, permission)) = (unbounded(), unbounded());
    let second = SecondOpinion::with(move || Some(Box::new(Sure { heard, permission })));
    let (started, first_started) = unbounded();
    let (proceed, first_may) = unbounded();
    let stub = Stub { calls: started, permission: Some(first_may), is_quick: true, fails: false };
    let opened = Opened { second: Some(second), ..alone(stub) };
    let (worker, events) = worker(move || Ok(opened));
    next(&events);
    worker.decode_early(1, paused(16_000, 512));
    first_started.recv().unwrap();
    assert_eq!(hears.recv().unwrap(), 16_512, "the first one is still decoding");
    proceed.send(()).unwrap();
    go.send(()).unwrap();
    early(&events);
}

#[test]
fn asr_worker_answers_with_the_first_opinion_where_the_second_is_late() {
    let (worker, events, _hears, _go) = unsure(false, Duration::from_millis(600));
    for sound in [1, 2] {
        worker.submit(sound, RecognitionInput::Speech(paused(16_000, 512))).unwrap();
    }
    for _ in 0..2 {
        let late = answer(&events);
        assert_eq!((text(&late), &late.heard.second), ("right", &SecondView::Late));
    }
}

#[test]
fn asr_worker_takes_the_words_of_a_server_once_for_each_whole_utterance() {
    let (worker, events, hears, go) = unsure(true, PATIENCE);
    for pause in [512, 3_200] {
        worker.decode_early(1, paused(16_000, pause));
        let found = early(&events);
        assert!(!found.awaits_second && text(&found) == "right", "{found:?}");
    }
    let end = paused(16_000, 3_200);
    worker.decode_early(1, end.clone());
    early(&events);
    worker.submit(1, RecognitionInput::Speech(end)).unwrap();
    go.send(()).unwrap();
    let decided = answer(&events);
    assert_eq!((text(&decided), &decided.heard.second), ("white", &SecondView::NotAsked));
    assert!(decided.heard.first.hypotheses[0].word_confidence[0] < 1.0, "{decided:?}");
    assert_eq!(hears.try_iter().collect::<Vec<_>>(), [19_200], "not for the pauses");
}

#[test]
fn asr_worker_stops_at_once_while_a_server_is_slow() {
    let (worker, events, hears, _go) = unsure(true, PATIENCE);
    worker.submit(1, RecognitionInput::Speech(paused(16_000, 512))).unwrap();
    hears.recv_timeout(PATIENCE).unwrap();
    let stop = paused(4_000, 512);
    worker.decode_early(2, stop.clone());
    assert_eq!(text(&early(&events)), "stop", "while the first one waits");
    worker.submit(2, RecognitionInput::Speech(stop)).unwrap();
    // The first one's result comes first, by the built-in recogniser, and the stop asks no one.
    let first = answer(&events);
    assert_eq!((text(&first), &first.heard.second), ("right", &SecondView::Late));
    let stop = answer(&events);
    assert_eq!((text(&stop), &stop.heard.second), ("stop", &SecondView::NotAsked));
    assert!(hears.is_empty());
}

#[test]
fn asr_worker_waits_for_no_opinion_on_a_recording_while_an_utterance_does() {
    let (worker, events, hears, go) = unsure(true, PATIENCE);
    worker.submit(1, RecognitionInput::Speech(paused(16_000, 512))).unwrap();
    hears.recv_timeout(PATIENCE).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let quiet = vec![0; 16_000];
    write_wav(&path, &[&quiet[..], &testing::voice(1.0), &quiet].concat()).unwrap();
    worker.submit(2, file(&path)).unwrap();
    let recording = result(&events);
    let segments = recording.segments.unwrap();
    assert_eq!((recording.sound, &segments[0].heard.second), (2, &SecondView::Late));
    go.send(()).unwrap();
    let live = result(&events);
    assert_eq!((live.sound, text(&live.segments.unwrap()[0])), (1, "white"));
}

#[test]
fn asr_worker_asks_for_no_second_opinion_on_a_stop() {
    let (worker, events, _hears, _go) = unsure(false, PATIENCE);
    worker.submit(1, RecognitionInput::Speech(paused(4_000, 512))).unwrap();
    assert_eq!(answer(&events).heard.second, SecondView::NotAsked);
}

#[test]
fn asr_worker_forgets_a_doubt_about_an_utterance_that_goes_on() {
    let (worker, events, hears, go) = unsure(false, PATIENCE);
    worker.decode_early(1, paused(16_000, 512));
    assert!(early(&events).awaits_second);
    assert_eq!(hears.recv(), Ok(16_512));
    let end = paused(32_000, 3_200);
    worker.decode_early(1, end.clone());
    assert!(early(&events).awaits_second);
    go.send(()).unwrap();
    worker.submit(1, RecognitionInput::Speech(end)).unwrap();
    let whole = loop {
        match next(&events) {
            In::Recognised(recognised) => break recognised.segments.unwrap().remove(0),
            event => assert!(matches!(event, In::EarlyResult { .. })),
        }
    };
    assert_eq!(text(&whole), "white");
    assert_eq!(hears.try_iter().collect::<Vec<_>>(), [35_200]);
}
