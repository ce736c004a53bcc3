//! The robot's voice: prompts are synthesised by one program and played by another, one after the
//! other; each can be interrupted.
//!
//! Invariant: every accepted prompt yields `Started` and then exactly one of `Ended`, `Interrupted`
//! and `Failed` (which may also come alone), in order, within a deadline by its length only.
//!
//! `Started` comes when the player has begun; the audio was synthesised before. `Ended` comes when
//! the player has exited, and at least the audio's duration after `Started`: some players return
//! early, and a null device at once. The duration covers the audible part (`trim.rs`).

mod options;
mod player;
mod program;
mod prompt_audio_cache;
mod server;
mod synthesis;
mod trim;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, SendError, Sender, TryRecvError, unbounded};
use messages::SoundFile;
use serde::{Deserialize, Serialize};
use wyoming::Kind;

use crate::child_process::End;
use crate::server_state;
use crate::worker_thread::{QueueError, WorkerThread};
pub use options::{VoiceMode, VoiceOptions};
pub use player::Player;
pub use program::Program;
pub use prompt_audio_cache::CACHED_MAX;
use prompt_audio_cache::PromptAudioCache;
pub use server::ServerOptions;
use synthesis::{FORESEEN_MAX, Sound};
pub use synthesis::{SynthesisError, Synthesiser};

/// Progress of a playback.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlaybackEvent {
    /// Number of the playback.
    pub playback: u64,
    /// New state of the playback.
    pub state: PlaybackState,
}

/// State of a playback.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PlaybackState {
    /// The sound began.
    Started,
    /// The sound was played to the end.
    Ended,
    /// The prompt was interrupted, or cancelled before it began.
    Interrupted,
    /// The prompt could not be spoken, for this reason.
    Failed(String),
}

/// Output of the voice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VoiceOutput {
    /// Prompts are played by this program, or silently for their duration.
    Aloud(Player),
    /// Prompts are shown as text only.
    Text {
        /// Reason, for the operator.
        reason: String,
    },
}

/// An event of the voice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VoiceEvent {
    /// The output of the voice; the first event.
    Output(VoiceOutput),
    /// What stands in the server's place and why, whenever that changes; `None`: it works.
    Server(Option<String>),
    /// Progress of a playback.
    Playback(PlaybackEvent),
}

/// Prompts that may wait.
pub const WAITING_MAX: usize = 8;

/// The voice, on a thread of its own. Dropping it interrupts the current prompt.
pub struct Voice {
    /// Prompts of an earlier generation are cancelled.
    generation: Arc<AtomicU64>,
    /// Ends what is synthesised without a prompt.
    closed: Arc<AtomicBool>,
    thread: WorkerThread<Prompt>,
}

struct Prompt {
    playback: u64,
    generation: u64,
    /// File of the prompt in the cache.
    file: SoundFile,
    text: String,
}

impl Voice {
    /// Starts the thread.
    pub fn start(options: VoiceOptions) -> (Self, Receiver<VoiceEvent>) {
        let (events, happened) = unbounded();
        let generation = Arc::new(AtomicU64::new(0));
        let current = Arc::clone(&generation);
        let closed: Arc<AtomicBool> = Arc::default();
        let own_closed = Arc::clone(&closed);
        let thread = WorkerThread::start(WAITING_MAX, move |prompts| {
            let mut synthesiser = Synthesiser::new(&options);
            let output = choose(&options, &mut synthesiser, &own_closed);
            let (mode, cache) = (options.mode, options.audio_dir.as_deref().and_then(cache));
            // Without a receiver of its events the voice has no more to do.
            if events.send(VoiceEvent::Output(output.clone())).is_ok() {
                let (generation, closed, mut foreseen) = (current, own_closed, options.foreseen);
                foreseen.truncate(FORESEEN_MAX);
                foreseen.reverse();
                let noted = None;
                Speaker {
                    mode,
                    output,
                    synthesiser,
                    cache,
                    events,
                    generation,
                    closed,
                    foreseen,
                    noted,
                }
                .run(prompts);
            }
        });
        (Self { generation, closed, thread }, happened)
    }

    /// Starts the voice without a prompt. Returns what speaks, and through which player.
    ///
    /// # Errors
    /// Why prompts are shown as text, or why another voice takes the server's place.
    pub fn try_out(options: VoiceOptions) -> Result<String, String> {
        let own = options.program.name();
        let examine = |server: &ServerOptions| server_state::examine(&server.client, Kind::Voice);
        let server = options.server.as_ref().map(examine);
        let built_in = VoiceOptions { server: None, ..options.clone() };
        let (_voice, events) = Self::start(options);
        let player = match events.recv() {
            Ok(VoiceEvent::Output(VoiceOutput::Aloud(player))) => player.program,
            Ok(VoiceEvent::Output(VoiceOutput::Text { reason })) => {
                return Err(format!("{reason}; questions are shown as text"));
            }
            _ => return Err("it crashed; questions are shown as text".to_owned()),
        };
        match server {
            None => Ok(format!("{own} through {player}")),
            Some(Ok(server)) => Ok(format!("{server} through {player}")),
            Some(Err(reason)) => Err(match Synthesiser::new(&built_in).try_out(|| false) {
                Ok(()) => format!("{reason}; {own} takes its place"),
                Err(error) => format!("{reason}; nothing takes its place: {error}"),
            }),
        }
    }

    /// Queues a prompt. `playback` identifies it in the events, `file` is its sound's in the cache.
    ///
    /// # Errors
    /// If [`WAITING_MAX`] prompts wait already, or the thread is gone.
    pub fn speak(&self, playback: u64, file: SoundFile, text: &str) -> Result<(), QueueError> {
        let generation = self.generation.load(Ordering::SeqCst);
        self.thread.offer(Prompt { playback, generation, file, text: text.to_owned() })
    }

    /// Interrupts the current prompt and cancels those that wait.
    pub fn interrupt(&self) {
        self.generation.fetch_add(1, Ordering::SeqCst);
    }
}

impl Drop for Voice {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::SeqCst);
        self.interrupt();
    }
}

fn choose(
    options: &VoiceOptions,
    synthesiser: &mut Synthesiser,
    closed: &AtomicBool,
) -> VoiceOutput {
    if options.mode == VoiceMode::Print {
        return VoiceOutput::Text { reason: "speech.voice is \"print\"".to_owned() };
    }
    let tried = match synthesiser.try_out(|| closed.load(Ordering::SeqCst)) {
        // The server may work with a later prompt.
        Err(SynthesisError::Failed(reason)) if options.server.is_some() => {
            tracing::warn!(reason, "nothing speaks in place of the server");
            Ok(())
        }
        tried => tried,
    };
    let player = match tried.and_then(|()| synthesiser.silence()) {
        Ok(file) => Player::find(&options.players, &file),
        Err(error) => Err(error.to_string()),
    };
    match player {
        Ok(player) => VoiceOutput::Aloud(player),
        Err(reason) => VoiceOutput::Text { reason },
    }
}

fn cache(folder: &std::path::Path) -> Option<PromptAudioCache> {
    match PromptAudioCache::open(folder) {
        Ok(cache) => Some(cache),
        Err(error) => {
            tracing::warn!(%error, folder = %folder.display(), "prompt audio is not cached");
            None
        }
    }
}

/// The thread's side.
struct Speaker {
    mode: VoiceMode,
    output: VoiceOutput,
    synthesiser: Synthesiser,
    cache: Option<PromptAudioCache>,
    events: Sender<VoiceEvent>,
    generation: Arc<AtomicU64>,
    closed: Arc<AtomicBool>,
    /// Prompts to synthesise in advance, the most likely last.
    foreseen: Vec<String>,
    /// The published note about the server.
    noted: Option<String>,
}

/// Time beyond the duration of the audio: opening the device and draining its buffer.
const PLAY_SLACK: Duration = Duration::from_secs(5);
/// Polling interval of cancellation.
const POLL_EVERY: Duration = Duration::from_millis(5);

impl Speaker {
    fn run(mut self, prompts: &Receiver<Prompt>) {
        while let Some(prompt) = self.next(prompts) {
            let state = match self.present(&prompt) {
                Ok(End::Done) => PlaybackState::Ended,
                Ok(End::Cancelled) => PlaybackState::Interrupted,
                Err(error) => PlaybackState::Failed(error),
            };
            if self.send(&prompt, state).is_err() {
                return;
            }
        }
    }

    /// Returns the next prompt. Meanwhile foreseen prompts are synthesised, one at a time, so that
    /// a prompt waits for one at most.
    fn next(&mut self, prompts: &Receiver<Prompt>) -> Option<Prompt> {
        loop {
            // Asked first: the last prompt was queued before.
            let is_closed = self.closed.load(Ordering::SeqCst);
            match prompts.try_recv() {
                Ok(prompt) => return Some(prompt),
                Err(TryRecvError::Disconnected) => return None,
                Err(TryRecvError::Empty) if is_closed => return None,
                Err(TryRecvError::Empty) => {}
            }
            self.publish_note();
            // What stands in a server's place would not last.
            let is_ahead = matches!(self.output, VoiceOutput::Aloud(_)) && self.noted.is_none();
            let Some(text) = is_ahead.then(|| self.foreseen.pop()).flatten() else {
                return prompts.recv().ok();
            };
            let closed = &self.closed;
            let is_cancelled = || closed.load(Ordering::SeqCst) || !prompts.is_empty();
            match self.synthesiser.speak(&text, is_cancelled) {
                Err(SynthesisError::Cancelled) => self.foreseen.push(text),
                _ if self.synthesiser.note().is_some() => self.foreseen.push(text),
                Ok(_) => {}
                // A failing prompt reports its error when it is spoken.
                Err(error) => {
                    tracing::debug!(%error, "prompts are not synthesised in advance");
                    self.foreseen.clear();
                }
            }
        }
    }

    fn present(&mut self, prompt: &Prompt) -> Result<End, String> {
        if self.is_cancelled(prompt) {
            return Ok(End::Cancelled);
        }
        let player = match &self.output {
            VoiceOutput::Aloud(player) => player.clone(),
            VoiceOutput::Text { reason } if self.mode == VoiceMode::Aloud => {
                return Err(reason.clone());
            }
            VoiceOutput::Text { .. } => {
                self.begin(prompt);
                return Ok(End::Done);
            }
        };
        let current = Arc::clone(&self.generation);
        let is_cancelled = || prompt.generation < current.load(Ordering::SeqCst);
        let synthesised = self.synthesiser.speak(&prompt.text, is_cancelled);
        self.publish_note();
        match synthesised {
            Ok(Some(sound)) => {
                self.store(prompt, &sound);
                self.play(prompt, &sound, &player)
            }
            Ok(None) => {
                self.begin(prompt);
                Ok(End::Done)
            }
            Err(SynthesisError::Cancelled) => Ok(End::Cancelled),
            Err(error) => Err(error.to_string()),
        }
    }

    fn send(&self, prompt: &Prompt, state: PlaybackState) -> Result<(), SendError<VoiceEvent>> {
        self.events.send(VoiceEvent::Playback(PlaybackEvent { playback: prompt.playback, state }))
    }

    /// Publishes the note about the server if it has changed.
    fn publish_note(&mut self) {
        let note = self.synthesiser.note();
        if note != self.noted.as_deref() {
            self.noted = note.map(str::to_owned);
            // A missing receiver is noticed at the end of the prompt.
            let _ = self.events.send(VoiceEvent::Server(self.noted.clone()));
        }
    }

    fn begin(&self, prompt: &Prompt) {
        // A missing receiver is noticed at the end of the prompt.
        let _ = self.send(prompt, PlaybackState::Started);
    }

    fn store(&mut self, prompt: &Prompt, sound: &Sound) {
        let Some(cache) = &mut self.cache else { return };
        if let Err(error) = cache.store(prompt.file, &sound.file) {
            tracing::warn!(%error, "prompt audio not cached");
        }
    }

    /// Plays audio, for its own duration at least.
    fn play(&self, prompt: &Prompt, sound: &Sound, player: &Player) -> Result<End, String> {
        let length = Duration::from_secs_f64(sound.seconds);
        let mut playing = match player.is_none() {
            true => None,
            false => Some(player.play(&sound.file).map_err(|e| e.to_string())?),
        };
        let began = Instant::now();
        self.begin(prompt);
        if let Some(playing) = &mut playing {
            let pause = |time| {
                thread::sleep(time);
                self.is_cancelled(prompt)
            };
            let end = playing.wait(length + PLAY_SLACK, pause).map_err(|e| e.to_string())?;
            if end == End::Cancelled {
                return Ok(end);
            }
        }
        while let Some(left) = length.checked_sub(began.elapsed()) {
            if self.is_cancelled(prompt) {
                return Ok(End::Cancelled);
            }
            thread::sleep(left.min(POLL_EVERY));
        }
        Ok(End::Done)
    }

    fn is_cancelled(&self, prompt: &Prompt) -> bool {
        prompt.generation < self.generation.load(Ordering::SeqCst)
    }
}

#[cfg(test)]
mod tests;
