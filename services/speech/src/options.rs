//! Options of the engines by the configuration.

use std::path::Path;

use config::{MicrophoneMode, Recogniser, Speech};
use speech_engines::microphone::MicrophoneOptions;
use speech_engines::recogniser::{Backend, CommandOptions, PocketSphinxOptions, WyomingOptions};
use speech_engines::vad::SegmenterOptions;
use speech_engines::voice::{Player, Program, ServerOptions, VoiceMode, VoiceOptions};

/// Returns the recogniser, with work files in `work`.
pub fn backend(speech: &Speech, work: &Path) -> Backend {
    let debian = PocketSphinxOptions::debian(work);
    let model = speech.model_dir.clone().unwrap_or_else(|| debian.model.clone());
    let built_in = PocketSphinxOptions { model, ..debian };
    match (speech.recogniser, speech.wyoming.recogniser_client()) {
        (Recogniser::Command, _) => {
            let command = speech.recogniser_command.clone().unwrap_or_default();
            Backend::Command(CommandOptions::new(command))
        }
        (Recogniser::Wyoming, Some(client)) => {
            Backend::Wyoming(WyomingOptions { client, built_in })
        }
        _ => Backend::PocketSphinx(built_in),
    }
}

/// Returns the segmentation of audio into utterances.
pub fn segmenter(speech: &Speech) -> SegmenterOptions {
    SegmenterOptions {
        closing_pause_s: speech.closing_pause.as_secs_f64(),
        longest_s: speech.spoken_max.as_secs_f64(),
        ..SegmenterOptions::default()
    }
}

/// Returns the microphone.
pub fn microphone(speech: &Speech) -> MicrophoneOptions {
    let microphone = &speech.microphone;
    let defaults = MicrophoneOptions::hands_free();
    MicrophoneOptions {
        programs: microphone.command.clone().map_or(defaults.programs, |own| vec![own]),
        hands_free: microphone.mode == MicrophoneMode::HandsFree,
        barge_in: microphone.barge_in,
        segmenter: segmenter(speech),
        ..defaults
    }
}

/// Returns the voice, with work files in `work`.
pub fn voice(speech: &Speech, work: &Path) -> VoiceOptions {
    let defaults = VoiceOptions::new(work);
    let players = match speech.player.as_deref() {
        Some([program, arguments @ ..]) => {
            vec![Player { program: program.clone(), arguments: arguments.to_vec() }]
        }
        _ => defaults.players,
    };
    let espeak_ng = defaults.program;
    let (mode, program) = match speech.voice {
        config::Voice::Auto => (VoiceMode::Auto, espeak_ng),
        config::Voice::EspeakNg | config::Voice::Wyoming => (VoiceMode::Aloud, espeak_ng),
        config::Voice::Flite => (VoiceMode::Aloud, Program::Flite("flite".into())),
        config::Voice::Command => {
            let words = speech.voice_command.clone().unwrap_or_default();
            (VoiceMode::Aloud, Program::Command(words))
        }
        config::Voice::Print => (VoiceMode::Print, espeak_ng),
    };
    let server = speech.wyoming.voice_client().filter(|_| speech.voice == config::Voice::Wyoming);
    VoiceOptions {
        mode,
        program,
        server: server.map(|(client, voice)| ServerOptions { client, voice }),
        voice: speech.voice_name.clone(),
        words_per_minute: u16::try_from(speech.voice_words_per_minute).unwrap_or(u16::MAX),
        players,
        audio_dir: speech.voice_dir.clone(),
        ..defaults
    }
}
