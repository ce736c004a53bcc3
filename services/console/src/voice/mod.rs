//! Sound of viewers on its way to the robot.
//!
//! The server reads a binary frame of the socket into a [`PcmFrame`] and hands it, if its viewer is in
//! control, to the main loop, which owns every topic. There [`Voice`] gets it with
//! [`Voice::frame`], is let work in every pass with [`Voice::pass`], and is told with
//! [`Voice::left`] that a viewer has gone. What it returns is sent to the viewer as it is.
//!
//! Invariant: each stream that has begun is ended towards the robot, which is repeated until the robot
//! has said that it is over or has been silent for [`PATIENCE`].

mod frame;
mod ledger;
mod receipts;
mod times;

use messages::{AudioChunk, RequestKey};
use service::audio::AudioStream;
use service::client::Client;
use service::clock;
use service::{Span, Time};

use crate::hub::ViewerId;
pub use frame::PcmFrame;
use ledger::{Ledger, Name, Step};
use times::Times;

/// How often the robot is told that a stream has ended.
const AGAIN: Span = Span::from_ms(250);
/// How long the robot may take to say that a stream is over.
const PATIENCE: Span = Span::from_ms(20_000);

/// A frame for one viewer.
pub type Letter = (ViewerId, String);

/// The streams of all viewers. Lives on the main thread.
#[derive(Debug, Default)]
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

impl Voice {
    /// Takes in a piece of sound.
    ///
    /// # Errors
    /// Why it goes nowhere, for its viewer.
    pub fn frame(
        &mut self,
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
    }
}
