use std::fs;

use hound::{WavSpec, WavWriter};
use tempfile::TempDir;

use super::*;

const LONGEST_S: f64 = 2.0;

fn spec(channels: u16, sample_rate: u32, bits: u16, sample_format: SampleFormat) -> WavSpec {
    WavSpec { channels, sample_rate, bits_per_sample: bits, sample_format }
}

/// A folder with one file `x.wav` of 0.1 s in which every channel carries a ramp.
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

fn bytes(content: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    fs::write(&path, content).unwrap();
    (folder, path)
}

#[test]
fn the_services_own_make_is_read_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let samples = [0, 1, -1, i16::MAX, i16::MIN, 12_345];
    let mut wav = WavWriter::create(&path, spec(1, RATE_HZ, 16, SampleFormat::Int)).unwrap();
    samples.iter().for_each(|&s| wav.write_sample(s).unwrap());
    wav.finalize().unwrap();
    assert_eq!(read_wav(&path, LONGEST_S).unwrap(), samples);
}

#[test]
fn every_usual_make_yields_the_same_ramp() {
    let makes = [
        (1, 16_000, 8, SampleFormat::Int),
        (2, 16_000, 16, SampleFormat::Int),
        (1, 44_100, 24, SampleFormat::Int),
        (2, 48_000, 32, SampleFormat::Int),
        (6, 48_000, 32, SampleFormat::Float),
        (1, 8_000, 16, SampleFormat::Int),
    ];
    for (channels, rate, bits, format) in makes {
        let (_folder, path) = written(spec(channels, rate, bits, format));
        let heard = read_wav(&path, LONGEST_S).unwrap();
        assert_eq!(heard.len(), 1_600, "{channels} x {rate} Hz {bits} bit");
        for (n, &sample) in heard.iter().enumerate().skip(200).take(1_200) {
            let ramp = (n as f64 / 1_600.0 - 0.5) * 32_768.0;
            // 8 bits are steps of 256.
            assert!((f64::from(sample) - ramp).abs() < 300.0, "{rate} Hz {bits} bit at {n}");
        }
    }
}

#[test]
fn what_is_no_sound_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.wav");
    assert!(matches!(read_wav(&missing, LONGEST_S), Err(WavError::Unreadable { .. })));
    assert!(matches!(read_wav(folder.path(), LONGEST_S), Err(WavError::NotAFile { .. })));
    for text in [&b""[..], b"RIFF", b"hello there, this is a text", &[0xFF; 100]] {
        let (_folder, path) = bytes(text);
        let error = read_wav(&path, LONGEST_S).unwrap_err();
        assert!(matches!(error, WavError::NotWav { .. }), "{error}");
        assert!(error.to_string().contains("x.wav"), "{error}");
    }
}

#[test]
fn limits_are_told() {
    let (_folder, path) = written(spec(1, 16_000, 16, SampleFormat::Int));
    let error = read_wav(&path, 0.05).unwrap_err();
    assert!(matches!(error, WavError::TooLong { .. }), "{error}");
    let (_folder, path) = written(spec(1, 4_000, 16, SampleFormat::Int));
    let error = read_wav(&path, LONGEST_S).unwrap_err();
    assert!(error.to_string().contains("4000 Hz"), "{error}");
}

#[test]
fn empty_and_cut_off_files_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let wav = WavWriter::create(&path, spec(1, RATE_HZ, 16, SampleFormat::Int)).unwrap();
    wav.finalize().unwrap();
    assert!(matches!(read_wav(&path, LONGEST_S), Err(WavError::Empty { .. })));

    let (_folder, path) = written(spec(1, 16_000, 16, SampleFormat::Int));
    let whole = fs::read(&path).unwrap();
    for len in 0..44 {
        fs::write(&path, &whole[..len]).unwrap();
        let error = read_wav(&path, LONGEST_S).unwrap_err();
        assert!(matches!(error, WavError::NotWav { .. }), "{len} bytes: {error}");
    }
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let error = read_wav(&path, LONGEST_S).unwrap_err();
    assert!(matches!(error, WavError::CutOff { .. }), "{error}");
}

#[test]
fn a_length_unknown_to_a_pipe_is_mended() {
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

#[test]
fn not_a_number_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let mut wav = WavWriter::create(&path, spec(1, RATE_HZ, 32, SampleFormat::Float)).unwrap();
    for sample in [0.0, f32::NAN, 0.5] {
        wav.write_sample(sample).unwrap();
    }
    wav.finalize().unwrap();
    let error = read_wav(&path, LONGEST_S).unwrap_err();
    assert!(error.to_string().contains("not numbers"), "{error}");
}

#[test]
fn too_loud_floats_are_clipped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.wav");
    let mut wav = WavWriter::create(&path, spec(1, RATE_HZ, 32, SampleFormat::Float)).unwrap();
    for sample in [3.0_f32, -3.0] {
        wav.write_sample(sample).unwrap();
    }
    wav.finalize().unwrap();
    assert_eq!(read_wav(&path, LONGEST_S).unwrap(), [i16::MAX, i16::MIN]);
}
