//! The microphone's thread: programs started and started anew, their sound cut into utterances.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, TryRecvError};
use messages::{MicrophoneState, Source};
use service::client::random_key;
use service::clock;

use super::level::{Level, QUIETEST_DB};
use super::outgoing::{Outgoing, Sink};
use super::program::{Read16, Recording};
use super::{MicrophoneEvent, MicrophoneOptions, MicrophoneStatus, Talk};
use crate::devices::stream::{Duplex, Listener, OwnVoice, SampleClock, StreamEvent};
use crate::live::{Began, Live, next_sound};

/// How long one look at the sound waits for it.
const LOOK: Duration = Duration::from_millis(50);
/// What helps where no program gives sound.
const CURE: &str = "see: whichone doctor; name a program in speech.toml, table [microphone], key \
    command, or install alsa-utils";
/// A program that has given sound for this long was a good one: its end is not held against it.
const GOOD: Duration = Duration::from_secs(1);

pub(super) struct Worker {
    options: MicrophoneOptions,
    outgoing: Outgoing,
    listener: Listener,
    clock: SampleClock,
    recording: Option<Recording>,
    /// Since when sound comes without a pause.
    sounding: Option<Instant>,
    heard_last: Instant,
    /// The program that is tried, and how often in a row one has failed.
    program: usize,
    failures: u32,
    retry_at: Instant,
    level: Level,
    status: MicrophoneStatus,
    talking: Option<Talking>,
    /// The utterance that is going on.
    open: Option<u64>,
}

/// A request that is being served.
struct Talking {
    sound: u64,
    until: Instant,
    /// Whether any sound came for it.
    heard: bool,
}

impl Worker {
    pub(super) fn new(options: MicrophoneOptions, own_voice: Arc<OwnVoice>, sink: Sink) -> Self {
        let now = Instant::now();
        Self {
            listener: Listener::new(options.segmenter.clone(), own_voice),
            outgoing: Outgoing::new(sink),
            clock: SampleClock::default(),
            recording: None,
            sounding: None,
            heard_last: now,
            program: 0,
            failures: 0,
            retry_at: now,
            level: Level::default(),
            status: MicrophoneStatus::closed(),
            talking: None,
            open: None,
            options,
        }
    }

    /// Works until there is nobody left who could ask for anything.
    pub(super) fn run(mut self, requests: &Receiver<Talk>) {
        self.announce();
        loop {
            if self.is_wanted() {
                match requests.try_recv() {
                    Ok(talk) => self.begin(talk),
                    Err(TryRecvError::Empty) => {}
                    Err(TryRecvError::Disconnected) => return,
                }
                self.record(requests);
            } else {
                self.close();
                match requests.recv_timeout(Duration::from_secs(1)) {
                    Ok(talk) => self.begin(talk),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
            self.outgoing.flush();
        }
    }

    fn is_wanted(&self) -> bool {
        self.options.hands_free || self.talking.is_some()
    }

    fn begin(&mut self, talk: Talk) {
        if self.talking.is_some() {
            let reason = "somebody is talking through this microphone already".to_owned();
            self.send(Live::Silent { sound: talk.sound, reason });
            return;
        }
        // What somebody is saying just now was not said for this request.
        self.break_off();
        let until = Instant::now() + talk.longest;
        self.talking = Some(Talking { sound: talk.sound, until, heard: false });
        (self.failures, self.retry_at) = (0, Instant::now());
    }

    /// Listens for a moment.
    fn record(&mut self, requests: &Receiver<Talk>) {
        if self.recording.is_none() {
            if Instant::now() < self.retry_at {
                // A request ends the wait.
                let wait = (self.retry_at - Instant::now()).min(LOOK);
                if let Ok(talk) = requests.recv_timeout(wait) {
                    self.begin(talk);
                }
                return self.mind_the_time();
            }
            self.open();
        }
        let Some(recording) = &mut self.recording else { return self.mind_the_time() };
        match recording.read(LOOK) {
            Read16::Samples(samples) => self.hear(&samples),
            Read16::Nothing if self.heard_last.elapsed() >= self.options.pause => self.break_off(),
            Read16::Nothing => {}
            Read16::Over(why) => self.failed(why),
        }
        self.mind_the_time();
    }

    fn open(&mut self) {
        let words = self.options.programs.get(self.program).map_or(&[][..], Vec::as_slice);
        match Recording::start(words) {
            Ok(recording) => {
                self.status.note = recording.name().to_owned();
                self.status.state = MicrophoneState::Opening;
                self.recording = Some(recording);
                self.heard_last = Instant::now();
            }
            Err(why) => self.failed(why),
        }
    }

    /// Takes sound that was just read.
    fn hear(&mut self, samples: &[i16]) {
        let now = Instant::now();
        self.heard_last = now;
        if self.sounding.is_none() {
            self.sounding = Some(now);
            tracing::info!(program = self.status.note, "the microphone listens");
        }
        let at = self.clock.read(samples.len(), clock::now());
        let talks = self.talking.as_mut().map(|talking| talking.heard = true).is_some();
        let duplex = if talks || self.options.barge_in { Duplex::Full } else { Duplex::Half };
        for event in self.listener.hear(at, samples, duplex) {
            self.take(event);
        }
        let muted = self.listener.is_muted();
        let state = if muted { MicrophoneState::Muted } else { MicrophoneState::Listening };
        let changed = std::mem::replace(&mut self.status.state, state) != state;
        let news = self.level.take(samples);
        self.status.level_db = self.level.db();
        if changed || news {
            self.announce();
        }
    }

    fn take(&mut self, event: StreamEvent) {
        match event {
            StreamEvent::Began(at) => {
                let talking = self.talking.as_ref().map(|talking| talking.sound);
                let sound = talking.unwrap_or_else(next_sound);
                self.open = Some(sound);
                self.send(Live::Began(Began {
                    sound,
                    at,
                    stream: random_key(),
                    segment: None,
                    source: Source::Microphone,
                    interrupts: self.options.barge_in || talking.is_some(),
                }));
            }
            StreamEvent::SoFar(samples) => {
                let Some(sound) = self.open else { return };
                self.send(Live::SoFar { sound, samples });
            }
            StreamEvent::Paused(cut) => {
                let Some(sound) = self.open else { return };
                self.send(Live::Paused { sound, cut });
            }
            StreamEvent::Ended(cut) => {
                let Some(sound) = self.open.take() else { return };
                self.talking.take_if(|talking| talking.sound == sound);
                self.send(Live::Ended { sound, cut });
            }
        }
    }

    /// Ends what a request asked for when its time is up.
    fn mind_the_time(&mut self) {
        let now = Instant::now();
        let Some(talking) = self.talking.take_if(|talking| now >= talking.until) else { return };
        if self.open == Some(talking.sound) {
            return self.break_off();
        }
        let note = &self.status.note;
        let reason = match talking.heard {
            true => format!("nobody was heard (the microphone is {note})"),
            false => format!("the microphone gives no sound ({note}); {CURE}"),
        };
        self.send(Live::Silent { sound: talking.sound, reason });
    }

    /// The program has ended, or did not start.
    fn failed(&mut self, why: String) {
        let was_good = self.sounding.is_some_and(|since| since.elapsed() >= GOOD);
        self.close();
        self.status.restarts += 1;
        if was_good {
            self.failures = 0;
        } else {
            self.program = (self.program + 1) % self.options.programs.len().max(1);
            self.failures += 1;
        }
        let pause = self.pause();
        tracing::warn!(why, again_in = ?pause, "the microphone does not listen");
        self.status.state = MicrophoneState::Broken;
        self.status.note = why;
        self.retry_at = Instant::now() + pause;
        self.announce();
        if self.failures as usize >= self.options.programs.len() {
            self.give_up();
        }
    }

    /// How long to wait for the next try. Each program is tried once before the first pause.
    fn pause(&self) -> Duration {
        let programs = self.options.programs.len().max(1) as u32;
        if (1..programs).contains(&self.failures) {
            return Duration::ZERO;
        }
        let rounds = self.failures.saturating_sub(programs) / programs;
        let (shortest, longest) = self.options.retry;
        shortest.saturating_mul(1 << rounds.min(16)).min(longest)
    }

    /// No program works, so that whoever asked to talk is not kept waiting.
    fn give_up(&mut self) {
        if let Some(talking) = self.talking.take() {
            let reason = format!("the microphone does not work ({}); {CURE}", self.status.note);
            self.send(Live::Silent { sound: talking.sound, reason });
        }
    }

    /// Ends the stream with the utterance that is going on; what comes next is a new stream.
    fn break_off(&mut self) {
        for event in self.listener.finish() {
            self.take(event);
        }
        self.clock = SampleClock::default();
        self.sounding = None;
    }

    /// Ends the program.
    fn close(&mut self) {
        self.break_off();
        self.level = Level::default();
        self.status.level_db = QUIETEST_DB;
        if self.recording.take().is_some() {
            self.status.state = MicrophoneState::Closed;
            self.announce();
        }
    }

    fn announce(&mut self) {
        self.status.dropped = self.outgoing.dropped();
        self.outgoing.send(MicrophoneEvent::Status(self.status.clone()));
    }

    fn send(&mut self, live: Live) {
        self.outgoing.send(MicrophoneEvent::Live(live));
    }
}
