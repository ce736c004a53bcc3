//! Sound of viewers on its way to the robot.
//!
//! The server reads a binary frame of the socket into a [`PcmFrame`] and hands it, if its viewer is in
//! control, to the main loop, which owns every topic. There [`Voice`] gets it with
//! [`Voice::frame`], is let work in every pass with [`Voice::pass`], and is told with
//! [`Voice::left`] that a viewer has gone. What it returns is sent to the viewer as it is.
<<<<<<< HEAD

use node::Time;
=======
//!
//! Invariant: each stream that has begun is ended towards the robot, which is repeated until the robot
//! has said that it is over or has been silent for [`PATIENCE`].

mod frame;
mod ledger;
mod receipts;
mod times;

use node::{Span, Time};
use protocol::{AudioChunk, RequestKey};
use runtime::audio::AudioStream;
>>>>>>> 17b767e (Voice in the page: talk by key, by click or hands-free, and hear the robot)
use runtime::client::Client;
use runtime::clock;

use crate::hub::ViewerId;
<<<<<<< HEAD

/// Bytes before the samples.
const HEADER: usize = 24;
/// Samples of one frame at most: a tenth of a second.
const SAMPLES_MAX: usize = 1_600;

/// A piece of a viewer's stream of sound: one channel, 16 000 samples a second.
#[derive(Clone, Debug, PartialEq)]
pub struct PcmFrame {
    /// The stream ends with this frame.
    pub end: bool,
    /// The person holds a key while speaking.
    pub held: bool,
    /// The robot's own voice is not in it.
    pub echo_free: bool,
    /// Number of the stream, made by the page.
    pub stream: u32,
    /// When the first sample was taken, monotonic clock.
    pub taken: Time,
    /// Samples of the stream before this frame.
    pub before: u64,
    /// The sound.
    pub samples: Vec<i16>,
}

impl PcmFrame {
    /// Reads a binary frame: version 1, flags (1 end, 2 held, 4 echo-free), two bytes of zero, stream
    /// `u32`, time in server milliseconds `f64`, samples before `u64`, samples `i16`; all with the low
    /// byte first.
    ///
    /// # Errors
    /// What keeps it from being one.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let Some((header, sound)) = bytes.split_at_checked(HEADER) else {
            return Err(format!("a frame of sound has a header of {HEADER} bytes"));
        };
        let [1, flags @ 0..=7, 0, 0, ..] = *header else {
            return Err("the header of a frame of sound begins with 1, flags, 0, 0".to_owned());
        };
        if sound.len() % 2 != 0 || sound.len() / 2 > SAMPLES_MAX {
            return Err(format!("a frame of sound holds up to {SAMPLES_MAX} samples of 2 bytes"));
        }
        let eight = |at: usize| {
            let mut eight = [0; 8];
            eight.copy_from_slice(&header[at..at + 8]);
            eight
        };
        let taken_ms = f64::from_le_bytes(eight(8));
        if !taken_ms.is_finite() || taken_ms < 0.0 {
            return Err("the time of a frame of sound is no time".to_owned());
        }
        Ok(Self {
            end: flags & 1 != 0,
            held: flags & 2 != 0,
            echo_free: flags & 4 != 0,
            stream: u32::from_le_bytes([header[4], header[5], header[6], header[7]]),
            // A page's idea of the server's clock may be a little ahead.
            taken: Time((taken_ms * 1e6) as u64).min(clock::now()),
            before: u64::from_le_bytes(eight(16)),
            samples: sound.chunks_exact(2).map(|b| i16::from_le_bytes([b[0], b[1]])).collect(),
        })
    }
}
=======
pub use frame::PcmFrame;
use ledger::{Ledger, Name, Step};
use times::Times;

/// How often the robot is told that a stream has ended.
const AGAIN: Span = Span::from_ms(250);
/// How long the robot may take to say that a stream is over.
const PATIENCE: Span = Span::from_ms(20_000);
>>>>>>> 17b767e (Voice in the page: talk by key, by click or hands-free, and hear the robot)

/// A frame for one viewer.
pub type Letter = (ViewerId, String);

/// The streams of all viewers. Lives on the main thread.
#[derive(Debug, Default)]
<<<<<<< HEAD
pub struct Voice {}
=======
pub struct Voice {
    ledger: Ledger,
    streams: Vec<Stream>,
    letters: Vec<Letter>,
}

/// A stream that the robot has not said to be over.
#[derive(Debug)]
struct Stream {
    name: Name,
    audio: AudioStream,
    times: Times,
    /// Since when it has ended, and when the robot was told last.
    ended: Option<(Time, Time)>,
    /// Nobody is there any more whom its receipts would interest.
    deserted: bool,
}
>>>>>>> 17b767e (Voice in the page: talk by key, by click or hands-free, and hear the robot)

impl Voice {
    /// Takes in a piece of sound.
    ///
    /// # Errors
    /// Why it goes nowhere, for its viewer.
    pub fn frame(
        &mut self,
<<<<<<< HEAD
        _client: &Client,
        _viewer: ViewerId,
        _frame: PcmFrame,
    ) -> Result<(), String> {
        Err("this console takes no sound; type instead".to_owned())
    }

    /// Looks what became of the streams: receipts and what else their viewers are to be told.
    pub fn pass(&mut self, _client: &Client, _now: Time) -> Vec<Letter> {
        Vec::new()
    }

    /// A viewer has gone: its streams end.
    pub fn left(&mut self, _viewer: ViewerId) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(flags: u8, samples: &[i16]) -> Vec<u8> {
        let mut bytes = vec![1, flags, 0, 0];
        bytes.extend(7_u32.to_le_bytes());
        bytes.extend(1.5_f64.to_le_bytes());
        bytes.extend(3_200_u64.to_le_bytes());
        samples.iter().for_each(|sample| bytes.extend(sample.to_le_bytes()));
        bytes
    }

    #[test]
    fn a_frame_is_read_as_it_was_written() {
        let read = PcmFrame::read(&frame(3, &[-2, 513])).unwrap();
        let expected = PcmFrame {
            end: true,
            held: true,
            echo_free: false,
            stream: 7,
            taken: Time(1_500_000),
            before: 3_200,
            samples: vec![-2, 513],
        };
        assert_eq!(read, expected);
    }

    #[test]
    fn what_is_no_frame_is_refused() {
        let mut nan = frame(0, &[]);
        nan[8..16].copy_from_slice(&f64::NAN.to_le_bytes());
        let odd = [frame(0, &[1]), vec![0]].concat();
        for bad in [vec![], vec![1; 23], frame(8, &[]), frame(0, &[0; 1_601]), nan, odd] {
            assert!(PcmFrame::read(&bad).is_err());
        }
=======
        client: &Client,
        viewer: ViewerId,
        frame: PcmFrame,
    ) -> Result<(), String> {
        let (now, name) = (clock::now(), (viewer, frame.stream));
        let gap = match self.ledger.take(name, frame.before, frame.samples.len())? {
            Step::Ignore => return Ok(()),
            Step::GoOn(gap) => gap,
            Step::Begin => {
                if let Err(why) = self.begin(client, name) {
                    self.ledger.forget(name);
                    return Err(why);
                }
                // A page that opens another stream has lost sight of the one before.
                self.ledger.others(name).into_iter().for_each(|other| self.end(other, now));
                0
            }
        };
        let Some(stream) = self.streams.iter_mut().find(|stream| stream.name == name) else {
            return Ok(());
        };
        let sent = stream.send(&frame, gap, now);
        if frame.end {
            self.end(name, now);
        }
        sent
    }

    fn begin(&mut self, client: &Client, name: Name) -> Result<(), String> {
        let audio = AudioStream::open(client, 0)
            .map_err(|error| format!("the robot cannot be spoken to: {error}"))?;
        let times = Times::default();
        self.streams.push(Stream { name, audio, times, ended: None, deserted: false });
        Ok(())
    }

    fn end(&mut self, name: Name, now: Time) {
        self.ledger.end(name);
        for stream in self.streams.iter_mut().filter(|stream| stream.name == name) {
            stream.end(now);
        }
    }

    /// Looks what became of the streams: receipts and what else their viewers are to be told.
    pub fn pass(&mut self, _client: &Client, now: Time) -> Vec<Letter> {
        let Self { ledger, streams, letters } = self;
        streams.retain_mut(|stream| {
            let goes_on = stream.pass(now, letters);
            if !goes_on {
                ledger.forget(stream.name);
            }
            goes_on
        });
        std::mem::take(letters)
    }

    /// A viewer has gone: its streams end.
    pub fn left(&mut self, viewer: ViewerId) {
        let now = clock::now();
        self.ledger.of(viewer).into_iter().for_each(|name| self.end(name, now));
        let own = self.streams.iter_mut().filter(|stream| stream.name.0 == viewer);
        own.for_each(|stream| stream.deserted = true);
    }

    /// Whose stream it is that the robot knows by this key, and the number that the page gave it.
    pub fn stream_of(&self, key: RequestKey) -> Option<(ViewerId, u32)> {
        self.streams.iter().find(|stream| stream.audio.key() == key).map(|stream| stream.name)
    }
}

impl Stream {
    fn send(&mut self, frame: &PcmFrame, gap: u64, now: Time) -> Result<(), String> {
        let held = u8::from(frame.held) * AudioChunk::HELD;
        let echo_free = u8::from(frame.echo_free) * AudioChunk::ECHO_FREE;
        self.audio.set_flags(held | echo_free);
        self.audio.skip(gap);
        let taken = self.times.taken(frame.taken, frame.before, frame.samples.len(), now);
        self.audio.send(taken, &frame.samples).map_err(|error| error.to_string())
    }

    fn end(&mut self, now: Time) {
        self.ended = self.ended.or(Some((now, now)));
        self.tell_end(now);
    }

    fn tell_end(&mut self, now: Time) {
        // One that is lost is told again.
        let _ = self.audio.end(now);
    }

    /// Returns whether there is more to come.
    fn pass(&mut self, now: Time, letters: &mut Vec<Letter>) -> bool {
        let (viewer, number) = self.name;
        let mut tell = |frame: String| {
            if !self.deserted {
                letters.push((viewer, frame));
            }
        };
        match self.audio.receipts() {
            Ok(receipts) => {
                receipts.iter().for_each(|receipt| tell(receipts::frame(number, receipt)));
            }
            Err(error) => {
                tell(receipts::lost(number, &error.to_string()));
                return false;
            }
        }
        if self.audio.is_over() {
            return false;
        }
        match &mut self.ended {
            Some((since, _)) if now >= *since + PATIENCE => {
                tell(receipts::lost(number, "the robot's hearing does not answer; say it again"));
                return false;
            }
            Some((_, told)) if now >= *told + AGAIN => {
                *told = now;
                self.tell_end(now);
            }
            _ => {}
        }
        true
>>>>>>> 17b767e (Voice in the page: talk by key, by click or hands-free, and hear the robot)
    }
}
