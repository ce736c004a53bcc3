//! The streams of sound of a page. Each has an entry in the audit before its first frame passes,
//! and is followed to its end: the words heard in it are recorded, though the page is gone.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Streams of a page that are not over; a console has fewer.
const STREAMS_MAX: usize = 8;
/// Bytes before the samples (docs/console.md).
const HEADER: usize = 24;

/// A frame of sound, as far as the gateway reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frame {
    header: [u8; HEADER],
    samples: u64,
}

impl Frame {
    /// Reads the header; `None` if it is not a frame of sound.
    pub(crate) fn read(bytes: &[u8]) -> Option<Self> {
        let (header, sound) = bytes.split_first_chunk::<HEADER>()?;
        let is_frame = matches!(*header, [1, 0..=7, 0, 0, ..]) && sound.len() % 2 == 0;
        is_frame.then_some(Self { header: *header, samples: sound.len() as u64 / 2 })
    }

    /// Returns the number of the frame's stream.
    pub(crate) fn stream(&self) -> u32 {
        let [_, _, _, _, a, b, c, d, ..] = self.header;
        u32::from_le_bytes([a, b, c, d])
    }

    fn is_end(&self) -> bool {
        self.header[1] & 1 != 0
    }

    /// The frame that ends the stream behind this one.
    fn end(&self) -> Vec<u8> {
        let mut header = self.header;
        header[1] |= 1;
        let [.., a, b, c, d, e, f, g, h] = header;
        let next = u64::from_le_bytes([a, b, c, d, e, f, g, h]).saturating_add(self.samples);
        header[HEADER - 8..].copy_from_slice(&next.to_le_bytes());
        header.to_vec()
    }
}

/// The latest frame of each stream that is not over.
#[derive(Debug, Default)]
pub(crate) struct Sounds(Mutex<Vec<Frame>>);

impl Sounds {
    /// Returns whether the frame begins a stream.
    pub(crate) fn is_new(&self, frame: &Frame) -> bool {
        self.lock().iter().all(|known| known.stream() != frame.stream())
    }

    /// Takes in a frame that passes; `false` if there are too many streams.
    pub(crate) fn take(&self, frame: Frame) -> bool {
        let mut open = self.lock();
        if let Some(known) = open.iter_mut().find(|known| known.stream() == frame.stream()) {
            *known = frame;
            return true;
        }
        let has_room = open.len() < STREAMS_MAX;
        if has_room {
            open.push(frame);
        }
        has_room
    }

    /// The robot has confirmed the end of a stream.
    pub(crate) fn over(&self, stream: u64) {
        self.lock().retain(|known| u64::from(known.stream()) != stream);
    }

    /// Returns whether no stream is open.
    pub(crate) fn are_over(&self) -> bool {
        self.lock().is_empty()
    }

    /// Returns the frames that end the streams which their page has not ended.
    pub(crate) fn ends(&self) -> Vec<Vec<u8>> {
        self.lock().iter().filter(|known| !known.is_end()).map(Frame::end).collect()
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Frame>> {
        // Every change leaves a consistent list.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(flags: u8, stream: u32, before: u64, samples: usize) -> Vec<u8> {
        let mut bytes = vec![1, flags, 0, 0];
        bytes.extend(stream.to_le_bytes());
        bytes.extend(1.5_f64.to_le_bytes());
        bytes.extend(before.to_le_bytes());
        bytes.extend(vec![7; 2 * samples]);
        bytes
    }

    #[test]
    fn streams_are_followed_until_they_are_over() {
        let (sounds, read) = (Sounds::default(), |bytes: Vec<u8>| Frame::read(&bytes).unwrap());
        let first = read(frame(6, 9, 0, 800));
        assert!(first.stream() == 9 && sounds.is_new(&first) && sounds.take(first));
        assert!(!sounds.is_new(&first) && sounds.take(read(frame(6, 9, 800, 800))));
        assert!(sounds.take(read(frame(1, 10, 0, 0))), "a stream that its page has ended");
        assert_eq!(sounds.ends(), [frame(7, 9, 1_600, 0)]);
        sounds.over(9);
        assert!(!sounds.are_over() && sounds.ends().is_empty());
        sounds.over(10);
        assert!(sounds.are_over());
        let taken = (0..100).filter(|stream| sounds.take(read(frame(0, *stream, 0, 1)))).count();
        assert_eq!(taken, STREAMS_MAX);
    }

    #[test]
    fn what_is_no_frame_of_sound_is_none() {
        for bad in [vec![], vec![1; 23], frame(8, 1, 0, 1), [frame(0, 1, 0, 1), vec![0]].concat()] {
            assert_eq!(Frame::read(&bad), None);
        }
    }
}
