//! Handing over without waiting.

use std::collections::VecDeque;

use super::MicrophoneEvent;
use crate::live::Live;

/// Takes an event, or gives it back where there is no room.
pub type Sink = Box<dyn Fn(MicrophoneEvent) -> Result<(), MicrophoneEvent> + Send>;

/// Events that may wait for a taker; beyond it new utterances are dropped whole.
const WAITING_MAX: usize = 16;

/// What is on its way out.
pub(crate) struct Outgoing {
    sink: Sink,
    waiting: VecDeque<MicrophoneEvent>,
    /// An utterance whose beginning was dropped, so that its end is, too.
    left_out: Option<u64>,
    dropped: u32,
}

impl Outgoing {
    pub(crate) fn new(sink: Sink) -> Self {
        Self { sink, waiting: VecDeque::new(), left_out: None, dropped: 0 }
    }

    /// Utterances that were dropped.
    pub(crate) fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Hands an event over as soon as there is room.
    pub(crate) fn send(&mut self, event: MicrophoneEvent) {
        self.flush();
        let full = self.waiting.len() >= WAITING_MAX;
        match &event {
            // The next one tells more.
            MicrophoneEvent::Status(_) if !self.waiting.is_empty() => return,
            // It helps only while it is new.
            MicrophoneEvent::Live(live) if live.is_hint() && !self.waiting.is_empty() => return,
            MicrophoneEvent::Live(Live::Began(began)) if full => {
                self.left_out = Some(began.sound);
                self.dropped += 1;
                let dropped = self.dropped;
                tracing::warn!(dropped, "the service is too busy: an utterance was dropped");
                return;
            }
            MicrophoneEvent::Live(Live::Ended { sound, .. }) if self.left_out == Some(*sound) => {
                self.left_out = None;
                return;
            }
            _ => self.waiting.push_back(event),
        }
        self.flush();
    }

    /// Hands over what waits, as far as there is room.
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
    use crate::devices::stream::Cut;
    use crate::live::Began;
    use crossbeam_channel::{TrySendError, bounded};
    use messages::{RequestKey, Source};
    use service::Time;

    fn began(sound: u64) -> MicrophoneEvent {
        MicrophoneEvent::Live(Live::Began(Began {
            sound,
            at: Time(sound),
            stream: RequestKey([0; 16]),
            segment: None,
            source: Source::Microphone,
            interrupts: false,
        }))
    }

    fn ended(sound: u64) -> MicrophoneEvent {
        let cut = Cut { onset: Time(0), end: Time(0), samples: Vec::new(), speech: 0..0 };
        MicrophoneEvent::Live(Live::Ended { sound, cut })
    }

    #[test]
    fn a_full_queue_drops_whole_utterances_and_counts_them() {
        let (taker, taken) = bounded(2);
        let sink = move |event| match taker.try_send(event) {
            Err(TrySendError::Full(event)) => Err(event),
            _ => Ok(()),
        };
        let mut outgoing = Outgoing::new(Box::new(sink));
        for sound in 0..12 {
            outgoing.send(began(sound));
            outgoing.send(ended(sound));
        }
        assert_eq!(outgoing.dropped(), 3, "two are taken, sixteen wait");
        let mut events = Vec::new();
        while let Ok(event) = taken.try_recv() {
            events.push(event);
            outgoing.flush();
        }
        let expected: Vec<_> = (0..9).flat_map(|sound| [began(sound), ended(sound)]).collect();
        assert_eq!(events, expected);
    }
}
