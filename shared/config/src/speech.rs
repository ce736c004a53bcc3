//! `speech.toml`: recognition and voice.

use std::path::PathBuf;
use std::time::Duration;

use diagnostics::Fields;

/// Recognition and voice.
#[derive(Clone, Debug, PartialEq)]
pub struct Speech {
    /// The voice.
    pub voice: Voice,
    /// The voice's own name for a voice or language, e.g. `en-us`.
    pub voice_name: String,
    /// Speed of the voice.
    pub voice_words_per_minute: u32,
    /// Program that speaks under [`Voice::Command`], with its arguments, with `{text}` and `{wav}`
    /// for the text and the file to write.
    pub voice_command: Option<Vec<String>>,
    /// Folder in which the sound of the latest sentences is kept, if the operator names one
    /// ([`Settings::voice_dir`](crate::Settings::voice_dir)).
    pub voice_dir: Option<PathBuf>,
    /// Program with arguments before the file, to play WAV; `None` to detect it. `none` is silent.
    pub player: Option<Vec<String>>,
    /// The recogniser.
    pub recogniser: Recogniser,
    /// The program, with its arguments, that turns audio into words; there if `recogniser` is
    /// [`Recogniser::Command`].
    pub recogniser_command: Option<Vec<String>>,
    /// The model file of a second recogniser, whisper.cpp, in builds that have it, if any.
    pub whisper_model: Option<PathBuf>,
    /// Folder of the recogniser's acoustic model; `None` to detect it.
    pub model_dir: Option<PathBuf>,
    /// Minimum score of speech that counts as addressed to the robot, 0 … 1.
    pub accept_score_min: f64,
    /// Silence that ends an utterance which is complete.
    pub complete_pause: Duration,
    /// Silence that ends an utterance of which nothing else is known.
    pub closing_pause: Duration,
    /// Silence that ends an utterance whose last words lead on.
    pub open_pause: Duration,
    /// Maximum length of an utterance.
    pub spoken_max: Duration,
    /// Longest typed or injected utterance, bytes of UTF-8.
    pub utterance_bytes_max: usize,
    /// Length of the longest recording that is recognised.
    pub recording_max: Duration,
    /// The microphone of the robot's computer.
    pub microphone: Microphone,
    /// Servers of the Wyoming protocol.
    pub wyoming: wyoming::Settings,
}

/// The microphone of the robot's computer.
#[derive(Clone, Debug, PartialEq)]
pub struct Microphone {
    /// Mode of listening.
    pub mode: MicrophoneMode,
    /// Program with its arguments that writes one channel of signed 16-bit samples, low byte first,
    /// at 16 kHz, to its standard output; `None` to detect it.
    pub command: Option<Vec<String>>,
    /// Users may interrupt the robot: only if the microphone does not hear it.
    pub barge_in: bool,
    /// Time after a sentence of the robot for which the microphone still hears it.
    pub echo_pause: Duration,
}

/// When a microphone listens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MicrophoneMode {
    /// Never.
    Off,
    /// All the time.
    HandsFree,
    /// For one utterance, on request.
    PushToTalk,
}

/// The program that speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Voice {
    /// The first that this machine has, else print.
    Auto,
    /// The espeak-ng program.
    EspeakNg,
    /// The flite program.
    Flite,
    /// The program of `voice_command`.
    Command,
    /// The server of `wyoming.voice`.
    Wyoming,
    /// No sound: the text alone.
    Print,
}

/// The recogniser: audio to words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recogniser {
    /// The first that this machine has, else none.
    Auto,
    /// The pocketsphinx library.
    PocketSphinx,
    /// A program of the operator's.
    Command,
    /// The server of `wyoming.recogniser`.
    Wyoming,
    /// None: typed text only.
    None,
}

pub(crate) fn read(f: &mut Fields<'_>) -> Speech {
    let voice = f.choice(
        "voice",
        &[
            ("auto", Voice::Auto),
            ("espeak-ng", Voice::EspeakNg),
            ("flite", Voice::Flite),
            ("command", Voice::Command),
            ("wyoming", Voice::Wyoming),
            ("print", Voice::Print),
        ],
    );
    let recogniser = f.choice(
        "recogniser",
        &[
            ("auto", Recogniser::Auto),
            ("pocketsphinx", Recogniser::PocketSphinx),
            ("command", Recogniser::Command),
            ("wyoming", Recogniser::Wyoming),
            ("none", Recogniser::None),
        ],
    );
    let wyoming = f.table("wyoming", wyoming::read_settings);
    if voice == Voice::Wyoming && wyoming.voice.is_none() {
        f.problem("voice", "`wyoming` needs a server", "set `voice` in the table [wyoming]");
    }
    if recogniser == Recogniser::Wyoming && wyoming.recogniser.is_none() {
        f.problem("recogniser", "`wyoming` needs a server", "set `recogniser` in [wyoming]");
    }
    Speech {
        voice,
        voice_name: voice_name(f, voice),
        voice_words_per_minute: f.whole("voice_words_per_minute", 80..=450),
        voice_command: voice_command(f, voice),
        voice_dir: f.absolute("voice_dir"),
        player: f.optional_command("player"),
        recogniser,
        recogniser_command: recogniser_command(f, recogniser),
        whisper_model: f.absolute("whisper_model"),
        model_dir: f.absolute("model_dir"),
        accept_score_min: f.number("accept_score_min", 0.0..=1.0),
        complete_pause: Duration::from_millis(f.whole("complete_pause_ms", 50..=5000)),
        open_pause: Duration::from_millis(f.whole("open_pause_ms", 100..=5000)),
        closing_pause: Duration::from_millis(f.whole("closing_pause_ms", 100..=5000)),
        spoken_max: f.seconds("spoken_s_max", 2.0..=60.0),
        utterance_bytes_max: f.whole("utterance_bytes_max", 16..=UTTERANCE_BYTES_MAX) as usize,
        recording_max: f.seconds("recording_s_max", 1.0..=600.0),
        microphone: f.table("microphone", microphone),
        wyoming,
    }
}

fn microphone(f: &mut Fields<'_>) -> Microphone {
    Microphone {
        mode: f.choice(
            "mode",
            &[
                ("off", MicrophoneMode::Off),
                ("hands-free", MicrophoneMode::HandsFree),
                ("push-to-talk", MicrophoneMode::PushToTalk),
            ],
        ),
        command: f.optional_command("command"),
        barge_in: f.flag("barge_in"),
        echo_pause: Duration::from_millis(f.whole("echo_pause_ms", 0..=5000)),
    }
}

/// Capacity of the utterance topic, bytes.
const UTTERANCE_BYTES_MAX: u32 = 16_384;

/// Each program has its own names for its voices.
fn voice_name(f: &mut Fields<'_>, voice: Voice) -> String {
    let name = f.text("voice_name");
    if voice == Voice::Flite && f.is_built_in(&["voice_name"]) {
        let help = "set voice_name to one that `flite -lv` lists, e.g. `slt`";
        f.problem("voice", format!("flite has no voice `{name}`"), help);
    }
    name
}

fn voice_command(f: &mut Fields<'_>, voice: Voice) -> Option<Vec<String>> {
    const HELP: &str = "write `voice_command = [\"program\", \"{text}\", \"{wav}\"]`";
    let words = f.optional_command("voice_command");
    match &words {
        None if voice == Voice::Command => {
            f.problem("voice", "`command` needs a voice_command", HELP);
        }
        Some(words) => {
            for slot in ["{text}", "{wav}"] {
                if words.iter().skip(1).all(|word| !word.contains(slot)) {
                    f.problem("voice_command", format!("expected the slot {slot}"), HELP);
                }
            }
        }
        None => {}
    }
    words
}

fn recogniser_command(f: &mut Fields<'_>, recogniser: Recogniser) -> Option<Vec<String>> {
    let command = f.optional_command("recogniser_command");
    if recogniser == Recogniser::Command && command.is_none() {
        let help = "write `recogniser_command = [\"program\", \"argument\"]`";
        f.problem("recogniser", "`command` needs a recogniser_command", help);
    }
    command
}
