//! Trimming of silence: synthesisers append up to a third of a second, during which users already
//! answer.

use std::path::Path;

use hound::{SampleFormat, WavReader, WavWriter};

use super::SynthesisError;
use super::synthesis::{SOUND_MAX_S, read};
use crate::audio::seconds;

/// Level of silence relative to the loudest sample.
const QUIET: f64 = 0.01;
/// Silence that remains at both ends, seconds.
const MARGIN_S: f64 = 0.02;

/// Trims the silence from both ends of a file of the usual format. Returns the duration, seconds.
pub(super) fn trim(file: &Path) -> Result<f64, SynthesisError> {
    let whole = || Ok(seconds(read(file)?.len()));
    let Ok(mut reader) = WavReader::open(file) else { return whole() };
    let spec = reader.spec();
    if spec.channels != 1 || spec.bits_per_sample != 16 || spec.sample_format != SampleFormat::Int {
        return whole();
    }
    let Ok(samples) = reader.samples::<i16>().collect::<Result<Vec<_>, _>>() else {
        return whole();
    };
    drop(reader);
    let rate = f64::from(spec.sample_rate);
    let sound = audible(&samples, (MARGIN_S * rate) as usize);
    let cut = samples.get(sound).filter(|cut| !cut.is_empty()).unwrap_or(&samples);
    if cut.is_empty() || cut.len() as f64 > SOUND_MAX_S * rate {
        return whole();
    }
    let written = WavWriter::create(file, spec).and_then(|mut wav| {
        cut.iter().try_for_each(|&sample| wav.write_sample(sample))?;
        wav.finalize()
    });
    written.map_err(|error| unwritten(file, &error))?;
    Ok(cut.len() as f64 / rate)
}

/// Returns the audible range with a margin, samples.
fn audible(samples: &[i16], margin: usize) -> std::ops::Range<usize> {
    let peak = samples.iter().map(|s| s.unsigned_abs()).max().unwrap_or(0);
    let loud = |s: &i16| f64::from(s.unsigned_abs()) > QUIET * f64::from(peak);
    let (Some(first), Some(last)) = (samples.iter().position(loud), samples.iter().rposition(loud))
    else {
        return 0..samples.len();
    };
    first.saturating_sub(margin)..(last + 1 + margin).min(samples.len())
}

/// Returns the error of writing a WAV file.
pub(super) fn unwritten(file: &Path, error: &hound::Error) -> SynthesisError {
    SynthesisError::Failed(format!("{} cannot be written: {error}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trim_keeps_the_audible_range() {
        let mut samples = vec![1; 500];
        samples.extend([1000, -900, 0, 0, 0, 800]);
        samples.extend([0; 700]);
        assert_eq!(audible(&samples, 10), 490..516);
        assert_eq!(audible(&samples, 10_000), 0..samples.len());
        assert_eq!(audible(&[0; 50], 10), 0..50, "silence alone remains");
        assert_eq!(audible(&[], 10), 0..0);
    }

    #[test]
    fn trim_shortens_the_file_to_its_audible_range() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.wav");
        let spec = hound::WavSpec {
            channels: 1,
            sample_rate: 22_050,
            bits_per_sample: 16,
            sample_format: SampleFormat::Int,
        };
        let mut wav = WavWriter::create(&file, spec).unwrap();
        let tone = |n: u32| if (4_410..22_050).contains(&n) { 9_000_i16 } else { 3 };
        (0..44_100).for_each(|n| wav.write_sample(tone(n)).unwrap());
        wav.finalize().unwrap();
        let seconds = trim(&file).unwrap();
        assert!((seconds - (0.8 + 2.0 * MARGIN_S)).abs() < 1e-3, "{seconds}");
        std::fs::write(folder.path().join("b.wav"), b"nothing").unwrap();
        assert!(trim(&folder.path().join("b.wav")).is_err());
        let found = WavReader::open(&file).unwrap().duration();
        assert_eq!((f64::from(found) / 22_050.0 * 1e6).round(), (seconds * 1e6).round());
    }
}
