//! Events of live sources of sound, and their queue for a receiver that may be busy.

use std::collections::VecDeque;

use messages::MicrophoneState;

use crate::stream::StreamEvent;

/// An event of a microphone or of clients' streams.
#[derive(Clone, Debug, PartialEq)]
pub enum LiveEvent {
    /// An event of a stream.
    Stream(StreamEvent),
    /// Status of the microphone.
    Microphone(MicrophoneStatus),
}

/// Level of digital silence, decibels below full scale.
pub(crate) const QUIETEST_DB: f32 = -100.0;

/// Status of the microphone, published on every change and five times a second while it listens.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MicrophoneStatus {
    /// State of the microphone.
    pub state: MicrophoneState,
    /// Level over the last fifth of a second, decibels below full scale; -100 for digital silence
    /// and if unknown.
    pub level_db: f32,
    /// Restarts of recording programs.
    pub restarts: u32,
    /// Utterances dropped because the service was too busy.
    pub dropped: u32,
    /// The program, or the reason why it does not run.
    pub note: String,
}

impl MicrophoneStatus {
    /// Returns the status of a closed microphone.
    pub fn closed() -> Self {
        let (state, level_db) = (MicrophoneState::Closed, QUIETEST_DB);
        Self { state, level_db, restarts: 0, dropped: 0, note: String::new() }
    }
}

/// Accepts an event, or returns it for lack of room.
pub type Sink = Box<dyn Fn(LiveEvent) -> Result<(), LiveEvent> + Send>;

/// Events that may wait; beyond it new utterances are dropped as a whole.
const WAITING_MAX: usize = 16;

/// Events that wait for the sink.
pub(crate) struct EventQueue {
    sink: Sink,
    waiting: VecDeque<LiveEvent>,
    /// An utterance whose beginning was dropped; its end is dropped as well.
    skipped: Option<u64>,
    dropped: u32,
}

impl EventQueue {
    pub(crate) fn new(sink: Sink) -> Self {
        Self { sink, waiting: VecDeque::new(), skipped: None, dropped: 0 }
    }

    /// Returns the number of dropped utterances.
    pub(crate) fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Returns true if no event waits for room.
    pub(crate) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Sends an event as soon as there is room.
    pub(crate) fn send(&mut self, event: LiveEvent) {
        self.flush();
        let full = self.waiting.len() >= WAITING_MAX;
        match &event {
            // The next one is more recent.
            LiveEvent::Microphone(_) if !self.waiting.is_empty() => return,
            // Useful only while it is recent.
            LiveEvent::Stream(event) if event.is_optional() && !self.waiting.is_empty() => {
                return;
            }
            LiveEvent::Stream(StreamEvent::Began(began)) if full => {
                self.skipped = Some(began.sound);
                self.dropped += 1;
                let dropped = self.dropped;
                tracing::warn!(dropped, "service overloaded: utterance dropped");
                return;
            }
            LiveEvent::Stream(StreamEvent::Ended { sound, .. }) if self.skipped == Some(*sound) => {
                self.skipped = None;
                return;
            }
            _ => self.waiting.push_back(event),
        }
        self.flush();
    }

    /// Sends waiting events as far as there is room.
    pub(crate) fn flush(&mut self) {
        while let Some(event) = self.waiting.pop_front() {
            if let Err(event) = (self.sink)(event) {
                self.waiting.push_front(event);
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{Began, SpeechSegment};
    use crate::testing;
    use crossbeam_channel::{TrySendError, bounded};
    use vocabulary::time::Time;

    fn began(sound: u64) -> LiveEvent {
        LiveEvent::Stream(StreamEvent::Began(Began { sound, ..testing::began(Time(0)) }))
    }

    fn ended(sound: u64) -> LiveEvent {
        let segment =
            SpeechSegment { onset: Time(0), end: Time(0), samples: Vec::new(), speech: 0..0 };
        LiveEvent::Stream(StreamEvent::Ended { sound, segment })
    }

    #[test]
    fn event_queue_drops_whole_utterances_when_full() {
        let (sender, receiver) = bounded(2);
        let sink = move |event| match sender.try_send(event) {
            Err(TrySendError::Full(event)) => Err(event),
            _ => Ok(()),
        };
        let mut queue = EventQueue::new(Box::new(sink));
        for sound in 0..12 {
            queue.send(began(sound));
            queue.send(ended(sound));
        }
        assert_eq!(queue.dropped(), 3, "two were accepted, sixteen wait");
        let mut events = Vec::new();
        while let Ok(event) = receiver.try_recv() {
            events.push(event);
            queue.flush();
        }
        let expected: Vec<_> = (0..9).flat_map(|sound| [began(sound), ended(sound)]).collect();
        assert_eq!(events, expected);
    }
}
