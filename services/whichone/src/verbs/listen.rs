//! `listen`: recognition of recordings and streams.

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use audio::{RATE_HZ, SampleClock, read_wav};
use command_line::Outcome;
use command_line::output::Output;
use messages::{AudioChunk, Receipt, ReceiptStatus, Service, Sound};
use service::audio::AudioStream;
use service::client::Client;
use service::clock;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::availability::{Availability, Lookout};
use super::speak;
use crate::cli::ListenArgs;

/// Samples per block of a stream: a twentieth of a second.
const BLOCK: usize = RATE_HZ as usize / 20;
/// Longest recording for streaming, seconds.
const LONGEST_S: f64 = 3_600.0;
/// Polling interval.
const POLL_EVERY: Duration = Duration::from_millis(20);
/// Resend interval for the end of a stream.
const RESEND_END_EVERY: Duration = Duration::from_millis(250);

/// Sends a recording or a stream to the robot and prints the results.
pub(super) fn listen(paths: &GroupPaths, args: &ListenArgs, out: &mut Output<'_>) -> Outcome {
    if args.file == Path::new("-") {
        return stream(paths, args, from_stdin(), out);
    }
    if args.live {
        let samples = read_wav(&args.file, LONGEST_S);
        let samples = samples.map_err(|error| Failure::new(Exit::NotReached, error.to_string()))?;
        return stream(paths, args, from_samples(samples), out);
    }
    let absolute = args.file.canonicalize().map_err(|error| Failure::file(&args.file, &error))?;
    safe_files::open_regular(&absolute).map_err(|error| Failure::file(&args.file, &error))?;
    let path = absolute.into_os_string().into_string().map_err(|path| {
        let what = format!("{}: the path is not UTF-8; rename the file", path.display());
        Failure::new(Exit::Usage, what)
    })?;
    speak::give(paths, Sound::Wav(path), args.timeout, out)
}

/// Blocks of samples, or the error of reading them.
type Blocks = Receiver<Result<Vec<i16>, String>>;

/// Streams blocks in real time and prints receipts as they arrive.
fn stream(paths: &GroupPaths, args: &ListenArgs, blocks: Blocks, out: &mut Output<'_>) -> Outcome {
    Availability::now(paths).require(Service::Speech)?;
    let client = Client::join(paths)?;
    let flags = if args.echo_free { AudioChunk::ECHO_FREE } else { 0 };
    let mut stream = AudioStream::open(&client, flags)?;
    let (mut times, mut printed) = (SampleClock::default(), Printed::default());
    let mut lookout = Lookout::of(&[Service::Speech]);
    loop {
        require_speech(&mut lookout, paths)?;
        match blocks.recv_timeout(POLL_EVERY) {
            Ok(Ok(samples)) => {
                let taken = times.read(samples.len(), clock::now());
                stream.send(taken, &samples)?;
            }
            Ok(Err(why)) => return Err(Failure::new(Exit::NotReached, why)),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        printed.print(&stream.receipts()?, out)?;
    }
    let (until, mut ended) = (Instant::now() + args.timeout, None::<Instant>);
    while !stream.is_over() {
        require_speech(&mut lookout, paths)?;
        if Instant::now() >= until {
            let what =
                format!("no answer within {} s; see: whichone status", args.timeout.as_secs());
            return Err(Failure::new(Exit::NotReached, what));
        }
        if ended.is_none_or(|ended| ended.elapsed() >= RESEND_END_EVERY) {
            stream.end(clock::now())?;
            ended = Some(Instant::now());
        }
        thread::sleep(POLL_EVERY);
        printed.print(&stream.receipts()?, out)?;
    }
    printed.outcome()
}

/// Fails once the speech service does nothing until a person acts: nothing more is recognised.
fn require_speech(lookout: &mut Lookout, paths: &GroupPaths) -> Result<(), Failure> {
    match lookout.news(paths) {
        Some(why) => Err(Failure::new(Exit::NotReached, why)),
        None => Ok(()),
    }
}

/// Printed receipts of a stream.
#[derive(Default)]
struct Printed {
    segments: Vec<u32>,
    accepted: bool,
}

impl Printed {
    fn print(&mut self, receipts: &[Receipt], out: &mut Output<'_>) -> Result<(), Failure> {
        for receipt in receipts {
            if self.segments.contains(&receipt.segment) {
                continue;
            }
            self.segments.push(receipt.segment);
            self.accepted |= receipt.status == ReceiptStatus::Accepted;
            match speak::print(receipt, out) {
                // A rejected utterance does not end the stream.
                Err(trouble) if receipt.status == ReceiptStatus::Refused => {
                    command_line::output::note(trouble);
                }
                printed => printed?,
            }
        }
        Ok(())
    }

    fn outcome(&self) -> Outcome {
        match self.segments.len() {
            0 | 1 => Err(Failure::new(Exit::NotReached, "no speech found".to_owned())),
            _ => Ok(if self.accepted { Exit::Ok } else { Exit::NotReached }),
        }
    }
}

fn from_samples(samples: Vec<i16>) -> Blocks {
    let (send, blocks) = sync_channel(0);
    thread::spawn(move || {
        let mut pace = Pace::begin();
        for block in samples.chunks(BLOCK) {
            pace.wait(block.len());
            if send.send(Ok(block.to_vec())).is_err() {
                return;
            }
        }
    });
    blocks
}

/// Reads standard input, at most in real time.
fn from_stdin() -> Blocks {
    let (send, blocks) = sync_channel(0);
    thread::spawn(move || {
        let mut input = match past_header(BufReader::new(io::stdin())) {
            Ok(input) => input,
            Err(why) => {
                let _ = send.send(Err(why));
                return;
            }
        };
        let mut pace = Pace::begin();
        let mut bytes = [0; 2 * BLOCK];
        loop {
            let mut filled = 0;
            // A block holds the available bytes, as whole samples.
            while filled == 0 || filled % 2 == 1 {
                match input.read(&mut bytes[filled..]) {
                    Ok(0) => return,
                    Ok(count) => filled += count,
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => {
                        let _ = send.send(Err(format!("standard input: {error}")));
                        return;
                    }
                }
            }
            let pairs = bytes[..filled].chunks_exact(2);
            let samples: Vec<i16> = pairs.map(|b| i16::from_le_bytes([b[0], b[1]])).collect();
            pace.wait(samples.len());
            if send.send(Ok(samples)).is_err() {
                return;
            }
        }
    });
    blocks
}

/// Skips and checks a WAV header, if there is one.
fn past_header(mut input: BufReader<impl Read + 'static>) -> Result<Box<dyn Read>, String> {
    const HELP: &str = "help: convert it, e.g.: ffmpeg -i FILE -ar 16000 -ac 1 -f s16le - | whichone \
        listen -";
    let first = input.fill_buf().map_err(|error| format!("standard input: {error}"))?;
    if !first.starts_with(b"RIFF") {
        return Ok(Box::new(input));
    }
    let header = hound::WavReader::new(input);
    let header = header.map_err(|error| format!("standard input: {error}; {HELP}"))?;
    let spec = header.spec();
    if (spec.sample_rate, spec.channels, spec.bits_per_sample) != (RATE_HZ, 1, 16) {
        let hound::WavSpec { sample_rate, channels, bits_per_sample, .. } = spec;
        return Err(format!(
            "standard input: expected 1 channel of 16 bits at {RATE_HZ} Hz, found {channels} of \
             {bits_per_sample} bits at {sample_rate} Hz; {HELP}"
        ));
    }
    Ok(Box::new(header.into_inner()))
}

/// Limits a stream to real time.
struct Pace {
    began: Instant,
    samples: usize,
}

impl Pace {
    fn begin() -> Self {
        Self { began: Instant::now(), samples: 0 }
    }

    /// Waits until these samples could have been recorded.
    fn wait(&mut self, samples: usize) {
        self.samples += samples;
        let spoken = Duration::from_secs_f64(self.samples as f64 / f64::from(RATE_HZ));
        match spoken.checked_sub(self.began.elapsed()) {
            Some(early) => thread::sleep(early),
            // A pause is not caught up.
            None => *self = Self::begin(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &'static [u8]) -> Result<Vec<u8>, String> {
        let mut all = Vec::new();
        past_header(BufReader::new(bytes))?.read_to_end(&mut all).map_err(|e| e.to_string())?;
        Ok(all)
    }

    fn wav(rate: u32) -> Vec<u8> {
        let spec = hound::WavSpec {
            channels: 1,
            sample_rate: rate,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let mut file = io::Cursor::new(Vec::new());
        let mut writer = hound::WavWriter::new(&mut file, spec).unwrap();
        writer.write_sample(513_i16).unwrap();
        writer.finalize().unwrap();
        file.into_inner()
    }

    #[test]
    fn listen_skips_and_checks_a_wav_header() {
        assert_eq!(read(&[1, 2, 3, 4, 5, 6]), Ok(vec![1, 2, 3, 4, 5, 6]));
        assert_eq!(read(wav(16_000).leak()), Ok(vec![1, 2]));
        let error = read(wav(44_100).leak()).unwrap_err();
        assert!(error.contains("44100 Hz") && error.contains("ffmpeg"), "{error}");
    }
}
