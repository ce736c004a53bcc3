use crossbeam_channel::unbounded;
use messages::{CHUNK_SAMPLES_MAX, Pcm};

use super::*;
use crate::testing::voice;

struct Client {
    streams: ClientStreams,
    events: Receiver<LiveEvent>,
    number: u64,
    first_sample: u64,
    flags: u8,
    /// When the stream began; it is sent faster than real time.
    began: Time,
}

impl Client {
    fn new() -> Self {
        let (send, events) = unbounded();
        let sink = move |event| {
            let _ = send.send(event);
            Ok(())
        };
        let mask = Arc::new(PlaybackMask::new(Span::from_ms(300)));
        let options = SegmenterOptions::default();
        let streams = ClientStreams::start(options, mask, Arc::default(), Box::new(sink));
        let began = clock::now() - Span::from_s(20.0);
        Self { streams, events, number: 0, first_sample: 0, flags: 0, began }
    }

    fn chunk(&mut self, samples: &[i16], flags: u8) -> AudioChunk {
        let mut chunk = AudioChunk {
            stream: [9; 16],
            number: self.number,
            first_sample: self.first_sample,
            taken_ns: shifted(self.began, self.first_sample as i64).ns(),
            count: samples.len() as u32,
            flags: self.flags | flags,
            samples: Pcm::default(),
            ..AudioChunk::default()
        };
        chunk.samples.0[..samples.len()].copy_from_slice(samples);
        self.number += 1;
        self.first_sample += samples.len() as u64;
        chunk
    }

    /// Sends samples except for the chunks with the numbers in `lost`.
    fn send(&mut self, samples: &[i16], lost: &[usize]) {
        for (n, samples) in samples.chunks(CHUNK_SAMPLES_MAX).enumerate() {
            let chunk = self.chunk(samples, 0);
            while !lost.contains(&n) && self.waiting() >= CHUNKS_MAX {
                std::thread::sleep(Duration::from_millis(2));
            }
            if !lost.contains(&n) {
                self.streams.take(&chunk);
            }
        }
    }

    fn waiting(&self) -> usize {
        self.streams.0.waiting()
    }

    fn end(&mut self) {
        let chunk = self.chunk(&[], AudioChunk::END);
        self.streams.take(&chunk);
    }

    /// Returns the next event that is not optional.
    fn event(&self) -> StreamEvent {
        loop {
            match self.events.recv_timeout(Duration::from_secs(20)).unwrap() {
                LiveEvent::Stream(event) if event.is_optional() => {}
                LiveEvent::Stream(event) => return event,
                event => panic!("{event:?}"),
            }
        }
    }
}

/// Returns half a second of quiet, a second of voice, and enough quiet to end it.
fn request() -> Vec<i16> {
    [vec![0; 8_000], voice(1.0), vec![0; 12_800]].concat()
}

#[test]
fn client_stream_reports_utterances_and_its_end() {
    let mut client = Client::new();
    client.send(&request(), &[]);
    client.send(&request(), &[]);
    client.end();
    let mut tenths = Vec::new();
    for _ in 0..2 {
        let StreamEvent::Began(began) = client.event() else { panic!() };
        let StreamEvent::Ended { sound, segment } = client.event() else { panic!() };
        assert_eq!((sound, began.interrupts), (began.sound, false));
        assert!((0.7..1.3).contains(&segment.end.since(segment.onset).s()), "{segment:?}");
        tenths.push(began.segment.unwrap());
    }
    assert!(tenths[0].abs_diff(5) <= 2 && tenths[1].abs_diff(28) <= 2, "{tenths:?}");
    let closed = StreamEvent::Closed { stream: RequestKey([9; 16]), utterances: 2, lost: 0 };
    assert_eq!(client.event(), closed);
    client.end();
    assert!(matches!(client.event(), StreamEvent::Closed { utterances: 0, .. }), "a repeated end");
}

#[test]
fn client_stream_fills_short_gaps_and_ends_the_utterance_at_long_ones() {
    let mut client = Client::new();
    // One chunk in the middle of the voice: 0.1 s.
    client.send(&request(), &[10]);
    let (StreamEvent::Began(first), StreamEvent::Ended { segment, .. }) =
        (client.event(), client.event())
    else {
        panic!()
    };
    assert!((0.7..1.3).contains(&segment.end.since(first.at).s()));
    assert!(
        segment.samples[segment.speech.clone()].windows(1_600).any(|w| w.iter().all(|s| *s == 0))
    );
    // Seven chunks: more than half a second, from the middle of the voice on.
    client.send(&request(), &[10, 11, 12, 13, 14, 15, 16]);
    client.end();
    let (StreamEvent::Began(_), StreamEvent::Ended { segment, .. }) =
        (client.event(), client.event())
    else {
        panic!()
    };
    assert!(segment.end.since(segment.onset).s() < 0.7);
    let StreamEvent::Closed { lost, utterances, .. } = client.event() else { panic!() };
    assert_eq!((lost, utterances), (8 * 1_600, 2));
}

#[test]
fn client_stream_push_to_talk_interrupts_and_ends_on_release() {
    let mut client = Client::new();
    client.flags = AudioChunk::HELD;
    client.send(&request()[..20_000], &[]);
    let StreamEvent::Began(began) = client.event() else { panic!() };
    assert!(began.interrupts);
    client.flags = 0;
    client.send(&[0; 1_600], &[]);
    assert!(matches!(client.event(), StreamEvent::Ended { sound, .. } if sound == began.sound));
}

#[test]
fn client_stream_that_is_released_too_soon_ends_with_the_voice() {
    let mut client = Client::new();
    client.flags = AudioChunk::HELD;
    client.send(&request()[..16_000], &[]);
    client.flags = 0;
    // At once: a pause of the client ends the utterance, too.
    client.send(&request()[16_000..28_800], &[]);
    let StreamEvent::Began(began) = client.event() else { panic!() };
    let StreamEvent::Ended { sound, segment } = client.event() else { panic!() };
    assert_eq!(sound, began.sound);
    let spoken_s = segment.end.since(segment.onset).s();
    assert!((0.7..1.3).contains(&spoken_s), "the whole voice: {spoken_s} s");
}

#[test]
fn client_stream_ends_when_the_client_dies() {
    let mut client = Client::new();
    client.send(&request()[..20_000], &[]);
    let StreamEvent::Began(began) = client.event() else { panic!() };
    assert!(matches!(client.event(), StreamEvent::Ended { sound, .. } if sound == began.sound));
    assert!(matches!(client.event(), StreamEvent::Closed { utterances: 1, .. }));
}

#[test]
fn client_stream_tolerates_another_clock_and_invalid_counts() {
    let mut client = Client::new();
    for taken_ns in [0, u64::MAX / 4, 1] {
        let mut chunk = client.chunk(&[0; 1_600], 0);
        (chunk.taken_ns, chunk.count) = (taken_ns, if taken_ns == 1 { u32::MAX } else { 1_600 });
        client.streams.take(&chunk);
    }
    client.send(&request(), &[]);
    let StreamEvent::Began(began) = client.event() else { panic!() };
    assert!(began.at <= clock::now() && began.at + Span::from_s(30.0) > clock::now());
}
