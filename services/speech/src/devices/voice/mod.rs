//! The robot's voice: sentences spoken by espeak-ng, one after the other, each of which can be cut
//! short.
//!
//! Invariant: every sentence that is taken yields `Started` and then exactly one of `Ended`,
//! `Interrupted` and `Failed` (which may also come alone), in the order of the sentences, within a
//! deadline that depends on its length only.

mod player;
mod synthesis;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, unbounded};

use crate::devices::child::End;
pub use player::Player;
pub use synthesis::{SynthesisError, Synthesiser};

/// How sentences are presented.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VoiceMode {
    /// Aloud where espeak-ng and a player that works are there, else as text alone.
    #[default]
    Auto,
    /// Aloud; where that is impossible every sentence fails.
    EspeakNg,
    /// As text alone: a sentence ends as soon as it starts.
    Print,
}

/// How the voice sounds and what it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct VoiceOptions {
    /// How sentences are presented.
    pub mode: VoiceMode,
    /// espeak-ng's voice, e.g. `en-us`.
    pub voice: String,
    /// Speed, words a minute.
    pub words_per_minute: u16,
    /// The program that speaks.
    pub espeak_ng: PathBuf,
    /// Players to try, the preferred one first.
    pub players: Vec<Player>,
    /// A folder of this service's own for the sound of the current sentence.
    pub work: PathBuf,
}

impl VoiceOptions {
    /// An American voice at a calm pace, aloud where possible.
    pub fn new(work: impl Into<PathBuf>) -> Self {
        Self {
            mode: VoiceMode::Auto,
            voice: "en-us".to_owned(),
            words_per_minute: 150,
            espeak_ng: "espeak-ng".into(),
            players: Player::usual(),
            work: work.into(),
        }
    }
}

/// What became of the wish to speak aloud.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VoiceOutput {
    /// Sentences are played by this program.
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
            let output = choose(&options);
            // Without a listener for its events the voice has no more to do.
            if events.send(VoiceEvent::Output(output.clone())).is_ok() {
                Speaker { options, output, events, turn: speaker_turn }.run(&taken);
            }
        });
        (Self { sentences: Some(sentences), turn, thread: Some(thread) }, happened)
    }

    /// Speaks a sentence after those that wait. `id` names it in the events.
    ///
    /// # Errors
    /// If [`SENTENCES_MAX`] sentences wait already, or the thread is gone.
    pub fn speak(&self, id: u64, text: &str) -> Result<(), SpeakError> {
        let turn = self.turn.load(Ordering::SeqCst);
        let sentence = Sentence { id, turn, text: text.to_owned() };
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

fn choose(options: &VoiceOptions) -> VoiceOutput {
    if options.mode == VoiceMode::Print {
        return VoiceOutput::Text { reason: "the configuration asks for text".to_owned() };
    }
    let synthesiser = Synthesiser::new(options);
    let player = match synthesiser.silence() {
        Ok(file) => Player::find(&options.players, &file),
        Err(error) => Err(error.to_string()),
    };
    match player {
        Ok(player) => VoiceOutput::Aloud(player),
        Err(reason) => VoiceOutput::Text { reason },
    }
}

/// The thread's side.
struct Speaker {
    options: VoiceOptions,
    output: VoiceOutput,
    events: Sender<VoiceEvent>,
    turn: Arc<AtomicU64>,
}

/// Beyond the sound's own length: opening the device and playing out its buffer.
const PLAY_SLACK: Duration = Duration::from_secs(5);

impl Speaker {
    fn run(&self, sentences: &Receiver<Sentence>) {
        let synthesiser = Synthesiser::new(&self.options);
        for sentence in sentences {
            let id = sentence.id;
            let end = if self.is_called_off(&sentence) {
                VoiceEvent::Interrupted { id }
            } else {
                match self.present(&sentence, &synthesiser) {
                    Ok(End::Done) => VoiceEvent::Ended { id },
                    Ok(End::CalledOff) => VoiceEvent::Interrupted { id },
                    Err(error) => VoiceEvent::Failed { id, error },
                }
            };
            if self.events.send(end).is_err() {
                return;
            }
        }
    }

    fn present(&self, sentence: &Sentence, synthesiser: &Synthesiser) -> Result<End, String> {
        let started = || {
            // A listener that is gone is noticed at the sentence's end.
            let _ = self.events.send(VoiceEvent::Started { id: sentence.id });
        };
        let player = match &self.output {
            VoiceOutput::Aloud(player) => player,
            VoiceOutput::Text { reason } if self.options.mode == VoiceMode::EspeakNg => {
                return Err(reason.clone());
            }
            VoiceOutput::Text { .. } => {
                started();
                return Ok(End::Done);
            }
        };
        let Some(sound) = synthesiser.speak(&sentence.text).map_err(|e| e.to_string())? else {
            started();
            return Ok(End::Done);
        };
        let mut playing = player.play(&sound.file).map_err(|e| e.to_string())?;
        started();
        let deadline = Duration::from_secs_f64(sound.seconds) + PLAY_SLACK;
        let pause = |time| {
            thread::sleep(time);
            self.is_called_off(sentence)
        };
        playing.wait(deadline, pause).map_err(|e| e.to_string())
    }

    fn is_called_off(&self, sentence: &Sentence) -> bool {
        sentence.turn < self.turn.load(Ordering::SeqCst)
    }
}

#[cfg(test)]
mod tests;
