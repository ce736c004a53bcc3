//! A queue of events for a receiver that may be busy.

use std::collections::VecDeque;

use crate::In;
use crate::stream_events::StreamEvent;

/// Accepts an event, or returns it where there is no room.
pub(crate) type Sink = Box<dyn Fn(In<'static>) -> Result<(), In> + Send>;

/// Events that may wait; beyond it new utterances are dropped as a whole.
const WAITING_MAX: usize = 16;

/// Events that wait for the sink.
pub(crate) struct EventQueue {
    sink: Sink,
    waiting: VecDeque<In<'static>>,
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
    pub(crate) fn send(&mut self, event: In<'static>) {
        self.flush();
        let full = self.waiting.len() >= WAITING_MAX;
        match &event {
            // The next one is more recent.
            In::Microphone(_) if !self.waiting.is_empty() => return,
            // Useful only while it is recent.
            In::Stream(event) if event.is_optional() && !self.waiting.is_empty() => {
                return;
            }
            In::Stream(StreamEvent::Began(began)) if full => {
                self.skipped = Some(began.sound);
                self.dropped += 1;
                let dropped = self.dropped;
                tracing::warn!(dropped, "service overloaded: utterance dropped");
                return;
            }
            In::Stream(StreamEvent::Ended { sound, .. }) if self.skipped == Some(*sound) => {
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
    use crate::devices::stream::SpeechSegment;
    use crate::devices::testing;
    use crate::stream_events::Began;
    use crossbeam_channel::{TrySendError, bounded};
    use service::Time;

    fn began(sound: u64) -> In<'static> {
        In::Stream(StreamEvent::Began(Began { sound, ..testing::began(Time(0)) }))
    }

    fn ended(sound: u64) -> In<'static> {
        let segment =
            SpeechSegment { onset: Time(0), end: Time(0), samples: Vec::new(), speech: 0..0 };
        In::Stream(StreamEvent::Ended { sound, segment })
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
