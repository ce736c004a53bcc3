//! The main loop's part of the live view: reads every topic while there are viewers.

use std::path::PathBuf;

use config::Settings;
use group_metrics::Metrics;
use recording::clock::WallClock;
use recording::group_reader::{GroupReader, Sample};
use service::bus::Bus;
use service::{Span, Time};

use super::Live;

/// Interval between two looks at all topics. Their buffers hold ten times as much.
const LOOK_EVERY: Span = Span::from_ms(30);
/// Interval between two looks at the services' logs and at the wall clock.
const TEND_EVERY: Span = Span::from_ms(500);
/// Topics that are opened in one pass of the main loop, which has other work.
const OPENED_AT_ONCE: usize = 2;
/// Pause after a failure to open the topics.
const RETRY_AFTER: Span = Span::from_ms(2_000);

/// Reads every topic for live viewers.
#[derive(Debug)]
pub struct Feed {
    settings: Settings,
    log_folder: PathBuf,
    /// `None` without viewers.
    open: Option<Open>,
    next_attempt: Time,
}

#[derive(Debug)]
struct Open {
    reader: GroupReader,
    clock: WallClock,
    next_look: Time,
    next_tend: Time,
}

impl Feed {
    /// Makes the feed of a group with these settings, whose logs are in `log_folder`.
    pub fn new(settings: &Settings, log_folder: PathBuf) -> Self {
        Self { settings: settings.clone(), log_folder, open: None, next_attempt: Time(0) }
    }

    /// Publishes new messages, if there are viewers.
    pub fn pass(&mut self, bus: &Bus, live: &Live, metrics: &Metrics, now: Time) {
        if live.viewers.count() == 0 {
            if self.open.take().is_some() {
                live.viewers.clear();
                tracing::debug!("live view closed: no viewer is left");
            }
            return;
        }
        let mut publish = |sample: Sample<'_>| {
            let lost = live.viewers.publish(sample.channel, sample.at_ns, sample.data);
            metrics.live_lost.inc_by(lost);
            metrics.live_messages.inc();
        };
        if now < self.next_attempt {
            return;
        }
        if self.open.is_none() {
            self.open(now);
            if let Some(Open { reader, clock, .. }) = &mut self.open {
                reader.begin(now, *clock, &mut publish);
            }
        }
        let Some(Open { reader, clock, next_look, next_tend }) = &mut self.open else { return };
        for _ in 0..OPENED_AT_ONCE {
            if let Err(error) = reader.open_next(bus) {
                tracing::warn!(%error, "a topic cannot be opened for the live view; trying again");
                self.next_attempt = now + RETRY_AFTER;
            }
        }
        if now >= *next_look {
            reader.look(now, *clock, &mut publish);
            *next_look = now + LOOK_EVERY;
        }
        if now >= *next_tend {
            let read = WallClock::read();
            if clock.has_jumped(read) {
                *clock = read;
            }
            reader.show_logs(now, *clock, &mut publish);
            *next_tend = now + TEND_EVERY;
        }
    }

    fn open(&mut self, now: Time) {
        match GroupReader::closed(&self.settings, self.log_folder.clone(), now) {
            Ok(reader) => {
                let clock = WallClock::read();
                self.open = Some(Open { reader, clock, next_look: now, next_tend: now });
            }
            Err(error) => {
                tracing::warn!(%error, "no live view; trying again");
                self.next_attempt = now + RETRY_AFTER;
            }
        }
    }
}
