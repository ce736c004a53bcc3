//! Audio streams from viewers to the robot.
//!
//! The server reads a binary frame of the socket into a [`PcmFrame`] and hands it, if its viewer is
//! in control, to the main loop, which owns every topic. There [`Voice`] forwards it
//! ([`Voice::frame`]) and returns receipts ([`Voice::pass`]).
//!
//! Invariant: each stream that has begun is ended towards the robot; the end is repeated until the
//! robot confirms it or has been silent for [`PATIENCE`].

mod frame;
mod stream_table;
mod timestamps;

use messages::{AudioChunk, RequestKey};
use service::audio::AudioStream;
use service::client::Client;
use service::clock;
use service::{Span, Time};

use crate::hub::outbound::{PageMessage, StreamReceipt};
use crate::hub::{Hub, ViewerId};
pub use frame::PcmFrame;
use stream_table::{FrameKind, Name, StreamTable};
use timestamps::Timestamps;

/// Interval at which the end of a stream is repeated.
const AGAIN: Span = Span::from_ms(250);
/// Deadline for the robot to confirm the end of a stream.
const PATIENCE: Span = Span::from_ms(20_000);

#[derive(Debug, Default)]
pub struct Voice {
    table: StreamTable,
    streams: Vec<Stream>,
}

/// A stream whose end the robot has not confirmed.
#[derive(Debug)]
struct Stream {
    name: Name,
    audio: AudioStream,
    timestamps: Timestamps,
    /// When it ended, and when the end was sent last.
    ended: Option<(Time, Time)>,
    /// `true` if the viewer has gone.
    deserted: bool,
}

impl Voice {
    pub fn frame(
        &mut self,
        client: &Client,
        viewer: ViewerId,
        frame: PcmFrame,
    ) -> Result<(), String> {
        let (now, name) = (clock::now(), (viewer, frame.stream));
        let gap = match self.table.take(name, frame.before, frame.samples.len())? {
            FrameKind::Ignore => return Ok(()),
            FrameKind::Next(gap) => gap,
            FrameKind::Begin => {
                if let Err(why) = self.begin(client, name) {
                    self.table.forget(name);
                    return Err(why);
                }
                // A page has one stream at a time.
                self.table.others(name).into_iter().for_each(|other| self.end(other, now));
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
            .map_err(|error| format!("cannot reach the speech service: {error}"))?;
        let timestamps = Timestamps::default();
        self.streams.push(Stream { name, audio, timestamps, ended: None, deserted: false });
        Ok(())
    }

    fn end(&mut self, name: Name, now: Time) {
        self.table.end(name);
        for stream in self.streams.iter_mut().filter(|stream| stream.name == name) {
            stream.end(now);
        }
    }

    /// Forwards the receipts of the streams to their viewers, and forgets those that are over.
    pub fn pass(&mut self, hub: &Hub, now: Time) {
        let Self { table, streams } = self;
        streams.retain_mut(|stream| {
            let continues = stream.pass(hub, now);
            if !continues {
                table.forget(stream.name);
            }
            continues
        });
    }

    /// Ends the streams of a viewer that has gone.
    pub fn left(&mut self, viewer: ViewerId) {
        let now = clock::now();
        self.table.of(viewer).into_iter().for_each(|name| self.end(name, now));
        let own = self.streams.iter_mut().filter(|stream| stream.name.0 == viewer);
        own.for_each(|stream| stream.deserted = true);
    }

    /// Returns the viewer and the page's number of the stream with this key.
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
        let taken = self.timestamps.taken(frame.taken, frame.before, frame.samples.len(), now);
        self.audio.send(taken, &frame.samples).map_err(|error| error.to_string())
    }

    fn end(&mut self, now: Time) {
        self.ended = self.ended.or(Some((now, now)));
        self.send_end(now);
    }

    fn send_end(&mut self, now: Time) {
        // A lost one is repeated.
        let _ = self.audio.end(now);
    }

    /// Returns whether more is to come.
    fn pass(&mut self, hub: &Hub, now: Time) -> bool {
        let (viewer, number) = self.name;
        let send = |receipt: StreamReceipt<'_>| {
            if !self.deserted {
                hub.send(viewer, &PageMessage::Receipt(receipt));
            }
        };
        match self.audio.receipts() {
            Ok(receipts) => {
                receipts.iter().for_each(|r| send(StreamReceipt::new(number, r)));
            }
            Err(error) => {
                send(StreamReceipt::lost(number, &error.to_string()));
                return false;
            }
        }
        if self.audio.is_over() {
            return false;
        }
        match &mut self.ended {
            Some((since, _)) if now >= *since + PATIENCE => {
                let why = "the speech service does not answer; help: say it again";
                send(StreamReceipt::lost(number, why));
                return false;
            }
            Some((_, sent)) if now >= *sent + AGAIN => {
                *sent = now;
                self.send_end(now);
            }
            _ => {}
        }
        true
    }
}
