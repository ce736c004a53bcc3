//! Options of the engines by the configuration.

use std::path::Path;

use config::{MicrophoneMode, Recogniser, Speech};
use speech_engines::microphone::MicrophoneOptions;
use speech_engines::recogniser::{Backend, CommandOptions, PocketSphinxOptions};
use speech_engines::vad::SegmenterOptions;
use speech_engines::voice::{Player, Program, VoiceMode, VoiceOptions};

/// Returns the recogniser, with work files in `work`.
pub fn backend(speech: &Speech, work: &Path) -> Backend {
    match speech.recogniser {
        Recogniser::Command => {
            let command = speech.recogniser_command.clone().unwrap_or_default();
            Backend::Command(CommandOptions::new(command))
        }
        _ => {
            let options = PocketSphinxOptions::debian(work);
            let model = speech.model_dir.clone().unwrap_or_else(|| options.model.clone());
            Backend::PocketSphinx(PocketSphinxOptions { model, ..options })
        }
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
        config::Voice::EspeakNg => (VoiceMode::Aloud, espeak_ng),
        config::Voice::Flite => (VoiceMode::Aloud, Program::Flite("flite".into())),
        config::Voice::Command => {
            let words = speech.voice_command.clone().unwrap_or_default();
            (VoiceMode::Aloud, Program::Command(words))
        }
        config::Voice::Print => (VoiceMode::Print, espeak_ng),
    };
    VoiceOptions {
        mode,
        program,
        voice: speech.voice_name.clone(),
        words_per_minute: u16::try_from(speech.voice_words_per_minute).unwrap_or(u16::MAX),
        players,
        audio_dir: speech.voice_dir.clone(),
        ..defaults
    }
}
