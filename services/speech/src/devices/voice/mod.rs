//! The robot's voice: sentences made sound by a program and played by another, one after the
//! other, each of which can be cut short.
//!
//! Invariant: every sentence that is taken yields `Started` and then exactly one of `Ended`,
//! `Interrupted` and `Failed` (which may also come alone), in the order of the sentences, within a
//! deadline that depends on its length only.
//!
//! `Started` comes when the player has begun and the sound was made before: making it is no speech.
//! `Ended` comes when the player has ended, and not before the sound's own length has passed since
//! `Started`: some players return early, and a null one at once. The sound's length goes from its
//! first to its last audible sample (`trim.rs`).

mod kept;
mod options;
mod player;
mod program;
mod synthesis;
mod trim;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, unbounded};

use crate::devices::child::End;
pub use kept::KEPT_MAX;
use kept::Kept;
pub use options::{VoiceMode, VoiceOptions};
pub use player::Player;
pub use program::Program;
use synthesis::Sound;
pub use synthesis::{SynthesisError, Synthesiser};

/// What became of the wish to speak aloud.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VoiceOutput {
    /// Sentences are played by this program, or by none for as long as they would take.
    Aloud(Player),
    /// Sentences are text alone, for this reason.
    Text {
        /// Why, in words for the operator.
        reason: String,
    },
}

/// What the voice did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VoiceEvent {
    /// First of all: whether sentences are heard.
    Output(VoiceOutput),
    /// The sentence begins.
    Started {
        /// The sentence.
        id: u64,
    },
    /// It has been heard to its end.
    Ended {
        /// The sentence.
        id: u64,
    },
    /// It was cut short, or called off before it began.
    Interrupted {
        /// The sentence.
        id: u64,
    },
    /// It could not be spoken.
    Failed {
        /// The sentence.
        id: u64,
        /// Why, in words for the operator.
        error: String,
    },
}

/// Why a sentence is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SpeakError {
    /// More sentences wait than anybody would listen to.
    #[error("{SENTENCES_MAX} sentences wait to be spoken already")]
    Busy,
    /// The voice's thread has broken down.
    #[error("the voice has broken down")]
    Gone,
}

/// Sentences that may wait.
pub const SENTENCES_MAX: usize = 8;

/// The voice, on a thread of its own. Dropping it cuts the current sentence short.
pub struct Voice {
    sentences: Option<Sender<Sentence>>,
    /// Sentences of an earlier turn than this are called off.
    turn: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

struct Sentence {
    id: u64,
    turn: u64,
    /// Its name among the kept ones.
    name: String,
    text: String,
}

impl Voice {
    /// Starts the thread; which output it has found is its first event.
    pub fn start(options: VoiceOptions) -> (Self, Receiver<VoiceEvent>) {
        let (sentences, taken) = bounded(SENTENCES_MAX);
        let (events, happened) = unbounded();
        let turn = Arc::new(AtomicU64::new(0));
        let speaker_turn = Arc::clone(&turn);
        let thread = thread::spawn(move || {
            let mut synthesiser = Synthesiser::new(&options);
            let output = choose(&options, &mut synthesiser);
            let (mode, kept) = (options.mode, options.kept.as_deref().and_then(keeper));
            // Without a listener for its events the voice has no more to do.
            if events.send(VoiceEvent::Output(output.clone())).is_ok() {
                let turn = speaker_turn;
                Speaker { mode, output, synthesiser, kept, events, turn }.run(&taken);
            }
        });
        (Self { sentences: Some(sentences), turn, thread: Some(thread) }, happened)
    }

    /// Speaks a sentence after those that wait. `id` names it in the events, `name` among the kept
    /// files.
    ///
    /// # Errors
    /// If [`SENTENCES_MAX`] sentences wait already, or the thread is gone.
    pub fn speak(&self, id: u64, name: &str, text: &str) -> Result<(), SpeakError> {
        let turn = self.turn.load(Ordering::SeqCst);
        let sentence = Sentence { id, turn, name: name.to_owned(), text: text.to_owned() };
        let sentences = self.sentences.as_ref().ok_or(SpeakError::Gone)?;
        sentences.try_send(sentence).map_err(|error| match error {
            TrySendError::Full(_) => SpeakError::Busy,
            TrySendError::Disconnected(_) => SpeakError::Gone,
        })
    }

    /// Cuts the current sentence short and calls off those that wait.
    pub fn interrupt(&self) {
        self.turn.fetch_add(1, Ordering::SeqCst);
    }
}

impl Drop for Voice {
    fn drop(&mut self) {
        self.interrupt();
        self.sentences = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so already.
            let _ = thread.join();
        }
    }
}

fn choose(options: &VoiceOptions, synthesiser: &mut Synthesiser) -> VoiceOutput {
    if options.mode == VoiceMode::Print {
        return VoiceOutput::Text { reason: "the configuration asks for text".to_owned() };
    }
    let player = match synthesiser.try_out().and_then(|()| synthesiser.silence()) {
        Ok(file) => Player::find(&options.players, &file),
        Err(error) => Err(error.to_string()),
    };
    match player {
        Ok(player) => VoiceOutput::Aloud(player),
        Err(reason) => VoiceOutput::Text { reason },
    }
}

fn keeper(folder: &std::path::Path) -> Option<Kept> {
    match Kept::open(folder) {
        Ok(kept) => Some(kept),
        Err(error) => {
            tracing::warn!(%error, folder = %folder.display(), "the robot's sentences are not kept");
            None
        }
    }
}

/// The thread's side.
struct Speaker {
    mode: VoiceMode,
    output: VoiceOutput,
    synthesiser: Synthesiser,
    kept: Option<Kept>,
    events: Sender<VoiceEvent>,
    turn: Arc<AtomicU64>,
}

/// Beyond the sound's own length: opening the device and playing out its buffer.
const PLAY_SLACK: Duration = Duration::from_secs(5);
/// How often it is looked whether to stop.
const LOOK: Duration = Duration::from_millis(5);

impl Speaker {
    fn run(mut self, sentences: &Receiver<Sentence>) {
        for sentence in sentences {
            let id = sentence.id;
            let end = match self.present(&sentence) {
                Ok(End::Done) => VoiceEvent::Ended { id },
                Ok(End::CalledOff) => VoiceEvent::Interrupted { id },
                Err(error) => VoiceEvent::Failed { id, error },
            };
            if self.events.send(end).is_err() {
                return;
            }
        }
    }

    fn present(&mut self, sentence: &Sentence) -> Result<End, String> {
        if self.is_called_off(sentence) {
            return Ok(End::CalledOff);
        }
        let player = match &self.output {
            VoiceOutput::Aloud(player) => player.clone(),
            VoiceOutput::Text { reason } if self.mode == VoiceMode::Aloud => {
                return Err(reason.clone());
            }
            VoiceOutput::Text { .. } => {
                self.begin(sentence);
                return Ok(End::Done);
            }
        };
        let turn = Arc::clone(&self.turn);
        let is_called_off = || sentence.turn < turn.load(Ordering::SeqCst);
        match self.synthesiser.speak(&sentence.text, is_called_off) {
            Ok(Some(sound)) => {
                self.keep(sentence, &sound);
                self.play(sentence, &sound, &player)
            }
            Ok(None) => {
                self.begin(sentence);
                Ok(End::Done)
            }
            Err(SynthesisError::CalledOff) => Ok(End::CalledOff),
            Err(error) => Err(error.to_string()),
        }
    }

    fn begin(&self, sentence: &Sentence) {
        // A listener that is gone is noticed at the sentence's end.
        let _ = self.events.send(VoiceEvent::Started { id: sentence.id });
    }

    fn keep(&mut self, sentence: &Sentence, sound: &Sound) {
        let Some(kept) = &mut self.kept else { return };
        if let Err(error) = kept.keep(&sentence.name, &sound.file) {
            tracing::warn!(%error, "a sentence is not kept");
        }
    }

    /// Plays a sound, for its own length at least.
    fn play(&self, sentence: &Sentence, sound: &Sound, player: &Player) -> Result<End, String> {
        let length = Duration::from_secs_f64(sound.seconds);
        let mut playing = match player.is_none() {
            true => None,
            false => Some(player.play(&sound.file).map_err(|e| e.to_string())?),
        };
        let began = Instant::now();
        self.begin(sentence);
        if let Some(playing) = &mut playing {
            let pause = |time| {
                thread::sleep(time);
                self.is_called_off(sentence)
            };
            let end = playing.wait(length + PLAY_SLACK, pause).map_err(|e| e.to_string())?;
            if end == End::CalledOff {
                return Ok(end);
            }
        }
        while let Some(left) = length.checked_sub(began.elapsed()) {
            if self.is_called_off(sentence) {
                return Ok(End::CalledOff);
            }
            thread::sleep(left.min(LOOK));
        }
        Ok(End::Done)
    }

    fn is_called_off(&self, sentence: &Sentence) -> bool {
        sentence.turn < self.turn.load(Ordering::SeqCst)
    }
}

#[cfg(test)]
mod tests;
