use std::fs;

use hound::{WavSpec, WavWriter};
use tempfile::TempDir;

use super::*;

const LONGEST_S: f64 = 2.0;

fn spec(channels: u16, sample_rate: u32, bits: u16, sample_format: SampleFormat) -> WavSpec {
    WavSpec { channels, sample_rate, bits_per_sample: bits, sample_format }
}

/// Returns a folder with one file `x.wav` of 0.1 s in which every channel carries a ramp.
fn written(spec: WavSpec) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let mut wav = WavWriter::create(&path, spec).unwrap();
    for n in 0..spec.sample_rate / 10 {
        let ramp = f64::from(n) / f64::from(spec.sample_rate / 10) - 0.5;
        for _ in 0..spec.channels {
            match spec.sample_format {
                SampleFormat::Float => wav.write_sample(ramp as f32).unwrap(),
                SampleFormat::Int => {
                    let full = (1_u64 << (spec.bits_per_sample - 1)) as f64;
                    wav.write_sample((ramp * full) as i32).unwrap();
                }
            }
        }
    }
    wav.finalize().unwrap();
    (folder, path)
}

/// Returns a folder with one mono file `x.wav` of these samples.
fn with_samples<S: hound::Sample + Copy>(
    bits: u16,
    format: SampleFormat,
    samples: &[S],
) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let mut wav = WavWriter::create(&path, spec(1, RATE_HZ, bits, format)).unwrap();
    samples.iter().for_each(|&s| wav.write_sample(s).unwrap());
    wav.finalize().unwrap();
    (folder, path)
}

#[test]
fn wav_reads_every_usual_format() {
    let samples = [0, 1, -1, i16::MAX, i16::MIN, 12_345];
    let (_folder, path) = with_samples(16, SampleFormat::Int, &samples);
    assert_eq!(read_wav(&path, LONGEST_S).unwrap(), samples, "the service's own format");
    let (_folder, path) = with_samples(32, SampleFormat::Float, &[3.0_f32, -3.0]);
    assert_eq!(read_wav(&path, LONGEST_S).unwrap(), [i16::MAX, i16::MIN], "clipped");
    for (channels, rate, bits, format) in [
        (1, 16_000, 8, SampleFormat::Int),
        (2, 16_000, 16, SampleFormat::Int),
        (1, 44_100, 24, SampleFormat::Int),
        (2, 48_000, 32, SampleFormat::Int),
        (6, 48_000, 32, SampleFormat::Float),
        (1, 8_000, 16, SampleFormat::Int),
    ] {
        let (_folder, path) = written(spec(channels, rate, bits, format));
        let samples = read_wav(&path, LONGEST_S).unwrap();
        assert_eq!(samples.len(), 1_600, "{channels} x {rate} Hz {bits} bit");
        for (n, &sample) in samples.iter().enumerate().skip(200).take(1_200) {
            let ramp = (n as f64 / 1_600.0 - 0.5) * 32_768.0;
            // 8 bits are steps of 256.
            assert!((f64::from(sample) - ramp).abs() < 300.0, "{rate} Hz {bits} bit at {n}");
        }
    }
}

#[test]
fn wav_clips_samples_that_no_filter_can_add() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge.wav");
    let mut wav = WavWriter::create(&path, spec(2, 44_100, 32, SampleFormat::Float)).unwrap();
    (0..2 * 441).for_each(|n| wav.write_sample(f32::MAX * [1.0, -1.0, 1.0][n % 3]).unwrap());
    wav.finalize().unwrap();
    assert_eq!(read_wav(&path, LONGEST_S).unwrap().len(), 160);
}

#[test]
fn wav_rejects_other_and_damaged_files_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let error = |path: &Path, longest_s| read_wav(path, longest_s).unwrap_err().to_string();
    assert!(error(&path, LONGEST_S).contains("x.wav cannot be read"));
    assert!(error(folder.path(), LONGEST_S).contains("expected a regular file, found a folder"));
    let (_ramp, ramp) = written(spec(1, RATE_HZ, 16, SampleFormat::Int));
    let whole = fs::read(ramp).unwrap();
    let truncated_headers = (0..44).map(|len| &whole[..len]);
    let other = [&b"RIFF"[..], b"hello there, this is a text", &[0xFF; 100]];
    for content in truncated_headers.chain(other) {
        fs::write(&path, content).unwrap();
        let error = error(&path, LONGEST_S);
        assert!(error.contains("x.wav is not a valid WAV file"), "{error}");
    }
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    assert!(error(&path, LONGEST_S).contains("is truncated"));
    fs::write(&path, &whole).unwrap();
    assert!(error(&path, 0.05).contains("longer than 0.05 s"));
    let (_folder, path) = with_samples::<i16>(16, SampleFormat::Int, &[]);
    assert!(error(&path, LONGEST_S).contains("no audio"));
    let (_folder, path) = written(spec(1, 4_000, 16, SampleFormat::Int));
    assert!(error(&path, LONGEST_S).contains("found 4000 Hz"));
    let (_folder, path) = with_samples(32, SampleFormat::Float, &[0.0, f32::NAN, 0.5]);
    assert!(error(&path, LONGEST_S).contains("not numbers"));
}

#[test]
fn wav_repairs_the_placeholder_length_of_a_pipe() {
    let (_folder, path) = written(spec(1, 16_000, 16, SampleFormat::Int));
    let mut content = fs::read(&path).unwrap();
    let expected = read_wav(&path, LONGEST_S).unwrap();
    for announced in [0x7FFF_F000_u32, 0x8000_0000, u32::MAX] {
        let at = content.windows(4).position(|w| w == b"data").unwrap() + 4;
        content[at..at + 4].copy_from_slice(&announced.to_le_bytes());
        fs::write(&path, &content).unwrap();
        assert_eq!(read_wav(&path, LONGEST_S).unwrap(), expected);
    }
}
