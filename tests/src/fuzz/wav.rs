//! Sound files.

use audio::{RATE_HZ, read_wav};

use super::bytes::MemoryFile;

/// Longest sound, seconds.
const LONGEST_S: f64 = 2.0;

pub(super) fn run(input: &[u8]) {
    let file = MemoryFile::new(input);
    match read_wav(&file.path(), LONGEST_S) {
        Ok(samples) => {
            let most = (LONGEST_S * f64::from(RATE_HZ)) as usize + RATE_HZ as usize / 100;
            assert!(samples.len() <= most, "{} samples", samples.len());
        }
        Err(error) => assert!(error.to_string().starts_with("/proc/self/fd/"), "{error}"),
    }
}

/// A file of some frames.
fn file(format: u16, channels: u16, rate_hz: u32, bits: u16, frames: usize) -> Vec<u8> {
    let block = channels * bits.div_ceil(8);
    let sound: Vec<u8> = (0..frames * usize::from(block)).map(|n| (n * 7) as u8).collect();
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + sound.len() as u32).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0");
    [format, channels].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    [rate_hz, rate_hz * u32::from(block)]
        .iter()
        .for_each(|number| bytes.extend(number.to_le_bytes()));
    [block, bits].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes.extend(b"data");
    bytes.extend((sound.len() as u32).to_le_bytes());
    bytes.extend(sound);
    bytes
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let mut streamed = file(1, 1, 16_000, 16, 40);
    streamed[40..44].copy_from_slice(&u32::MAX.to_le_bytes());
    vec![
        file(1, 1, 16_000, 16, 160),
        file(1, 2, 44_100, 24, 40),
        file(1, 1, 8_000, 8, 80),
        file(1, 3, 192_000, 32, 20),
        file(3, 1, 48_000, 32, 48),
        streamed,
    ]
}
