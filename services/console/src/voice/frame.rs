//! A frame of sound as a page sends it.

use service::Time;
use service::clock;

/// Bytes before the samples.
const HEADER: usize = 24;
/// Samples of one frame at most: a tenth of a second.
const SAMPLES_MAX: usize = 1_600;

/// A frame of a viewer's audio stream: one channel, 16 000 samples a second.
#[derive(Clone, Debug, PartialEq)]
pub struct PcmFrame {
    pub end: bool,
    /// The user holds a key while speaking.
    pub held: bool,
    /// The robot's own voice is not in it.
    pub echo_free: bool,
    /// Number of the stream, made by the page.
    pub stream: u32,
    /// Time of the first sample, monotonic clock.
    pub taken: Time,
    /// Samples of the stream before this frame.
    pub before: u64,
    pub samples: Vec<i16>,
}

impl PcmFrame {
    /// Reads a binary frame: version 1, flags (1 end, 2 held, 4 echo-free), two bytes of zero,
    /// stream `u32`, time in server milliseconds `f64`, samples before `u64`, samples `i16`; all
    /// with the low byte first.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let Some((header, sound)) = bytes.split_at_checked(HEADER) else {
            return Err(format!("expected a header of {HEADER} bytes in a frame of sound"));
        };
        let [1, flags @ 0..=7, 0, 0, ..] = *header else {
            return Err("expected 1, flags, 0, 0 at the start of a frame of sound".to_owned());
        };
        if sound.len() % 2 != 0 || sound.len() / 2 > SAMPLES_MAX {
            return Err(format!(
                "expected at most {SAMPLES_MAX} samples of 2 bytes in a frame of sound"
            ));
        }
        let eight = |at: usize| {
            let mut eight = [0; 8];
            eight.copy_from_slice(&header[at..at + 8]);
            eight
        };
        let taken_ms = f64::from_le_bytes(eight(8));
        if !taken_ms.is_finite() || taken_ms < 0.0 {
            return Err("invalid time in a frame of sound".to_owned());
        }
        Ok(Self {
            end: flags & 1 != 0,
            held: flags & 2 != 0,
            echo_free: flags & 4 != 0,
            stream: u32::from_le_bytes([header[4], header[5], header[6], header[7]]),
            // A page's idea of the server's clock may be a little ahead.
            taken: Time((taken_ms * 1e6) as u64).min(clock::now()),
            before: u64::from_le_bytes(eight(16)),
            samples: sound.chunks_exact(2).map(|b| i16::from_le_bytes([b[0], b[1]])).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(flags: u8, samples: &[i16]) -> Vec<u8> {
        let mut bytes = vec![1, flags, 0, 0];
        bytes.extend(7_u32.to_le_bytes());
        bytes.extend(1.5_f64.to_le_bytes());
        bytes.extend(3_200_u64.to_le_bytes());
        samples.iter().for_each(|sample| bytes.extend(sample.to_le_bytes()));
        bytes
    }

    #[test]
    fn pcm_frame_is_read_as_written() {
        let read = PcmFrame::read(&frame(3, &[-2, 513])).unwrap();
        let expected = PcmFrame {
            end: true,
            held: true,
            echo_free: false,
            stream: 7,
            taken: Time(1_500_000),
            before: 3_200,
            samples: vec![-2, 513],
        };
        assert_eq!(read, expected);
    }

    #[test]
    fn pcm_frame_rejects_invalid_bytes() {
        let mut nan = frame(0, &[]);
        nan[8..16].copy_from_slice(&f64::NAN.to_le_bytes());
        let odd = [frame(0, &[1]), vec![0]].concat();
        for bad in [vec![], vec![1; 23], frame(8, &[]), frame(0, &[0; 1_601]), nan, odd] {
            assert!(PcmFrame::read(&bad).is_err());
        }
    }
}
