//! A voice behind the Wyoming protocol, such as Piper.

use std::path::Path;
use std::time::Duration;

use hound::{SampleFormat, WavSpec, WavWriter};
use wyoming::{Client, ClientError, Sound, Voice};

use super::synthesis::SOUND_MAX_S;
use super::{SynthesisError, trim};
use crate::server_state::ServerState;

/// A server that synthesises prompts, and its voice.
#[derive(Clone, Debug, PartialEq)]
pub struct ServerOptions {
    /// Client of the server.
    pub client: Client,
    /// Voice of the server.
    pub voice: Voice,
}

/// Time without requests to a server that was late: every line would wait as long.
const LATE_FOR: Duration = Duration::from_secs(30);

/// The server, with its state.
pub(super) struct Server {
    options: ServerOptions,
    pub(super) state: ServerState,
}

impl Server {
    pub(super) fn new(options: ServerOptions) -> Self {
        let address = options.client.address.clone();
        let state = ServerState::new(address, "built-in voice", "synthesis_ms");
        let state = state.away_if_late(LATE_FOR);
        Self { options, state }
    }

    /// Synthesises a text into a WAV file. Returns `false` if the server fails, or was away or late
    /// a moment ago.
    ///
    /// # Errors
    /// If the file cannot be written, or the text is not needed any more.
    pub(super) fn speak(
        &mut self,
        text: &str,
        file: &Path,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<bool, SynthesisError> {
        if self.state.is_away() {
            return Ok(false);
        }
        let ServerOptions { client, voice } = &self.options;
        let sound = client.synthesize(text, voice, is_cancelled).and_then(supported);
        self.state.record(&sound);
        match sound {
            Ok(sound) => write(file, &sound).map(|()| true),
            Err(ClientError::Cancelled) => Err(SynthesisError::Cancelled),
            Err(_) => Ok(false),
        }
    }
}

/// Returns the sound if it is of a kind that every player knows.
fn supported(sound: Sound) -> Result<Sound, ClientError> {
    let wyoming::AudioFormat { rate_hz, width, channels } = sound.format;
    if width != 2 || channels > 2 {
        return Err(ClientError::Broken(format!(
            "expected 2 bytes a sample and at most 2 channels, found {width} and {channels}"
        )));
    }
    let seconds = (sound.audio.len() / (2 * usize::from(channels))) as f64 / f64::from(rate_hz);
    if seconds > 0.0 && seconds <= SOUND_MAX_S {
        Ok(sound)
    } else {
        let what = format!("expected sound of at most {SOUND_MAX_S} s, found {seconds:.0} s");
        Err(ClientError::Broken(what))
    }
}

fn write(file: &Path, Sound { format, audio }: &Sound) -> Result<(), SynthesisError> {
    let spec = WavSpec {
        channels: format.channels,
        sample_rate: format.rate_hz,
        bits_per_sample: 16,
        sample_format: SampleFormat::Int,
    };
    // A file of whole frames: what is cut off is no sound.
    let frame = 2 * usize::from(format.channels);
    let written = WavWriter::create(file, spec).and_then(|mut wav| {
        let samples = audio.chunks_exact(frame).flat_map(|frame| frame.chunks_exact(2));
        samples
            .map(|bytes| i16::from_le_bytes([bytes[0], bytes[1]]))
            .try_for_each(|sample| wav.write_sample(sample))?;
        wav.finalize()
    });
    written.map_err(|error| trim::unwritten(file, &error))
}

#[cfg(test)]
mod tests {
    use wyoming::stand_in::{FORMAT, Manner, Request, StandIn};

    use super::*;
    use crate::audio::RATE_HZ;
    use crate::voice::{Program, Synthesiser, VoiceOptions};

    const PATIENCE: Duration = Duration::from_secs(20);

    /// Returns a synthesiser with a server, in whose place `cp` writes half as long a sound.
    fn synthesiser(server: &StandIn, folder: &Path, answer: Duration) -> Synthesiser {
        let client = Client::new(server.address.clone(), PATIENCE, answer);
        let short = folder.join("short.wav");
        let tone: Vec<i16> = (0..4_000).map(|n| if n % 40 < 20 { 9_000 } else { -9_000 }).collect();
        crate::audio::write_wav(&short, &tone).unwrap();
        let program = ["cp", short.to_str().unwrap(), "{wav}", "--suffix={text}"];
        Synthesiser::new(&VoiceOptions {
            program: Program::Command(program.map(str::to_owned).into()),
            server: Some(ServerOptions { client, voice: Voice::default() }),
            ..VoiceOptions::new(folder.join("work"))
        })
    }

    #[test]
    fn server_speaks_each_prompt_once_and_is_stood_in_for_while_it_fails() {
        let folder = tempfile::tempdir().unwrap();
        let server = StandIn::start(Manner::Error("no voice".to_owned()));
        let mut synthesiser = synthesiser(&server, folder.path(), PATIENCE);
        let length = |synthesiser: &mut Synthesiser, text| synthesiser.samples(text).unwrap().len();
        assert_eq!(length(&mut synthesiser, "one"), 4_000, "by the program");
        assert!(synthesiser.note().unwrap().ends_with("it reports: no voice"));
        for (manner, expected) in [
            (Manner::Cut(b"{\"type\"".to_vec()), "ended the connection"),
            (Manner::Bytes(b"garbage\n".to_vec()), "not JSON"),
        ] {
            server.behave(manner);
            assert_eq!(length(&mut synthesiser, "one"), 4_000, "by the program");
            assert!(synthesiser.note().unwrap().contains(expected));
        }
        server.behave(Manner::Answer(String::new()));
        // Half a second with a margin of silence: the other sound was not cached.
        let of_server = length(&mut synthesiser, "one");
        assert!((8_000..9_000).contains(&of_server), "{of_server}");
        assert_eq!(synthesiser.note(), None);
        let asked = server.requests().len();
        assert_eq!(length(&mut synthesiser, "one"), of_server);
        assert_eq!(server.requests().len(), asked, "cached");
        assert_eq!(server.requests()[0], Request::Synthesize("one".to_owned()));
    }

    #[test]
    fn server_that_was_late_is_left_alone_for_a_while() {
        let folder = tempfile::tempdir().unwrap();
        let server = StandIn::start(Manner::Deaf);
        let mut synthesiser = synthesiser(&server, folder.path(), Duration::from_millis(50));
        for text in ["one", "two"] {
            assert_eq!(synthesiser.samples(text).unwrap().len(), 4_000, "by the program");
            assert!(synthesiser.note().unwrap().contains("raise speech.wyoming.synthesis_ms"));
            server.behave(Manner::Answer(String::new()));
        }
        assert!(!server.requests().contains(&Request::Synthesize("two".to_owned())));
    }

    #[test]
    fn sound_of_a_server_is_written_with_its_own_rate_and_channels() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.wav");
        for channels in [1, 2] {
            let format = wyoming::AudioFormat { channels, ..FORMAT };
            let audio = [9, 0].repeat(usize::from(channels) * 24_000);
            let sound = supported(Sound { format, audio: [&audio[..], &[7]].concat() }).unwrap();
            write(&file, &sound).unwrap();
            let samples = crate::audio::read_wav(&file, 2.0).unwrap();
            assert_eq!(samples.len(), RATE_HZ as usize, "{channels}");
        }
        for (width, channels, bytes) in [(1, 1, 24), (4, 1, 24), (2, 3, 24), (2, 2, 3)] {
            let format = wyoming::AudioFormat { width, channels, ..FORMAT };
            let refused = supported(Sound { format, audio: vec![0; bytes] });
            assert!(refused.is_err(), "{width} {channels} {bytes}");
        }
        let long = Sound { format: FORMAT, audio: vec![0; 121 * 48_000] };
        assert!(supported(long).is_err());
    }
}
